#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "core/json.hpp"
#include "experiment/settings.hpp"
#include "loop/study_folder.hpp"

namespace clearway {
namespace {

/// Short runs whose every number is pinned: a change of behaviour that nobody meant fails here. Each line of
/// the file is a run, the hash of its trace (all snapshots and leases), and one of its results (metrics,
/// vehicles, what became of leases, events of signals). A run that is meant to change is renewed with
/// CLEARWAY_RENEW_GOLDEN=1, which writes the new lines and fails once, so that it is a deliberate act.
class Golden : public testing::Test {
  protected:
    static experiment::ConditionSpec condition(const std::string& name, const std::string& policy) {
        experiment::ConditionSpec spec;
        spec.name = name;
        spec.failure = "perfect";
        spec.predictor = "none";
        spec.policies = {policy};
        return spec;
    }

    static void expect(const std::string& scenario, const std::vector<experiment::ConditionSpec>& runs,
                       const std::map<std::string, std::string>& environment = {}) {
        const test::StudyFolder folder(scenario, {}, runs);
        const core::Exit exit = folder.run(folder.unit(0), environment);
        ASSERT_TRUE(exit.ok()) << exit.describe() << core::tail(folder.log(), 20);
        std::map<std::string, std::string> known = read();
        const auto before = known;
        for (const experiment::ConditionSpec& run : runs) {
            const std::optional<results::RunRecord> record = folder.store().read({scenario, run.name, 0});
            ASSERT_TRUE(record.has_value()) << run.name;
            EXPECT_GT(record->metrics.leases_issued, 0U) << run.name;
            const std::string found = record->provenance.trace_hash + ' ' + hash_of_results(folder, *record);
            EXPECT_EQ(found, known[run.name])
                << run.name << " of " << scenario << " runs otherwise than before";
            known[run.name] = found;
        }
        if (std::getenv("CLEARWAY_RENEW_GOLDEN") != nullptr && known != before) write(known);
    }

  private:
    static constexpr const char* file = CLEARWAY_SOURCE_DIR "/tests/loop/golden.txt";

    static std::string hash_of_results(const test::StudyFolder& folder, const results::RunRecord& record) {
        core::Json all = core::Json::array();
        const auto add = [&](const auto& row) { core::write_fields(all.emplace_back(), row); };
        add(record.metrics);
        // These are younger than the file. They count where there is a lock, where ways or holds are tried,
        // where an incident is, or where somebody is called.
        if (record.metrics.locks == 0)
            for (const char* const column : {"locks", "locked_vehicles", "locked_emergency_vehicles",
                                             "locked_vehicle_s", "longest_lock_s"})
                all.back().erase(column);
        if (record.metrics.way_decisions == 0)
            for (const char* const column :
                 {"way_decisions", "way_decisions_best", "ways_tried", "way_regret_s"})
                all.back().erase(column);
        if (record.metrics.hold_decisions == 0)
            for (const char* const column :
                 {"hold_decisions", "hold_decisions_best", "holds_tried", "hold_regret_s"})
                all.back().erase(column);
        if (!record.metrics.incident_delay_s)
            for (const char* const column : {"emergency_met_incident", "emergency_turned_round",
                                             "emergency_cut_off", "others_rerouted", "incident_delay_s"})
                all.back().erase(column);
        if (record.metrics.units_sent + record.metrics.units_missing == 0)
            for (const char* const column :
                 {"units_sent", "units_missing", "unit_decisions", "wrong_unit_share", "unit_regret_s"})
                all.back().erase(column);
        for (const metrics::VehicleRow& vehicle : record.vehicles) {
            all.push_back(vehicle.id);
            add(vehicle);
            if (!vehicle.incident_met_s) all.back().erase("incident_met_s");
        }
        for (const metrics::LeaseRow& lease : record.leases) {
            all.push_back({lease.policy, name(lease.action), lease.refused_words()});
            add(lease);
        }
        const auto events = folder.store().read_signal_events(record.key);
        for (const metrics::SignalEvent& event : events.value())
            add(event);
        return core::content_hash(core::to_text(all));
    }

    static std::map<std::string, std::string> read() {
        std::map<std::string, std::string> hashes;
        std::istringstream lines(core::read_file(file));
        for (std::string name, trace, results; lines >> name >> trace >> results;)
            hashes[name] = trace + ' ' + results;
        return hashes;
    }
    static void write(const std::map<std::string, std::string>& hashes) {
        std::ofstream lines(file);
        for (const auto& [name, hash] : hashes)
            lines << name << ' ' << hash << '\n';
    }
};

TEST_F(Golden, CorridorWithPerfectSensorsAndOnARepairedGraph) {
    experiment::ConditionSpec repaired = condition("repaired_by_lead", "corridor");
    repaired.failure = "B10";
    repaired.predictor = "graphsage";
    experiment::set(repaired, "preempt_signals.timing", "lead");
    experiment::ConditionSpec by_lead = condition("corridor_by_lead", "corridor");
    experiment::set(by_lead, "preempt_signals.timing", "lead");
    expect("city", {condition("corridor", "corridor"), by_lead, repaired});
}

TEST_F(Golden, VacateLane) {
    expect("arterial", {condition("vacate_lane", "vacate_lane")});
}

/// The worker has an allocator of its own; a C library that is loaded before it takes its place.
TEST_F(Golden, IsTheSameWithTheAllocatorOfTheCLibrary) {
    expect("arterial", {condition("vacate_lane", "vacate_lane")}, {{"LD_PRELOAD", "libc.so.6"}});
}

}  // namespace
}  // namespace clearway
