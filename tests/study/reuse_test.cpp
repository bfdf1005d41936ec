#include "study/reuse.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "results/synthetic.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::study {
namespace {

using results::Manifest;
using results::Store;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A folder `old` with all runs of a study, and the same study elsewhere.
class Reuse : public testing::Test {
  protected:
    Reuse() : old_(Store::create(folder_.path() / "old", wanted_)) {
        double travel_time_s = 40.0;
        for (const experiment::RunKey& key : wanted_.runs())
            old_.write(results::synthetic::record(key, travel_time_s++), {});
    }
    Store store(const std::string& name = "new") const {
        return Store::create(folder_.path() / name, wanted_);
    }
    std::string problem() const {
        try {
            static_cast<void>(reuse(store(), old_.folder()));
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "none";
    }

    support::TemporaryFolder folder_;
    Manifest wanted_ = results::synthetic::manifest(3);
    Store old_;
};

TEST_F(Reuse, takes_the_runs_of_conditions_and_scenarios_that_are_the_same) {
    wanted_.conditions[1].policies = {"corridor"};
    wanted_.conditions.push_back({.name = "more", .policies = {"green_wave"}});
    wanted_.scenarios[1].configuration_hash = std::string(32, 'b');
    wanted_.replications = 2;
    const Store now = store();
    const Reused reused = reuse(now, old_.folder());
    EXPECT_EQ(reused.runs, 2U) << "baseline in alpha";
    EXPECT_THAT(reused.other_conditions, ElementsAre("treated"));
    EXPECT_THAT(reused.damaged, IsEmpty());
    for (const std::uint32_t replication : {0U, 1U})
        EXPECT_EQ(now.read({"alpha", "baseline", replication})->metrics.emergency_travel_time_s,
                  old_.read({"alpha", "baseline", replication})->metrics.emergency_travel_time_s);
    EXPECT_EQ(now.complete_runs().size(), 2U);
    EXPECT_EQ(reuse(now, old_.folder()).runs, 0U) << "once is enough";
}

TEST_F(Reuse, takes_the_runs_of_a_condition_that_has_another_name_there) {
    wanted_.conditions[1].name = "ours";
    const Store now = store();
    const Reused reused = reuse(now, old_.folder());
    EXPECT_EQ(reused.runs, wanted_.run_count());
    EXPECT_THAT(reused.renamed, ElementsAre("ours (treated there)"));
    EXPECT_THAT(reused.other_conditions, IsEmpty());
    const results::RunRecord taken = *now.read({"alpha", "ours", 2});
    const results::RunRecord there = *old_.read({"alpha", "treated", 2});
    EXPECT_EQ(taken.condition, wanted_.conditions[1]);
    EXPECT_EQ(taken.metrics.emergency_travel_time_s, there.metrics.emergency_travel_time_s);
    EXPECT_EQ(there.condition.name, "treated") << "files may be shared, names not";
    now.check({"alpha", "ours", 2});
}

TEST_F(Reuse, leaves_out_a_damaged_run_and_says_so) {
    core::write_atomically(old_.run_folder({"alpha", "baseline", 1}) / "run.json", "{}");
    const Store now = store();
    const Reused reused = reuse(now, old_.folder());
    EXPECT_EQ(reused.runs, 11U);
    EXPECT_THAT(reused.damaged, ElementsAre(HasSubstr("It is left out")));
    EXPECT_FALSE(now.complete({"alpha", "baseline", 1}));
}

TEST_F(Reuse, refuses_what_cannot_be_the_same) {
    wanted_.study_seed = 2;
    EXPECT_THAT(problem(), HasSubstr("has the seed 1"));
    wanted_.study_seed = 1;
    wanted_.clearway_build = "another";
    EXPECT_THAT(problem(), HasSubstr("build of Clearway"));
}

TEST_F(Reuse, refuses_a_folder_that_shares_nothing) {
    for (results::ScenarioEntry& scenario : wanted_.scenarios)
        scenario.version = "v2";
    EXPECT_THAT(problem(), HasSubstr("has no scenario of this study"));
}

TEST_F(Reuse, refuses_what_is_no_run_folder) {
    const Store now = store();
    EXPECT_THROW(static_cast<void>(reuse(now, folder_.path() / "none")), core::InputError);
    EXPECT_THAT(now.complete_runs(), IsEmpty());
}

}  // namespace
}  // namespace clearway::study
