#include <algorithm>
#include <cassert>
#include <limits>
#include <vector>

#include "roads/network.hpp"
#include "roads/reach.hpp"

namespace clearway::roads {
namespace {

constexpr std::uint32_t unseen = std::numeric_limits<std::uint32_t>::max();

/// Tarjan's strongly connected components (1972) without recursion, because real networks would overflow the
/// stack.
class ComponentSearch {
  public:
    explicit ComponentSearch(const Network& network)
        : network_(network), number_(network.edges().size(), unseen), low_(network.edges().size(), unseen) {}

    std::vector<core::EdgeIndex> largest() {
        for (const core::EdgeIndex edge : car_edges(network_)) {
            if (number_[edge.value] == unseen) search_from(edge);
            assert(open_.empty() && visits_.empty());
        }
        std::ranges::sort(best_);
        return std::move(best_);
    }

  private:
    struct Visit {
        core::EdgeIndex edge;
        std::size_t next_successor = 0;
    };

    void enter(core::EdgeIndex edge) {
        number_[edge.value] = low_[edge.value] = count_++;
        visits_.push_back({edge});
        open_.push_back(edge);
    }

    void search_from(core::EdgeIndex root) {
        enter(root);
        while (!visits_.empty()) {
            Visit& visit = visits_.back();
            const auto successors = network_.successors(visit.edge);
            if (visit.next_successor == successors.size()) {
                leave();
                continue;
            }
            const core::EdgeIndex next = successors[visit.next_successor++];
            if (number_[next.value] == unseen) {
                enter(next);
            } else if (number_[next.value] != closed) {
                low_[visit.edge.value] = std::min(low_[visit.edge.value], number_[next.value]);
            }
        }
    }

    void leave() {
        const core::EdgeIndex edge = visits_.back().edge;
        assert(low_[edge.value] <= number_[edge.value]);
        visits_.pop_back();
        if (!visits_.empty()) {
            std::uint32_t& parent_low = low_[visits_.back().edge.value];
            parent_low = std::min(parent_low, low_[edge.value]);
        }
        if (low_[edge.value] == number_[edge.value]) close_component(edge);
    }

    void close_component(core::EdgeIndex root) {
        assert(std::ranges::find(open_, root) != open_.end());
        const auto first = std::find(open_.rbegin(), open_.rend(), root).base() - 1;
        for (auto member = first; member != open_.end(); ++member) {
            number_[member->value] = closed;
        }
        // Of components of equal size, take the one with the smallest edge: the result must not depend on the
        // order.
        const auto size = static_cast<std::size_t>(open_.end() - first);
        const auto smallest = *std::min_element(first, open_.end());
        if (size > best_.size() || (size == best_.size() && smallest < *std::ranges::min_element(best_))) {
            best_.assign(first, open_.end());
        }
        open_.erase(first, open_.end());
    }

    static constexpr std::uint32_t closed = unseen - 1;
    const Network& network_;
    std::vector<std::uint32_t> number_;
    std::vector<std::uint32_t> low_;
    std::vector<Visit> visits_;
    std::vector<core::EdgeIndex> open_;
    std::vector<core::EdgeIndex> best_;
    std::uint32_t count_ = 0;
};

}  // namespace

std::vector<core::EdgeIndex> largest_car_component(const Network& network) {
    return ComponentSearch(network).largest();
}

}  // namespace clearway::roads
