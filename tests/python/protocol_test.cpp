// Names of parts, sheets in shared memory, and the channel; the other end is the Python suites' matter.
#include <array>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <numeric>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "python/channel.hpp"
#include "python/nursery.hpp"
#include "python/part_name.hpp"
#include "python/sheet.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::python {
namespace {

TEST(PartName, is_a_class_of_a_file_or_a_torch_script) {
    const auto name = part_name_from("some/my_policy.py:Yield");
    ASSERT_TRUE(name);
    EXPECT_EQ(*name, (PartName{"some/my_policy.py", "Yield", ""}));
    EXPECT_EQ(*part_name_from("net.pt"), (PartName{"net.pt", "", ""}));
    EXPECT_EQ(*part_name_from("a.py:B@0123456789abcdef0123456789abcdef"),
              (PartName{"a.py", "B", "0123456789abcdef0123456789abcdef"}));
    for (const char* other : {"corridor", "graphsage", "py:Yield", "my_policy:Yield", ""})
        EXPECT_FALSE(part_name_from(other)) << other;
    EXPECT_EQ(short_name("some/my_policy.py:Yield@0123456789abcdef0123456789abcdef"), "Yield");
    EXPECT_EQ(short_name("some/net.pt"), "net");
    EXPECT_EQ(short_name("corridor"), "corridor");
}

TEST(PartName, resolves_to_an_absolute_file_with_the_hash_of_its_content) {
    const support::TemporaryFolder folder;
    core::write_atomically(folder.path() / "mine.py", "class Mine: pass\n");
    const std::string word = resolved("mine.py:Mine", folder.path(), "--policy");
    const std::string hash = core::content_hash("class Mine: pass\n");
    EXPECT_EQ(word, (folder.path() / "mine.py").string() + ":Mine@" + hash);
    EXPECT_EQ(resolved(word, "/elsewhere", "--policy"), word);
    EXPECT_EQ(resolved("corridor", folder.path(), "--policy"), "corridor");
    core::write_atomically(folder.path() / "mine.py", "class Mine: act = 1\n");
    EXPECT_THROW(resolved(word, folder.path(), "--policy"), core::ConflictError);
    EXPECT_THROW(resolved("mine.py", folder.path(), "--policy"), core::InputError);
    EXPECT_THROW(resolved("other.py:Mine", folder.path(), "--policy"), core::InputError);
}

constexpr std::array<Column, 3> columns = {
    {{"key", "u8", "", "a key"}, {"x_m", "f4", "m", "a place"}, {"flag", "u1", "", ""}}};

TEST(Sheet, reads_what_was_written_at_places_of_64_bytes) {
    alignas(64) std::array<std::byte, 1024> memory{};
    Sheet sheet(memory, columns);
    sheet.clear();
    sheet.put<std::uint64_t>(0, {7, 8});
    std::vector<float> places(20);
    std::iota(places.begin(), places.end(), 0.5F);
    sheet.put(1, places);
    const auto read = sheet.read<float>(1);
    EXPECT_EQ(std::vector<float>(read.begin(), read.end()), places);
    EXPECT_EQ((reinterpret_cast<const std::byte*>(read.data()) - memory.data()) % 64, 0);
    EXPECT_EQ(sheet.read<std::uint64_t>(0)[1], 8U);
    EXPECT_TRUE(sheet.read<std::uint8_t>(2).empty());
    EXPECT_EQ(to_json(columns),
              R"([["key","u8","","a key"],["x_m","f4","m","a place"],["flag","u1","",""]])");
}

TEST(Sheet, refuses_what_does_not_fit) {
    alignas(64) std::array<std::byte, 256> memory{};
    Sheet sheet(memory, columns);
    sheet.clear();
    EXPECT_THROW(sheet.room<float>(1, 100), std::length_error);
    EXPECT_THROW(sheet.room<double>(1, 1), std::logic_error);
    auto* const directory = reinterpret_cast<std::uint64_t*>(memory.data());
    directory[2] = 64;  // the offset of x_m, and a count that leads outside
    directory[3] = 1000;
    EXPECT_THROW(sheet.read<float>(1), std::out_of_range);
    directory[2] = ~std::uint64_t{0};
    EXPECT_THROW(sheet.read<float>(1), std::out_of_range);
}

TEST(Channel, tells_when_the_other_side_is_gone) {
    Channel ours;
    const char letter = 'A';
    ASSERT_EQ(::write(ours.theirs().write, &letter, 1), 1);
    Bell bell{};
    EXPECT_TRUE(ours.wait(bell));
    EXPECT_EQ(bell, Bell::answer);
    EXPECT_TRUE(ours.ring(Bell::decide));
    ours.close_theirs();
    EXPECT_FALSE(ours.wait(bell));
    EXPECT_FALSE(ours.ring(Bell::decide));
}

/// Processes of parts, made by the nursery or, without one, each for itself.
class HostTest : public testing::TestWithParam<bool> {
  protected:
    void SetUp() override {
        ::setenv("CLEARWAY_PACKAGE", CLEARWAY_SOURCE_DIR "/python", 1);
        if (GetParam()) nursery_ = std::make_unique<Nursery>();
    }
    static bool has_nursery() { return std::getenv("CLEARWAY_NURSERY") != nullptr; }

    std::unique_ptr<Nursery> nursery_;
};
INSTANTIATE_TEST_SUITE_P(WithAndWithout, HostTest, testing::Bool());

TEST_P(HostTest, answers_and_says_how_it_ended) {
    EXPECT_EQ(has_nursery(), GetParam());
    for (int time = 0; time < 2; ++time) {
        Channel channel;
        Host host(channel.theirs());
        channel.close_theirs();
        channel.write_text("{}");  // a greeting that lacks all
        ASSERT_TRUE(channel.ring(Bell::hello));
        Bell bell{};
        ASSERT_TRUE(channel.wait(bell));
        EXPECT_EQ(bell, Bell::failed);
        EXPECT_NE(channel.read_text().find("KeyError: 'file'"), std::string::npos) << channel.read_text();
        EXPECT_FALSE(channel.wait(bell));
        EXPECT_EQ(host.wait()->signal, SIGKILL);  // it ends what it started, and so itself
    }
}

TEST_P(HostTest, ends_with_its_owner_although_it_waits) {
    Channel channel;
    auto host = std::make_unique<Host>(channel.theirs());
    channel.close_theirs();
    host.reset();
    Bell bell{};
    EXPECT_FALSE(channel.wait(bell)) << "nobody holds the other end";
}

TEST(Nursery, that_has_ended_is_not_needed) {
    ::setenv("CLEARWAY_PACKAGE", CLEARWAY_SOURCE_DIR "/python", 1);
    ::setenv("CLEARWAY_NURSERY", "nobody listens here", 1);
    Channel channel;
    Host host(channel.theirs());
    channel.close_theirs();
    channel.write_text("{}");
    ASSERT_TRUE(channel.ring(Bell::hello));
    Bell bell{};
    EXPECT_TRUE(channel.wait(bell));
    ::unsetenv("CLEARWAY_NURSERY");
    {
        const Nursery nursery;
        EXPECT_NE(std::getenv("CLEARWAY_NURSERY"), nullptr);
    }
    EXPECT_EQ(std::getenv("CLEARWAY_NURSERY"), nullptr);
}

}  // namespace
}  // namespace clearway::python
