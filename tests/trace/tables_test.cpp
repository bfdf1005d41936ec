#include <algorithm>

#include <gmock/gmock.h>

#include "trace/random_run.hpp"
#include "trace/recording_tables.hpp"

namespace clearway::results {
namespace {

/// A step in which one emergency vehicle, believed 2 m from a car, asks it to change lanes.
class OneStep : public testing::Test {
  protected:
    OneStep() {
        for (const char* const id : {"ambulance,1", "car"}) {
            traffic::VehicleInfo info;
            info.id = id;
            info.key = core::vehicle_key(id);
            roster_.add(info);
        }
        const core::VehicleKey ambulance = core::vehicle_key("ambulance,1");
        const core::VehicleKey car = core::vehicle_key("car");
        snapshot_.time = core::Seconds(12.5);
        snapshot_.key = {ambulance};
        snapshot_.resize(1);
        snapshot_.vehicle_class = {traffic::VehicleClass::emergency};
        snapshot_.x_m = {0.1F};
        snapshot_.y_m = {-3.0F};
        snapshot_.speed_mps = {8.25F};
        snapshot_.lane = {core::LaneIndex{1}};
        snapshot_.signals.state = {"Gr"};
        events_.departed = {car};
        observation_.is_report = true;
        observation_.vehicles = {
            {car, traffic::VehicleClass::human, traffic::Freshness::stale, 4.0F, 0.0F, {}}};
        observation_.detected_links = {{ambulance, car, -1.0F, 0.0F}};
        belief_.vehicles = {{ambulance, traffic::VehicleClass::emergency, {}, 0.5F, 0.0F},
                            {car, traffic::VehicleClass::human, {}, 3.0F, 4.0F}};
        belief_.first_link = {0, 1, 2};
        belief_.links = {{1, 2.0F, 0.75F}, {0, 2.0F, 0.75F}};
        leases_ = {
            {car, traffic::ChangeLane{1}, core::Seconds(14.0), 2, "clear_lane", "in the way", ambulance},
            {core::SignalIndex{0}, traffic::HoldGreen{{2, 3}, {3}}, core::Seconds(20.0), 0, "preempt", "near",
             ambulance},
            {traffic::Stretch{core::LaneIndex{1}, 20.0F, 320.5F, 8.0F}, traffic::PullAside{},
             core::Seconds(17.5), 1, "geocast", "cleared", ambulance},
            {ambulance, traffic::StandBack{{core::EdgeIndex{4}, core::EdgeIndex{0}}}, core::Seconds(18.0), 0,
             "navigate", "faster", ambulance}};
        step_ = {&snapshot_, &roster_, &events_, &observation_, &belief_, leases_};
    }
    std::string lines(trace::RecordingTable table) const {
        return trace::csv_lines(table, step_, {{"first_0", "first_1"}, {"crossing"}});
    }

    traffic::Roster roster_;
    truth::Snapshot snapshot_;
    truth::Events events_;
    traffic::Observation observation_;
    traffic::BelievedGraph belief_;
    std::vector<traffic::Lease> leases_;
    trace::RecordedStep step_;
};

TEST_F(OneStep, IsWrittenWithNamesAndUnits) {
    EXPECT_EQ(trace::csv_header(trace::RecordingTable::snapshot),
              "time_s,vehicle,class,acceleration_mps2,x_m,y_m,heading_rad,speed_mps,lane,lane_position_m,"
              "route_edge\n");
    EXPECT_EQ(lines(trace::RecordingTable::snapshot),
              "12.5,\"ambulance,1\",emergency,0,0.1,-3,0,8.25,first_1,0,0\n");
    EXPECT_EQ(lines(trace::RecordingTable::signals), "12.5,crossing,Gr\n");
    EXPECT_EQ(lines(trace::RecordingTable::events), "12.5,departed,car,,,\n");
    EXPECT_EQ(lines(trace::RecordingTable::observation), "12.5,1,car,human,stale,4,0,0,0,0,0,,0,0\n");
    EXPECT_EQ(lines(trace::RecordingTable::detections), "12.5,\"ambulance,1\",car,,0\n");
    EXPECT_EQ(lines(trace::RecordingTable::belief),
              "12.5,\"ambulance,1\",emergency,0,0.5,0,0,0,0,,0,0\n12.5,car,human,4,3,0,0,0,0,,0,0\n");
    EXPECT_EQ(lines(trace::RecordingTable::links), "12.5,\"ambulance,1\",car,2,0.75\n");
    EXPECT_EQ(lines(trace::RecordingTable::leases),
              "12.5,car,,change_lane,,1,,,,14,2,clear_lane,in the way,\"ambulance,1\",,,,,\n"
              "12.5,,crossing,hold_green,,,,2 3,3,20,0,preempt,near,\"ambulance,1\",,,,,\n"
              "12.5,,,pull_aside,,,right,,,17.5,1,geocast,cleared,\"ambulance,1\",first_1,20,320.5,8,"
              "automated\n"
              "12.5,\"ambulance,1\",,stand_back,,,,4 0,,18,0,navigate,faster,\"ambulance,1\",,,,,\n");
}

TEST(RecordingTables, HaveAsManyCellsAsTheirHeaderInEveryLine) {
    test::RandomRun run(4);
    const auto cells = [](const std::string& line) {
        bool quoted = false;
        return std::ranges::count_if(line, [&](char letter) {
            if (letter == '"') quoted = !quoted;
            return letter == ',' && !quoted;
        });
    };
    for (int step = 0; step < 30; ++step) {
        const trace::RecordedStep now = run.next();
        for (const std::string& word : trace::recording_table_names()) {
            const trace::RecordingTable table = trace::recording_table_from(word).value();
            EXPECT_EQ(name(table), word);
            std::string text = trace::csv_lines(table, now, {});
            for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
                EXPECT_EQ(cells(text.substr(0, end)), cells(trace::csv_header(table))) << word;
                text.erase(0, end + 1);
            }
        }
    }
    EXPECT_EQ(trace::recording_table_from("belif"), std::nullopt);
}

}  // namespace
}  // namespace clearway::results
