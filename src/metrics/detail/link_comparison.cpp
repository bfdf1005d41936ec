#include "metrics/detail/link_comparison.hpp"

#include <algorithm>
#include <limits>

namespace clearway::metrics::detail {
namespace {

constexpr std::uint32_t gone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void LinkComparison::match(const truth::Snapshot& snapshot, const traffic::BelievedGraph& belief,
                           float fresh_age_s) {
    row_of_believed_.assign(belief.vehicles.size(), gone);
    believed_is_dark_.assign(belief.vehicles.size(), 1);
    row_is_dark_.assign(snapshot.size(), 1);
    std::uint32_t row = 0;  // Both are ordered by key.
    for (std::uint32_t believed = 0; believed < belief.vehicles.size(); ++believed) {
        const traffic::BelievedVehicle& vehicle = belief.vehicles[believed];
        while (row < snapshot.size() && snapshot.key[row] < vehicle.key)
            ++row;
        if (vehicle.age_s <= fresh_age_s) believed_is_dark_[believed] = 0;
        if (row == snapshot.size() || snapshot.key[row] != vehicle.key) continue;
        row_of_believed_[believed] = row;
        row_is_dark_[row] = believed_is_dark_[believed];
    }
}

void LinkComparison::add(const truth::Snapshot& snapshot, const graph::ProximityGraph& true_graph,
                         const traffic::BelievedGraph& belief, float fresh_age_s) {
    match(snapshot, belief, fresh_age_s);
    LinkCounts now;
    LinkCounts now_dark;
    for (std::uint32_t left = 0; left < belief.vehicles.size(); ++left) {
        for (const traffic::BelievedLink& link : belief.links_of(left)) {
            if (link.neighbour <= left) continue;
            const std::uint32_t from = row_of_believed_[left];
            const std::uint32_t to = row_of_believed_[link.neighbour];
            const bool is_true =
                from != gone && to != gone && std::ranges::binary_search(true_graph.neighbours_of(from), to);
            const bool is_dark = (believed_is_dark_[left] | believed_is_dark_[link.neighbour]) != 0;
            ++(is_true ? now.true_positive : now.false_positive);
            if (is_dark) ++(is_true ? now_dark.true_positive : now_dark.false_positive);
        }
    }
    std::uint64_t dark_links = 0;
    for (std::uint32_t left = 0; left < true_graph.vehicle_count(); ++left) {
        for (const std::uint32_t right : true_graph.neighbours_of(left)) {
            if (right > left && (row_is_dark_[left] | row_is_dark_[right]) != 0) ++dark_links;
        }
    }
    now.false_negative = true_graph.link_count() - now.true_positive;
    now_dark.false_negative = dark_links - now_dark.true_positive;
    for (auto [total, part] : {std::pair(&all, &now), std::pair(&dark, &now_dark)}) {
        total->true_positive += part->true_positive;
        total->false_positive += part->false_positive;
        total->false_negative += part->false_negative;
    }
}

}  // namespace clearway::metrics::detail
