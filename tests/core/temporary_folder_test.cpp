#include "core/temporary_folder.hpp"

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.hpp"

namespace clearway::core {
namespace {

using ::testing::HasSubstr;

TEST(TemporaryFolderTest, GoesWithAllThatItHolds) {
    std::filesystem::path path;
    {
        const TemporaryFolder folder;
        path = folder.path();
        std::filesystem::create_directories(path / "a" / "b");
        std::ofstream(path / "a" / "b" / "file") << "text";
        EXPECT_TRUE(std::filesystem::exists(path / "a" / "b" / "file"));
        const TemporaryFolder other;
        EXPECT_NE(other.path(), path);
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(TemporaryFolderTest, MakesTheFolderThatItIsGivenAndLeavesItsParents) {
    const TemporaryFolder parent;
    const auto path = parent.path() / "new" / "work";
    {
        const TemporaryFolder folder(path);
        EXPECT_TRUE(std::filesystem::is_directory(path));
    }
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_TRUE(std::filesystem::exists(parent.path() / "new"));
}

TEST(TemporaryFolderTest, SaysWhatToDoWhereNoneCanBeMade) {
    const char* const before = std::getenv("TMPDIR");
    const std::string kept = before == nullptr ? "" : before;
    std::vector<std::string> messages;
    for (const char* const place : {"/proc", "/nonexistent", "/dev/null", ""}) {
        ::setenv("TMPDIR", place, 1);
        try {
            const TemporaryFolder folder;
        } catch (const EnvironmentError& error) {
            messages.emplace_back(error.what());
        }
    }
    before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1);
    ASSERT_EQ(messages.size(), 4U);
    EXPECT_THAT(messages[0], HasSubstr("/proc: cannot make a folder there: "));
    for (std::size_t at = 1; at < messages.size(); ++at)
        EXPECT_THAT(messages[at], HasSubstr("TMPDIR: cannot make a folder there: "));
    EXPECT_THAT(messages, ::testing::Each(HasSubstr(". Set TMPDIR to a writable folder")));
}

/// A process that has ended, and that nobody has begun anew.
pid_t ended_process() {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    ::waitpid(child, nullptr, 0);
    return child;
}

TEST(TemporaryFolderTest, RemovesWhatAKilledProcessLeft) {
    const TemporaryFolder place;
    const std::filesystem::path left = place.path() / fmt::format("clearway-{}-a1b2c3", ended_process());
    std::filesystem::create_directories(left / "below");
    const char* const before = std::getenv("TMPDIR");
    const std::string kept = before == nullptr ? "" : before;
    ::setenv("TMPDIR", place.path().c_str(), 1);
    {
        const TemporaryFolder folder;
        EXPECT_EQ(folder.path().parent_path(), place.path());
        EXPECT_THAT(folder.path().filename().string(),
                    testing::StartsWith(fmt::format("clearway-{}-", ::getpid())));
    }
    before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1);
    EXPECT_FALSE(std::filesystem::exists(left));
}

TEST(ProcessFolderTest, RemovesWhatKilledProcessesLeftAndNothingElse) {
    const TemporaryFolder place;
    const auto folder_of = [&](const std::string& name) {
        std::filesystem::create_directories(place.path() / name / "below");
        return place.path() / name;
    };
    const std::string gone = std::to_string(ended_process());
    const auto left = folder_of("live-" + gone + "-a1b2c3");
    const std::vector kept = {folder_of("live-" + std::to_string(::getppid()) + "-a1b2c3"),
                              folder_of("mine"),
                              folder_of("live-"),
                              folder_of("live-0-a"),
                              folder_of("live-x-a"),
                              folder_of("live-" + gone),
                              folder_of("other-" + gone + "-a")};
    const auto mine = process_folder(place.path(), "live-");
    EXPECT_FALSE(std::filesystem::exists(left));
    for (const auto& folder : kept)
        EXPECT_TRUE(std::filesystem::exists(folder / "below")) << folder;
    EXPECT_THAT(mine.filename().string(), testing::StartsWith("live-" + std::to_string(::getpid()) + "-"));
    EXPECT_EQ(std::filesystem::status(mine).permissions(), std::filesystem::perms::owner_all);
    EXPECT_NE(process_folder(place.path(), "live-"), mine) << "and its own stay";
    EXPECT_TRUE(std::filesystem::exists(mine));
}

TEST(ProcessFolderTest, APlaceWhereNothingCanBeMadeIsTold) {
    EXPECT_THROW(process_folder("/proc/clearway", "live-"), EnvironmentError);
}

}  // namespace
}  // namespace clearway::core
