// Who answers a call.
#include <map>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include "loop/copy_of_run.hpp"
#include "loop/study_folder.hpp"
#include "loop/unit_run.hpp"
#include "scenario/called_scenario.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::loop {
namespace {

using experiment::ConditionSpec;
using experiment::Dispatch;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::Le;

ConditionSpec by(Dispatch dispatch, core::Settings settings = {}) {
    ConditionSpec spec;
    spec.name = std::string(experiment::name(dispatch)) + (settings.empty() ? "" : "_tried");
    spec.dispatch = dispatch;
    spec.settings = std::move(settings);
    return spec;
}

/// The scenario of called_scenario.hpp with more text.
class CalledScenario {
  public:
    explicit CalledScenario(const std::string& rest) {
        scenario::write_called_roads(
            [&](const std::string& name, const std::string& text) { return folder_.write(name, text); });
        folder_.write("scenario.toml", scenario::called_head + rest);
    }
    std::string file() const { return (folder_.path() / "scenario.toml").string(); }

  private:
    support::TemporaryFolder folder_;
};

struct Outcome {
    results::RunRecord record;
    /// The first edge of each emergency vehicle, by id.
    std::map<std::string, std::string> from = {};
};

/// Notes where emergency vehicles start.
class Starts : public trace::StepListener {
  public:
    explicit Starts(const roads::Network& network) : network_(network) {}
    void on_step(const truth::Snapshot&, const traffic::Roster&) override {}
    void on_step_end(const trace::RecordedStep& step) override {
        for (std::size_t row = 0; row < step.snapshot->size(); ++row) {
            if (step.snapshot->vehicle_class[row] != traffic::VehicleClass::emergency) continue;
            const traffic::VehicleInfo& info = *step.roster->find(step.snapshot->key[row]);
            from.emplace(info.id, network_.edge(step.roster->route(info.route).front()).id);
        }
    }
    std::map<std::string, std::string> from;

  private:
    const roads::Network& network_;
};

Outcome outcome_of(const std::string& rest, const ConditionSpec& condition) {
    const CalledScenario called(rest);
    const test::StudyFolder folder(called.file(), {}, {condition});
    UnitRun run(folder.unit(0), folder.path() / "demand", folder.path() / "sumo");
    Starts starts(run.network());
    results::RunTiming timing;
    Outcome outcome{run.finish_here(condition, timing, &starts)};
    outcome.from = starts.from;
    return outcome;
}

constexpr const char* one_call = "[[call]]\nedge = \"place\"\nat_s = 150.0\n";
/// Known at once, and in force when the unit would be there.
constexpr const char* closed_later =
    "[[incident]]\nedge = \"straight\"\nfrom_s = 100.0\nto_s = 205.0\nknown_after_s = 0.0\n";

std::string start_of(const std::string& rest, Dispatch dispatch) {
    const Outcome outcome = outcome_of(rest, by(dispatch));
    EXPECT_EQ(outcome.record.metrics.units_sent, 1U);
    EXPECT_EQ(outcome.record.metrics.emergency_arrived, 1U);
    return outcome.from.empty() ? "nowhere" : outcome.from.begin()->second;
}

TEST(Dispatcher, EachRuleSendsTheStationThatItFindsNearest) {
    EXPECT_EQ(start_of(one_call, Dispatch::straight_line), "east");
    EXPECT_EQ(start_of(one_call, Dispatch::free_flow), "west");
    EXPECT_EQ(start_of(one_call, Dispatch::believed), "west");
    EXPECT_EQ(start_of(one_call, Dispatch::true_times), "west");
}

TEST(Dispatcher, WhoKnowsOfABlockSendsFromTheOtherSide) {
    const std::string blocked = std::string(closed_later) + one_call;
    EXPECT_EQ(start_of(blocked, Dispatch::free_flow), "west");
    EXPECT_EQ(start_of(blocked, Dispatch::believed), "east");
    EXPECT_EQ(start_of(blocked, Dispatch::true_times), "east");
    // Nobody is told of it in time, and no sensor passes: beliefs do not know it, the truth does.
    std::string unheard = blocked;
    unheard.replace(unheard.find("known_after_s = 0.0"), 19, "known_after_s = 104.0");
    EXPECT_EQ(start_of(unheard, Dispatch::believed), "west");
    EXPECT_EQ(start_of(unheard, Dispatch::true_times), "east");
}

TEST(Dispatcher, UnitsGoOnceAndThoseThatAreMissingCount) {
    const Outcome outcome = outcome_of(std::string("[[call]]\nedge = \"place\"\nat_s = 150.0\nunits = 2\n") +
                                           "[[call]]\nedge = \"place\"\nat_s = 200.0\n",
                                       by(Dispatch::free_flow));
    EXPECT_EQ(outcome.record.metrics.units_sent, 3U);
    EXPECT_EQ(outcome.record.metrics.units_missing, 0U);
    const std::map<std::string, std::string> expected = {
        {"emergency.call.0.0", "west"}, {"emergency.call.0.1", "east"}, {"emergency.call.1.0", "east"}};
    EXPECT_EQ(outcome.from, expected);
    EXPECT_EQ(outcome.record.metrics.emergency_arrived, 3U);
}

TEST(Dispatcher, WhoIsCalledToABlockedRoadDrivesUpToTheBlock) {
    for (const char* const policy : {"", "navigate"}) {
        ConditionSpec condition = by(Dispatch::free_flow);
        if (*policy != '\0') condition.policies = {policy};
        const Outcome outcome = outcome_of(
            "[[incident]]\nedge = \"place\"\nfrom_s = 200.0\nknown_after_s = 0.0\n[[call]]\nincident = 0\n",
            condition);
        EXPECT_EQ(outcome.record.metrics.emergency_arrived, 1U) << policy;
        EXPECT_EQ(outcome.record.metrics.emergency_cut_off, 0U) << policy;
    }
}

TEST(Dispatcher, CopiesTellWhichUnitWasWrongAndDoNotChangeTheRun) {
    const core::Settings tried = {{"loop.units_tried", "2"}};
    const Outcome wrong = outcome_of(one_call, by(Dispatch::straight_line, tried));
    EXPECT_EQ(wrong.record.metrics.unit_decisions, 1U);
    EXPECT_EQ(wrong.record.metrics.wrong_unit_share, 1.0);
    const Outcome right = outcome_of(one_call, by(Dispatch::free_flow, tried));
    EXPECT_EQ(right.record.metrics.wrong_unit_share, 0.0);
    EXPECT_EQ(right.record.metrics.unit_regret_s, 0.0);
    // The copy that sent the other unit is as late as the run that did.
    const auto arrival_s = [](const Outcome& outcome) {
        for (const metrics::VehicleRow& row : outcome.record.vehicles)
            if (row.vehicle_class == traffic::VehicleClass::emergency) return row.arrival_s.value();
        return 0.0;
    };
    EXPECT_NEAR(wrong.record.metrics.unit_regret_s.value(), arrival_s(wrong) - arrival_s(right), 1e-6);
    EXPECT_EQ(outcome_of(one_call, by(Dispatch::straight_line)).record.provenance.trace_hash,
              wrong.record.provenance.trace_hash);
}

TEST(Dispatcher, AStationThatIsSentAnywayIsNoBetterOne) {
    const auto counts = [](int units, Dispatch dispatch) {
        const std::string call = fmt::format("{}units = {}\n", one_call, units);
        return outcome_of(call, by(dispatch, {{"loop.units_tried", "2"}})).record.metrics;
    };
    // From the east twice, where the first could have come from the west.
    const metrics::RunMetrics wrong = counts(2, Dispatch::straight_line);
    EXPECT_EQ(wrong.unit_decisions, 2U);
    EXPECT_GE(wrong.wrong_unit_share.value(), 0.5);
    EXPECT_EQ(counts(2, Dispatch::free_flow).unit_decisions, 0U);
    EXPECT_EQ(counts(3, Dispatch::straight_line).unit_decisions, 0U) << "all are sent";
}

TEST(Dispatcher, ACopyOfTheRunIsNotCopiedAgain) {
    const ConditionSpec tried = by(Dispatch::free_flow, {{"loop.units_tried", "2"}});
    EXPECT_EQ(outcome_of(one_call, tried).record.metrics.unit_decisions, 1U);
    const CalledScenario called(one_call);
    const test::StudyFolder folder(called.file(), {}, {tried});
    UnitRun run(folder.unit(0), folder.path() / "demand", folder.path() / "sumo");
    ClosedLoop& loop = run.start(tried);
    loop.run(core::Seconds(140.0));
    // The call comes in while the copy runs, as where another way of a vehicle is tried.
    const core::Seconds largest_kib = in_copy(folder.path() / "copy", [&] {
        loop.end_after([] { return true; }, core::VehicleKey{1}, core::Seconds(160.0),
                       folder.path() / "copy");
        rusage children{};
        getrusage(RUSAGE_CHILDREN, &children);
        return core::Seconds(static_cast<double>(children.ru_maxrss));
    });
    EXPECT_EQ(largest_kib.value, 0.0) << "the copy had children of its own";
}

TEST(Dispatcher, UnitsWhoseWaysCrossAtASignalAllArrive) {
    support::TemporaryFolder made;
    const std::filesystem::path folder = made.path() / "crossing";
    scenario::init(folder, "intersection");
    std::string text = core::read_file(folder / "scenario.toml");
    // From every side at once.
    for (const auto& [from, to] : {std::pair{"north", "south"}, std::pair{"east", "west"},
                                   std::pair{"south", "north"}, std::pair{"west", "east"}})
        text += fmt::format(
            "\n[[emergency_site]]\nkind = \"ambulance_station\"\nedge = \"{}_in\"\n"
            "\n[[call]]\nedge = \"{}_out\"\nat_s = 100.0\n",
            from, to);
    core::write_atomically(folder / "scenario.toml", text);
    ConditionSpec corridor = by(Dispatch::straight_line);
    corridor.policies = {"corridor"};
    const test::StudyFolder study((folder / "scenario.toml").string(), {}, {corridor});
    UnitRun run(study.unit(0), study.path() / "demand", study.path() / "sumo");
    results::RunTiming timing;
    const results::RunRecord record = run.finish_here(corridor, timing);
    EXPECT_EQ(record.metrics.units_sent, 4U);
    EXPECT_EQ(record.metrics.emergency_arrived, record.metrics.emergency_count);
    EXPECT_EQ(record.metrics.emergency_collisions, 0U);
    // Nobody waits for longer than the green of the other street and the change.
    for (const metrics::VehicleRow& row : record.vehicles) {
        if (!row.id.starts_with("emergency.call")) continue;
        EXPECT_LT(row.waiting_time_s.value(), 45.0) << row.id;
    }
}

}  // namespace
}  // namespace clearway::loop
