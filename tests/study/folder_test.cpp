#include <cstdlib>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "experiment/conditions.hpp"
#include "scenario/network.hpp"
#include "study/plan.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::study {
namespace {

class RunFolder : public testing::Test {
  protected:
    RunFolder() {
        setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1);
        setenv("SUMO_HOME", "/usr/share/sumo", 0);
        config_.scenarios = {scenario::load("merge")};
        config_.conditions = {experiment::built_in_condition("baseline", "")};
        config_.replications = 1;
    }
    Plan plan() const { return make_plan(config_, {"0.1.0", "1.15.0"}, out_); }

    support::TemporaryFolder folder_;
    std::filesystem::path out_ = folder_.path() / "out";
    StudyConfig config_;
};

TEST_F(RunFolder, HoldsScenarioAndNetworkAsUnitsNameThem) {
    const results::Store store = prepare_folder(plan(), out_);
    const experiment::RunJob unit = plan().units.front().unit;
    const scenario::ScenarioConfig stored = scenario::load(unit.scenario_file.string());
    EXPECT_EQ(scenario::scenario_hash(stored), store.manifest().scenarios.front().configuration_hash);
    EXPECT_TRUE(std::filesystem::exists(scenario::open_network(stored, unit.network_folder).file));
}

TEST_F(RunFolder, IsKeptWhenItIsPreparedAgain) {
    prepare_folder(plan(), out_);
    const auto file = out_ / "scenarios" / "merge" / "network" / "network.net.xml";
    const auto before = std::filesystem::last_write_time(file);
    prepare_folder(plan(), out_);
    EXPECT_EQ(std::filesystem::last_write_time(file), before);
    config_.seed = 2;
    EXPECT_THROW(prepare_folder(plan(), out_), core::InputError);
}

TEST_F(RunFolder, HasNoHalfScenarioAfterAFailure) {
    config_.scenarios[0].network.edges = "none.edg.xml";
    EXPECT_ANY_THROW(prepare_folder(plan(), out_));
    EXPECT_FALSE(std::filesystem::exists(out_ / "scenarios" / "merge"));
}

}  // namespace
}  // namespace clearway::study
