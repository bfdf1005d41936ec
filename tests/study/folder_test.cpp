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

/// What the error says that preparing the folder again ends with.
class ContinuedFolder : public RunFolder {
  protected:
    std::string refusal() const {
        try {
            prepare_folder(plan(), out_);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "";
    }
};

TEST_F(ContinuedFolder, IsRefusedWhereItsScenarioWasEdited) {
    prepare_folder(plan(), out_);
    EXPECT_EQ(refusal(), "");
    const auto file = out_ / "scenarios" / "merge" / "scenario.toml";
    std::string text = core::read_file(file);
    const std::size_t at = text.find("human = ");
    ASSERT_NE(at, std::string::npos);
    text.insert(at + 8, "1");
    core::write_atomically(file, text);
    EXPECT_THAT(refusal(), testing::AllOf(testing::HasSubstr("merge/scenario.toml"),
                                          testing::HasSubstr("was changed"), testing::HasSubstr("remove ")));
    std::filesystem::remove_all(file.parent_path());
    EXPECT_EQ(refusal(), "") << "made again";
}

TEST_F(ContinuedFolder, IsRefusedWhereItsNetworkWasEdited) {
    prepare_folder(plan(), out_);
    const auto file = out_ / "scenarios" / "merge" / "network" / "network.net.xml";
    core::write_atomically(file, core::read_file(file) + "\n");
    EXPECT_THAT(refusal(),
                testing::AllOf(testing::HasSubstr("network/network.net.xml: was changed"),
                               testing::HasSubstr("remove " + (out_ / "scenarios/merge").string())));
    std::filesystem::remove_all(out_ / "scenarios" / "merge");
    EXPECT_EQ(refusal(), "") << "made again";
}

TEST_F(ContinuedFolder, IsRefusedWhereALinkLeadsOutOfIt) {
    prepare_folder(plan(), out_);
    const auto elsewhere = folder_.path() / "elsewhere";
    std::filesystem::create_directory(elsewhere);
    std::filesystem::create_directory_symlink(elsewhere, out_ / "work");
    EXPECT_THAT(refusal(), testing::HasSubstr("work: is a symbolic link"));
}

TEST_F(RunFolder, HasNoHalfScenarioAfterAFailure) {
    config_.scenarios[0].network.edges = "none.edg.xml";
    EXPECT_ANY_THROW(prepare_folder(plan(), out_));
    EXPECT_FALSE(std::filesystem::exists(out_ / "scenarios" / "merge"));
}

}  // namespace
}  // namespace clearway::study
