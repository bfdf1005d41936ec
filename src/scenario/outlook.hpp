#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/ids.hpp"
#include "core/json.hpp"
#include "core/spellings.hpp"
#include "roads/network.hpp"

namespace clearway::scenario {

/// From one edge to the next.
struct Turn {
    core::EdgeIndex from, to;
    auto operator<=>(const Turn&) const = default;
};

/// The routes of a route file that `prepare` wrote.
struct PlannedRoutes {
    std::size_t vehicles = 0;
    std::size_t single = 0;  ///< Of them, on a single edge.
    std::map<Turn, double> turns;
};
PlannedRoutes planned_routes(const std::filesystem::path& file, const roads::Network& network);

/// What to expect of preemption.
enum class Prospect : std::uint8_t { helps, costs_others, little };
constexpr core::Spellings<Prospect, 3> spellings(Prospect) {
    return {
        {{Prospect::helps, "helps"}, {Prospect::costs_others, "costs_others"}, {Prospect::little, "little"}}};
}

/// What network, programs and planned trips say about preemption without a run: the most that open signals
/// can save where nobody queues, and what stands in the way.
struct Outlook {
    std::size_t signals = 0;        ///< Of the network.
    std::size_t trips = 0;          ///< Of emergency vehicles.
    std::size_t trips_passing = 0;  ///< Of them, those that pass a signal.
    double signals_a_trip = 0.0;
    double red_s = 0.0;   ///< Of a trip, mean: roads::LinkGreen::wait_s of each signal, added up.
    double trip_s = 0.0;  ///< Of a trip, mean: at the limits, and `red_s`.
    /// Signals on these ways, and of them: where others fill an approach (degree of saturation of at least
    /// `full_degree`), where full turns compete for green, on closed loops of short blocks, where the
    /// clearance of people on foot is slow.
    std::size_t passed = 0, full = 0, contested = 0, on_short_loops = 0, slow_walks = 0;
    double fullest_degree = 0.0;
    std::string fullest = {};  ///< Id of the signal with that degree, of a contested one if there are any.

    double red_share() const { return trip_s > 0.0 ? red_s / trip_s : 0.0; }
    Prospect prospect() const;
};
inline constexpr double full_degree = 0.9;

/// What a trip over these edges waits at red where nobody queues, s, by signal: of these `red_s` is the sum.
std::map<core::SignalIndex, double> red_waits_s(const roads::Network& network,
                                                const std::vector<std::string>& edges);

/// `ways`: the edges of each emergency vehicle's trip. The others' turns count as a flow over `window_s`.
Outlook outlook(const roads::Network& network, const std::vector<std::vector<std::string>>& ways,
                const PlannedRoutes& others, double window_s);

/// The prospect with its numbers, as one sentence. Ids are text from a file.
std::string outlook_sentence(const Outlook& outlook);

/// All of it, `prospect` and `sentence` too.
core::Json outlook_json(const Outlook& outlook);

}  // namespace clearway::scenario
