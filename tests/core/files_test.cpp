#include "core/files.hpp"

#include <algorithm>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/leftovers.hpp"
#include "core/near_file.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::core {
namespace {

using ::testing::HasSubstr;

class FilesTest : public ::testing::Test {
  protected:
    std::ptrdiff_t files_in_folder() const {
        return std::distance(std::filesystem::directory_iterator(folder_.path()),
                             std::filesystem::directory_iterator());
    }
    template <class Exception, class Action>
    std::string complaint(const Action& action) {
        try {
            action();
        } catch (const Exception& error) {
            return error.what();
        }
        return "no complaint";
    }

    support::TemporaryFolder folder_;
};

TEST_F(FilesTest, WritesAndReadsEveryByte) {
    const auto file = folder_.path() / "data";
    std::string content;
    for (int byte = 0; byte < 100'000; ++byte) {
        content += static_cast<char>(byte % 256);
    }
    write_atomically(file, content);
    EXPECT_EQ(read_file(file), content);
    write_atomically(file, "short");
    EXPECT_EQ(read_file(file), "short");
    write_atomically(file, "");
    EXPECT_EQ(read_file(file), "");
    EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(FilesTest, AFullDiskLeavesTheOldFile) {
    const auto file = folder_.write("result.csv", "old");
    // What is written aside ends up on a device without room.
    std::filesystem::create_symlink("/dev/full",
                                    file.string() + "." + std::to_string(getpid()) + ".clearway-part");
    const std::string text = complaint<EnvironmentError>([&] { write_atomically(file, "new"); });
    EXPECT_THAT(text, HasSubstr("result.csv: cannot write: No space left on device. Free some space"));
    EXPECT_EQ(read_file(file), "old");
    EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(FilesTest, NamesTheFileThatCannotBeWritten) {
    const auto file = folder_.path() / "missing" / "result.csv";
    EXPECT_THAT(complaint<EnvironmentError>([&] { write_atomically(file, "x"); }),
                HasSubstr("missing/result.csv: cannot write: No such file or directory"));
    std::filesystem::create_directory(folder_.path() / "taken");
    EXPECT_THAT(complaint<EnvironmentError>([&] { write_atomically(folder_.path() / "taken", "x"); }),
                HasSubstr("taken: cannot write: Is a directory"));
    EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(FilesTest, APipeIsNotReplaced) {
    const std::filesystem::path pipe = folder_.path() / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THAT(complaint<EnvironmentError>([&] { write_atomically(pipe, "text"); }),
                HasSubstr("pipe: cannot write: it is not a file. Choose another place"));
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST_F(FilesTest, APipeIsRefusedAtOnceAndWhatIsHandedOverIsRead) {
    const std::filesystem::path pipe = folder_.path() / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THROW(read_file(pipe), InputError);
    EXPECT_THROW(read_file("/dev/zero"), InputError);
    EXPECT_EQ(read_file("/dev/null"), "");
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    ASSERT_EQ(::write(ends[1], "words", 5), 5);
    ::close(ends[1]);
    EXPECT_EQ(read_file("/dev/fd/" + std::to_string(ends[0])), "words");
    ::close(ends[0]);
}

TEST_F(FilesTest, NamesTheFileThatCannotBeRead) {
    EXPECT_THAT(complaint<InputError>([&] { read_file(folder_.path() / "missing.toml"); }),
                HasSubstr("missing.toml: cannot be read"));
    EXPECT_THROW(read_file(folder_.path()), InputError);
}

TEST_F(FilesTest, AFileThatWouldFillTheMemoryIsRefused) {
    const std::filesystem::path file = folder_.write("holes", "");
    std::error_code no_room;
    std::filesystem::resize_file(file, std::uintmax_t{1} << 42, no_room);
    if (no_room) GTEST_SKIP() << "no file of 4 TiB of holes here: " << no_room.message();
    EXPECT_THAT(
        complaint<InputError>([&] { read_file(file); }),
        testing::AllOf(HasSubstr("holes: has 4194304 MiB"), HasSubstr("half of this machine's memory")));
}

TEST_F(FilesTest, AReadErrorIsNotTheEndOfAFile) {
    // The memory of a process cannot be read at address 0: the device of every machine that fails at once.
    EXPECT_THAT(complaint<EnvironmentError>([&] { read_file("/proc/self/mem"); }),
                HasSubstr("mem: cannot be read: Input/output error. The machine failed"));
}

TEST_F(FilesTest, WithoutDescriptorsTheMachineFailsAndNotTheInput) {
    const std::filesystem::path file = folder_.write("there", "text");
    rlimit limit{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
    const rlimit none{0, limit.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    const std::string said = complaint<EnvironmentError>([&] { read_file(file); });
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
    EXPECT_THAT(said, HasSubstr("there: cannot be read: Too many open files"));
    EXPECT_EQ(read_file(file), "text");
}

TEST_F(FilesTest, MakesFoldersWithTheirParents) {
    const auto folder = folder_.path() / "a" / "b" / "c";
    make_folder(folder);
    make_folder(folder);
    EXPECT_TRUE(std::filesystem::is_directory(folder));
    folder_.write("file", "x");
    EXPECT_THAT(complaint<EnvironmentError>([&] { make_folder(folder_.path() / "file" / "below"); }),
                HasSubstr("below: cannot write"));
    EXPECT_THROW(make_folder("/proc/clearway"), EnvironmentError);
}

TEST(ContentHash, GivesThePublishedValueOfXxh3) {
    EXPECT_EQ(content_hash(""), "99aa06d3014798d86001c324468d497f");
}

TEST(ContentHash, ChangesWithEveryByte) {
    const std::string text(1000, 'x');
    const std::string hash = content_hash(text);
    EXPECT_EQ(hash.size(), 32u);
    for (const std::size_t place : {0, 1, 500, 999}) {
        std::string other = text;
        other[place] = 'y';
        EXPECT_NE(content_hash(other), hash);
    }
    EXPECT_EQ(content_hash(std::string(1000, 'x')), hash);
}

TEST_F(FilesTest, an_output_is_written_after_what_killed_calls_left_of_it_is_removed) {
    const std::string gone = "2147483647";
    const auto running = folder_.write("a.html." + std::to_string(getppid()) + ".clearway-part", "");
    const auto other = folder_.write("b.html." + gone + ".clearway-part", "");
    std::vector<std::filesystem::path> left = {folder_.write("a.html." + gone + ".clearway-part", "")};
    for (const std::string& name :
         {".a.html." + gone + ".clearway-part", ".a.html.clearway-import-" + gone}) {
        std::filesystem::create_directories(folder_.path() / name / "network");
        left.push_back(folder_.path() / name);
    }
    for (const auto& path : left)
        EXPECT_TRUE(is_leftover(path)) << path;
    write_output(folder_.path() / "a.html", "whole");
    EXPECT_EQ(read_file(folder_.path() / "a.html"), "whole");
    for (const auto& path : left)
        EXPECT_FALSE(std::filesystem::exists(path)) << path;
    EXPECT_TRUE(std::filesystem::exists(running));
    EXPECT_TRUE(std::filesystem::exists(other)) << "of another file";
    for (const char* const name :
         {"a.clearway-part", "a.1x.clearway-part", "clearway-import-3", "a.-1.clearway-part", "part",
          ".clearway-import-", "photos.99998.part", ".a.importing-99998"})
        EXPECT_FALSE(is_leftover(name)) << name;
}

TEST_F(FilesTest, a_folder_that_cannot_be_listed_is_not_empty) {
    const auto folder = folder_.path() / "new";
    EXPECT_TRUE(is_absent_or_empty(folder));
    std::filesystem::create_directories(folder / ".hidden");
    EXPECT_TRUE(is_absent_or_empty(folder));
    EXPECT_FALSE(holds_only(folder, [](const std::string&) { return false; }));
    EXPECT_FALSE(is_absent_or_empty(folder_.write("file", "")));
    std::filesystem::create_symlink("loop", folder_.path() / "loop");
    EXPECT_THROW(is_absent_or_empty(folder_.path() / "loop"), InputError);
}

TEST_F(FilesTest, parts_of_killed_writers_go_and_those_of_others_stay) {
    const auto gone = folder_.write("a.json.2147483647.clearway-part", "");
    const auto own = folder_.write("a.json." + std::to_string(getpid()) + ".clearway-part", "");
    const auto no_writer = folder_.write("a.json.clearway-part", "");
    const auto no_process = folder_.write("a.12x.clearway-part", "");
    remove_abandoned_parts(folder_.path());
    EXPECT_FALSE(std::filesystem::exists(gone));
    for (const auto& kept : {own, no_writer, no_process})
        EXPECT_TRUE(std::filesystem::exists(kept)) << kept;
}

TEST(NearFile, has_the_ending_of_the_missing_one_and_is_written_as_it_is) {
    const support::TemporaryFolder folder;
    folder.write("parts.toml", "");
    folder.write("party.md", "");
    const std::string here = folder.path().string();
    EXPECT_EQ(did_you_mean_file(here + "/party.toml"), "Did you mean '" + here + "/parts.toml'?");
    EXPECT_EQ(did_you_mean_file(here + "/nowhere/party.toml", "None."), "None.");
}

}  // namespace
}  // namespace clearway::core
