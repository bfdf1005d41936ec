#include "samples/dataset_files.hpp"

#include <filesystem>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::prediction {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class DatasetFilesTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  ("dataset_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder_);
        core::make_folder(folder_);
        put(samples::vehicle_features_file, "1.5,2\n3,-4e1\n5,6\n");
        put(samples::edge_list_file, "0,1,2\n1,2,0\n");
        put(samples::target_file, "1,0,1\n");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void put(const char* name, const std::string& content) {
        core::write_atomically(folder_ / name, content);
    }

    /// Message of the InputError that reading throws; empty when it throws none.
    std::string message() {
        try {
            samples::read_pair_dataset(folder_);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return {};
    }

    std::filesystem::path folder_;
};

TEST_F(DatasetFilesTest, the_three_files_are_read) {
    const samples::PairDataset dataset = samples::read_pair_dataset(folder_);
    EXPECT_EQ(dataset.feature_count, 2U);
    EXPECT_THAT(dataset.features, testing::ElementsAre(1.5F, 2.0F, 3.0F, -40.0F, 5.0F, 6.0F));
    EXPECT_THAT(dataset.source, testing::ElementsAre(0, 1, 2));
    EXPECT_THAT(dataset.target, testing::ElementsAre(1, 2, 0));
    EXPECT_THAT(dataset.label, testing::ElementsAre(1.0F, 0.0F, 1.0F));
}

TEST_F(DatasetFilesTest, what_was_written_is_read) {
    const samples::PairDataset dataset{
        5, {0.1F, 1e-20F, 3.0F, 1.0F / 3.0F, -7.25F, 1, 2, 3, 4, 5}, {0, 1}, {1, 0}, {1.0F, 0.0F}};
    samples::write_pair_dataset(folder_ / "new" / "folder", dataset);
    EXPECT_EQ(samples::read_pair_dataset(folder_ / "new" / "folder"), dataset);
}

TEST_F(DatasetFilesTest, it_is_written_as_chapter_5_4_reads_it) {
    samples::write_pair_dataset(folder_, {2, {0.5F, 1.0F, 2.0F, 3.0F}, {0, 1}, {1, 0}, {1.0F, 0.0F}});
    EXPECT_EQ(core::read_file(folder_ / samples::edge_list_file), "0,1\n1,0\n");
    EXPECT_EQ(core::read_file(folder_ / samples::vehicle_features_file), "0.5,1\n2,3\n");
    EXPECT_EQ(core::read_file(folder_ / samples::target_file), "1,0\n");
}

TEST_F(DatasetFilesTest, spaces_signs_and_line_ends_of_other_systems_are_fine) {
    put(samples::edge_list_file, " 0, 1 ,+2\r\n1,2,0\r\n\r\n");
    put(samples::target_file, "1.0, 0.0,1");
    EXPECT_THAT(samples::read_pair_dataset(folder_).source, testing::ElementsAre(0, 1, 2));
}

TEST_F(DatasetFilesTest, sizes_that_contradict_each_other_are_not_written) {
    EXPECT_THROW(samples::write_pair_dataset(folder_, {3, {1, 2, 3}, {}, {}, {}}), std::logic_error);
    EXPECT_THROW(samples::write_pair_dataset(folder_, {2, {1, 2, 3}, {}, {}, {}}), std::logic_error);
    EXPECT_THROW(samples::write_pair_dataset(folder_, {2, {1, 2}, {0}, {}, {1}}), std::logic_error);
}

TEST_F(DatasetFilesTest, every_missing_file_is_named) {
    std::filesystem::remove(folder_ / samples::edge_list_file);
    std::filesystem::remove(folder_ / samples::target_file);
    EXPECT_THAT(message(), AllOf(HasSubstr("edge_list.csv"), HasSubstr("target_y.csv"),
                                 HasSubstr("clearway links dataset")));
}

TEST_F(DatasetFilesTest, ragged_features_are_refused_with_their_line) {
    put(samples::vehicle_features_file, "1,2\n3\n5,6\n");
    EXPECT_THAT(message(), HasSubstr("vehicle_features.csv:2: 1 values, the first row has 2"));
}

TEST_F(DatasetFilesTest, only_two_or_five_features) {
    put(samples::vehicle_features_file, "1,2,3\n4,5,6\n7,8,9\n");
    EXPECT_THAT(message(), HasSubstr("vehicle_features.csv:1: 3 values (allowed: 2 or 5)"));
}

TEST_F(DatasetFilesTest, values_that_are_no_finite_numbers_are_refused_with_their_place) {
    put(samples::vehicle_features_file, "1,nan\n3,inf\nx,6\n1,\n1e99,0\n");
    EXPECT_THAT(message(), AllOf(HasSubstr("vehicle_features.csv:1: value 2: `nan`"),
                                 HasSubstr("vehicle_features.csv:2: value 2: `inf`"),
                                 HasSubstr("vehicle_features.csv:3: value 1: `x`"),
                                 HasSubstr("vehicle_features.csv:4: value 2: nothing"),
                                 HasSubstr("vehicle_features.csv:5: value 1: `1e99`")));
}

TEST_F(DatasetFilesTest, indices_must_be_integers_of_listed_vehicles) {
    put(samples::edge_list_file, "-1,1,2.5\n1,3,0\n");
    EXPECT_THAT(message(), AllOf(HasSubstr("edge_list.csv:1: value 1: vehicle -1"),
                                 HasSubstr("edge_list.csv:1: value 3: `2.5` (allowed: an integer)"),
                                 HasSubstr("edge_list.csv:2: value 2: vehicle 3"), HasSubstr("0 to 2")));
}

TEST_F(DatasetFilesTest, an_index_beyond_64_bit_is_refused) {
    put(samples::edge_list_file, "0,1,99999999999999999999\n1,2,0\n");
    EXPECT_THAT(message(), HasSubstr("edge_list.csv:1: value 3"));
}

TEST_F(DatasetFilesTest, a_pair_needs_two_vehicles) {
    put(samples::edge_list_file, "0,1,2\n1,1,0\n");
    EXPECT_THAT(message(), HasSubstr("edge_list.csv:2: value 2: vehicle 1 paired with itself"));
}

TEST_F(DatasetFilesTest, the_edge_list_has_two_rows_of_one_length) {
    put(samples::edge_list_file, "0,1,2\n");
    EXPECT_THAT(message(), HasSubstr("edge_list.csv: 1 rows (allowed: 2)"));
    put(samples::edge_list_file, "0,1,2\n1,2\n");
    EXPECT_THAT(message(), HasSubstr("edge_list.csv:2: 2 targets for 3 sources"));
    put(samples::edge_list_file, "0,1\n1,2\n2,0\n");
    EXPECT_THAT(message(), HasSubstr("edge_list.csv: 3 rows"));
}

TEST_F(DatasetFilesTest, labels_are_zero_or_one_one_a_pair) {
    put(samples::target_file, "1,0.5,2\n");
    EXPECT_THAT(message(), AllOf(HasSubstr("target_y.csv:1: value 2: `0.5`"),
                                 HasSubstr("target_y.csv:1: value 3: `2`")));
    put(samples::target_file, "1,0\n");
    EXPECT_THAT(message(), HasSubstr("2 labels, but edge_list.csv has 3 pairs"));
    put(samples::target_file, "1\n0\n1\n");
    EXPECT_THAT(message(), HasSubstr("target_y.csv: 3 rows"));
}

TEST_F(DatasetFilesTest, empty_files_are_refused) {
    put(samples::vehicle_features_file, "\n\n");
    EXPECT_THAT(message(), HasSubstr("vehicle_features.csv: no vehicle"));
    put(samples::vehicle_features_file, "1,2\n3,4\n");
    put(samples::edge_list_file, "");
    put(samples::target_file, "");
    EXPECT_THAT(message(), AllOf(HasSubstr("edge_list.csv: 0 rows"), HasSubstr("target_y.csv: 0 rows")));
}

TEST_F(DatasetFilesTest, a_file_of_faults_is_not_repeated_whole) {
    std::string rows;
    for (int row = 0; row < 100; ++row)
        rows += "nan,1\n";
    put(samples::vehicle_features_file, rows);
    EXPECT_THAT(message(),
                AllOf(HasSubstr(":20:"), HasSubstr("and: 80 more"), testing::Not(HasSubstr(":21:"))));
}

}  // namespace
}  // namespace clearway::prediction
