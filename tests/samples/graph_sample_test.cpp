#include "samples/graph_sample.hpp"

#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "support/message_of.hpp"

namespace clearway::prediction {
namespace {

using support::message_of;
using testing::HasSubstr;

class GraphSampleTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  ("samples_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder_);
        core::make_folder(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path file() const { return folder_ / "merge_B10_3.samples"; }

    std::filesystem::path folder_;
};

samples::SampleOrigin origin() {
    return {"merge", "B10", {"corrected", 1, 2}, 7, 3, 50.0};
}

samples::GraphSample three_vehicles() {
    return {12.5, 3, {0.5F, -1.0F, 2.0F, 3.25F, 0.0F, 1e-7F}, {{0, 2}}, {{0, 1, 41.5F, 1}, {1, 2, 63.0F, 0}}};
}

TEST_F(GraphSampleTest, what_was_written_is_read) {
    samples::GraphSampleWriter writer(origin());
    writer.add(three_vehicles());
    writer.add({13.5, 0, {}, {}, {}});
    EXPECT_EQ(writer.sample_count(), 2U);
    writer.write(file());

    const samples::GraphSampleFile read = samples::read_graph_samples(file());
    EXPECT_EQ(read.origin, origin());
    ASSERT_EQ(read.samples.size(), 2U);
    EXPECT_EQ(read.samples[0], three_vehicles());
    EXPECT_EQ(read.samples[1].vehicle_count, 0U);
    EXPECT_EQ(read.content_hash.size(), 32U);
}

TEST_F(GraphSampleTest, other_traffic_is_told_and_usual_traffic_is_not) {
    samples::GraphSampleWriter(origin()).write(file());
    EXPECT_EQ(core::read_file(file()).find("traffic"), std::string::npos);
    samples::SampleOrigin other = origin();
    other.traffic = "under corridor, krauss, driver spread 0.2";
    samples::GraphSampleWriter(other).write(file());
    EXPECT_EQ(samples::read_graph_samples(file()).origin, other);
}

TEST_F(GraphSampleTest, equal_samples_make_equal_files) {
    for (const char* name : {"a.samples", "b.samples"}) {
        samples::GraphSampleWriter writer(origin());
        writer.add(three_vehicles());
        writer.write(folder_ / name);
    }
    EXPECT_EQ(core::read_file(folder_ / "a.samples"), core::read_file(folder_ / "b.samples"));
}

TEST_F(GraphSampleTest, a_run_without_samples_is_a_file) {
    samples::GraphSampleWriter(origin()).write(file());
    EXPECT_TRUE(samples::read_graph_samples(file()).samples.empty());
}

TEST_F(GraphSampleTest, a_file_cut_anywhere_is_refused) {
    samples::GraphSampleWriter writer(origin());
    writer.add(three_vehicles());
    writer.write(file());
    const std::string whole = core::read_file(file());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        std::ofstream(file(), std::ios::binary | std::ios::trunc) << whole.substr(0, size);
        EXPECT_THAT(message_of([&] { samples::read_graph_samples(file()); }),
                    HasSubstr("merge_B10_3.samples"))
            << "cut after " << size;
    }
}

TEST_F(GraphSampleTest, a_changed_byte_is_noticed) {
    samples::GraphSampleWriter writer(origin());
    writer.add(three_vehicles());
    writer.write(file());
    std::string bytes = core::read_file(file());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    core::write_atomically(file(), bytes);
    EXPECT_THAT(message_of([&] { samples::read_graph_samples(file()); }), HasSubstr("its content hash is"));
}

TEST_F(GraphSampleTest, an_impossible_count_is_refused_before_memory_is_taken) {
    samples::GraphSampleWriter writer(origin());
    samples::GraphSample lonely{0.0, 0, {}, {}, {}};
    writer.add(lonely);
    writer.write(file());
    std::string bytes = core::read_file(file());
    const std::size_t end = bytes.rfind("\nend ");
    bytes = bytes.substr(0, end);
    for (std::size_t at = end - 12; at < end; ++at)
        bytes[at] = '\xff';
    bytes += "\nend 1 " + core::content_hash(bytes) + "\n";
    core::write_atomically(file(), bytes);
    EXPECT_THAT(message_of([&] { samples::read_graph_samples(file()); }), HasSubstr("ends before its data"));
}

TEST_F(GraphSampleTest, another_version_is_named) {
    core::write_atomically(file(), "clearway graph samples 2\n");
    EXPECT_THAT(message_of([&] { samples::read_graph_samples(file()); }),
                HasSubstr("clearway graph samples 1"));
}

TEST_F(GraphSampleTest, a_sample_that_contradicts_itself_is_a_fault_of_the_recorder) {
    samples::GraphSampleWriter writer(origin());
    const auto refused = [&](auto&& change) {
        samples::GraphSample sample = three_vehicles();
        change(sample);
        EXPECT_THROW(writer.add(sample), std::logic_error);
    };
    refused([](samples::GraphSample& sample) { sample.features.pop_back(); });
    refused(
        [](samples::GraphSample& sample) { sample.features[1] = std::numeric_limits<float>::quiet_NaN(); });
    refused([](samples::GraphSample& sample) { sample.observed_edges[0] = {2, 0}; });
    refused([](samples::GraphSample& sample) { sample.candidates[0].right = 3; });
    refused([](samples::GraphSample& sample) { sample.candidates[0].linked = 2; });
    refused([](samples::GraphSample& sample) { sample.candidates[0].dead_reckoned_m = -1.0F; });
    EXPECT_EQ(writer.sample_count(), 0U);
}

TEST_F(GraphSampleTest, a_folder_lists_its_files_by_name) {
    for (const char* name : {"b.samples", "a.samples", "notes.txt"})
        samples::GraphSampleWriter(origin()).write(folder_ / name);
    EXPECT_THAT(samples::find_graph_samples(folder_),
                testing::ElementsAre(folder_ / "a.samples", folder_ / "b.samples"));
}

TEST_F(GraphSampleTest, an_empty_or_missing_folder_is_said) {
    EXPECT_THAT(message_of([&] { samples::find_graph_samples(folder_); }),
                HasSubstr("clearway links dataset"));
    EXPECT_THAT(message_of([&] { samples::find_graph_samples(folder_ / "none"); }),
                HasSubstr("No such file"));
}

TEST_F(GraphSampleTest, an_unwritable_place_is_the_machine_s_fault) {
    EXPECT_THROW(samples::GraphSampleWriter(origin()).write(folder_ / "missing" / "a.samples"),
                 core::EnvironmentError);
}

}  // namespace
}  // namespace clearway::prediction
