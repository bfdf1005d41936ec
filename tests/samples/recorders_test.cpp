#include "samples/recorders.hpp"

#include <algorithm>

#include <gmock/gmock.h>

#include "samples/graph_sample.hpp"
#include "samples/pair_samples.hpp"
#include "samples/repair_sample.hpp"
#include "support/ascii_scene.hpp"
#include "support/temporary_folder.hpp"
#include "support/told_sensor.hpp"

namespace clearway::samples {
namespace {

using support::ToldSensor;

// Fronts at x = 5 (a1), 85 (e1), 125 (h1) and 155 (a2). h1 was not heard for 3 s and is believed where it
// was; in truth it has gone on by 20 m, so that a2 is still linked to it, and e1 is not.
constexpr const char* road = R"(
    10 m per cell, limit 20 m/s, speed 0 m/s
    a.......e...h..a............................................
)";

class SampleRecorderTest : public testing::Test {
  protected:
    SampleRecorderTest() {
        traffic::Observation observation = support::perfect_observation(scene_);
        const auto dark =
            std::ranges::find(observation.vehicles, scene_.key("h1"), &traffic::ObservedVehicle::key);
        dark->freshness = traffic::Freshness::stale;
        dark->age_s = 3.0F;
        observation.is_report = true;
        told_ = observation;
        const auto row = scene_.row("h1");
        scene_.snapshot().x_m[row] += 20.0F;
        scene_.snapshot().lane_position_m[row] += 20.0F;
    }

    /// Records `seconds` steps of a second each, with a sample every 5 s.
    std::filesystem::path record(experiment::DatasetKind kind, int seconds) {
        const auto recorder = make_sample_recorder(kind, {.network = scene_.network(),
                                                          .rules = {},
                                                          .origin = {.scenario = "road",
                                                                     .failure = "told",
                                                                     .features = {},
                                                                     .study_seed = 7,
                                                                     .replication = 3,
                                                                     .link_radius_m = 50.0},
                                                          .sensor = std::make_unique<ToldSensor>(told_),
                                                          .interval = core::Seconds(5.0)});
        const double start_s = scene_.snapshot().time.value;
        for (int second = 0; second < seconds; ++second) {
            scene_.snapshot().time = core::Seconds(start_s + second);
            recorder->on_step(scene_.snapshot(), scene_.roster());
        }
        scene_.snapshot().time = core::Seconds(start_s);
        const std::filesystem::path file = folder_.path() / (std::string("road") + sample_ending(kind));
        words_ = recorder->write(file);
        return file;
    }
    std::uint32_t row(const char* id) const { return static_cast<std::uint32_t>(scene_.row(id)); }
    bool truly_linked(std::uint32_t left, std::uint32_t right) const {
        return std::minmax(left, right) == std::minmax(row("h1"), row("a2"));
    }

    support::Scene scene_{road};
    traffic::Observation told_;
    support::TemporaryFolder folder_;
    std::string words_;
};

TEST_F(SampleRecorderTest, labels_candidates_by_where_vehicles_truly_are) {
    const GraphSampleFile file = read_graph_samples(record(experiment::DatasetKind::samples, 1));
    EXPECT_EQ(file.origin.features, prediction::FeatureSchema({"corrected", 2, 5}));
    EXPECT_EQ(file.origin.replication, 3u);
    ASSERT_EQ(file.samples.size(), 1u);
    const std::vector<CandidatePair>& pairs = file.samples.front().candidates;
    ASSERT_GE(pairs.size(), 2u);
    EXPECT_EQ(std::ranges::count(pairs, 1, &CandidatePair::linked), 1);
    for (const CandidatePair& pair : pairs)
        EXPECT_EQ(pair.linked, truly_linked(pair.left, pair.right)) << pair.left << ' ' << pair.right;
}

TEST_F(SampleRecorderTest, all_kinds_label_alike) {
    const GraphSampleFile graph = read_graph_samples(record(experiment::DatasetKind::samples, 1));
    const PairSampleFile pairs = read_pair_samples(record(experiment::DatasetKind::pair_samples, 1));
    const RepairSampleFile repair = read_repair_samples(record(experiment::DatasetKind::repair, 1));
    std::vector<std::uint8_t> labels;
    for (const CandidatePair& pair : graph.samples.front().candidates)
        labels.push_back(pair.linked);
    EXPECT_EQ(pairs.linked, labels);
    EXPECT_EQ(repair.samples.front().linked, labels);
}

TEST_F(SampleRecorderTest, keeps_the_true_displacement_beside_what_the_net_is_given) {
    const RepairSampleFile file = read_repair_samples(record(experiment::DatasetKind::repair, 1));
    const RepairSample& sample = file.samples.front();
    ASSERT_EQ(sample.inputs.receivers.size(), 1u);
    EXPECT_EQ(sample.inputs.receivers.front().row, row("h1"));
    ASSERT_EQ(sample.true_displacement_m.size(), 1u);
    EXPECT_NEAR(sample.true_displacement_m.front(), 20.0F, 1e-3F);
    EXPECT_EQ(sample.rule.size(), sample.linked.size());
}

TEST_F(SampleRecorderTest, takes_a_sample_at_every_interval) {
    EXPECT_EQ(read_graph_samples(record(experiment::DatasetKind::samples, 11)).samples.size(), 3u);
    EXPECT_EQ(words_, "3 samples");
    EXPECT_EQ(read_repair_samples(record(experiment::DatasetKind::repair, 10)).samples.size(), 2u);
    record(experiment::DatasetKind::pair_samples, 1);
    EXPECT_THAT(words_, testing::HasSubstr(" pairs"));
}

}  // namespace
}  // namespace clearway::samples
