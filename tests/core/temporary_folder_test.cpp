#include "core/temporary_folder.hpp"

#include <cstdlib>
#include <fstream>
#include <string>

#include <gmock/gmock.h>

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
    ::setenv("TMPDIR", "/proc", 1);
    std::string message;
    try {
        const TemporaryFolder folder;
    } catch (const EnvironmentError& error) {
        message = error.what();
    }
    before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1);
    EXPECT_THAT(message, HasSubstr("/proc: cannot make a folder there. Set TMPDIR"));
}

}  // namespace
}  // namespace clearway::core
