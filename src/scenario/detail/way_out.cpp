#include "scenario/detail/way_out.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "roads/exits.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario::detail {
namespace {

/// The rows of those that close every one of the edges at some moment of an interval; none if one is open.
std::set<std::size_t> closing(const roads::Network& network, const std::vector<PlacedIncident>& incidents,
                              const std::vector<core::EdgeIndex>& edges, double first_s, double last_s) {
    constexpr double instant_s = 0.01;     // an EV that comes at the very moment counts as well
    std::vector<double> moments{first_s};  // more is closed only from when an incident begins
    for (const PlacedIncident& placed : incidents)
        if (placed.closed.from.value > first_s && placed.closed.from.value < last_s + instant_s)
            moments.push_back(placed.closed.from.value);
    for (const double at_s : moments) {
        std::set<std::size_t> rows;
        if (std::ranges::all_of(edges, [&](auto edge) {
                const auto of_edge = closing_rows(network, incidents, edge, at_s);
                rows.insert(of_edge.begin(), of_edge.end());
                return !of_edge.empty();
            }))
            return rows;
    }
    return {};
}

std::string closing_words(const roads::Network& network, const std::vector<core::EdgeIndex>& edges,
                          const std::set<std::size_t>& rows) {
    const auto quoted = [&](core::EdgeIndex edge) { return fmt::format("\"{}\"", network.edge(edge).id); };
    std::vector<std::string> others;
    for (const std::size_t row : rows)
        if (row != *rows.begin()) others.push_back(fmt::format("incident[{}]", row));
    return fmt::format("closes {}{}{}, the only way out of", edges.size() == 1 ? "edge " : "edges ",
                       core::listed(core::texts_of(edges, quoted)),
                       others.empty() ? "" : ", with " + core::listed(others));
}

}  // namespace

void check_way_out(const ScenarioConfig& config, const roads::Network& network,
                   const std::vector<PlacedIncident>& incidents, const Leaving& leaving,
                   std::vector<core::Problem>& problems) {
    std::vector<core::EdgeIndex> passed;
    std::vector<core::EdgeIndex> edges{leaving.edge};
    double elapsed_s = 0.0;
    while (!edges.empty()) {
        if (leaving.end && core::contains(edges, *leaving.end)) return;
        if (core::contains(passed, edges.front())) return;
        const std::set<std::size_t> rows =
            closing(network, incidents, edges, leaving.first_s + elapsed_s, leaving.last_s + elapsed_s);
        if (!rows.empty()) {
            problems.push_back({config.where(fmt::format("incident[{}]", *rows.begin())),
                                fmt::format("{} {} at \"{}\"", closing_words(network, edges, rows),
                                            leaving.key, network.edge(leaving.edge).id),
                                "an edge with a way round it, or times when no EV starts there",
                                "close another edge, leave a lane open, or set emergency_passes = 1"});
            return;
        }
        if (edges.size() > 1) return;
        passed.push_back(edges.front());
        const roads::Lane& lane = network.lane(network.lane_of(edges.front(), 0));
        elapsed_s += lane.length_m / lane.speed_limit_mps;
        edges = roads::exits(network, edges.front(), roads::Driver::emergency);
    }
}

}  // namespace clearway::scenario::detail
