#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "core/error.hpp"
#include "roads/route.hpp"
#include "scenario/detail/demand.hpp"
#include "scenario/detail/driver_types.hpp"
#include "scenario/detail/own_types.hpp"
#include "scenario/detail/trip_routes.hpp"
#include "scenario/detail/xml_text.hpp"
#include "scenario/vehicle_types.hpp"

namespace clearway::scenario::detail {

namespace {

using core::Purpose;
using traffic::VehicleClass;

/// Numbers of the random draws for a measured vehicle. Never renumber them.
enum MeasuredDraw : std::uint64_t { made_automated = 0, thinned = 2 };

/// Reads the route files of one scenario into planned vehicles.
class MeasuredReader {
  public:
    explicit MeasuredReader(const DemandContext& context)
        : context_(context), measured_(*context.config.measured) {
        for (const MeasuredType& type : measured_.types)
            types_[type.id] = &type;
    }

    void read(const std::filesystem::path& file) {
        const pugi::xml_document document = load_xml(file, "a SUMO route file");
        for (const pugi::xml_node vehicle : document.document_element().children("vehicle"))
            take(vehicle, file);
    }

    PlannedDemand finish() {
        if (!problems_.empty()) throw core::InputError(problems_);
        if (demand_.vehicles.empty())
            throw core::InputError(core::Problem{
                context_.config.where("measured.routes"), "no vehicle departs in [0, time.window_s]",
                "<vehicle> elements with routes inside", "choose other route files"});
        add_emergency();
        return std::move(demand_);
    }

  private:
    void take(pugi::xml_node vehicle, const std::filesystem::path& file) {
        const std::string id = vehicle.attribute("id").value();
        const char* depart_text = vehicle.attribute("depart").value();
        char* end = nullptr;
        const double depart_s = std::strtod(depart_text, &end);
        if (end == depart_text || *end != '\0')
            return problem(file, id, fmt::format("depart is \"{}\"", depart_text), "a time in s");
        if (depart_s > context_.config.time.window_s) return;
        const std::uint64_t key = core::vehicle_key(id).value;
        if (context_.random.uniform(Purpose::demand, key, MeasuredDraw::thinned) >=
            context_.config.demand.density)
            return;
        const auto type = types_.find(vehicle.attribute("type").value());
        if (type == types_.end()) return unknown_type(file, id, vehicle.attribute("type").value());
        const MeasuredType& listed = *type->second;
        if (!note_route(vehicle, file, id, listed)) return;
        add(vehicle, id, depart_s, listed);
    }

    void add(pugi::xml_node vehicle, const std::string& id, double depart_s, const MeasuredType& type) {
        PlannedVehicle planned;
        planned.id = id;
        planned.depart_s = depart_s;
        const double uniform = context_.random.uniform(Purpose::vehicle_class, core::vehicle_key(id).value,
                                                       MeasuredDraw::made_automated);
        if (type.kind == "car" && uniform < measured_.automated_share)
            planned.vehicle_class = VehicleClass::automated;
        set_type(vehicle, type, planned);
        vehicle.remove_attribute("color");
        if (!keeps_driver(planned.vehicle_class)) {
            const double factor = speed_factor(context_, id, planned.vehicle_class);
            vehicle.remove_attribute("speedFactor");
            vehicle.append_attribute("speedFactor").set_value(fmt::format("{:.4f}", factor).c_str());
            if (measured_.own_types) limit_depart_speed(vehicle, factor);
        }
        planned.xml = element_text(vehicle);
        demand_.vehicles.push_back(std::move(planned));
    }

    void set_type(pugi::xml_node vehicle, const MeasuredType& type, PlannedVehicle& planned) const {
        const VehicleClass vehicle_class = planned.vehicle_class;
        std::string id =
            measured_.own_types
                ? own_type_id(vehicle_class, type.id)
                : type_id(vehicle_class, *core::value_from<traffic::VehicleKind>(type.kind), type.access);
        if (has_own_type(context_.config, vehicle_class)) {
            planned.own_type_of = id;
            id = driver_type_id(id, planned.id);
        }
        vehicle.attribute("type").set_value(id.c_str());
    }

    /// Whether a driver of this class keeps the desired speed of the type.
    bool keeps_driver(VehicleClass vehicle_class) const {
        return measured_.own_types && measured_.own_types->car_following == CarFollowing::own &&
               vehicle_class == VehicleClass::human;
    }

    /// SUMO aborts at a vehicle that departs faster than its driver would drive, and this driver is not the
    /// one of the file.
    void limit_depart_speed(pugi::xml_node vehicle, double factor) const {
        pugi::xml_attribute speed = vehicle.attribute("departSpeed");
        char* end = nullptr;
        const double speed_mps = std::strtod(speed.value(), &end);
        if (!speed || end == speed.value() || *end != '\0') return;
        const std::string edges = vehicle.child("route").attribute("edges").value();
        const auto edge = context_.network.find_edge(edges.substr(0, edges.find(' ')));
        double slowest_mps = std::numeric_limits<double>::infinity();
        for (std::uint32_t number = 0; number < context_.network.edge(*edge).lane_count; ++number)
            slowest_mps = std::min<double>(
                slowest_mps, context_.network.lane(context_.network.lane_of(*edge, number)).speed_limit_mps);
        if (speed_mps > factor * slowest_mps) speed.set_value("max");
    }

    /// Checks the route's edges; remembers it for emergency vehicles. False after a problem.
    bool note_route(pugi::xml_node vehicle, const std::filesystem::path& file, const std::string& id,
                    const MeasuredType& type) {
        const std::string edges = vehicle.child("route").attribute("edges").value();
        std::istringstream words(edges);
        RouteEdges route;
        for (std::string word; words >> word;) {
            const auto edge = context_.network.find_edge(word);
            if (!edge) {
                problem(file, id, fmt::format("the network has no edge \"{}\"", word),
                        "edges of the network");
                return false;
            }
            route.push_back(*edge);
        }
        if (route.empty()) {
            problem(file, id, "has no route inside", "<route edges=\"...\"/>");
            return false;
        }
        if (type.access != Access::own) return true;
        auto& seen = type.kind == "car" ? car_routes_ : other_routes_;
        if (seen.insert(edges).second &&
            roads::route_length(context_.network, route).value >= measured_.emergency_minimum_length_m &&
            open_to_emergency(context_.network, route))
            (type.kind == "car" ? long_routes_ : long_other_routes_).push_back(std::move(route));
        return true;
    }

    void add_emergency() {
        const int count = context_.config.demand.emergency;
        const bool has_sites = !context_.config.emergency_sites.empty();
        if (long_routes_.empty()) long_routes_ = std::move(long_other_routes_);
        if (count > 0 && !has_sites && long_routes_.empty())
            throw core::InputError(core::Problem{
                context_.config.where("measured.emergency_minimum_length_m"),
                "no measured route that emergency vehicles may drive is that long", "shorter", "lower it"});
        std::optional<TripRoutes> trips;
        if (count > 0 && has_sites) trips.emplace(context_);
        for (int number = 0; number < count; ++number) {
            traffic::EmergencyDeparture departure;
            departure.id = fmt::format("emergency.{}", number);
            departure.kind = emergency_kind(context_, departure.id);
            departure.type = type_id(VehicleClass::emergency, departure.kind);
            departure.depart = core::Seconds(emergency_departure_s(context_, departure.id));
            departure.edges = edge_ids(context_.network,
                                       trips ? trips->emergency(departure.id, departure.kind, least_length())
                                             : measured_route(departure.id));
            demand_.emergency.push_back(std::move(departure));
        }
    }

    LeastLength least_length() const {
        return {"measured.emergency_minimum_length_m", measured_.emergency_minimum_length_m};
    }

    const RouteEdges& measured_route(const std::string& id) const {
        constexpr std::uint64_t route_draw = 1;
        return long_routes_[context_.random.below(long_routes_.size(), Purpose::emergency,
                                                  core::vehicle_key(id).value, route_draw)];
    }

    void unknown_type(const std::filesystem::path& file, const std::string& id, const std::string& type) {
        if (!unknown_types_.insert(type).second) return;
        problem(file, id, fmt::format("type \"{}\" is not listed", type), "a type of [[measured.type]]");
    }

    void problem(const std::filesystem::path& file, const std::string& id, std::string what,
                 std::string allowed) {
        problems_.push_back({fmt::format("{}: vehicle \"{}\"", file.string(), id), std::move(what),
                             std::move(allowed), "correct the route file, or list the type in the scenario"});
    }

    const DemandContext& context_;
    const Measured& measured_;
    std::map<std::string, const MeasuredType*> types_;
    std::set<std::string> unknown_types_;
    std::set<std::string> car_routes_;
    std::set<std::string> other_routes_;
    std::vector<RouteEdges> long_routes_;        ///< For emergency vehicles: routes of cars,
    std::vector<RouteEdges> long_other_routes_;  ///< or, if no car has a long one, of any vehicle.
    std::vector<core::Problem> problems_;
    PlannedDemand demand_;
};

}  // namespace

PlannedDemand read_measured(const DemandContext& context) {
    MeasuredReader reader(context);
    for (const std::string& path : context.config.measured->routes)
        reader.read(resolve(context.config, path));
    return reader.finish();
}

}  // namespace clearway::scenario::detail
