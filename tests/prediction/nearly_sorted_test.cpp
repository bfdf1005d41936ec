#include "prediction/detail/nearly_sorted.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace clearway::prediction::detail {
namespace {

void expect_sorted_as_by_std(std::vector<int> items) {
    std::vector<int> expected = items;
    std::ranges::sort(expected);
    std::vector<int> buffer = {7, 7};
    sort_nearly_sorted(items, buffer);
    EXPECT_EQ(items, expected);
}

TEST(NearlySorted, SortsWhatIsShortOrTurned) {
    expect_sorted_as_by_std({});
    expect_sorted_as_by_std({1});
    expect_sorted_as_by_std({2, 1});
    expect_sorted_as_by_std({5, 4, 3, 2, 1});
    expect_sorted_as_by_std({1, 1, 1});
    expect_sorted_as_by_std({9, 1, 2, 3});
    expect_sorted_as_by_std({1, 2, 3, 0});
}

TEST(NearlySorted, SortsWithAnyNumberOfItemsOutOfPlace) {
    std::mt19937 random(1);
    for (const int displaced : {1, 2, 5, 50, 300}) {
        std::vector<int> items(300);
        std::iota(items.begin(), items.end(), 0);
        std::uniform_int_distribution<std::size_t> any(0, items.size() - 1);
        for (int turn = 0; turn < displaced; ++turn)
            items[any(random)] = static_cast<int>(any(random));
        expect_sorted_as_by_std(items);
    }
}

TEST(NearlySorted, DropsFewOfAnOrderThatFewBreak) {
    std::vector<int> items(1000);
    std::iota(items.begin(), items.end(), 0);
    items[10] = 2000;
    items[500] = -1;
    std::vector<int> buffer;
    sort_nearly_sorted(items, buffer);
    EXPECT_LE(buffer.size(), 3U);
}

}  // namespace
}  // namespace clearway::prediction::detail
