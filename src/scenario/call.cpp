#include "scenario/call.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/error.hpp"
#include "core/number.hpp"
#include "core/random.hpp"
#include "core/spellings.hpp"
#include "roads/closure.hpp"
#include "roads/route_search.hpp"
#include "scenario/config.hpp"
#include "scenario/detail/checks.hpp"
#include "scenario/detail/demand.hpp"
#include "scenario/detail/road_place.hpp"
#include "scenario/detail/way_out.hpp"

namespace clearway::scenario {
namespace {

using Problems = std::vector<core::Problem>;
using traffic::VehicleKind;

/// Vehicles that are called to an incident stop this far before it, m.
constexpr float gap_before_incident_m = 10.0F;
/// A trip ends at least this far into its edge, m: the longest vehicle fits.
constexpr float least_position_m = 15.0F;

std::string row_of(std::size_t row) {
    return fmt::format("call[{}]", row);
}

VehicleKind kind_at(SiteKind site) {
    return site == SiteKind::fire_station ? VehicleKind::fire_engine : VehicleKind::ambulance;
}

bool is_known(const std::string& kind) {
    return kind == core::name(VehicleKind::ambulance) || kind == core::name(VehicleKind::fire_engine);
}

/// Whether the row names an incident, be it one that cannot be.
bool names_incident(const ScenarioConfig& config, std::size_t row) {
    return config.origins.contains(row_of(row) + ".incident");
}

/// That a call names; null without one that exists.
const Incident* incident_of(const ScenarioConfig& config, const Call& call) {
    if (!call.incident || static_cast<std::size_t>(*call.incident) >= config.incidents.size()) return nullptr;
    return &config.incidents[static_cast<std::size_t>(*call.incident)];
}

/// When the call comes in; nothing if neither the call nor its incident tells.
std::optional<double> comes_in_s(const ScenarioConfig& config, const Call& call) {
    if (call.at_s) return call.at_s;
    const Incident* const incident = incident_of(config, call);
    if (incident == nullptr || !incident->known_after_s) return std::nullopt;
    return incident->from_s + *incident->known_after_s;
}

void check_place(const ScenarioConfig& config, std::size_t row, Problems& problems) {
    const Call& call = config.calls[row];
    const std::string key = row_of(row);
    const bool any = call.longitude || call.latitude;
    const bool both = call.longitude && call.latitude;
    const int places = (call.edge.empty() ? 0 : 1) + (any ? 1 : 0) + (names_incident(config, row) ? 1 : 0);
    if (places != 1 || any != both)
        problems.push_back({detail::place_of_row(config, key, places > 0),
                            places == 0  ? "has no place"
                            : places > 1 ? "has more than one place"
                                         : "has but one of longitude and latitude",
                            "edge, or longitude and latitude, or incident", "give one of the three"});
    if (call.incident && incident_of(config, call) == nullptr)
        problems.push_back(
            {detail::place_of_key(config, key, "incident"),
             fmt::format("there is no incident {}", *call.incident),
             config.incidents.empty() ? "a scenario with [[incident]]"
                                      : fmt::format("0 to {}", config.incidents.size() - 1),
             config.incidents.empty() && config.origins.contains("incident")
                 ? "the override incident removes those of the file: give one there, or leave it out"
                 : "count from 0, or give edge instead"});
    if (call.incident && call.position_m)
        problems.push_back({detail::place_of_key(config, key, "position_m"),
                            "is given for a call to an incident", "the place before the incident",
                            "leave it out, or give edge instead of incident"});
}

void check_moment(const ScenarioConfig& config, std::size_t row, Problems& problems) {
    const Call& call = config.calls[row];
    const auto at_s = comes_in_s(config, call);
    const std::string where = detail::place_of_key(config, row_of(row), "at_s");
    const Times& time = config.time;
    if (!at_s) {
        if (names_incident(config, row) && incident_of(config, call) == nullptr)
            return;  // the fault that is told
        problems.push_back({where, "is not given", "when the call comes in, s",
                            call.incident ? "set it, or known_after_s of the incident" : "set it"});
    } else if (const Incident* const incident = incident_of(config, call);
               incident != nullptr && call.at_s && incident->to_s && *incident->to_s <= *at_s &&
               *incident->to_s > incident->from_s) {
        problems.push_back({where,
                            fmt::format("{} is not before incident[{}] is over", *at_s, *call.incident),
                            fmt::format("below {} (its to_s)", *incident->to_s),
                            "call earlier, or give edge instead of incident"});
    } else if (*at_s < time.warm_up_s ||
               time.latest_s(*at_s) + call.spread_s + call.turnout_s >= time.horizon_s) {
        std::string spread;
        if (time.events_spread_s) spread += fmt::format(", time.events_spread_s, {}", *time.events_spread_s);
        if (call.spread_s > 0.0) spread += fmt::format(", spread_s, {}", call.spread_s);
        if (!spread.empty()) spread += ",";
        problems.push_back(
            {where,
             *at_s < time.warm_up_s ? fmt::format("{} is before the warm-up ends", *at_s)
                                    : fmt::format("{}{} and turnout_s, {}, are not before the end of the run",
                                                  *at_s, spread, call.turnout_s),
             fmt::format("{} (time.warm_up_s) to below {} (time.horizon_s)", time.warm_up_s, time.horizon_s),
             "change it, or the times of the scenario"});
    }
}

void check_kind(const ScenarioConfig& config, std::size_t row, Problems& problems) {
    const std::string& kind = config.calls[row].kind;
    if (is_known(kind)) return;
    problems.push_back({detail::place_of_key(config, row_of(row), "kind"),
                        fmt::format("no site sends out \"{}\"", kind), "ambulance, fire_engine",
                        core::did_you_mean(kind, {"ambulance", "fire_engine"})});
}

/// Whether a site's units were given and could not be read, which is told.
bool has_unread_units(const ScenarioConfig& config) {
    for (std::size_t row = 0; row < config.emergency_sites.size(); ++row)
        if (!config.emergency_sites[row].units &&
            config.origins.contains(fmt::format("emergency_site[{}].units", row)))
            return true;
    return false;
}

/// Whether enough vehicles wait for all calls of a kind.
void check_fleet(const ScenarioConfig& config, Problems& problems) {
    if (has_unread_units(config)) return;
    for (const VehicleKind kind : {VehicleKind::ambulance, VehicleKind::fire_engine}) {
        int ready = 0, called = 0;
        std::optional<std::size_t> first;
        for (const EmergencySite& site : config.emergency_sites)
            if (kind_at(site.kind) == kind) ready += site.ready();
        for (std::size_t row = 0; row < config.calls.size(); ++row) {
            if (config.calls[row].kind != core::name(kind)) continue;
            called += config.calls[row].units;
            if (!first && called > ready) first = row;
        }
        if (!first) continue;
        const std::string name(core::name(kind));
        const std::string units = row_of(*first) + ".units";
        problems.push_back(
            {config.where(config.origins.contains(units) ? units : row_of(*first)),
             fmt::format("{} of kind {} {} called, and {} {} at all sites",
                         core::counted(static_cast<std::size_t>(called), "unit"), name,
                         called == 1 ? "is" : "are", ready, ready == 1 ? "waits" : "wait"),
             fmt::format("as many as wait at sites of kind {}",
                         kind == VehicleKind::ambulance ? "ambulance_station or hospital" : "fire_station"),
             "raise units of [[emergency_site]], add a site, or call fewer"});
    }
}

void sort_by_time(Calls& calls) {
    std::ranges::stable_sort(calls.calls, {}, [](const PlacedCall& call) { return call.at.value; });
}

/// Puts calls and stations on the network, and collects what is wrong with them.
class CallPlacing {
  public:
    CallPlacing(const ScenarioConfig& config, const roads::Network& network,
                const std::vector<PlacedIncident>& incidents)
        : config_(config),
          network_(network),
          incidents_(incidents),
          search_(network, roads::Driver::emergency) {}

    Calls all() {
        put_stations();
        for (row_ = 0; row_ < config_.calls.size(); ++row_)
            put(config_.calls[row_]);
        for (std::size_t station = 0; station < calls_.stations.size(); ++station)
            check_way_out(station);
        if (!problems_.empty()) throw core::InputError(std::move(problems_));
        sort_by_time(calls_);
        return std::move(calls_);
    }

  private:
    std::string where(const char* key) const { return detail::place_of_key(config_, row_of(row_), key); }

    void put_stations() {
        const std::vector<core::EdgeIndex> edges = site_edges(config_, network_, problems_);
        for (std::size_t row = 0; row < edges.size(); ++row) {
            const EmergencySite& site = config_.emergency_sites[row];
            if (site.ready() == 0 || !edges[row].exists()) continue;
            calls_.stations.push_back(
                {edges[row], kind_at(site.kind), static_cast<std::uint32_t>(site.ready())});
            sites_.push_back(row);
        }
    }

    std::optional<detail::RoadPlace> place_of(const Call& call) {
        if (call.incident) {
            const traffic::Incident& incident = incidents_[static_cast<std::size_t>(*call.incident)].closed;
            return detail::RoadPlace{incident.edge,
                                     std::max(1.0F, incident.position_m - gap_before_incident_m)};
        }
        auto place = call.edge.empty() ? detail::at_coordinates(network_, {*call.longitude, *call.latitude},
                                                                where("longitude"), problems_)
                                       : detail::on_edge(network_, call.edge, where("edge"), problems_);
        if (!place) return place;
        if (call.position_m)
            detail::move_to(network_, *call.position_m, where("position_m"), *place, problems_);
        place->position_m =
            std::max(place->position_m, std::min(least_position_m, network_.edge(place->edge).length_m));
        return place;
    }

    void put(const Call& call) {
        const auto place = place_of(call);
        if (!place || !is_open(place->edge)) return;
        PlacedCall placed{.id = fmt::format("{}{}", called_prefix, row_),
                          .edge = place->edge,
                          .position_m = place->position_m,
                          .at = core::Seconds(*comes_in_s(config_, call)),
                          .spread = core::Seconds(call.spread_s),
                          .turnout = core::Seconds(call.turnout_s),
                          .kind = *core::value_from<VehicleKind>(call.kind),
                          .units = static_cast<std::uint32_t>(call.units)};
        if (!check_incidents(placed, call) || !check_way(placed)) return;
        calls_.calls.push_back(std::move(placed));
    }

    bool is_open(core::EdgeIndex index) {
        const roads::Edge& edge = network_.edge(index);
        const auto lanes = network_.lanes().subspan(edge.first_lane, edge.lane_count);
        if (std::ranges::any_of(lanes, &roads::Lane::allows_emergency)) return true;
        problems_.push_back({where("edge"), fmt::format("no emergency vehicle may use edge \"{}\"", edge.id),
                             "an edge with a lane open to class emergency", "choose the road before it"});
        return false;
    }

    /// What lasts on the call's edge while vehicles come.
    bool check_incidents(PlacedCall& placed, const Call& call) {
        for (std::size_t row = 0; row < incidents_.size(); ++row) {
            const traffic::Incident& incident = incidents_[row].closed;
            if (incident.edge != placed.edge || incident.to.value <= placed.at.value ||
                !roads::closes_to_emergency(network_, incident))
                continue;
            placed.before_incident = true;
            if (incident.position_m > placed.position_m || call.incident) continue;
            problems_.push_back(
                {where("position_m"),
                 fmt::format("{:.0f} lies behind incident[{}] on edge \"{}\"", placed.position_m, row,
                             network_.edge(placed.edge).id),
                 fmt::format("below {:.0f} m, or after {} s", incident.position_m, incident.to.value),
                 fmt::format("give incident = {} instead of the edge: they stop before it", row)});
            return false;
        }
        return true;
    }

    bool check_way(const PlacedCall& placed) {
        const auto free_s = [&](core::EdgeIndex edge, double) { return search_.free_s(edge); };
        std::vector<core::EdgeIndex> way;
        bool any = false;
        for (const Station& station : calls_.stations) {
            if (station.kind != placed.kind) continue;
            any = true;
            if (search_.search({station.edge, placed.edge}, free_s, way) != roads::no_way_s) return true;
        }
        // Without a station the fleet is too small, which `check` has reported.
        if (any)
            problems_.push_back(
                {config_.where(row_of(row_)),
                 fmt::format("no station of its kind leads to edge \"{}\"", network_.edge(placed.edge).id),
                 "a place that an emergency vehicle can reach from one of them",
                 "choose another place, or add a site"});
        return any;
    }

    /// Whether an incident closes it when a call would send somebody.
    void check_way_out(std::size_t station) {
        const std::size_t found = problems_.size();
        for (const PlacedCall& call : calls_.calls) {
            const double leaves_s = call.at.value + call.turnout.value;
            if (call.kind == calls_.stations[station].kind)
                detail::check_way_out(
                    config_, network_, incidents_,
                    {fmt::format("emergency_site[{}]", sites_[station]), calls_.stations[station].edge,
                     leaves_s, leaves_s + call.spread.value, call.edge},
                    problems_);
            if (problems_.size() > found) return;
        }
    }

    const ScenarioConfig& config_;
    const roads::Network& network_;
    const std::vector<PlacedIncident>& incidents_;
    roads::RouteSearch search_;
    Calls calls_;
    std::vector<std::size_t> sites_;  ///< Of `calls_.stations` in the file.
    std::size_t row_ = 0;
    Problems problems_;
};

}  // namespace

void detail::check_calls(const ScenarioConfig& config, Problems& problems) {
    for (std::size_t row = 0; row < config.calls.size(); ++row) {
        check_place(config, row, problems);
        check_moment(config, row, problems);
        check_kind(config, row, problems);
    }
    check_fleet(config, problems);
}

Calls place_calls(const ScenarioConfig& config, const roads::Network& network,
                  const std::vector<PlacedIncident>& incidents) {
    if (config.calls.empty()) return {};
    return CallPlacing(config, network, incidents).all();
}

void draw_times(Calls& calls, core::Seconds delay, const core::KeyedRandom& random) {
    for (PlacedCall& call : calls.calls)
        call.at.value += delay.value + detail::drawn_delay(random, call.id, call.spread.value).value;
    sort_by_time(calls);
}

}  // namespace clearway::scenario
