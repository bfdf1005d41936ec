#include "scenario/detail/demand.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <sstream>

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>

#include "core/error.hpp"
#include "core/xml_stream.hpp"
#include "roads/fastest_routes.hpp"
#include "roads/route_search.hpp"
#include "scenario/detail/driver_types.hpp"
#include "scenario/detail/trip_routes.hpp"
#include "scenario/fleet.hpp"
#include "scenario/vehicle_types.hpp"

namespace clearway::scenario::detail {

namespace {

using core::Purpose;
using traffic::VehicleClass;
using traffic::VehicleKind;

/// Numbers of the random draws for one vehicle; those of trip_routes.cpp follow. Never renumber them.
enum DemandDraw : std::uint64_t { depart = 0, flow = 1 };
/// 0 is the speed factor; 1 to 3 are those of driver_types.cpp.
constexpr std::uint64_t slow_draw = 4;
enum ClassDraw : std::uint64_t { automated = 0, kind = 1 };

double rounded(double value, double unit) {
    return std::round(value / unit) * unit;
}

/// A row drawn by weight with a uniform number in [0, 1).
std::size_t pick(std::span<const double> weights, double uniform) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    double left = uniform * sum;
    std::size_t last = 0;
    for (std::size_t row = 0; row < weights.size(); ++row) {
        if (weights[row] <= 0.0) continue;
        last = row;
        if (left < weights[row]) return row;
        left -= weights[row];
    }
    return last;
}

template <class Kinds>
VehicleKind pick_kind(const DemandContext& context, const std::string& id, const Kinds& kinds) {
    std::vector<double> weights;
    std::vector<VehicleKind> values;
    core::for_each_field<Kinds>([&](const auto& field) {
        weights.push_back(kinds.*field.member);
        values.push_back(*core::value_from<traffic::VehicleKind>(field.name));
    });
    const double uniform =
        context.random.uniform(Purpose::vehicle_class, core::vehicle_key(id).value, ClassDraw::kind);
    return values[pick(weights, uniform)];
}

double departure_s(const DemandContext& context, Purpose purpose, const std::string& id, double from_s,
                   double to_s) {
    const double uniform = context.random.uniform(purpose, core::vehicle_key(id).value, DemandDraw::depart);
    return rounded(from_s + uniform * (to_s - from_s), 0.01);
}

/// An edge outside junctions; nothing after adding a problem.
std::optional<core::EdgeIndex> edge_of(const DemandContext& context, const std::string& key,
                                       const std::string& id, std::vector<core::Problem>& problems) {
    const auto found = context.network.find_edge(id);
    if (found && !context.network.edge(*found).internal) return found;
    std::vector<std::string> known;
    for (const roads::Edge& row : context.network.edges())
        if (!row.internal) known.push_back(row.id);
    problems.push_back({context.config.where(key), fmt::format("the network has no edge \"{}\"", id),
                        "id of an edge outside junctions", core::did_you_mean(id, known)});
    return std::nullopt;
}

/// Routes between edges that a scenario names. The network is prepared for the search when the first is asked
/// for.
class NamedRoutes {
  public:
    explicit NamedRoutes(const DemandContext& context) : context_(context) {}

    /// The fastest route by car between two edges given by id; nothing after adding problems to `problems`.
    std::optional<RouteEdges> between(const std::string& key, const std::string& from, const std::string& to,
                                      std::vector<core::Problem>& problems) {
        const auto origin = edge_of(context_, key + ".from", from, problems);
        const auto destination = edge_of(context_, key + ".to", to, problems);
        if (!origin || !destination) return std::nullopt;
        if (!fastest_) fastest_.emplace(context_.network);
        auto route = fastest_->between(*origin, *destination);
        if (!route)
            problems.push_back({context_.config.where(key + ".to"),
                                fmt::format("no car can reach \"{}\" from \"{}\"", to, from),
                                "an edge downstream by lanes open to cars",
                                "choose other edges, or add connections"});
        return route;
    }

  private:
    const DemandContext& context_;
    std::optional<roads::FastestRoutes> fastest_;
};

/// Routes of the configured flows, by row.
class FlowRoutes {
  public:
    explicit FlowRoutes(const DemandContext& context) : context_(context) {
        NamedRoutes named(context);
        std::vector<core::Problem> problems;
        for (std::size_t row = 0; row < context.config.flows.size(); ++row) {
            const Flow& flow = context.config.flows[row];
            auto route = named.between(fmt::format("flow[{}]", row), flow.from, flow.to, problems);
            if (route) routes_.push_back(std::move(*route));
            shares_.push_back(flow.share);
        }
        if (!problems.empty()) throw core::InputError(problems);
    }
    const RouteEdges& operator()(Purpose purpose, const std::string& id) const {
        const double uniform =
            context_.random.uniform(purpose, core::vehicle_key(id).value, DemandDraw::flow);
        return routes_[pick(shares_, uniform)];
    }

  private:
    const DemandContext& context_;
    std::vector<RouteEdges> routes_;
    std::vector<double> shares_;
};

/// A route source that hides whether routes come from flows or from trips.
class Routes {
  public:
    explicit Routes(const DemandContext& context) : context_(context) {
        if (context.config.demand_kind() == DemandKind::flows) {
            flows_.emplace(context);
        } else {
            trips_.emplace(context);
        }
    }
    RouteEdges traffic(const std::string& id) {
        return flows_ ? (*flows_)(Purpose::demand, id) : trips_->traffic(id);
    }
    RouteEdges emergency(const std::string& id, VehicleKind kind) {
        if (flows_) return (*flows_)(Purpose::emergency, id);
        return trips_->emergency(
            id, kind, {"trips.emergency_minimum_length_m", context_.config.trips.emergency_minimum_length_m});
    }

  private:
    const DemandContext& context_;
    std::optional<FlowRoutes> flows_;
    std::optional<TripRoutes> trips_;
};

/// Looks for rerouters that close a road or a lane.
class ClosingFinder : public core::XmlHandler {
  public:
    void start(std::string_view element, const core::XmlAttributes&, unsigned long) override {
        found |= element == "closingReroute" || element == "closingLaneReroute";
    }
    void end(std::string_view) override {}
    bool found = false;
};

/// Attribute of vehicles that SUMO routes again at departure, because a road may be closed by then; else
/// empty.
const char* routing_mark(const ScenarioConfig& config) {
    ClosingFinder finder;
    for (const std::filesystem::path& file : additional_files(config))
        core::stream_xml(file, finder);
    return finder.found ? " reroute=\"true\"" : "";
}

PlannedVehicle plan_vehicle(const DemandContext& context, Routes& routes, VehicleClass vehicle_class,
                            int number, const char* mark) {
    PlannedVehicle vehicle;
    vehicle.id = fmt::format("{}.{}", traffic::name(vehicle_class), number);
    vehicle.vehicle_class = vehicle_class;
    vehicle.depart_s = departure_s(context, Purpose::demand, vehicle.id, 0.0, context.config.time.window_s);
    const VehicleKind kind = pick_kind(context, vehicle.id, context.config.traffic_kinds);
    std::string type = type_id(vehicle_class, kind);
    if (has_own_type(context.config, vehicle_class)) {
        vehicle.own_type_of = type;
        type = driver_type_id(type, vehicle.id);
    }
    vehicle.xml = fmt::format(
        "    <vehicle id=\"{}\" type=\"{}\" depart=\"{:.2f}\" departLane=\"best\" departSpeed=\"max\" "
        "speedFactor=\"{:.4f}\"{}>\n        <route edges=\"{}\"/>\n    </vehicle>\n",
        vehicle.id, type, vehicle.depart_s, speed_factor(context, vehicle.id, vehicle_class), mark,
        fmt::join(edge_ids(context.network, routes.traffic(vehicle.id)), " "));
    return vehicle;
}

traffic::EmergencyDeparture plan_emergency(const DemandContext& context, std::string id, VehicleKind kind,
                                           double depart_s, const RouteEdges& route) {
    traffic::EmergencyDeparture departure;
    departure.id = std::move(id);
    departure.type = type_id(VehicleClass::emergency, kind);
    departure.kind = kind;
    departure.edges = edge_ids(context.network, route);
    departure.depart = core::Seconds(depart_s);
    return departure;
}

}  // namespace

double speed_factor(const DemandContext& context, const std::string& id, VehicleClass vehicle_class) {
    const Drivers& drivers = context.config.drivers;
    const Slow& slow = context.config.slow;
    const auto draw = [&] {
        return context.random.uniform(Purpose::driver, core::vehicle_key(id).value, slow_draw);
    };
    if (slow.share > 0.0 && draw() < slow.share) return slow.speed_factor;
    if (vehicle_class != VehicleClass::human) return 1.0;
    const double deviation = std::max(drivers.speed_factor_deviation,
                                      context.config.following.driver_spread * drivers.speed_factor_mean);
    if (deviation <= 0.0) return drivers.speed_factor_mean;
    // Inverse transform sampling: one draw per driver, whatever the bounds.
    const boost::math::normal normal(drivers.speed_factor_mean, deviation);
    const double low = boost::math::cdf(normal, drivers.speed_factor_minimum);
    const double high = boost::math::cdf(normal, drivers.speed_factor_maximum);
    const double uniform = context.random.uniform(Purpose::driver, core::vehicle_key(id).value);
    constexpr double least_probability = 1e-12;
    const double probability =
        std::clamp(low + uniform * (high - low), least_probability, 1.0 - least_probability);
    return rounded(std::clamp(boost::math::quantile(normal, probability), drivers.speed_factor_minimum,
                              drivers.speed_factor_maximum),
                   0.0001);
}

double emergency_departure_s(const DemandContext& context, const std::string& id) {
    return departure_s(context, Purpose::emergency, id, context.config.time.warm_up_s,
                       context.config.time.window_s);
}

traffic::VehicleKind emergency_kind(const DemandContext& context, const std::string& id) {
    return pick_kind(context, id, context.config.emergency_kinds);
}

std::vector<std::string> edge_ids(const roads::Network& network, const std::vector<core::EdgeIndex>& route) {
    std::vector<std::string> ids;
    ids.reserve(route.size());
    for (const core::EdgeIndex edge : route)
        ids.push_back(network.edge(edge).id);
    return ids;
}

void sort_by_departure(PlannedDemand& demand) {
    std::sort(demand.vehicles.begin(), demand.vehicles.end(),
              [](const PlannedVehicle& a, const PlannedVehicle& b) {
                  return std::tie(a.depart_s, a.id) < std::tie(b.depart_s, b.id);
              });
    std::sort(demand.emergency.begin(), demand.emergency.end(), [](const auto& a, const auto& b) {
        return std::tie(a.depart.value, a.id) < std::tie(b.depart.value, b.id);
    });
}

PlannedDemand generate(const DemandContext& context) {
    const Demand& counts = context.config.demand;
    const auto scaled = [&](int count) { return static_cast<int>(std::lround(count * counts.density)); };
    Routes routes(context);
    const char* const mark = routing_mark(context.config);
    PlannedDemand demand;
    for (int number = 0; number < scaled(counts.human); ++number)
        demand.vehicles.push_back(plan_vehicle(context, routes, VehicleClass::human, number, mark));
    for (int number = 0; number < scaled(counts.automated); ++number)
        demand.vehicles.push_back(plan_vehicle(context, routes, VehicleClass::automated, number, mark));
    for (int number = 0; number < counts.emergency; ++number) {
        const std::string id = fmt::format("emergency.{}", number);
        const VehicleKind kind = emergency_kind(context, id);
        demand.emergency.push_back(plan_emergency(context, id, kind, emergency_departure_s(context, id),
                                                  routes.emergency(id, kind)));
    }
    return demand;
}

/// The route of an emergency vehicle as its trip gives it; nothing after adding problems to `problems`.
std::optional<RouteEdges> route_of(const DemandContext& context, NamedRoutes& named, const std::string& key,
                                   const EmergencyTrip& trip, std::vector<core::Problem>& problems) {
    if (trip.edges.empty()) return named.between(key, trip.from, trip.to, problems);
    RouteEdges route;
    std::istringstream ids(trip.edges);
    for (std::string id; ids >> id;) {
        const auto edge = edge_of(context, key + ".edges", id, problems);
        if (!edge) return std::nullopt;
        route.push_back(*edge);
    }
    if (open_to_emergency(context.network, route)) return route;
    problems.push_back({context.config.where(key + ".edges"), "is no way for an emergency vehicle",
                        "edges that join, all open to class emergency", "correct the edges"});
    return std::nullopt;
}

core::Seconds drawn_delay(const core::KeyedRandom& random, std::string_view what, double spread_s) {
    const double share = random.uniform(Purpose::emergency, core::fnv1a64(what));
    return core::Seconds(std::floor(100.0 * share * spread_s) / 100.0);
}

core::Seconds events_delay(const DemandContext& context) {
    return drawn_delay(context.random, "events", context.config.time.events_spread_s.value_or(0.0));
}

void add_emergency_trips(const DemandContext& context, PlannedDemand& demand) {
    const double delay_s = events_delay(context).value;
    NamedRoutes named(context);
    std::vector<core::Problem> problems;
    for (std::size_t row = 0; row < context.config.emergency_trips.size(); ++row) {
        const EmergencyTrip& trip = context.config.emergency_trips[row];
        const auto route = route_of(context, named, fmt::format("emergency_trip[{}]", row), trip, problems);
        if (!route) continue;
        demand.emergency.push_back(plan_emergency(context, fmt::format("emergency.trip.{}", row),
                                                  *core::value_from<traffic::VehicleKind>(trip.kind),
                                                  trip.depart_s + delay_s, *route));
    }
    if (!problems.empty()) throw core::InputError(problems);
}

void add_calls(const DemandContext& context, const Calls& calls, PlannedDemand& demand) {
    if (calls.calls.empty()) return;
    roads::RouteSearch search(context.network, roads::Driver::emergency);
    const auto free_s = [&](core::EdgeIndex edge, double) { return search.free_s(edge); };
    Fleet fleet(calls.stations);
    for (const PlacedCall& call : calls.calls) {
        for (std::uint32_t unit = 0; unit < call.units; ++unit) {
            const std::vector<Sending> candidates = fleet.candidates(call, search, free_s);
            const Sending* const sent = cheapest(candidates);
            if (sent == nullptr) break;
            fleet.send_from(sent->station);
            traffic::EmergencyDeparture departure = plan_emergency(
                context, call.vehicle(unit), call.kind, call.at.value + call.turnout.value, sent->way);
            departure.arrival = core::Metres(call.position_m);
            departure.is_called = true;
            demand.emergency.push_back(std::move(departure));
        }
    }
}

}  // namespace clearway::scenario::detail
