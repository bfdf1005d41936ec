#include "server/detail/feed.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace clearway::server::detail {
namespace {

TEST(Feed, readsNumbersOfUpToTenBytes) {
    std::size_t at = 0;
    std::uint64_t value = 0;
    EXPECT_TRUE(read_number("\x85\x01-", at, value));
    EXPECT_EQ(value, 133U);
    EXPECT_EQ(at, 2U);
    at = 0;
    EXPECT_TRUE(read_number(std::string(9, '\xff') + '\x01', at, value));
    EXPECT_EQ(value, std::numeric_limits<std::uint64_t>::max());
    at = 0;
    EXPECT_FALSE(read_number("\x85", at, value)) << "not whole yet";
    at = 0;
    EXPECT_FALSE(read_number(std::string(80, '\xff') + '\x01', at, value)) << "no number has so many";
}

}  // namespace
}  // namespace clearway::server::detail
