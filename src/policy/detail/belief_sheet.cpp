#include "policy/detail/belief_sheet.hpp"

#include <algorithm>
#include <cassert>
#include <string>
#include <string_view>

namespace clearway::policy::detail {
namespace {

using python::Sheet;
constexpr python::Column belief_sheet_columns[] = {
    {"time_s", "f8", "s", "Simulation time of the belief"},
    {"key", "u8", "", "Identity of each believed vehicle during the run; rows are ordered by it"},
    {"vehicle_class", "u1", "", "0 human, 1 automated, 2 emergency"},
    {"x_m", "f4", "m", "Front bumper, in the plane of the network"},
    {"y_m", "f4", "m", "Likewise"},
    {"heading_rad", "f4", "rad", "Counter-clockwise from the x axis"},
    {"speed_mps", "f4", "m/s", "Believed speed"},
    {"lane", "u4", "", "Lane of the network, internal ones included; 4294967295: none"},
    {"lane_position_m", "f4", "m", "Front bumper from the start of the lane"},
    {"route_edge", "u4", "1", "Position in the route of the edge entered last"},
    {"sigma_m", "f4", "m", "Standard deviation of the position along the route"},
    {"age_s", "f4", "s", "Age of the report that the belief rests on"},
    {"link_first", "u4", "1", "Where the links of each vehicle begin"},
    {"link_neighbour", "u4", "", "Row of the vehicle at the other end"},
    {"link_distance_m", "f4", "m", "Believed distance"},
    {"link_probability", "f4", "1", "That the true distance is below the link radius"},
    {"emergency_key", "u8", "",
     "Emergency vehicles on the road, as they know themselves, or else as believed"},
    {"emergency_x_m", "f4", "m", "Front bumper"},
    {"emergency_y_m", "f4", "m", "Front bumper"},
    {"emergency_heading_rad", "f4", "rad", "Counter-clockwise from the x axis"},
    {"emergency_speed_mps", "f4", "m/s", ""},
    {"emergency_lane", "u4", "", "Lane of the network"},
    {"emergency_lane_position_m", "f4", "m", "Front bumper from the start of the lane"},
    {"emergency_allowed_speed_mps", "f4", "m/s", "Highest speed that the road and the vehicle allow"},
    {"ahead_first", "u4", "1", "Where the vehicles ahead of each emergency vehicle begin"},
    {"ahead_row", "u4", "", "Row of a vehicle on its way, nearest first, up to 300 m ahead"},
    {"ahead_distance_m", "f4", "m", "Front to front, along the route of the emergency vehicle"},
    {"ahead_usable_lower", "u1", "1",
     "Of automated vehicles: the next lane outward is open to it and goes on"},
    {"ahead_usable_higher", "u1", "1", "The same for the next lane inward"},
    {"approach_first", "u4", "1", "Where the signals ahead of each emergency vehicle begin"},
    {"approach_signal", "u4", "", "Signal of the network, nearest first, up to 600 m ahead"},
    {"approach_distance_m", "f4", "m", "To its stop line"},
    {"own_link_first", "u4", "1", "Where the own links of each approach begin"},
    {"own_link", "u2", "", "Link of the signal that the emergency vehicle itself may take"},
    {"served_link_first", "u4", "1", "Where the links of each approach begin"},
    {"served_link", "u2", "", "Own links, and those of its approaches that do not conflict with them"},
    {"route_first", "u4", "1", "Where the way of each emergency vehicle begins"},
    {"route", "u4", "", "Edge of the network on its way, from the one entered last to its destination"},
    {"incident_edge", "u4", "", "Edge of each incident that lasts and is known"},
    {"incident_closed", "u1", "1", "No lane that an emergency vehicle may use is open"},
    {"signal_first", "u4", "1", "Where the letters of each signal begin"},
    {"signal_letters", "u1", "", "SUMO's letter of each link; none where it is not known"},
    {"edge_times_s", "f8", "s",
     "Of each edge, believed for an emergency vehicle that enters it now and drives at the limit; inf: "
     "closed to it, or inside a junction"},
};

/// Fills the columns of a sheet one after the other; each call names the column that is next.
class Filler {
  public:
    explicit Filler(Sheet& sheet) : sheet_(sheet) {}

    template <class Value>
    void put(std::string_view name, const std::vector<Value>& values) {
        sheet_.put(next(name), values);
    }
    template <class Value>
    std::span<Value> room(std::string_view name, std::size_t count) {
        return sheet_.room<Value>(next(name), count);
    }
    template <class Value, class Row, class Member>
    void put(std::string_view name, const std::vector<Row>& rows, const Member& member) {
        std::ranges::transform(rows, sheet_.room<Value>(next(name), rows.size()).begin(), member);
    }

  private:
    std::size_t next([[maybe_unused]] std::string_view name) {
        assert(next_ < std::size(belief_sheet_columns) && name == belief_sheet_columns[next_].name);
        return next_++;
    }

    Sheet& sheet_;
    std::size_t next_ = 0;
};

using Vehicle = traffic::BelievedVehicle;

/// Columns that believed vehicles and emergency vehicles have alike.
void write_motion(const std::vector<Vehicle>& rows, const std::string& of, Filler& fill) {
    fill.put<float>(of + "x_m", rows, [](const Vehicle& row) { return row.state.x_m; });
    fill.put<float>(of + "y_m", rows, [](const Vehicle& row) { return row.state.y_m; });
    fill.put<float>(of + "heading_rad", rows, [](const Vehicle& row) { return row.state.heading_rad; });
    fill.put<float>(of + "speed_mps", rows, [](const Vehicle& row) { return row.state.speed_mps; });
    fill.put<std::uint32_t>(of + "lane", rows, [](const Vehicle& row) { return row.state.lane.value; });
    fill.put<float>(of + "lane_position_m", rows,
                    [](const Vehicle& row) { return row.state.lane_position_m; });
}

void write_vehicles(const std::vector<Vehicle>& rows, Filler& fill) {
    fill.put<std::uint64_t>("key", rows, [](const Vehicle& row) { return row.key.value; });
    fill.put<std::uint8_t>("vehicle_class", rows,
                           [](const Vehicle& row) { return static_cast<std::uint8_t>(row.vehicle_class); });
    write_motion(rows, "", fill);
    fill.put<std::uint32_t>("route_edge", rows, [](const Vehicle& row) { return row.state.route_edge; });
    fill.put<float>("sigma_m", rows, [](const Vehicle& row) { return row.sigma_m; });
    fill.put<float>("age_s", rows, [](const Vehicle& row) { return row.age_s; });
}

void write_links(const traffic::BelievedGraph& belief, Filler& fill) {
    using Link = traffic::BelievedLink;
    fill.put("link_first", belief.first_link);
    fill.put<std::uint32_t>("link_neighbour", belief.links, [](const Link& link) { return link.neighbour; });
    fill.put<float>("link_distance_m", belief.links, [](const Link& link) { return link.distance_m; });
    fill.put<float>("link_probability", belief.links, [](const Link& link) { return link.probability; });
}

void write_emergency(const View& view, const std::vector<Vehicle>& rows, Filler& fill) {
    fill.put<std::uint64_t>("emergency_key", rows, [](const Vehicle& row) { return row.key.value; });
    write_motion(rows, "emergency_", fill);
    fill.put<float>("emergency_allowed_speed_mps", rows,
                    [&](const Vehicle& row) { return static_cast<float>(view.allowed_speed(row).value); });
}

void write_ahead(const View& view, const std::vector<Vehicle>& emergency, Filler& fill) {
    std::vector<std::uint32_t> first = {0}, row;
    std::vector<float> distance_m;
    std::vector<std::uint8_t> lower, higher;
    const Vehicle* const begin = view.belief().vehicles.data();
    for (const Vehicle& vehicle : emergency) {
        for (const VehicleAhead& ahead : view.vehicles_ahead(vehicle, sheet_horizon)) {
            const Vehicle& other = *ahead.vehicle;
            row.push_back(static_cast<std::uint32_t>(ahead.vehicle - begin));
            distance_m.push_back(static_cast<float>(ahead.distance_m));
            const bool takes_leases = other.vehicle_class == traffic::VehicleClass::automated;
            const std::uint32_t number = view.lane_number(other);
            lower.push_back(takes_leases && number > 0 && view.may_use_lane(other, number - 1) ? 1 : 0);
            higher.push_back(takes_leases && view.may_use_lane(other, number + 1) ? 1 : 0);
        }
        first.push_back(static_cast<std::uint32_t>(row.size()));
    }
    fill.put("ahead_first", first);
    fill.put("ahead_row", row);
    fill.put("ahead_distance_m", distance_m);
    fill.put("ahead_usable_lower", lower);
    fill.put("ahead_usable_higher", higher);
}

void write_approaches(const View& view, const std::vector<Vehicle>& emergency, Filler& fill) {
    std::vector<std::uint32_t> first = {0}, signal, own_first = {0}, served_first = {0};
    std::vector<float> distance_m;
    std::vector<std::uint16_t> own, served;
    for (const Vehicle& vehicle : emergency) {
        for (const Approach& approach : approaches(view, vehicle, approach_horizon)) {
            signal.push_back(approach.signal.value);
            distance_m.push_back(static_cast<float>(approach.distance_m));
            own.insert(own.end(), approach.own_links.begin(), approach.own_links.end());
            own_first.push_back(static_cast<std::uint32_t>(own.size()));
            served.insert(served.end(), approach.links.begin(), approach.links.end());
            served_first.push_back(static_cast<std::uint32_t>(served.size()));
        }
        first.push_back(static_cast<std::uint32_t>(signal.size()));
    }
    fill.put("approach_first", first);
    fill.put("approach_signal", signal);
    fill.put("approach_distance_m", distance_m);
    fill.put("own_link_first", own_first);
    fill.put("own_link", own);
    fill.put("served_link_first", served_first);
    fill.put("served_link", served);
}

void write_ways(const View& view, const std::vector<Vehicle>& emergency, Filler& fill) {
    std::vector<std::uint32_t> first = {0}, edges;
    for (const Vehicle& vehicle : emergency) {
        for (const core::EdgeIndex edge : view.route_of(vehicle.key).subspan(vehicle.state.route_edge))
            edges.push_back(edge.value);
        first.push_back(static_cast<std::uint32_t>(edges.size()));
    }
    fill.put("route_first", first);
    fill.put("route", edges);
}

void write_incidents(const std::vector<traffic::KnownIncident>& incidents, Filler& fill) {
    using Incident = traffic::KnownIncident;
    fill.put<std::uint32_t>("incident_edge", incidents, [](const Incident& row) { return row.edge.value; });
    fill.put<std::uint8_t>("incident_closed", incidents, [](const Incident& row) {
        return static_cast<std::uint8_t>(row.closed_to_emergency ? 1 : 0);
    });
}

void write_signals(const traffic::SignalStates& signals, Filler& fill) {
    std::vector<std::uint32_t> first = {0};
    std::vector<std::uint8_t> letters;
    for (const std::string& state : signals.state) {
        letters.insert(letters.end(), state.begin(), state.end());
        first.push_back(static_cast<std::uint32_t>(letters.size()));
    }
    fill.put("signal_first", first);
    fill.put("signal_letters", letters);
}

void write_edge_times(const BelievedWays& ways, const roads::Network& network, Filler& fill) {
    const std::span<double> times_s = fill.room<double>("edge_times_s", network.edges().size());
    for (std::uint32_t row = 0; row < times_s.size(); ++row)
        times_s[row] = ways.now_s(core::EdgeIndex{row});
}

}  // namespace

std::span<const python::Column> belief_columns() {
    return belief_sheet_columns;
}

void write_belief(const View& view, const std::vector<traffic::BelievedVehicle>& emergency,
                  const BelievedWays& ways, Sheet& sheet) {
    const traffic::BelievedGraph& belief = view.belief();
    sheet.clear();
    Filler fill(sheet);
    fill.put("time_s", std::vector{belief.time.value});
    write_vehicles(belief.vehicles, fill);
    write_links(belief, fill);
    write_emergency(view, emergency, fill);
    write_ahead(view, emergency, fill);
    write_approaches(view, emergency, fill);
    write_ways(view, emergency, fill);
    write_incidents(belief.incidents, fill);
    write_signals(belief.signals, fill);
    write_edge_times(ways, view.network(), fill);
}

}  // namespace clearway::policy::detail
