#include "campaign/detail/way_findings.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/counted.hpp"
#include "core/error.hpp"
#include "roads/closure.hpp"
#include "roads/geography.hpp"
#include "roads/lane_grid.hpp"
#include "roads/route_search.hpp"
#include "scenario/fleet.hpp"
#include "scenario/site.hpp"

namespace clearway::campaign::detail {
namespace {

/// The ends of a trip, and who drives it.
struct Trip {
    std::string id;
    core::EdgeIndex from, to;
    std::vector<core::EdgeIndex> way = {};  ///< As planned, with both ends.
    double depart_s = 0.0;
    double latest_s = 0.0;  ///< When it has arrived at the latest.

    bool is_on_road(const traffic::Incident& incident) const {
        return depart_s < incident.to.value && incident.from.value < latest_s;
    }
    /// Whether it is called to a road that is closed then.
    bool queues_at(const roads::Network& network, const traffic::Incident& incident) const {
        return id.starts_with(scenario::called_prefix) && incident.edge == to && is_on_road(incident) &&
               roads::closes_to_emergency(network, incident);
    }
};

/// Assumed, and generous: jams make a trip four times as long, and it waits for a cycle of signals besides.
double latest_s(const roads::RouteSearch& search, const std::vector<core::EdgeIndex>& way) {
    constexpr double longer = 4.0;
    constexpr double cycle_s = 120.0;
    const auto free_s = [&](core::EdgeIndex edge, double) { return search.free_s(edge); };
    return longer * search.time_of(way, search.free_s(way.front()), free_s) + cycle_s;
}

std::vector<Trip> trips_of(const roads::Network& network, const std::vector<EmergencyTrip>& planned) {
    const roads::RouteSearch search(network, roads::Driver::emergency);
    std::vector<Trip> trips;
    for (const EmergencyTrip& trip : planned) {
        std::vector<core::EdgeIndex> way;
        for (const std::string& id : trip.edges)
            if (const auto edge = network.find_edge(id)) way.push_back(*edge);
        if (!way.empty())
            trips.push_back({trip.id, way.front(), way.back(), way, trip.depart_s,
                             trip.depart_s + latest_s(search, way)});
    }
    return trips;
}

Finding choice_finding(roads::RouteSearch& search, const std::vector<Trip>& trips) {
    constexpr double within = 1.2;
    constexpr std::size_t most_ways = 8;
    const auto free_s = [&](core::EdgeIndex edge, double) { return search.free_s(edge); };
    std::size_t choosing = 0;
    for (const Trip& trip : trips) {
        const auto ways = search.ways({trip.from, trip.to}, free_s, most_ways);
        if (ways.empty()) continue;
        const double best_s = search.time_of(ways.front(), 0.0, free_s);
        choosing += std::ranges::any_of(ways.begin() + 1, ways.end(), [&](const auto& way) {
            return search.time_of(way, 0.0, free_s) <= within * best_s;
        });
    }
    return {"ways", choosing > 0 ? Grade::ok : Grade::note,
            fmt::format("{} of {} can choose: two ways or more within 20 % of the fastest at free flow",
                        choosing, core::counted(trips.size(), "EV"))};
}

std::string place_words(const roads::Network& network, const traffic::Incident& incident) {
    const roads::Edge& edge = network.edge(incident.edge);
    return road_words(edge, incident.lanes.size() < edge.lane_count
                                ? fmt::format(", lane {}", fmt::join(incident.lanes, ", "))
                                : ", all lanes");
}

Finding incident_finding(roads::RouteSearch& search, const std::vector<Trip>& trips,
                         const std::vector<scenario::PlacedIncident>& incidents,
                         const roads::Network& network) {
    std::vector<std::string> cut_off;
    std::vector<core::EdgeIndex> way;
    for (const Trip& trip : trips) {
        std::vector<core::EdgeIndex> closed;
        for (const scenario::PlacedIncident& incident : incidents)
            if (trip.is_on_road(incident.closed) && roads::closes_to_emergency(network, incident.closed))
                closed.push_back(incident.closed.edge);
        const bool is_called = trip.id.starts_with(scenario::called_prefix);  // it stops before
        const auto open_s = [&](core::EdgeIndex edge, double) {
            const bool is_closed = core::contains(closed, edge);
            return is_closed && !(is_called && edge == trip.to) ? roads::no_way_s : search.free_s(edge);
        };
        if (search.search({trip.from, trip.to}, open_s, way) == roads::no_way_s) cut_off.push_back(trip.id);
    }
    const std::vector<std::string> places =
        core::texts_of(incidents, [&](const auto& one) { return place_words(network, one.closed); });
    const std::string count =
        fmt::format("{} on {}", core::counted(incidents.size(), "incident"), core::listed(places));
    if (cut_off.empty())
        return {
            "incidents", Grade::ok,
            fmt::format("{}, with a way round for all {}", count, core::counted(trips.size(), "EV trip"))};
    constexpr std::size_t most_named = 6;
    std::string named =
        core::listed({cut_off.begin(),
                      cut_off.begin() + static_cast<std::ptrdiff_t>(std::min(most_named, cut_off.size()))});
    if (cut_off.size() > most_named) named += fmt::format(" and {} more", cut_off.size() - most_named);
    return {"incidents", Grade::falls_short, fmt::format("{}: no way round then for {}", count, named),
            "another edge, other lanes, or emergency_passes = 1; else these EVs wait until it is over"};
}

/// Incidents that close a road only together: crews know each of them alone, with a lane left open. Nothing
/// where there are none.
std::optional<Finding> together_finding(const std::vector<scenario::PlacedIncident>& incidents,
                                        const roads::Network& network) {
    std::set<std::string> words;
    for (const scenario::PlacedIncident& one : incidents) {
        const auto rows = scenario::closing_rows(network, incidents, one.closed.edge, one.closed.from.value);
        const bool is_closed_alone = std::ranges::any_of(incidents, [&](const auto& each) {
            return rows.contains(each.row) && roads::closes_to_emergency(network, each.closed);
        });
        if (!rows.empty() && !is_closed_alone)
            words.insert(fmt::format("incidents {} close {} together", fmt::join(rows, " and "),
                                     road_words(network.edge(one.closed.edge))));
    }
    if (words.empty()) return std::nullopt;
    return Finding{"closed", Grade::note,
                   fmt::format("{}; each alone leaves a lane open, so EVs do not turn away: they wait there",
                               fmt::join(words, "; ")),
                   "one incident with the lanes of both, for EVs to take another way"};
}

/// Of those who are called to an edge, none passes it.
bool passes(const Trip& trip, const traffic::Incident& incident) {
    const bool is_called = trip.id.starts_with(scenario::called_prefix);
    return trip.is_on_road(incident) && core::contains(trip.way, incident.edge) &&
           !(is_called && incident.edge == trip.to);
}

/// As queueing_trips.
std::map<std::string, std::string> queueing(const std::vector<Trip>& trips,
                                            const std::vector<scenario::PlacedIncident>& incidents,
                                            const roads::Network& network) {
    std::map<std::string, std::string> found;
    for (const Trip& trip : trips)
        for (const auto& [incident, share, row] : incidents)
            if (trip.queues_at(network, incident))
                found.emplace(trip.id, fmt::format("{}, closed until {:g} s",
                                                   road_words(network.edge(trip.to)), incident.to.value));
    return found;
}

/// The edges in the middle third of a trip's length where a queue has room before a block in their middle.
std::vector<core::EdgeIndex> middle_of(const Trip& trip, const roads::Network& network) {
    constexpr float least_length_m = 30.0F;  // docs/guides/accident.md: 15 m before the block
    float length_m = 0.0F;
    for (const core::EdgeIndex edge : trip.way)
        length_m += network.edge(edge).length_m;
    std::vector<core::EdgeIndex> middle;
    float driven_m = 0.0F;
    for (const core::EdgeIndex edge : trip.way) {
        const float edge_m = network.edge(edge).length_m;
        const float at_m = driven_m + edge_m / 2.0F;
        driven_m += edge_m;
        const bool is_inside = at_m >= length_m / 3.0F && at_m <= length_m * 2.0F / 3.0F;
        const bool is_end = edge == trip.from || edge == trip.to;
        if (is_inside && !is_end && edge_m >= least_length_m) middle.push_back(edge);
    }
    return middle;
}

/// Whether a trip has a way round an edge.
bool has_way_round(const Trip& trip, core::EdgeIndex closed, roads::RouteSearch& search) {
    const auto open_s = [&](core::EdgeIndex edge, double) {
        return edge == closed ? roads::no_way_s : search.free_s(edge);
    };
    std::vector<core::EdgeIndex> way;
    return search.search({trip.from, trip.to}, open_s, way) != roads::no_way_s;
}

/// Up to three roads, those first that most trips pass near their middles, with how many have a way round.
std::vector<std::string> often_passed(const std::vector<Trip>& trips, const roads::Network& network) {
    std::map<core::EdgeIndex, std::vector<const Trip*>> passing;
    for (const Trip& trip : trips)
        for (const core::EdgeIndex edge : middle_of(trip, network))
            passing[edge].push_back(&trip);
    std::vector<core::EdgeIndex> edges;
    for (const auto& [edge, those] : passing)
        edges.push_back(edge);
    std::ranges::stable_sort(edges, std::greater{}, [&](auto edge) { return passing.at(edge).size(); });
    constexpr std::size_t most_named = 3;
    roads::RouteSearch search(network, roads::Driver::emergency);
    std::vector<std::string> words;
    std::set<std::string> streets;
    for (const core::EdgeIndex index : edges) {
        const roads::Edge& edge = network.edge(index);
        if (words.size() == most_named) break;
        if (streets.contains(edge.name)) continue;
        const auto count = static_cast<std::size_t>(std::ranges::count_if(
            passing.at(index), [&](const Trip* trip) { return has_way_round(*trip, index, search); }));
        if (count == 0) continue;
        if (!edge.name.empty()) streets.insert(edge.name);
        words.push_back(fmt::format("{}, {}", road_words(edge), core::counted(count, "trip")));
    }
    return words;
}

/// How often the station that is nearest in a straight line is not the one that is there first at free flow;
/// whether any call has a choice.
Finding call_finding(roads::RouteSearch& search, const scenario::Calls& calls,
                     const roads::Network& network) {
    const auto free_s = [&](core::EdgeIndex edge, double) { return search.free_s(edge); };
    const scenario::Fleet fleet(calls.stations);
    std::size_t differing = 0, choosing = 0;
    for (const scenario::PlacedCall& call : calls.calls) {
        std::vector<scenario::Sending> found = fleet.candidates(call, search, free_s);
        choosing += found.size() > 1 ? 1 : 0;
        const scenario::Sending* const first = scenario::cheapest(found);
        const std::size_t by_time = first == nullptr ? fleet.stations().size() : first->station;
        for (scenario::Sending& each : found)
            each.cost = scenario::straight_m(network, fleet.stations()[each.station], call);
        const scenario::Sending* const nearest = scenario::cheapest(found);
        differing += nearest != nullptr && nearest->station != by_time ? 1 : 0;
    }
    const std::string count = fmt::format("{}, {}", core::counted(calls.calls.size(), "call"),
                                          core::counted(calls.stations.size(), "station"));
    if (choosing == 0)
        return {
            "calls", Grade::note, count + "; no call has two stations of its kind to choose from",
            "a second [[emergency_site]] with units, for dispatch and loop.units_tried to have an effect"};
    return {"calls", Grade::ok,
            fmt::format("{}; the nearest in a straight line is not the first at free flow for {} of them",
                        count, differing == 0 ? "none" : std::to_string(differing))};
}

/// From the coordinates of a site to its edge.
double distance_m(const scenario::EmergencySite& site, core::EdgeIndex edge, const roads::Network& network,
                  const roads::LaneGrid& lanes) {
    const auto geography = roads::Geography::of(network.location());
    std::vector<roads::LanePlace> places;
    lanes.near(geography.value().point({*site.longitude, *site.latitude}), scenario::SiteRoads::reach,
               places);
    std::erase_if(places, [&](const auto& each) {
        return network.lane(each.lane).edge != edge || !network.lane(each.lane).allows_cars;
    });
    return std::ranges::min(places, {}, &roads::LanePlace::distance_m).distance_m;
}

/// Where sites lie that are given by coordinates.
Finding site_finding(const scenario::ScenarioConfig& config, const roads::Network& network) {
    std::vector<core::Problem> problems;
    const std::vector<core::EdgeIndex> edges = scenario::site_edges(config, network, problems);
    if (!problems.empty()) throw core::InputError(std::move(problems));
    constexpr double far_m = 100.0;  // Assumed: the width of a large site and its yard.
    const roads::LaneGrid lanes(network);
    Grade grade = Grade::ok;
    std::vector<std::string> places;
    for (std::size_t row = 0; row < edges.size(); ++row) {
        const scenario::EmergencySite& site = config.emergency_sites[row];
        if (!site.longitude) continue;
        const double away_m = distance_m(site, edges[row], network, lanes);
        if (away_m > far_m) grade = Grade::note;
        places.push_back(fmt::format("{}{} on {}, {:.0f} m from the coordinates", core::name(site.kind),
                                     site.name.empty() ? "" : fmt::format(" \"{}\"", site.name),
                                     road_words(network.edge(edges[row])), away_m));
    }
    return {"sites", grade, fmt::format("by coordinates: {}", fmt::join(places, "; ")),
            grade == Grade::ok ? ""
                               : "one is more than 100 m from its road: check its coordinates, or give its "
                                 "edge"};
}

/// SUMO takes a vehicle past the jam in which it has stood for long.
Finding teleport_finding(const scenario::ScenarioConfig& config,
                         const std::vector<scenario::PlacedIncident>& incidents) {
    const double patience_s = config.time.time_to_teleport_s.value_or(300.0);
    const auto is_long = [&](const scenario::PlacedIncident& incident) {
        return patience_s >= 0.0 && (incident.closed.to - incident.closed.from).value > patience_s;
    };
    if (std::ranges::none_of(incidents, is_long)) return {"teleports", Grade::ok, "none past an incident"};
    return {"teleports", Grade::note,
            fmt::format("SUMO takes vehicles past an incident that have stood there for {:g} s", patience_s),
            "time.time_to_teleport_s = -1 in scenario.toml"};
}

}  // namespace

std::string road_words(const roads::Edge& edge, const std::string& more) {
    const std::string place = fmt::format("edge {}{}", edge.id, more);
    return edge.name.empty() ? place : fmt::format("{} ({})", edge.name, place);
}

std::vector<Finding> way_findings(const scenario::ScenarioConfig& config, const roads::Network& network,
                                  const std::vector<EmergencyTrip>& planned,
                                  const std::vector<EmergencyTrip>& of_more_seeds) {
    const std::vector<Trip> trips = trips_of(network, planned);
    roads::RouteSearch search(network, roads::Driver::emergency);
    std::vector<Finding> findings = {choice_finding(search, trips)};
    const auto is_by_coordinates = [](const scenario::EmergencySite& site) {
        return site.longitude.has_value();
    };
    if (std::ranges::any_of(config.emergency_sites, is_by_coordinates))
        findings.push_back(site_finding(config, network));
    const std::vector<scenario::PlacedIncident> incidents = scenario::place_incidents(config, network);
    const scenario::Calls calls = scenario::place_calls(config, network, incidents);
    if (!calls.calls.empty()) findings.push_back(call_finding(search, calls, network));
    if (incidents.empty()) return findings;
    findings.push_back(incident_finding(
        search, of_more_seeds.empty() ? trips : trips_of(network, of_more_seeds), incidents, network));
    if (auto together = together_finding(incidents, network)) findings.push_back(*std::move(together));
    findings.push_back(teleport_finding(config, incidents));
    return findings;
}

Finding passing_finding(const scenario::ScenarioConfig& config, const roads::Network& network,
                        const std::vector<EmergencyTrip>& planned, std::size_t replications) {
    constexpr double few = 0.1;  // Assumed: of ten trips, one tells little of a block.
    const std::vector<Trip> trips = trips_of(network, planned);
    const std::vector<scenario::PlacedIncident> incidents = scenario::place_incidents(config, network);
    const auto count = [&](const auto& is_met) {
        return static_cast<std::size_t>(std::ranges::count_if(trips, [&](const Trip& trip) {
            return std::ranges::any_of(
                incidents, [&](const auto& placed) { return std::invoke(is_met, trip, placed.closed); });
        }));
    };
    const std::size_t passing = count(passes);
    const std::string text =
        fmt::format("{} of {} of {} {} a blocked road", passing, core::counted(trips.size(), "EV trip"),
                    core::counted(replications, "seed"), trips.size() == 1 ? "passes" : "pass");
    std::set<std::string> places;
    const auto queued = queueing(trips, incidents, network);
    for (const auto& [id, place] : queued)
        places.insert(place);
    if (!queued.empty())
        return {
            "met", Grade::note,
            fmt::format("{}; {} of them {} called to {}: if a queue stands before it, they end there", text,
                        queued.size(), queued.size() == 1 ? "is" : "are", fmt::join(places, " and ")),
            queueing_cure};
    if (static_cast<double>(passing) >= few * static_cast<double>(trips.size()) && passing > 0)
        return {"met", Grade::ok, text};
    if (count(&Trip::is_on_road) == 0)
        return {"met", Grade::note, text, "other times: no EV is on the road while an incident lasts"};
    const std::vector<std::string> roads = often_passed(trips, network);
    return {"met", Grade::note, text,
            roads.empty()
                ? "no road in the middle of an EV trip has a way round"
                : fmt::format("most pass, near their middles, with a way round: {}", fmt::join(roads, "; "))};
}

std::map<std::string, std::string> queueing_trips(const scenario::ScenarioConfig& config,
                                                  const roads::Network& network,
                                                  const std::vector<EmergencyTrip>& planned) {
    return queueing(trips_of(network, planned), scenario::place_incidents(config, network), network);
}

}  // namespace clearway::campaign::detail
