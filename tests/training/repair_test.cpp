#include "training/repair.hpp"

#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "prediction/predictor.hpp"
#include "support/message_of.hpp"
#include "support/temporary_folder.hpp"
#include "synthetic_repair.hpp"
#include "training/outputs.hpp"

namespace clearway::training {
namespace {

using samples::RepairSampleFile;
using support::message_of;
using ::testing::HasSubstr;

RepairConfig short_training() {
    RepairConfig config;
    config.epochs = 6;
    config.batch_snapshots = 4;
    config.easy_share = 1.0;
    config.hidden = 16;
    return config;
}

bool same_state(const StateDict& one, const StateDict& other) {
    return std::ranges::equal(one, other, [](const auto& left, const auto& right) {
        return left.name == right.name && left.values == right.values;
    });
}

TEST(TrainRepair, beats_the_rule_where_there_is_something_to_learn) {
    RepairConfig config = short_training();
    config.epochs = 25;
    const RepairResult result = train_repair(runs(10, 30), config, {});
    ASSERT_FALSE(result.groups.empty());
    const GroupQuality& all = result.groups.front();
    EXPECT_GT(all.model.ap.value(), all.reference->ap.value());
    EXPECT_LT(all.displacement_error_m.value(), 0.7 * all.reference_displacement_error_m.value());
    EXPECT_EQ(result.groups.size(), 1u + 2u + 2u) << "all, by failure, by scenario and failure";
}

TEST(TrainRepair, goes_on_from_its_checkpoint_as_if_never_interrupted) {
    const support::TemporaryFolder folder;
    const std::vector<RepairSampleFile> files = runs(6);
    const RepairConfig config = short_training();
    const RepairResult whole = train_repair(files, config, {});
    const Checkpoint checkpoint{folder.path() / "training", "hash"};
    int epochs = 0;
    TrainingHooks hooks;
    hooks.on_epoch = [&](std::uint32_t, const EpochLoss&) { ++epochs; };
    hooks.should_stop = [&] { return epochs == 3; };
    const RepairResult first = train_repair(files, config, checkpoint, hooks);
    EXPECT_EQ(first.outcome, Outcome::interrupted);
    EXPECT_EQ(first.losses.size(), 3u);
    EXPECT_FALSE(first.state.empty());
    const RepairResult second = train_repair(files, config, checkpoint);
    EXPECT_EQ(second.losses.size(), 6u);
    EXPECT_TRUE(same_state(second.state, whole.state));
    EXPECT_EQ(second.groups.front().model.ap, whole.groups.front().model.ap);
    // Once complete there is nothing left to do.
    const RepairResult third = train_repair(files, config, checkpoint);
    EXPECT_TRUE(same_state(third.state, whole.state));
}

TEST(TrainRepair, refuses_a_checkpoint_of_another_training) {
    const support::TemporaryFolder folder;
    const std::vector<RepairSampleFile> files = runs(4, 4);
    RepairConfig config = short_training();
    config.epochs = 1;
    const Checkpoint checkpoint{folder.path() / "training", "hash"};
    train_repair(files, config, checkpoint);
    RepairConfig other = config;
    other.learning_rate = 0.5;
    EXPECT_THAT(message_of([&] { train_repair(files, other, checkpoint); }),
                ::testing::AllOf(HasSubstr("learning_rate = 0.003"), HasSubstr("learning_rate = 0.5")));
    EXPECT_THAT(message_of([&] {
                    train_repair(files, config, {checkpoint.folder, "other data"});
                }),
                HasSubstr("data_hash"));
}

TEST(TrainRepair, a_damaged_checkpoint_tells_how_to_start_anew) {
    const support::TemporaryFolder folder;
    const std::vector<RepairSampleFile> files = runs(4, 4);
    RepairConfig config = short_training();
    config.epochs = 2;
    const Checkpoint checkpoint{folder.path() / "training", "hash"};
    train_repair(files, config, checkpoint);
    const std::filesystem::path head = checkpoint.folder / "checkpoint.json";
    const std::filesystem::path tensors = checkpoint.folder / "checkpoint.pth";
    const std::string head_bytes = core::read_file(head);
    const std::string bytes = core::read_file(tensors);
    const auto expect_refusal = [&](const std::string& what) {
        EXPECT_THAT(message_of([&] { train_repair(files, config, checkpoint); }),
                    ::testing::AllOf(HasSubstr(what),
                                     HasSubstr("Remove checkpoint.json and checkpoint.pth to start anew")));
    };
    core::write_atomically(tensors, bytes.substr(0, bytes.size() / 2));
    expect_refusal("checkpoint.pth: its content hash is");
    std::string flipped = bytes;
    flipped[bytes.size() / 2] ^= 1;
    core::write_atomically(tensors, flipped);
    expect_refusal("checkpoint.pth: its content hash is");
    std::filesystem::remove(tensors);
    expect_refusal("checkpoint.pth: is missing");
    core::write_atomically(tensors, bytes);
    std::filesystem::remove(head);
    expect_refusal("checkpoint.json: is missing");
    core::write_atomically(head, "{");
    expect_refusal("checkpoint.json");
    core::write_atomically(head, "{\"format\": \"clearway training checkpoint 1\"}");
    expect_refusal("clearway training checkpoint 1");
    core::write_atomically(head, head_bytes);
    EXPECT_EQ(message_of([&] { train_repair(files, config, checkpoint); }), "");
}

TEST(TrainRepair, goes_on_when_killed_between_the_files_of_a_checkpoint) {
    const support::TemporaryFolder folder;
    const std::vector<RepairSampleFile> files = runs(4, 4);
    RepairConfig config = short_training();
    config.epochs = 3;
    const RepairResult whole = train_repair(files, config, {});
    const Checkpoint checkpoint{folder.path() / "training", "hash"};
    const std::filesystem::path tensors = checkpoint.folder / "checkpoint.pth";
    std::string before;
    TrainingHooks hooks;
    hooks.on_epoch = [&](std::uint32_t epoch, const EpochLoss&) {
        if (epoch == 0) before = core::read_file(tensors);
    };
    int asked = 0;
    hooks.should_stop = [&] { return ++asked > 2; };
    train_repair(files, config, checkpoint, hooks);
    core::write_atomically(tensors, before);
    EXPECT_TRUE(same_state(train_repair(files, config, checkpoint).state, whole.state));
}

TEST(TrainRepair, divergence_stops_and_keeps_the_last_good_checkpoint) {
    const support::TemporaryFolder folder;
    std::vector<RepairSampleFile> files = runs(4, 4);
    RepairConfig config = short_training();
    config.learning_rate = 1e20;
    const RepairResult result = train_repair(files, config, {folder.path() / "training", "hash"});
    EXPECT_EQ(result.outcome, Outcome::diverged);
    EXPECT_LT(result.losses.size(), 6u);
}

TEST(TrainRepair, says_what_the_data_lack) {
    EXPECT_THAT(message_of([] { train_repair({}, {}, {}); }), HasSubstr("--net graphsage"));
    EXPECT_THAT(message_of([] { train_repair(runs(2), {}, {}); }), HasSubstr("3 seeds or more"));
    std::vector<RepairSampleFile> one_class = runs(4, 4);
    for (RepairSampleFile& file : one_class) {
        for (samples::RepairSample& sample : file.samples)
            std::ranges::fill(sample.linked, std::uint8_t{0});
    }
    EXPECT_THAT(message_of([&] { train_repair(one_class, {}, {}); }),
                HasSubstr("hold only pairs that are not linked"));
    std::vector<RepairSampleFile> other_radius = runs(4, 4);
    other_radius[2].origin.link_radius_m = 20.0;
    EXPECT_THAT(message_of([&] { train_repair(other_radius, {}, {}); }), HasSubstr("links below 20 m"));
}

TEST(TrainRepair, ablations_leave_out_what_they_say) {
    const std::vector<RepairSampleFile> files = runs(4, 4);
    RepairConfig config = short_training();
    config.epochs = 2;
    EXPECT_TRUE(config.is_whole());
    const RepairResult whole = train_repair(files, config, {});
    const auto differs = [&](const RepairConfig& other) {
        EXPECT_FALSE(other.is_whole());
        const RepairResult result = train_repair(files, other, {});
        EXPECT_FALSE(result.groups.empty());
        return result.losses.back().held_out != whole.losses.back().held_out;
    };
    for (const Aggregation aggregation : {Aggregation::mean, Aggregation::gcn, Aggregation::gat}) {
        RepairConfig other = config;
        other.aggregation = aggregation;
        EXPECT_TRUE(differs(other));
    }
    RepairConfig other = config;
    other.layers = 0;
    EXPECT_TRUE(differs(other));
    other = config;
    other.motion_head = false;
    EXPECT_TRUE(differs(other));
    other = config;
    other.pair_features = false;
    EXPECT_TRUE(differs(other));
    other = config;
    other.edges = MessageEdges::observed;
    EXPECT_TRUE(differs(other));
}

TEST(TrainRepair, samples_easy_pairs_without_changing_what_they_weigh) {
    SyntheticRepair world(5);
    const samples::RepairSample sample = world.sample(3.0);
    const samples::RepairSample* const one = &sample;
    const RepairBatch all = batch_of(std::span(&one, 1), MessageEdges::believed);
    double weight = 0.0;
    std::size_t pairs = 0;
    constexpr int draws = 200;
    for (std::uint32_t draw = 0; draw < draws; ++draw) {
        const PairSampling sampling{0.25, core::KeyedRandom(core::StudySeed{1}, core::Replication{draw})};
        const RepairBatch some = batch_of(std::span(&one, 1), MessageEdges::believed, sampling);
        for (const float of_pair : some.weight)
            weight += of_pair;
        pairs += some.pair_count();
    }
    const auto all_pairs = static_cast<double>(all.pair_count());
    EXPECT_LT(static_cast<double>(pairs), 0.6 * draws * all_pairs);
    EXPECT_NEAR(weight / draws, all_pairs, 0.03 * all_pairs);
}

TEST(RepairOutputs, the_folder_holds_a_model_unless_it_is_an_ablation) {
    const support::TemporaryFolder folder;
    const std::vector<RepairSampleFile> files = runs(4, 4);
    RepairConfig config = short_training();
    config.epochs = 1;
    const RepairResult result = train_repair(files, config, {});
    const auto summary = summary_of(result, identity_of(config, "hash"), "data");
    write_outputs(folder.path() / "whole", result, summary);
    const prediction::Weights weights =
        prediction::read_weights(folder.path() / "whole" / "graphsage.weights");
    EXPECT_NO_THROW(
        prediction::check_model("graphsage", (folder.path() / "whole" / "graphsage.weights").string()));
    EXPECT_THAT(weights.notes.front(), HasSubstr("hash"));
    EXPECT_THAT(core::read_file(folder.path() / "whole" / "metrics.csv"), HasSubstr("all,all,route_rule,"));
    const auto& configuration = summary["configuration"];
    EXPECT_EQ(configuration["aggregation"], "gated");
    EXPECT_EQ(configuration["edges"], "believed");
    EXPECT_EQ(configuration["motion_head"], true);
    RepairResult ablation = result;
    ablation.config.layers = 0;
    write_outputs(folder.path() / "ablation", ablation, summary);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "ablation" / "graphsage.weights"));
}

TEST(RepairOutputs, every_row_of_the_metrics_has_as_many_cells_as_the_header) {
    const std::string csv = metrics_csv(
        {{"line", "B10,dark_share=0.5", {}, metrics::LinkQuality{}, 0.0, 0.0}}, "graphsage", "route_rule");
    EXPECT_THAT(csv, HasSubstr("\nline,\"B10,dark_share=0.5\",graphsage,"));
    const auto commas = [](const std::string& text) { return std::ranges::count(text, ','); };
    const std::string header = csv.substr(0, csv.find('\n'));
    EXPECT_EQ(commas(csv), 3 * commas(header) + 2) << "two rows, each with one comma inside quotes";
}

TEST(RepairOutputs, an_interrupted_training_claims_nothing_measured) {
    const support::TemporaryFolder folder;
    const RepairConfig config = short_training();
    int asked = 0;
    const RepairResult result = train_repair(runs(4, 4), config, {}, {{}, [&] { return ++asked > 2; }});
    write_outputs(folder.path(), result, summary_of(result, identity_of(config, "hash"), "data"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "metrics.csv"));
    const prediction::Weights weights = prediction::read_weights(folder.path() / "graphsage.weights");
    EXPECT_THAT(weights.notes,
                ::testing::ElementsAre(HasSubstr("hash"), "interrupted after epoch 2, not measured"));
}

class RepairSampleFileTest : public ::testing::Test {
  protected:
    std::filesystem::path write() {
        SyntheticRepair world(1);
        file_ = world.file(4, 3);
        samples::RepairSampleWriter writer(file_.origin);
        for (const samples::RepairSample& sample : file_.samples)
            writer.add(sample);
        const std::filesystem::path path = folder_.path() / "some.samples";
        writer.write(path);
        return path;
    }
    support::TemporaryFolder folder_;
    RepairSampleFile file_;
};

TEST_F(RepairSampleFileTest, what_was_written_is_read) {
    const RepairSampleFile read = samples::read_repair_samples(write());
    EXPECT_EQ(read.origin, file_.origin);
    ASSERT_EQ(read.samples.size(), 3u);
    for (std::size_t at = 0; at < 3; ++at) {
        const prediction::RepairInputs& one = read.samples[at].inputs;
        const prediction::RepairInputs& other = file_.samples[at].inputs;
        EXPECT_EQ(one.nodes, other.nodes);
        EXPECT_EQ(one.edges, other.edges);
        EXPECT_EQ(one.source, other.source);
        EXPECT_EQ(one.first_edge, other.first_edge);
        EXPECT_EQ(one.pairs, other.pairs);
        EXPECT_EQ(one.pair_features, other.pair_features);
        EXPECT_EQ(read.samples[at].linked, file_.samples[at].linked);
        EXPECT_EQ(read.samples[at].rule, file_.samples[at].rule);
        ASSERT_EQ(one.receivers.size(), other.receivers.size());
        EXPECT_EQ(read.samples[at].true_displacement_m, file_.samples[at].true_displacement_m);
        EXPECT_EQ(one.receivers[1].path.points[3].x_m, other.receivers[1].path.points[3].x_m);
    }
}

TEST_F(RepairSampleFileTest, a_file_cut_or_changed_is_refused) {
    const std::filesystem::path path = write();
    const std::string bytes = core::read_file(path);
    for (const std::size_t size : {std::size_t{10}, bytes.size() / 2, bytes.size() - 3}) {
        core::write_atomically(path, bytes.substr(0, size));
        EXPECT_NE(message_of([&] { samples::read_repair_samples(path); }), "") << size;
    }
    std::string changed = bytes;
    changed[bytes.size() / 2] ^= 1;
    core::write_atomically(path, changed);
    EXPECT_THAT(message_of([&] { samples::read_repair_samples(path); }), HasSubstr("its content hash is"));
}

TEST_F(RepairSampleFileTest, numbers_that_contradict_each_other_are_a_fault_of_the_recorder) {
    SyntheticRepair world(1);
    const samples::RepairSample good = world.sample(0.0);
    samples::RepairSampleWriter writer({"line", "B10", prediction::repair_schema(), 1, 0, 50.0});
    samples::RepairSample bad = good;
    bad.inputs.source.front() = 1000;
    EXPECT_THROW(writer.add(bad), std::logic_error);
    bad = good;
    bad.linked.front() = 2;
    EXPECT_THROW(writer.add(bad), std::logic_error);
    bad = good;
    bad.inputs.nodes[3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(writer.add(bad), std::logic_error);
    EXPECT_NO_THROW(writer.add(good));
}

}  // namespace
}  // namespace clearway::training
