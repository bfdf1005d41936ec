#pragma once

#include <utility>
#include <vector>

namespace clearway::links::detail {

/// Adds `other` to `bins`, both ascending by `bin`; `add_counts(bin, same_bin)` adds the counts of two that
/// are the same.
template <typename Bin, typename AddCounts>
void add_bins(std::vector<Bin>& bins, const std::vector<Bin>& other, AddCounts&& add_counts) {
    std::vector<Bin> merged;
    merged.reserve(bins.size() + other.size());
    auto one = bins.begin();
    for (const Bin& bin : other) {
        while (one != bins.end() && one->bin < bin.bin)
            merged.push_back(*one++);
        merged.push_back(bin);
        if (one == bins.end() || one->bin != bin.bin) continue;
        add_counts(merged.back(), *one);
        ++one;
    }
    merged.insert(merged.end(), one, bins.end());
    bins = std::move(merged);
}

}  // namespace clearway::links::detail
