#include "sensing/incident_watch.hpp"

#include <gtest/gtest.h>

#include "sensing/traffic_fixture.hpp"

namespace clearway::sensing {
namespace {

/// Blocks the first edge of the scene at `position_m`, from 10 to 100 s.
traffic::Incident incident(float position_m) {
    const roads::Network& network = testing::small_scene().network();
    traffic::Incident blocked;
    for (std::uint32_t edge = 0; edge < network.edges().size(); ++edge)
        if (!network.edges()[edge].internal && !blocked.edge.exists()) blocked.edge = core::EdgeIndex{edge};
    blocked.lanes = {0};
    blocked.position_m = position_m;
    blocked.from = core::Seconds(10.0);
    blocked.to = core::Seconds(100.0);
    return blocked;
}

/// What is known at `time_s` when the class given reports, or not, right at the incident.
class Watch {
  public:
    explicit Watch(const traffic::Incident& blocked)
        : watch_(testing::small_scene().network(), {blocked}),
          at_(testing::small_scene().network().point_at(
              testing::small_scene().network().lane_of(blocked.edge, 0), core::Metres(blocked.position_m))) {}

    std::size_t known(double time_s, traffic::VehicleClass vehicle_class, traffic::Freshness freshness,
                      float away_m = 0.0F) {
        truth::Snapshot snapshot;
        snapshot.resize(1);
        snapshot.time = core::Seconds(time_s);
        snapshot.x_m[0] = at_.x_m + away_m;
        snapshot.y_m[0] = at_.y_m;
        traffic::Observation observation;
        observation.time = snapshot.time;
        observation.is_report = true;
        observation.vehicles.push_back({snapshot.key[0], vehicle_class, freshness, 0.0F, 0.0F, {}});
        watch_.observe(snapshot, observation);
        return observation.incidents.size();
    }

  private:
    IncidentWatch watch_;
    roads::Point at_;
};

using traffic::Freshness;
using traffic::VehicleClass;

TEST(IncidentWatch, is_known_once_an_automated_vehicle_with_a_working_sensor_sees_it) {
    Watch watch(incident(50.0F));
    EXPECT_EQ(watch.known(9.0, VehicleClass::automated, Freshness::fresh), 0U);  // not there yet
    EXPECT_EQ(watch.known(11.0, VehicleClass::human, Freshness::fresh), 0U);
    EXPECT_EQ(watch.known(12.0, VehicleClass::automated, Freshness::stale), 0U);
    EXPECT_EQ(watch.known(13.0, VehicleClass::automated, Freshness::fresh, 51.0F), 0U);
    EXPECT_EQ(watch.known(14.0, VehicleClass::automated, Freshness::fresh, 49.0F), 1U);
    EXPECT_EQ(watch.known(15.0, VehicleClass::human, Freshness::stale, 500.0F), 1U);  // and stays known
    EXPECT_EQ(watch.known(100.0, VehicleClass::automated, Freshness::fresh), 0U);     // over
}

TEST(IncidentWatch, the_scenario_may_set_when_it_is_known_to_all) {
    traffic::Incident blocked = incident(50.0F);
    blocked.known_after = core::Seconds(20.0);
    Watch watch(blocked);
    EXPECT_EQ(watch.known(29.5, VehicleClass::emergency, Freshness::fresh), 0U);
    EXPECT_EQ(watch.known(30.0, VehicleClass::human, Freshness::stale, 500.0F), 1U);
}

}  // namespace
}  // namespace clearway::sensing
