// A run that was recorded, thought through again without a simulator.
#include "trace/replay.hpp"

#include <algorithm>

#include <gmock/gmock.h>

#include "failures/failure_config.hpp"
#include "loop/study_folder.hpp"
#include "loop/unit_run.hpp"
#include "prediction/predictor.hpp"

namespace clearway::trace {
namespace {

using experiment::ConditionSpec;

ConditionSpec condition(const std::string& failure, const std::string& predictor,
                        std::vector<std::string> parts) {
    ConditionSpec spec;
    spec.name = "mine";
    spec.failure = failure;
    spec.predictor = predictor;
    spec.policies = std::move(parts);
    return spec;
}

/// A run of the intersection, recorded.
class RecordedRun {
  public:
    explicit RecordedRun(const ConditionSpec& condition,
                         experiment::StepRecording recording = experiment::StepRecording::on)
        : condition_(condition), folder_("intersection", {}, {condition}) {
        experiment::RunJob unit = folder_.unit(3);
        unit.recording = recording;
        loop::UnitRun run(unit, folder_.path() / "demand", folder_.path() / "work");
        results::RunTiming timing;
        record_ = run.finish_here(condition, timing);
    }
    ReplayResult replay(const ConditionSpec& condition) const {
        RecordingReader reader(file());
        const roads::Network network =
            roads::Network::read(folder_.path() / "scenarios/intersection/network/network.net.xml");
        return trace::replay(reader, condition, network);
    }
    ReplayResult replay() const { return replay(condition_); }
    std::filesystem::path file() const { return recording_file(folder_.path(), record_.key); }
    const results::RunRecord& record() const { return record_; }

  private:
    ConditionSpec condition_;
    test::StudyFolder folder_;
    results::RunRecord record_;
};

class EveryCondition : public testing::TestWithParam<ConditionSpec> {};

TEST_P(EveryCondition, ComesOutOfItsRecordingToTheBit) {
    const RecordedRun run(GetParam());
    const ReplayResult result = run.replay();
    EXPECT_GT(result.observations.compared, 100U);
    EXPECT_EQ(result.observations.same, result.observations.compared) << result.observations.first_difference;
    EXPECT_GT(result.beliefs.compared, 100U);
    EXPECT_EQ(result.beliefs.same, result.beliefs.compared) << result.beliefs.first_difference;
    EXPECT_EQ(result.leases.same, result.leases.compared) << result.leases.first_difference;
    EXPECT_GT(result.replayed.leases, 0U) << "a replay without leases shows little";
    EXPECT_EQ(result.replayed.leases, result.recorded.leases);
    // The run itself counted the same links.
    EXPECT_EQ(result.recorded.links.true_positive, run.record().metrics.links_true_positive);
    EXPECT_EQ(result.recorded.links.false_positive, run.record().metrics.links_false_positive);
    EXPECT_EQ(result.recorded.links.false_negative, run.record().metrics.links_false_negative);
    EXPECT_EQ(result.replayed.links, result.recorded.links);
}

/// Every way to fail, with the predictors in turn, and every predictor at least once.
std::vector<ConditionSpec> every_condition() {
    const std::vector<std::string> predictors = prediction::predictors().names();
    const std::vector<failures::FailurePreset> failures = failures::failure_presets();
    const std::vector<std::vector<std::string>> policies = {
        {"dissertation"}, {"corridor"}, {"preempt_signals", "clear_lane"}, {"listing_5_5"}};
    std::vector<ConditionSpec> conditions;
    for (std::size_t i = 0; i < std::max(failures.size(), predictors.size()); ++i) {
        conditions.push_back(condition(failures[i % failures.size()].name, predictors[i % predictors.size()],
                                       policies[i % policies.size()]));
    }
    return conditions;
}

INSTANTIATE_TEST_SUITE_P(Replay, EveryCondition, testing::ValuesIn(every_condition()),
                         [](const auto& tested) {
                             std::string name = tested.param.failure + "_" + tested.param.predictor;
                             std::ranges::replace(name, '.', '_');
                             return name;
                         });

TEST(Recording, ChangesNothingAboutARun) {
    const ConditionSpec spec = condition("B10", "dead_reckoning", {"dissertation"});
    const RecordedRun recorded(spec);
    const RecordedRun plain(spec, experiment::StepRecording::off);
    EXPECT_EQ(recorded.record(), plain.record());
    EXPECT_FALSE(std::filesystem::exists(plain.file()));
}

TEST(Replay, ShowsWhatAnotherPredictorWouldHaveBelieved) {
    const RecordedRun run(condition("B10", "none", {"dissertation"}));
    const ReplayResult result = run.replay(condition("B10", "dead_reckoning", {"dissertation"}));
    EXPECT_EQ(result.observations.same, result.observations.compared);
    EXPECT_LT(result.beliefs.same, result.beliefs.compared);
    EXPECT_THAT(result.beliefs.first_difference, testing::HasSubstr(" s: vehicles"));
    EXPECT_EQ(result.recorded.links.true_positive, run.record().metrics.links_true_positive);
    EXPECT_GT(result.replayed.links.recall().value(), result.recorded.links.recall().value());
    EXPECT_GT(result.candidates.pairs, 0U);
}

TEST(Replay, ShowsWhatOtherSensorsWouldHaveReported) {
    const RecordedRun run(condition("perfect", "none", {"dissertation"}));
    const ReplayResult result = run.replay(condition("A.7", "none", {"dissertation"}));
    EXPECT_LT(result.observations.same, result.observations.compared);
    EXPECT_EQ(result.recorded.links.false_negative, 0U);
    EXPECT_GT(result.replayed.links.false_negative, 0U);
}

TEST(Replay, BelievesInARunThatHadNoPolicy) {
    const RecordedRun run(condition("perfect", "none", {}));
    const ReplayResult result = run.replay(condition("B10", "dead_reckoning", {"dissertation"}));
    EXPECT_EQ(result.recorded.decisions, 0U);
    EXPECT_EQ(result.beliefs.compared, 0U);
    EXPECT_GT(result.replayed.decisions, 100U);
    EXPECT_GT(result.replayed.links.true_positive, 0U);
    EXPECT_GT(result.replayed.leases, 0U);
}

TEST(Replay, RefusesUnknownNames) {
    const RecordedRun run(condition("perfect", "none", {}));
    EXPECT_THROW(run.replay(condition("B11", "none", {})), core::InputError);
    EXPECT_THROW(run.replay(condition("B10", "nonne", {})), core::InputError);
}

}  // namespace
}  // namespace clearway::trace
