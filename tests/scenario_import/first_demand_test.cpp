#include <cstdlib>

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "scenario_import/detail/sumo_trial.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::scenario_import::detail {
namespace {

/// The first demand of an import of the city.
class FirstDemand : public testing::Test {
  protected:
    FirstDemand() {
        setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1);
        setenv("SUMO_HOME", "/usr/share/sumo", 0);
        config_ = scenario::load("city");
    }

    support::TemporaryFolder folder_;
    ImportRequest request_;
    OnProgress on_progress_ = [](const std::string&, double) {};
    Import import_{request_, on_progress_, folder_.path(), folder_.path()};
    scenario::ScenarioConfig config_;
};

TEST_F(FirstDemand, HalvesTheLengthOfTripsUntilTheNetworkHasThem) {
    config_.trips.emergency_minimum_length_m = 16000.0;
    EXPECT_FALSE(make_demand(import_, config_).demand.emergency.empty());
    EXPECT_LE(config_.trips.emergency_minimum_length_m, 4000.0);
}

TEST_F(FirstDemand, RefusesWhatShorterTripsDoNotCureAtOnce) {
    config_.emergency_sites.emplace_back().edge = "nowhere";
    const double least_m = config_.trips.emergency_minimum_length_m;
    EXPECT_THROW(make_demand(import_, config_), core::InputError);
    EXPECT_DOUBLE_EQ(config_.trips.emergency_minimum_length_m, least_m);
}

}  // namespace
}  // namespace clearway::scenario_import::detail
