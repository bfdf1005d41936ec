// Whether a network bears a load, from SUMO's summary.
#include "scenario_import/detail/load_watch.hpp"

#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::scenario_import::detail {
namespace {

/// One row of a summary.
struct Row {
    double time_s = 0.0;
    int running = 20;
    double speed = 0.6;
    int waiting = 0;
    int teleports = 0;
};

class LoadWatchTest : public testing::Test {
  protected:
    std::filesystem::path file() const { return folder_.path() / "summary.xml"; }
    void append(const std::string& text) const { std::ofstream(file(), std::ios::app) << text; }
    static std::string row(const Row& row) {
        return fmt::format(
            "    <step time=\"{:.2f}\" loaded=\"2000\" inserted=\"380\" running=\"{}\" "
            "waiting=\"{}\" teleports=\"{}\" halting=\"5\" meanSpeedRelative=\"{:.2f}\"/>\n",
            row.time_s, row.running, row.waiting, row.teleports, row.running > 0 ? row.speed : -1.0);
    }
    /// Rows every 10 s, as `describe` says.
    template <class Describe>
    void write(double until_s, Describe&& describe) const {
        append("<summary>\n");
        for (double time_s = 0.0; time_s < until_s; time_s += 10.0) {
            Row made{time_s};
            describe(made);
            append(row(made));
        }
        append("</summary>\n");
    }
    LoadWatch watch(double free_speed = 0.8) const { return {file(), {400.0, free_speed}}; }
    LoadFault fault(double free_speed = 0.8) const { return watch(free_speed).fault(); }

  private:
    support::TemporaryFolder folder_;
};

TEST_F(LoadWatchTest, a_network_that_empties_bears_the_load) {
    write(1200.0, [](Row& row) { row.running = row.time_s < 1000.0 ? 20 : 0; });
    LoadWatch watch = this->watch();
    EXPECT_TRUE(watch.is_decided());
    EXPECT_EQ(watch.fault(), LoadFault::none);
    EXPECT_DOUBLE_EQ(watch.load().running, 20.0);
    EXPECT_DOUBLE_EQ(watch.load().halting, 5.0);
    EXPECT_NEAR(watch.load().relative_speed, 0.6, 1e-12);
    EXPECT_NEAR(watch.load().speed_of_all_time, 0.6, 1e-12);
    EXPECT_DOUBLE_EQ(watch.load().end_s, 990.0);
}

TEST_F(LoadWatchTest, a_summary_that_cannot_be_read_is_not_taken_for_its_end) {
    EXPECT_FALSE(watch().is_decided()) << "SUMO has not begun";
    EXPECT_THROW(LoadWatch("/proc/self/mem", {400.0, 0.8}).is_decided(), core::EnvironmentError);
}

TEST_F(LoadWatchTest, one_vehicle_that_stays_to_the_horizon_is_too_much) {
    write(demand_horizon_s, [](Row& row) { row.running = row.time_s < 1000.0 ? 20 : 1; });
    EXPECT_EQ(fault(), LoadFault::stays);
}

TEST_F(LoadWatchTest, the_speed_counts_beside_that_of_free_flow) {
    write(1200.0, [](Row& row) {
        row.running = row.time_s < 1000.0 ? 20 : 0;
        row.speed = row.time_s < 720.0 ? 0.3 : 0.38;
    });
    EXPECT_EQ(fault(0.8), LoadFault::slow);
    EXPECT_EQ(fault(0.7), LoadFault::none);
    EXPECT_EQ(fault(0.0), LoadFault::none);
}

TEST_F(LoadWatchTest, three_early_minutes_at_less_than_a_third_of_the_free_speed_end_the_run) {
    const auto jam_until = [&](double until_s, double speed) {
        std::filesystem::remove(file());
        write(until_s, [&](Row& row) { row.speed = row.time_s < 180.0 ? 0.8 : speed; });
    };
    jam_until(360.0, 0.2);
    EXPECT_FALSE(watch().is_decided()) << "the three minutes are not over";
    jam_until(370.0, 0.2);
    EXPECT_TRUE(watch().is_decided());
    EXPECT_EQ(fault(), LoadFault::slow);
    jam_until(370.0, 0.28);
    EXPECT_FALSE(watch().is_decided());
    EXPECT_FALSE(watch(0.0).is_decided());
}

TEST_F(LoadWatchTest, three_early_minutes_in_which_one_in_thirteen_waits_end_the_run) {
    write(190.0, [](Row& row) { row.waiting = 31; });
    EXPECT_TRUE(watch().is_decided());
    EXPECT_EQ(fault(), LoadFault::queues);
    std::filesystem::remove(file());
    write(190.0, [](Row& row) { row.waiting = 30; });
    EXPECT_FALSE(watch().is_decided());
}

TEST_F(LoadWatchTest, there_is_room_where_hardly_anybody_is_slowed_down_waits_or_is_teleported) {
    const auto has_room = [&](const Row& last_minutes) {
        std::filesystem::remove(file());
        write(1200.0, [&](Row& row) {
            row.running = row.time_s < 1000.0 ? 20 : 0;
            row.speed = last_minutes.speed;
            row.waiting = row.time_s < 900.0 ? last_minutes.waiting : 0;
            row.teleports = row.time_s < 1000.0 ? 0 : last_minutes.teleports;
        });
        LoadWatch watch = this->watch();
        EXPECT_EQ(watch.fault(), LoadFault::none);
        return watch.has_room();
    };
    EXPECT_TRUE(has_room({.speed = 0.61, .waiting = 4}));
    EXPECT_FALSE(has_room({.speed = 0.59}));
    EXPECT_FALSE(has_room({.speed = 0.61, .waiting = 5}));
    EXPECT_FALSE(has_room({.speed = 0.61, .teleports = 1}));
}

TEST_F(LoadWatchTest, vehicles_that_wait_to_enter_are_too_much) {
    write(1200.0, [](Row& row) {
        row.running = row.time_s < 1000.0 ? 20 : 0;
        row.waiting = row.time_s < 900.0 ? 21 : 0;
    });
    EXPECT_EQ(fault(), LoadFault::queues);
}

TEST_F(LoadWatchTest, teleports_are_too_much_at_once_and_whenever_one_looks) {
    append("<summary>\n" + row({.time_s = 300.0, .teleports = 4}));
    LoadWatch watch = this->watch();
    EXPECT_FALSE(watch.is_decided());
    const std::string next = row({.time_s = 310.0, .teleports = 5});
    append(next.substr(0, next.size() - 10));
    EXPECT_FALSE(watch.is_decided()) << "half a row is no row";
    append(next.substr(next.size() - 10));
    EXPECT_TRUE(watch.is_decided());
    append(row({.time_s = 320.0, .teleports = 50}));
    EXPECT_EQ(watch.fault(), LoadFault::teleports);
    EXPECT_DOUBLE_EQ(watch.load().teleports, 5.0);
}

}  // namespace
}  // namespace clearway::scenario_import::detail
