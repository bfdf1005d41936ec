#pragma once

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace clearway::prediction::detail {

/// Sorts items of which few are out of place: O(n + m log m) for m such items (drop-merge sort). Those that
/// break the order are dropped, sorted apart and merged back. `buffer` keeps its memory between calls.
template <typename Item>
void sort_nearly_sorted(std::vector<Item>& items, std::vector<Item>& buffer) {
    buffer.clear();
    std::size_t kept = 0;
    for (std::size_t at = 0; at < items.size(); ++at) {
        // An item that fits behind the last but one says that the last one is out of place.
        if (kept > 1 && items[at] < items[kept - 1] && !(items[at] < items[kept - 2])) {
            buffer.push_back(std::move(items[kept - 1]));
            items[kept - 1] = std::move(items[at]);
        } else if (kept > 0 && items[at] < items[kept - 1]) {
            buffer.push_back(std::move(items[at]));
        } else {
            if (at != kept) items[kept] = std::move(items[at]);
            ++kept;
        }
    }
    std::sort(buffer.begin(), buffer.end());
    // From behind, so that what is kept moves once.
    std::size_t to = items.size();
    for (auto moved = buffer.rbegin(); moved != buffer.rend(); --to) {
        Item& back = items[to - 1];
        if (kept > 0 && *moved < items[kept - 1]) {
            back = std::move(items[--kept]);
        } else {
            back = std::move(*moved++);
        }
    }
}

}  // namespace clearway::prediction::detail
