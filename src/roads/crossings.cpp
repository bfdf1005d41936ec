#include "roads/crossings.hpp"

#include <algorithm>
#include <cassert>
#include <map>
#include <set>

namespace clearway::roads {
namespace {

/// Where pedestrians walk inside junctions: crossings and the walking areas at their ends.
class FootWays {
  public:
    explicit FootWays(const Network& network) : network_(network) {
        for_each_connection([&](const Connection& way) {
            if (is_crossing(way.from)) areas_.insert(way.to);
            if (is_crossing(way.to)) areas_.insert(way.from);
        });
        for_each_connection([&](const Connection& way) {
            if (areas_.contains(way.from)) beyond_[way.from].push_back({way.to, LaneEnd::first});
            if (areas_.contains(way.to)) beyond_[way.to].push_back({way.from, LaneEnd::last});
            const core::LaneIndex crossing = is_crossing(way.to) ? way.to : way.from;
            if (!is_crossing(crossing)) return;
            ends_[crossing].insert(is_crossing(way.to) ? way.from : way.to);
            if (way.signal.exists()) signalled_.insert(crossing);
        });
    }

    std::vector<Crossing> list() const {
        std::vector<Crossing> result;
        for (const auto& [lane, ends] : ends_) {
            if (ends.size() != 2) continue;
            Crossing crossing{network_.lane(lane).edge, signalled_.contains(lane),
                              sidewalks(*ends.begin(), lane), sidewalks(*ends.rbegin(), lane)};
            std::erase_if(crossing.other_side, [&](const SidewalkEnd& there) {
                return std::ranges::find(crossing.one_side, there.lane, &SidewalkEnd::lane) !=
                       crossing.one_side.end();
            });
            if (!crossing.one_side.empty() && !crossing.other_side.empty())
                result.push_back(std::move(crossing));
        }
        return result;
    }

  private:
    template <class Visit>
    void for_each_connection(Visit&& visit) const {
        for (std::uint32_t row = 0; row < network_.lanes().size(); ++row)
            for (const Connection& way : network_.connections_from(core::LaneIndex{row}))
                visit(way);
    }
    bool is_crossing(core::LaneIndex lane) const { return network_.edge(network_.lane(lane).edge).crossing; }
    bool is_inside(core::LaneIndex lane) const { return network_.edge(network_.lane(lane).edge).internal; }

    /// Sidewalks at a walking area, or else those that crossings other than `crossing` lead to.
    std::vector<SidewalkEnd> sidewalks(core::LaneIndex area, core::LaneIndex crossing) const {
        assert(is_crossing(crossing));
        std::set<core::LaneIndex> seen = {crossing, area};
        std::vector<core::LaneIndex> front = {area};
        while (!front.empty()) {
            std::vector<SidewalkEnd> found;
            std::vector<core::LaneIndex> next;
            for (const core::LaneIndex at : front) {
                const auto ways = beyond_.find(at);
                if (ways == beyond_.end()) continue;
                for (const SidewalkEnd& way : ways->second) {
                    if (!is_inside(way.lane)) found.push_back(way);
                    if (!is_crossing(way.lane) || !seen.insert(way.lane).second) continue;
                    for (const core::LaneIndex end : ends_.at(way.lane))
                        if (seen.insert(end).second) next.push_back(end);
                }
            }
            if (!found.empty()) return found;
            front = std::move(next);
        }
        return {};
    }

    const Network& network_;
    std::set<core::LaneIndex> areas_;
    std::set<core::LaneIndex> signalled_;
    std::map<core::LaneIndex, std::vector<SidewalkEnd>> beyond_;  ///< By walking area.
    std::map<core::LaneIndex, std::set<core::LaneIndex>> ends_;   ///< Walking areas by crossing.
};

}  // namespace

std::vector<Crossing> crossings(const Network& network) {
    return FootWays(network).list();
}

}  // namespace clearway::roads
