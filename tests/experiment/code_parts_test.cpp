#include "experiment/code_parts.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.hpp"
#include "support/message_of.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::experiment {
namespace {

/// A condition that repairs by a net of the user.
ConditionSpec with_net(const std::filesystem::path& file) {
    ConditionSpec condition;
    condition.name = "mine";
    condition.model_file = file.string();
    condition.model_hash = core::content_hash(core::read_file(file));
    return condition;
}

class KeptCodeTest : public testing::Test {
  protected:
    std::filesystem::path net() const { return folder_.path() / "mine.txt"; }
    std::filesystem::path run_folder() const { return folder_.path() / "run"; }

    void SetUp() override { core::write_atomically(net(), "weights"); }

    support::TemporaryFolder folder_;
};

TEST_F(KeptCodeTest, a_net_that_was_edited_or_is_gone_is_found_in_the_run_folder) {
    const ConditionSpec condition = with_net(net());
    keep_code({condition}, run_folder());
    EXPECT_EQ(located(condition, kept_code(run_folder()), "").model_file, net()) << "its own place is first";
    core::write_atomically(net(), "better weights");
    const std::filesystem::path copy = located(condition, kept_code(run_folder()), "").model_file;
    EXPECT_EQ(copy, run_folder() / "code" / condition.model_hash / "mine.txt");
    EXPECT_EQ(core::read_file(copy), "weights");
    std::filesystem::remove(net());
    EXPECT_EQ(located(condition, kept_code(run_folder()), "").model_file, copy);
}

TEST_F(KeptCodeTest, a_copy_that_was_edited_is_made_anew) {
    const ConditionSpec condition = with_net(net());
    keep_code({condition}, run_folder());
    const std::filesystem::path copy = kept_code(run_folder()).at(0) / "mine.txt";
    core::write_atomically(copy, "spoiled");
    keep_code({condition}, run_folder());
    EXPECT_EQ(core::read_file(copy), "weights");
}

TEST_F(KeptCodeTest, a_net_that_is_edited_while_the_study_is_read_is_refused) {
    const ConditionSpec condition = with_net(net());
    core::write_atomically(net(), "better weights");
    EXPECT_THAT(support::message_of([&] { keep_code({condition}, run_folder()); }),
                testing::AllOf(testing::HasSubstr("condition mine"), testing::HasSubstr("was changed"),
                               testing::HasSubstr("Give the command again")));
}

TEST_F(KeptCodeTest, a_folder_without_copies_has_none) {
    keep_code({ConditionSpec{}}, run_folder());
    EXPECT_TRUE(kept_code(run_folder()).empty());
}

}  // namespace
}  // namespace clearway::experiment
