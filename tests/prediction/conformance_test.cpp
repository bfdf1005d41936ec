// What every predictor must do. A new one is tested by being registered.
#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "prediction/darkness.hpp"
#include "prediction/nets.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::prediction {
namespace {

using testing::after_outage;
using ::testing::HasSubstr;

constexpr const char* busy = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    a.h.a.hh.a..e.h.a.a.+hh.a..h.e.a.h..........................
    .h.a.ha.e.h..a.h.h.a+.a..h.a.hh.a...........................
)";

/// Models for the learned predictors, the same for every test.
std::string model_of(const std::string& predictor) {
    static const support::TemporaryFolder folder;
    static const std::map<std::string, Weights> nets = {
        {"graphsage_as_published", testing::random_net(as_published_attributes_schema(), 10, 5, 0.2)},
        {"graphsage_corrected", testing::kernel_net()},
        {"gcn", testing::kernel_net(Convolution::gcn)},
        {"gat", testing::kernel_net(Convolution::gat)}};
    const auto net = nets.find(predictor);
    if (net == nets.end()) return "";
    const auto file = folder.path() / (predictor + ".weights");
    write_weights(file, net->second);
    return file.string();
}

class EveryPredictor : public ::testing::TestWithParam<std::string> {
  protected:
    std::unique_ptr<Predictor> make(const support::Scene& scene, double link_threshold = 0.5) const {
        return make_predictor(GetParam(), {scene.network(), {}, model_of(GetParam()), {link_threshold}});
    }
    traffic::BelievedGraph belief(const support::Scene& scene,
                                  const traffic::Observation& observation) const {
        traffic::BelievedGraph result;
        make(scene)->predict(observation, result);
        return result;
    }
};

void expect_well_formed(const traffic::BelievedGraph& belief, const graph::LinkRules& rules) {
    ASSERT_EQ(belief.first_link.size(), belief.vehicles.size() + 1);
    EXPECT_EQ(belief.first_link.back(), belief.links.size());
    EXPECT_TRUE(std::ranges::is_sorted(belief.vehicles, {}, &traffic::BelievedVehicle::key));
    for (core::VehicleIndex row = 0; row < belief.vehicles.size(); ++row) {
        EXPECT_GE(belief.vehicles[row].sigma_m, 0.0F);
        EXPECT_TRUE(std::isfinite(belief.vehicles[row].state.x_m));
        const auto links = belief.links_of(row);
        EXPECT_TRUE(std::ranges::is_sorted(links, {}, &traffic::BelievedLink::neighbour));
        for (const traffic::BelievedLink& link : links) {
            ASSERT_LT(link.neighbour, belief.vehicles.size());
            EXPECT_NE(link.neighbour, row);
            EXPECT_TRUE(link.probability >= 0.5F && link.probability <= 1.0F);
            EXPECT_GE(link.distance_m, 0.0F);
            EXPECT_TRUE(rules.allows(belief.vehicles[row].vehicle_class,
                                     belief.vehicles[link.neighbour].vehicle_class));
            const auto back = belief.links_of(link.neighbour);
            const auto same = std::ranges::find(back, row, &traffic::BelievedLink::neighbour);
            ASSERT_NE(same, back.end());
            EXPECT_EQ(same->probability, link.probability);
            EXPECT_EQ(same->distance_m, link.distance_m);
        }
    }
}

void expect_equal(const traffic::BelievedGraph& one, const traffic::BelievedGraph& other) {
    ASSERT_EQ(one.vehicles.size(), other.vehicles.size());
    EXPECT_EQ(one.first_link, other.first_link);
    for (std::size_t row = 0; row < one.vehicles.size(); ++row) {
        EXPECT_EQ(one.vehicles[row].key, other.vehicles[row].key);
        EXPECT_EQ(one.vehicles[row].state.x_m, other.vehicles[row].state.x_m);
        EXPECT_EQ(one.vehicles[row].sigma_m, other.vehicles[row].sigma_m);
    }
    ASSERT_EQ(one.links.size(), other.links.size());
    for (std::size_t at = 0; at < one.links.size(); ++at) {
        EXPECT_EQ(one.links[at].neighbour, other.links[at].neighbour);
        EXPECT_EQ(one.links[at].probability, other.links[at].probability);
    }
}

TEST_P(EveryPredictor, HasTheNameItIsRegisteredUnder) {
    const support::Scene scene(busy);
    EXPECT_EQ(make(scene)->name(), GetParam());
}

TEST_P(EveryPredictor, BelievesNothingOfAnEmptyObservation) {
    const support::Scene scene(busy);
    traffic::Observation observation;
    const traffic::BelievedGraph empty = belief(scene, observation);
    EXPECT_TRUE(empty.vehicles.empty() && empty.links.empty() && empty.own_states.empty());
    EXPECT_EQ(empty.first_link, std::vector<std::uint32_t>{0});
}

TEST_P(EveryPredictor, BelievesOneVehicleAsReported) {
    const support::Scene scene("10 m per cell\n..e....");
    const traffic::BelievedGraph one = belief(scene, support::perfect_observation(scene));
    ASSERT_EQ(one.vehicles.size(), 1u);
    EXPECT_EQ(one.vehicles[0].key, scene.key("e1"));
    EXPECT_EQ(one.vehicles[0].state.x_m, scene.snapshot().x_m[0]);
    EXPECT_EQ(one.vehicles[0].sigma_m, 0.0F);
    EXPECT_EQ(one.link_count(), 0u);
}

TEST_P(EveryPredictor, BelievesTheTruthWhenAllIsObserved) {
    const support::Scene scene(busy);
    const traffic::BelievedGraph believed = belief(scene, support::perfect_observation(scene));
    const traffic::BelievedGraph truth = support::perfect_belief(scene);
    expect_well_formed(believed, {});
    ASSERT_GT(truth.link_count(), 30u);
    ASSERT_EQ(believed.first_link, truth.first_link);
    for (std::size_t at = 0; at < truth.links.size(); ++at) {
        EXPECT_EQ(believed.links[at].neighbour, truth.links[at].neighbour);
        EXPECT_FLOAT_EQ(believed.links[at].distance_m, truth.links[at].distance_m);
        EXPECT_EQ(believed.links[at].probability, 1.0F);
    }
    for (std::size_t row = 0; row < truth.vehicles.size(); ++row) {
        EXPECT_EQ(believed.vehicles[row].state.x_m, truth.vehicles[row].state.x_m);
        EXPECT_EQ(believed.vehicles[row].state.lane, truth.vehicles[row].state.lane);
        EXPECT_EQ(believed.vehicles[row].age_s, 0.0F);
    }
}

TEST_P(EveryPredictor, WritesWellFormedGraphsInTheDark) {
    for (const double age_s : {1.0, 6.0, 25.0}) {
        support::Scene scene(busy);
        const traffic::BelievedGraph believed =
            belief(scene, after_outage(scene, age_s, {"a1", "a3", "h2", "h5", "e1", "a7", "e2", "h9"}));
        expect_well_formed(believed, {});
    }
}

TEST_P(EveryPredictor, GivesTheSameAnswerToTheSameReports) {
    support::Scene scene(busy);
    const traffic::Observation before = support::perfect_observation(scene);
    const traffic::Observation now = after_outage(scene, 6.0, {"a1", "a3", "h2", "h5", "e1"});
    traffic::BelievedGraph answers[2];
    for (traffic::BelievedGraph& answer : answers) {
        const auto predictor = make(scene);
        predictor->predict(before, answer);
        predictor->predict(now, answer);
    }
    expect_equal(answers[0], answers[1]);
}

TEST_P(EveryPredictor, BelievesTheSameWhereOnlyPlacesAreWanted) {
    support::Scene scene(busy);
    const traffic::Observation before = support::perfect_observation(scene);
    const traffic::Observation dark = after_outage(scene, 6.0, {"a1", "a3", "h2", "h5", "e1"});
    const traffic::Observation later = after_outage(scene, 7.0, {"a1", "a3", "h2", "h5", "e1"});
    const auto always = make(scene);
    const auto sparing = make(scene);
    traffic::BelievedGraph full;
    traffic::BelievedGraph sparse;
    always->predict(before, full);
    sparing->predict(before, sparse, Want::places);
    always->predict(dark, full);
    ASSERT_GT(full.link_count(), 0u);
    sparing->predict(dark, sparse, Want::places);
    EXPECT_EQ(sparse.link_count(), 0u);
    traffic::BelievedGraph without_links = full;
    without_links.links.clear();
    without_links.first_link.assign(full.vehicles.size() + 1, 0);
    expect_equal(sparse, without_links);
    always->predict(later, full);
    sparing->predict(later, sparse, Want::links);
    expect_equal(sparse, full);
}

TEST_P(EveryPredictor, ScoresEveryCandidateWithAProbability) {
    support::Scene scene(busy);
    const traffic::Observation observation = after_outage(scene, 6.0, {"a1", "a3", "h2", "h5", "e1"});
    const auto predictor = make(scene);
    traffic::BelievedGraph believed;
    predictor->predict(observation, believed);
    const CandidateScores scores = predictor->scores();
    ASSERT_EQ(scores.probability.size(), scores.scene->candidates.size());
    EXPECT_GT(scores.probability.size(), 50u);
    for (const float probability : scores.probability) {
        EXPECT_TRUE(probability >= 0.0F && probability <= 1.0F) << probability;
    }
}

TEST_P(EveryPredictor, ListsFewerLinksWithAHigherThreshold) {
    support::Scene scene(busy);
    const traffic::Observation observation = after_outage(scene, 6.0, {"a1", "a3", "h2", "h5", "e1"});
    std::size_t links = std::numeric_limits<std::size_t>::max();
    for (const double threshold : {0.0, 0.5, 1.0}) {
        traffic::BelievedGraph believed;
        make(scene, threshold)->predict(observation, believed);
        EXPECT_LE(believed.link_count(), links);
        links = believed.link_count();
    }
}

TEST_P(EveryPredictor, PassesOnWhatIsKnownAnyway) {
    support::Scene scene("10 m per cell\n..e..|G.a..\n.....|r....");
    traffic::Observation observation = after_outage(scene, 2.0, {"e1"});
    observation.own_states = {support::perfect_observation(scene).vehicles[scene.row("e1")]};
    const traffic::BelievedGraph believed = belief(scene, observation);
    EXPECT_EQ(believed.time, observation.time);
    EXPECT_EQ(believed.signals.state, observation.signals.state);
    EXPECT_EQ(believed.roster, observation.roster);
    ASSERT_EQ(believed.own_states.size(), 1u);
    EXPECT_EQ(believed.own_states[0].key, scene.key("e1"));
    EXPECT_EQ(believed.own_states[0].age_s, 0.0F);
    EXPECT_EQ(believed.own_states[0].state.x_m, scene.snapshot().x_m[scene.row("e1")]);
}

INSTANTIATE_TEST_SUITE_P(Registered, EveryPredictor, ::testing::ValuesIn(predictors().names()),
                         [](const auto& test) { return test.param; });

TEST(Predictors, AreListedWithASummaryAndATitleOfTheirOwn) {
    std::set<std::string> titles;
    for (const PredictorEntry& entry : predictors()) {
        EXPECT_FALSE(entry.summary.empty()) << entry.name;
        EXPECT_EQ(title_of(entry.name), entry.title);
        EXPECT_FALSE(entry.title.empty()) << entry.name;
        EXPECT_LE(entry.title.size(), 32U) << entry.name << ": tables of 100 columns have no more room";
        EXPECT_TRUE(titles.insert(entry.title).second) << entry.title;
    }
    EXPECT_THROW(title_of("graphsag"), core::InputError);
}

TEST(Predictors, SayWhatTheyAreFor) {
    using ::testing::ElementsAre;
    using traffic::Trait;
    EXPECT_THAT(predictors().names(Trait::compares_only),
                ElementsAre("common_neighbours", "logistic", "graphsage_corrected", "gcn", "gat"));
    EXPECT_THAT(predictors().names(Trait::repeats_dissertation), ElementsAre("graphsage_as_published"));
    EXPECT_THAT(predictors().names(Trait::knows_truth), ElementsAre("oracle"));
    EXPECT_THAT(predictors().names(Trait::learned),
                ElementsAre("logistic", "gradient_boosting", "graphsage_as_published", "graphsage_corrected",
                            "gcn", "gat", "graphsage"));
}

TEST(Predictors, NameTheNearestOfAnUnknownOne) {
    const support::Scene scene(busy);
    try {
        make_predictor("dead_reckonning", {scene.network(), {}, "", {}});
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("Did you mean 'dead_reckoning'?"));
    }
}

}  // namespace
}  // namespace clearway::prediction
