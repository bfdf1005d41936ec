#include "links/link_evaluation.hpp"

#include <algorithm>

#include <gmock/gmock.h>

#include "support/ascii_scene.hpp"
#include "support/told_sensor.hpp"

namespace clearway::links {
namespace {

// Fronts at x = 5 (a1), 35 (h1), 45 (h2), 85 (e1), 125 (h3) and 155 (a2). Links below 50 m: a1-h1, a1-h2,
// h2-e1, e1-h3, h3-a2; of them e1-h3 is with a vehicle ahead of the emergency vehicle. Human drivers are not
// linked to each other.
constexpr const char* road = R"(
    10 m per cell, limit 20 m/s, speed 0 m/s
    a..hh...e...h..a............................................
)";

/// Logs the true links that it is not told of.
class LoggingSensor final : public support::ToldSensor {
  public:
    using ToldSensor::ToldSensor;
    void log_failures(const truth::Snapshot& snapshot, const graph::ProximityGraph& true_graph,
                      sensing::FailureLog& log) const override {
        const auto is_told = [&](core::VehicleIndex row) {
            return std::ranges::find(told_.vehicles, snapshot.key[row], &traffic::ObservedVehicle::key) !=
                   told_.vehicles.end();
        };
        log.lost_links.clear();
        log.never_seen.clear();
        for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
            if (!is_told(row)) log.never_seen.push_back(snapshot.key[row]);
        }
        for (core::VehicleIndex left = 0; left < snapshot.size(); ++left) {
            for (const core::VehicleIndex right : true_graph.neighbours_of(left)) {
                if (right > left && !(is_told(left) && is_told(right)))
                    log.lost_links.push_back(
                        {snapshot.key[left], snapshot.key[right], sensing::FailureLog::Cause::never_seen});
            }
        }
    }
};

/// h3 is dark where it was last seen; h1 is dark and was last seen 400 m on; a2 never reported; a vehicle
/// that has left is still known, at x = 100.
traffic::Observation failing_observation(const support::Scene& scene) {
    traffic::Observation observation = support::perfect_observation(scene);
    observation.is_report = true;
    std::vector<traffic::ObservedVehicle>& vehicles = observation.vehicles;
    const auto make_dark = [&](const std::string& id, float age_s) -> traffic::ObservedVehicle& {
        auto vehicle = std::ranges::find(vehicles, scene.key(id), &traffic::ObservedVehicle::key);
        vehicle->freshness = traffic::Freshness::stale;
        vehicle->age_s = age_s;
        return *vehicle;
    };
    make_dark("h3", 3.0F);
    traffic::MotionState& far = make_dark("h1", 3.0F).state;
    far.x_m = 405.0F;
    far.lane_position_m = 405.0F;
    std::erase_if(vehicles, [&](const auto& vehicle) { return vehicle.key == scene.key("a2"); });
    traffic::ObservedVehicle ghost =
        *std::ranges::find(vehicles, scene.key("a1"), &traffic::ObservedVehicle::key);
    ghost.key = core::vehicle_key("ghost");
    ghost.freshness = traffic::Freshness::stale;
    ghost.age_s = 10.0F;
    ghost.state.x_m = 100.0F;
    ghost.state.lane_position_m = 100.0F;
    vehicles.push_back(ghost);
    std::ranges::sort(vehicles, {}, &traffic::ObservedVehicle::key);
    return observation;
}

class LinkTrialTest : public testing::Test {
  protected:
    LinkTrial::Setup setup(const std::vector<std::string>& predictors) const {
        LinkTrial::Setup setup{.failure = "told",
                               .exits = Exits::unknown,
                               .sensor = std::make_unique<LoggingSensor>(failing_observation(scene_)),
                               .predictors = {}};
        for (const std::string& name : predictors)
            setup.predictors.push_back(prediction::make_predictor(
                name, {.network = scene_.network(), .rules = rules_, .model_file = {}}));
        return setup;
    }

    support::Scene scene_{road};
    graph::LinkRules rules_;
};

TEST_F(LinkTrialTest, counts_what_there_was_to_find_and_what_was_found) {
    LinkTruthView truth(scene_.network(), rules_);
    truth.look(scene_.snapshot(), scene_.roster());
    ASSERT_EQ(truth.links().link_count(), 5U);
    ASSERT_EQ(truth.policy_links().size(), 1U);

    LinkTrial trial(scene_.network(), rules_, setup({"none", "dead_reckoning"}));
    trial.observe(scene_.snapshot(), scene_.roster());
    ASSERT_TRUE(trial.has_report());
    trial.ask(scene_.snapshot(), truth, true);

    const LinkCase none = trial.result(0);
    EXPECT_EQ(none.truth.reports, 1U);
    EXPECT_EQ(none.truth.vehicles, 6U);
    EXPECT_EQ(none.truth.true_links, 5U);
    EXPECT_EQ(none.truth.never_seen, 1U) << "h3-a2";
    EXPECT_EQ(none.truth.outside, 1U) << "a1-h1";
    EXPECT_EQ(none.truth.policy_links, 1U);
    EXPECT_EQ(none.belief.listed_true, 2U) << "a1-h2 and h2-e1";
    EXPECT_EQ(none.belief.listed_false, 0U);
    EXPECT_EQ(none.belief.policy_found, 0U);
    EXPECT_EQ(none.belief.believed_vehicles, 3U);
    EXPECT_EQ(none.belief.ghosts, 0U);

    const LinkCase reckoned = trial.result(1);
    EXPECT_EQ(reckoned.truth, none.truth);
    EXPECT_EQ(reckoned.belief.listed_true, 3U) << "and e1-h3";
    EXPECT_EQ(reckoned.belief.listed_false, 2U) << "the ghost with e1 and h3";
    EXPECT_EQ(reckoned.belief.policy_found, 1U);
    EXPECT_EQ(reckoned.belief.believed_vehicles, 6U);
    EXPECT_EQ(reckoned.belief.ghosts, 1U);
}

TEST_F(LinkTrialTest, scores_every_candidate_in_its_subsets) {
    LinkTruthView truth(scene_.network(), rules_);
    truth.look(scene_.snapshot(), scene_.roster());
    LinkTrial trial(scene_.network(), rules_, setup({"dead_reckoning"}));
    trial.observe(scene_.snapshot(), scene_.roster());
    trial.ask(scene_.snapshot(), truth, true);

    // Candidates: e1-h3 (40 m, the only true one), and the ghost with e1 (15 m), h3 (25 m) and h2 (55 m).
    const LinkScoreSummary scores = trial.result(0).scores;
    EXPECT_EQ(scores.of(LinkSubset::all).pairs(), 4U);
    EXPECT_EQ(scores.of(LinkSubset::all).true_links(), 1U);
    EXPECT_EQ(scores.of(LinkSubset::hard).pairs(), 3U) << "all but the ghost at 15 m";
    EXPECT_EQ(scores.of(LinkSubset::policy).pairs(), 2U) << "h3 and the ghost are ahead of e1";
    EXPECT_EQ(scores.of_age(age_class_of(3.0F)).pairs(), 1U);
    EXPECT_EQ(scores.of_age(age_class_of(10.0F)).pairs(), 3U);
    EXPECT_EQ(trial.timing(0).vehicles, 6U);
    EXPECT_GT(trial.timing(0).predict_s, 0.0);
}

TEST_F(LinkTrialTest, counts_dark_vehicles_and_how_far_off_they_are_believed) {
    LinkTruthView truth(scene_.network(), rules_);
    truth.look(scene_.snapshot(), scene_.roster());
    LinkTrial trial(scene_.network(), rules_, setup({"none", "dead_reckoning"}));
    trial.observe(scene_.snapshot(), scene_.roster());
    trial.ask(scene_.snapshot(), truth, true);

    const LinkCase none = trial.result(0);
    EXPECT_EQ(none.truth.dark_vehicles, 3U) << "h1, h3 and a2";
    EXPECT_EQ(none.truth.unseen_vehicles, 1U) << "a2";
    EXPECT_EQ(none.belief.dark_believed, 0U);
    EXPECT_TRUE(none.places.bins.empty());

    const LinkCase reckoned = trial.result(1);
    EXPECT_EQ(reckoned.belief.dark_believed, 2U) << "not the ghost, which is not on the road";
    const std::vector<PlaceErrors::Bin> expected = {{PlaceGrid::bin_of(0.0), 1},
                                                    {PlaceGrid::bin_of(370.0), 1}};
    EXPECT_EQ(reckoned.places.bins, expected) << "h3 stands where it was seen, h1 is believed 370 m on";
}

/// Next ahead in truth: h1 (dark) for a1, h3 (dark) for e1, nobody for a2.
TEST_F(LinkTrialTest, asks_who_is_next_ahead_where_the_true_or_the_believed_one_is_dark) {
    LinkTruthView truth(scene_.network(), rules_);
    truth.look(scene_.snapshot(), scene_.roster());
    ASSERT_EQ(truth.next_ahead().size(), 3U);
    const auto next_of = [&](const char* id) {
        return std::ranges::find(truth.next_ahead(), scene_.row(id), &LinkTruthView::NextAhead::row)->next;
    };
    EXPECT_EQ(next_of("a1"), scene_.row("h1"));
    EXPECT_EQ(next_of("e1"), scene_.row("h3"));
    EXPECT_EQ(next_of("a2"), core::no_row);
    LinkTrial trial(scene_.network(), rules_, setup({"none", "dead_reckoning"}));
    trial.observe(scene_.snapshot(), scene_.roster());
    trial.ask(scene_.snapshot(), truth, true);
    const LinkBelief none = trial.result(0).belief;
    EXPECT_EQ(none.next_cases, 2U) << "a1, which is told of h2 instead of h1, and e1";
    EXPECT_EQ(none.next_right, 0U);
    const LinkBelief reckoned = trial.result(1).belief;
    EXPECT_EQ(reckoned.next_cases, 2U);
    EXPECT_EQ(reckoned.next_right, 0U) << "a1 is told of h2 and e1 of the ghost at 100 m";
}

TEST_F(LinkTrialTest, is_right_about_a_dark_vehicle_ahead_once_the_ghost_is_gone) {
    LinkTruthView truth(scene_.network(), rules_);
    truth.look(scene_.snapshot(), scene_.roster());
    LinkTrial::Setup without = setup({"last_seen"});
    traffic::Observation observation = failing_observation(scene_);
    std::erase_if(observation.vehicles,
                  [](const auto& vehicle) { return vehicle.key == core::vehicle_key("ghost"); });
    without.sensor = std::make_unique<LoggingSensor>(observation);
    LinkTrial trial(scene_.network(), rules_, std::move(without));
    trial.observe(scene_.snapshot(), scene_.roster());
    trial.ask(scene_.snapshot(), truth, true);
    EXPECT_EQ(trial.result(0).belief.next_cases, 2U);
    EXPECT_EQ(trial.result(0).belief.next_right, 1U) << "e1 has h3 ahead";
}

TEST_F(LinkTrialTest, believes_a_ghost_ahead_where_there_is_nobody_and_is_wrong) {
    support::Scene alone(R"(
        10 m per cell, limit 20 m/s, speed 0 m/s
        a...................
    )");
    LinkTruthView truth(alone.network(), rules_);
    truth.look(alone.snapshot(), alone.roster());
    traffic::Observation observation = support::perfect_observation(alone);
    observation.is_report = true;
    traffic::ObservedVehicle ghost = observation.vehicles.front();
    ghost.key = core::vehicle_key("ghost");
    ghost.vehicle_class = traffic::VehicleClass::human;
    ghost.freshness = traffic::Freshness::stale;
    ghost.age_s = 10.0F;
    ghost.state.x_m += 30.0F;
    ghost.state.lane_position_m += 30.0F;
    observation.vehicles.push_back(ghost);
    std::ranges::sort(observation.vehicles, {}, &traffic::ObservedVehicle::key);
    LinkTrial::Setup with_ghost{.failure = "told",
                                .exits = Exits::unknown,
                                .sensor = std::make_unique<LoggingSensor>(observation),
                                .predictors = {}};
    with_ghost.predictors.push_back(prediction::make_predictor(
        "last_seen", {.network = alone.network(), .rules = rules_, .model_file = {}}));
    LinkTrial trial(alone.network(), rules_, std::move(with_ghost));
    trial.observe(alone.snapshot(), alone.roster());
    trial.ask(alone.snapshot(), truth, true);
    EXPECT_EQ(trial.result(0).belief.next_cases, 1U);
    EXPECT_EQ(trial.result(0).belief.next_right, 0U);
    EXPECT_EQ(trial.result(0).truth.dark_vehicles, 0U);
}

TEST_F(LinkTrialTest, asks_without_scoring_while_sensors_warm_up) {
    LinkTruthView truth(scene_.network(), rules_);
    truth.look(scene_.snapshot(), scene_.roster());
    LinkTrial trial(scene_.network(), rules_, setup({"last_seen"}));
    trial.observe(scene_.snapshot(), scene_.roster());
    trial.ask(scene_.snapshot(), truth, false);
    EXPECT_EQ(trial.result(0).truth, LinkTruth{});
    EXPECT_EQ(trial.result(0).scores, LinkScoreSummary{});
}

TEST_F(LinkTrialTest, is_scored_once_a_second_from_the_time_given) {
    const double start_s = scene_.snapshot().time.value;
    LinkEvaluator evaluator(scene_.network(), rules_, core::Seconds(start_s + 5.0));
    evaluator.add(setup({"none"}));
    for (int step = 0; step * 0.25 <= 7.0; ++step) {
        scene_.snapshot().time = core::Seconds(start_s + 0.25 * step);
        evaluator.on_step(scene_.snapshot(), scene_.roster());
    }
    EXPECT_EQ(evaluator.trials().front().result(0).truth.reports, 3U) << "5, 6 and 7 s after the start";
}

}  // namespace
}  // namespace clearway::links
