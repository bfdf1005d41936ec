#include "scenario/incident.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/number.hpp"
#include "roads/closure.hpp"
#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "scenario/detail/checks.hpp"
#include "scenario/detail/road_place.hpp"
#include "scenario/detail/way_out.hpp"

namespace clearway::scenario {
namespace {

using Problems = std::vector<core::Problem>;

std::string place(const ScenarioConfig& config, std::size_t row, const std::string& key) {
    return detail::place_of_key(config, fmt::format("incident[{}]", row), key);
}

double end_s(const ScenarioConfig& config, const Incident& incident) {
    return incident.to_s.value_or(config.time.horizon_s);
}

/// The lane numbers of the text; words that are none become problems.
std::vector<std::uint32_t> numbers_in(const std::string& text, const std::string& where, Problems& problems) {
    std::vector<std::uint32_t> numbers;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        constexpr std::size_t most_digits = 4;
        if (word.size() <= most_digits && word.find_first_not_of("0123456789") == std::string::npos) {
            numbers.push_back(static_cast<std::uint32_t>(std::stoul(word)));
        } else {
            problems.push_back({where, fmt::format("\"{}\" is no number of a lane", word),
                                "whole numbers with blanks between, 0 for the outermost lane",
                                "leave lanes out to close all lanes for cars"});
        }
    }
    std::ranges::sort(numbers);
    if (const auto twice = std::ranges::adjacent_find(numbers); twice != numbers.end())
        problems.push_back({where, fmt::format("names lane {} twice", *twice), "each lane once",
                            "name another, or it once"});
    return numbers;
}

bool overlap(double from_s, double to_s, double other_from_s, double other_to_s) {
    return from_s < other_to_s && other_from_s < to_s;
}

/// Puts the incidents of a scenario on its network, and collects what is wrong with them.
class Placing {
  public:
    Placing(const ScenarioConfig& config, const roads::Network& network)
        : config_(config), network_(network) {}

    std::vector<PlacedIncident> all() {
        for (row_ = 0; row_ < config_.incidents.size(); ++row_)
            put(config_.incidents[row_]);
        for (std::size_t later = 1; later < placed_.size(); ++later) {
            for (std::size_t earlier = 0; earlier < later; ++earlier)
                check_overlap(earlier, later);
        }
        check_starts();
        if (!problems_.empty()) throw core::InputError(std::move(problems_));
        return placed_;
    }

  private:
    void report(const std::string& key, std::string what, std::string allowed, std::string cure) {
        problems_.push_back(
            {place(config_, row_, key), std::move(what), std::move(allowed), std::move(cure)});
    }

    void put(const Incident& incident) {
        const std::optional<detail::RoadPlace> where =
            incident.edge.empty()
                ? detail::at_coordinates(network_, {*incident.longitude, *incident.latitude},
                                         place(config_, row_, "longitude"), problems_)
                : detail::on_edge(network_, incident.edge, place(config_, row_, "edge"), problems_);
        if (!where) return;
        detail::RoadPlace at = *where;
        if (incident.position_m)
            detail::move_to(network_, *incident.position_m, place(config_, row_, "position_m"), at,
                            problems_);
        if (incident.speed_past_kmh > 0.0 && incident.speed_past_kmh < 1.0)
            report("speed_past_kmh", fmt::format("{} km/h is a standstill", incident.speed_past_kmh),
                   "0 for no limit, or 1 to 400 km/h", "close the lane instead: lanes");
        traffic::Incident placed{
            .edge = at.edge,
            .lanes = lanes(incident, at.edge),
            .position_m = at.position_m,
            .from = core::Seconds(incident.from_s),
            .to = core::Seconds(end_s(config_, incident)),
            .known_after = {},
            .speed_past_mps = static_cast<float>(core::from_kmh(incident.speed_past_kmh).value),
            .emergency_passes = incident.emergency_passes == 1};
        if (incident.known_after_s) placed.known_after = core::Seconds(*incident.known_after_s);
        if (placed.lanes.empty()) return;
        if (incident.speed_past_kmh >= 1.0 && roads::closes_to_emergency(network_, placed))
            report("speed_past_kmh", fmt::format("{} km/h, but no lane stays open", incident.speed_past_kmh),
                   "with lanes that leave one open, or emergency_passes = 1", "leave it out, or set lanes");
        placed_.push_back({std::move(placed), incident.reroute_share, row_});
    }

    /// The lanes that an incident closes; empty after adding a problem.
    std::vector<std::uint32_t> lanes(const Incident& incident, core::EdgeIndex index) {
        const roads::Edge& edge = network_.edge(index);
        const auto lane = [&](std::uint32_t number) -> const roads::Lane& {
            return network_.lane(network_.lane_of(index, number));
        };
        std::vector<std::uint32_t> cars;
        bool any_emergency = false;
        for (std::uint32_t number = 0; number < edge.lane_count; ++number) {
            any_emergency |= lane(number).allows_emergency;
            if (lane(number).allows_cars) cars.push_back(number);
        }
        if (!any_emergency) {
            report("edge", fmt::format("no emergency vehicle may use edge \"{}\"", edge.id),
                   "an edge with a lane open to class emergency", "");
            return {};
        }
        if (incident.lanes.empty() && cars.empty())
            report("lanes", fmt::format("no lane of edge \"{}\" is open to cars", edge.id),
                   fmt::format("0 to {}", edge.lane_count - 1), "name the lanes");
        if (incident.lanes.empty()) return cars;
        Problems none;  // `check` has reported them
        std::vector<std::uint32_t> numbers = numbers_in(incident.lanes, "", none);
        for (const std::uint32_t number : numbers) {
            if (number >= edge.lane_count) {
                report("lanes", fmt::format("edge \"{}\" has no lane {}", edge.id, number),
                       fmt::format("0 to {}", edge.lane_count - 1), "");
                return {};
            }
            if (!lane(number).allows_cars && !lane(number).allows_emergency) {
                report("lanes",
                       fmt::format("neither cars nor EVs may use lane {} of edge \"{}\"", number, edge.id),
                       fmt::format("{}", fmt::join(cars, ", ")), "");
                return {};
            }
        }
        return numbers;
    }

    void check_overlap(std::size_t earlier, std::size_t later) {
        const traffic::Incident& one = placed_[earlier].closed;
        const traffic::Incident& other = placed_[later].closed;
        if (one.edge != other.edge ||
            !overlap(one.from.value, one.to.value, other.from.value, other.to.value))
            return;
        const auto shared = std::ranges::find_first_of(one.lanes, other.lanes);
        if (shared == one.lanes.end()) return;
        problems_.push_back({config_.where(fmt::format("incident[{}]", placed_[later].row)),
                             fmt::format("blocks lane {} of edge \"{}\" while incident[{}] does, too",
                                         *shared, network_.edge(one.edge).id, placed_[earlier].row),
                             "one incident on a lane at a time", "change lanes, from_s or to_s"});
    }

    /// Where emergency vehicles start, and when.
    void check_starts() {
        const Times& time = config_.time;
        const double first_s = time.warm_up_s - time.latest_s(0.0);  // incidents may come later, vehicles not
        const auto has_station = std::ranges::any_of(config_.emergency_sites, [](const EmergencySite& site) {
            return site.kind != SiteKind::hospital;
        });
        if (config_.demand.emergency > 0) {
            Problems of_sites;  // reported with the demand
            const std::vector<core::EdgeIndex> sites = site_edges(config_, network_, of_sites);
            for (std::size_t row = 0; row < sites.size(); ++row) {
                if (has_station && config_.emergency_sites[row].kind == SiteKind::hospital) continue;
                check_start(fmt::format("emergency_site[{}]", row), sites[row], first_s, time.window_s);
            }
            std::set<std::string> told;  // several flows may begin on an edge
            for (std::size_t row = 0; row < config_.flows.size(); ++row)
                if (told.insert(config_.flows[row].from).second)
                    check_start(fmt::format("flow[{}]", row), edge_of(config_.flows[row].from), first_s,
                                time.window_s);
        }
        for (std::size_t row = 0; row < config_.emergency_trips.size(); ++row) {
            const EmergencyTrip& trip = config_.emergency_trips[row];
            const std::string from =
                trip.edges.empty() ? trip.from : trip.edges.substr(0, trip.edges.find(' '));
            check_start(fmt::format("emergency_trip[{}]", row), edge_of(from), trip.depart_s, trip.depart_s);
        }
    }

    core::EdgeIndex edge_of(const std::string& id) const {
        return network_.find_edge(id).value_or(core::EdgeIndex::none());
    }

    void check_start(const std::string& key, core::EdgeIndex start, double first_s, double last_s) {
        if (!start.exists()) return;  // reported with the demand
        detail::check_way_out(config_, network_, placed_, {key, start, first_s, last_s}, problems_);
    }

    const ScenarioConfig& config_;
    const roads::Network& network_;
    std::vector<PlacedIncident> placed_;
    std::size_t row_ = 0;
    Problems problems_;
};

/// What needs no network.
void check_one(const ScenarioConfig& config, std::size_t row, Problems& problems) {
    const Incident& incident = config.incidents[row];
    const std::string key = fmt::format("incident[{}]", row);
    // A row of --incident that was refused, which is told.
    if (std::isnan(incident.from_s) && !config.origins.contains(key + ".from_s")) return;
    detail::check_edge_or_coordinates(incident, config, key, problems);
    const double to_s = end_s(config, incident);
    const Times& time = config.time;
    if (time.latest_s(incident.from_s) >= time.horizon_s)
        problems.push_back({place(config, row, "from_s"),
                            fmt::format("{} is not before the end of the run", incident.from_s),
                            fmt::format("below {} (time.horizon_s{})", time.horizon_s - time.latest_s(0.0),
                                        time.events_spread_s ? " less time.events_spread_s" : ""),
                            ""});
    else if (incident.from_s >= to_s)
        problems.push_back({place(config, row, "to_s"),
                            fmt::format("{} is not after from_s, {}", to_s, incident.from_s),
                            fmt::format("above {}", incident.from_s), "exchange the two, or leave to_s out"});
    else if (const double lasts_s = to_s - incident.from_s; incident.known_after_s >= lasts_s)
        problems.push_back({place(config, row, "known_after_s"),
                            fmt::format("{} is not before it is over", *incident.known_after_s),
                            fmt::format("below {} (to_s less from_s)", lasts_s),
                            "lower it, raise to_s, or leave it out"});
    numbers_in(incident.lanes, place(config, row, "lanes"), problems);
}

}  // namespace

void detail::check_incidents(const ScenarioConfig& config, Problems& problems) {
    for (std::size_t row = 0; row < config.incidents.size(); ++row)
        check_one(config, row, problems);
}

std::set<std::size_t> closing_rows(const roads::Network& network,
                                   const std::vector<PlacedIncident>& incidents, core::EdgeIndex edge,
                                   double at_s) {
    traffic::Incident together;
    together.edge = edge;
    std::set<std::size_t> rows;
    for (const auto& [one, share, row] : incidents) {
        if (one.edge != edge || one.emergency_passes || one.from.value > at_s || one.to.value <= at_s)
            continue;
        together.lanes.insert(together.lanes.end(), one.lanes.begin(), one.lanes.end());
        rows.insert(row);
    }
    std::ranges::sort(together.lanes);
    if (!roads::closes_to_emergency(network, together)) rows.clear();
    return rows;
}

std::vector<PlacedIncident> place_incidents(const ScenarioConfig& config, const roads::Network& network) {
    return Placing(config, network).all();
}

}  // namespace clearway::scenario
