#include "core/own_output.hpp"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::core {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class OwnOutputTest : public ::testing::Test {
  protected:
    template <class Action>
    static std::string refusal(const Action& action) {
        try {
            action();
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    }
    std::string claimed() const {
        return refusal([&] { claim(place(), own_); });
    }
    std::string written(const std::filesystem::path& file) const {
        return refusal([&] { write_own(file, "<ours> again", {"a page of this test", "<ours>"}); });
    }
    std::filesystem::path place() const { return folder_.path() / "place"; }

    OwnFolder own_{"clearway test", {".mark", "older"}};
    support::TemporaryFolder folder_;
};

TEST_F(OwnOutputTest, a_folder_that_is_new_or_empty_becomes_ones_own) {
    EXPECT_EQ(claimed(), "accepted");
    EXPECT_EQ(read_file(place() / ".mark"), "clearway test\n");
    folder_.write("place/result", "whatever");
    EXPECT_EQ(claimed(), "accepted") << "it has the mark";
    std::filesystem::remove_all(place());
    std::filesystem::create_directory(place());
    folder_.write("place/.hidden", "");
    folder_.write("place/result.2147483647.clearway-part", "");
    EXPECT_EQ(claimed(), "accepted");
}

TEST_F(OwnOutputTest, a_folder_with_any_of_the_marks_is_ones_own) {
    std::filesystem::create_directory(place());
    folder_.write("place/older", "");
    folder_.write("place/result", "");
    EXPECT_EQ(claimed(), "accepted");
    EXPECT_FALSE(std::filesystem::exists(place() / ".mark"));
}

TEST_F(OwnOutputTest, a_folder_or_file_of_somebody_else_is_refused) {
    std::filesystem::create_directory(place());
    folder_.write("place/thesis", "years");
    EXPECT_THAT(claimed(),
                AllOf(HasSubstr("--out: "), HasSubstr("place holds something else (allowed: a new or "
                                                      "empty folder, or one of clearway test)")));
    EXPECT_FALSE(std::filesystem::exists(place() / ".mark"));
    std::filesystem::remove_all(place());
    folder_.write("place", "a file");
    EXPECT_THROW(claimed(), EnvironmentError);
    EXPECT_EQ(read_file(place()), "a file");
}

TEST_F(OwnOutputTest, a_place_is_tried_and_nothing_of_it_stays) {
    require_writable(place() / "in" / "here");
    require_writable(place() / "in/");
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
    std::filesystem::create_directory(place());
    require_writable(place());
    EXPECT_TRUE(std::filesystem::is_directory(place())) << "it was there before";
    std::filesystem::remove(place());
    folder_.write("place", "a file");
    EXPECT_THROW(require_writable(place()), EnvironmentError);
    EXPECT_THROW(require_writable(place() / "in"), EnvironmentError);
    EXPECT_THROW(require_writable("/proc/x/y"), EnvironmentError);
    EXPECT_EQ(read_file(place()), "a file");
}

TEST_F(OwnOutputTest, a_file_is_written_over_if_it_is_empty_or_has_the_mark) {
    EXPECT_EQ(written(place()), "accepted");
    EXPECT_EQ(written(place()), "accepted");
    EXPECT_EQ(read_file(place()), "<ours> again");
    folder_.write("place", "");
    EXPECT_EQ(written(place()), "accepted");
    for (const std::string& theirs :
         {std::string("years"), std::string(mark_reach, ' ') + "<ours>", std::string("<our")}) {
        folder_.write("place", theirs);
        EXPECT_THAT(written(place()),
                    HasSubstr("place: is there already (allowed: a new file, or a page of this "
                              "test). Choose another name, or remove it"));
        EXPECT_EQ(read_file(place()), theirs);
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(OwnOutputTest, links_and_pipes_stay) {
    std::filesystem::create_symlink("nowhere", place());
    EXPECT_THAT(written(place()), HasSubstr("is there already"));
    EXPECT_TRUE(std::filesystem::is_symlink(place()));
    std::filesystem::remove(place());
    ASSERT_EQ(::mkfifo(place().c_str(), 0600), 0);
    EXPECT_THROW(written(place()), EnvironmentError);
    EXPECT_TRUE(std::filesystem::is_fifo(place()));
}

TEST_F(OwnOutputTest, a_new_file_never_takes_the_place_of_another) {
    const auto made = [&] { return refusal([&] { write_new(place(), "ours"); }); };
    EXPECT_EQ(made(), "accepted");
    EXPECT_EQ(read_file(place()), "ours");
    folder_.write("place", "theirs");
    EXPECT_THAT(made(), HasSubstr("place: is there already (allowed: a new file)"));
    EXPECT_EQ(read_file(place()), "theirs");
    std::filesystem::remove(place());
    std::filesystem::create_directory(place());
    EXPECT_THAT(made(), HasSubstr("is there already"));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1)
        << "nothing is left aside";
}

}  // namespace
}  // namespace clearway::core
