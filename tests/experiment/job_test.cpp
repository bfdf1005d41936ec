#include "experiment/job.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::experiment {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

RunJob run_job() {
    RunJob job;
    job.scenario = "city";
    job.scenario_file = "/out/scenarios/city/scenario.toml";
    job.network_folder = "/out/scenarios/city/network";
    job.study_seed = 18446744073709551615U;
    job.replication = 7;
    job.traffic_model = TrafficModel::sublane;
    job.recording = StepRecording::on;
    ConditionSpec condition;
    condition.name = "b10";
    condition.failure = "B10,mean_outage_s=20,detection=range";
    condition.predictor = "dead_reckoning";
    condition.policies = {"dissertation", "preempt"};
    condition.traffic_model = TrafficModel::sublane;
    condition.safety_checks = traffic::SafetyChecks::off;
    condition.settings = {{"loop.policy_period_s", "1"}, {"dissertation.ahead_m", "80"}};
    condition.model_file = "/models/net.weights";
    condition.model_hash = "00ff";
    condition.bluelight = traffic::BlueLight::on;
    ConditionSpec plain;
    plain.name = "plain";
    job.conditions = {condition, plain};
    job.limits = {.wall_s = 12.5, .memory_mib = 300};
    job.output = "/out";
    return job;
}

DatasetJob dataset_job() {
    DatasetJob job;
    job.scenario = "city";
    job.scenario_file = "a/scenario.toml";
    job.network_folder = "a/network";
    job.study_seed = 8101;
    job.replication = 4;
    job.output = "out";
    job.dataset = DatasetKind::repair;
    job.pairs = ListedPairs::true_links;
    job.feature_count = 2;
    job.failures = {"B10", "D3"};
    job.interval_s = 2.5;
    job.exits = failures::Exits::unknown;
    job.policies = {"corridor", "red_privilege"};
    job.settings = {{"preempt_signals.lead_s", "12"}};
    return job;
}

LinkJob link_job() {
    LinkJob job;
    job.scenario = "city";
    job.scenario_file = "a/scenario.toml";
    job.network_folder = "a/network";
    job.study_seed = 8101;
    job.replication = 3;
    job.work_folder = "work";
    job.failures = {"B10", "D3"};
    job.exits = {failures::Exits::known};
    job.policy = "corridor";
    job.predictors = {{"kalman", "", {{"link_threshold", "0.25"}}, "out.links"},
                      {"none", "a.weights", {}, "b"},
                      {"Mine", "", {}, "c", "/a/mine.py:Mine@0123456789abcdef0123456789abcdef"}};
    return job;
}

AttachJob attach_job() {
    AttachJob job;
    job.host = "localhost";
    job.port = 8813;
    job.network = "a/net.xml";
    job.automated = {"robot"};
    job.emergency = {"ambulance", "fire"};
    job.study_seed = 9;
    job.condition.name = "attached";
    job.condition.policies = {"corridor"};
    job.output = "/out";
    return job;
}

class JobTest : public ::testing::Test {
  protected:
    Job written_and_read(const Job& job) { return read_job(folder_.write("job.json", to_json(job))); }
    /// What is wrong with a file; empty for a good one.
    std::string complaint(const std::string& text) {
        try {
            read_job(folder_.write("job.json", text));
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "";
    }
    support::TemporaryFolder folder_;
};

TEST_F(JobTest, EveryKindSurvivesTheWayThroughAFile) {
    RunJob shown = run_job();
    shown.window = WindowSpec{.delay_s = 0.25, .settings_file = "view.xml", .program = "sumo"};
    for (const Job& job :
         {Job(run_job()), Job(shown), Job(dataset_job()), Job(link_job()), Job(attach_job())})
        EXPECT_TRUE(written_and_read(job) == job) << to_json(job);
}

TEST_F(JobTest, ReportsEveryProblemOfAFileAtOnce) {
    const std::string said = complaint(
        R"({"kind": "run", "scenario": 3, "traffic_model": "warp", "conditions": {}, "colour": "red"})");
    EXPECT_THAT(said, HasSubstr("scenario: is of another type"));
    EXPECT_THAT(said, HasSubstr("\"warp\" is not known"));
    EXPECT_THAT(said, HasSubstr("output: is missing"));
    EXPECT_THAT(said, HasSubstr("conditions: is of another type"));
    EXPECT_THAT(said, HasSubstr("colour: is unknown"));
    EXPECT_NE(complaint(to_json(run_job()).substr(0, 90)), "");
}

TEST_F(JobTest, RefusesConditionsThatSumoCannotServeTogether) {
    RunJob job = run_job();
    for (ConditionSpec& condition : job.conditions)
        condition.rerouting_s = 30.0;
    EXPECT_EQ(complaint(to_json(job)), "");
    job.conditions.back().rerouting_signal_penalty = 1.0;
    EXPECT_THAT(complaint(to_json(job)), HasSubstr("\"b10\" and \"plain\" need other penalties for signals"));
}

TEST_F(JobTest, NamesTheKindsThatThereAre) {
    EXPECT_THAT(complaint(R"({"kind": "fly"})"),
                AllOf(HasSubstr("\"fly\" is not known"), HasSubstr("run, dataset, links or attach")));
    EXPECT_THAT(complaint("{}"), HasSubstr("kind: is missing"));
}

TEST_F(JobTest, SaysNothingOfPoliciesWhereADataSetHasNone) {
    DatasetJob job = dataset_job();
    EXPECT_EQ(sample_file(job, "B10", ".samples"),
              "out/city-B10-exits-unknown-under-corridor+red_privilege-0004.samples");
    job.policies.clear();
    job.settings.clear();
    EXPECT_THAT(to_json(job), Not(HasSubstr("policies")));
    EXPECT_THAT(to_json(job), Not(HasSubstr("settings")));
    EXPECT_EQ(sample_file(job, "B10", ".samples"), "out/city-B10-exits-unknown-0004.samples");
}

TEST_F(JobTest, RefusesNumbersOutOfRangeAndWordsThatAreNotKnown) {
    AttachJob attach = attach_job();
    attach.port = 70000;
    EXPECT_THAT(complaint(to_json(attach)),
                AllOf(HasSubstr("port"), HasSubstr("70000"), HasSubstr("1 to 65535")));
    DatasetJob dataset = dataset_job();
    dataset.interval_s = 0.0;
    EXPECT_THAT(complaint(to_json(dataset)), HasSubstr("interval_s"));
    RunJob run = run_job();
    run.limits.wall_s = 0.0;
    EXPECT_THAT(complaint(to_json(run)), HasSubstr("wall_limit_s: is not above 0"));
    std::string text = to_json(dataset_job());
    text.replace(text.find("repair"), 6, "unread");
    EXPECT_THAT(complaint(text),
                AllOf(HasSubstr("\"unread\" is not known"), HasSubstr("published, samples")));
}

TEST_F(JobTest, RefusesNamesThatLeadOutOfAFolder) {
    RunJob run = run_job();
    run.scenario = "../escaped";
    EXPECT_THAT(complaint(to_json(run)),
                HasSubstr("scenario: \"../escaped\" cannot be the name of a folder"));
    run = run_job();
    run.conditions.front().name = "../escaped";
    EXPECT_THAT(complaint(to_json(run)),
                HasSubstr("conditions: name: \"../escaped\" cannot be the name of a folder"));
    DatasetJob dataset = dataset_job();
    dataset.scenario = "../escaped";
    EXPECT_THAT(complaint(to_json(dataset)), HasSubstr("cannot be the name of a folder"));
}

}  // namespace
}  // namespace clearway::experiment
