#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/units.hpp"
#include "sumo/drawing.hpp"
#include "traffic/command.hpp"

// Every call to SUMO, in plain types. Each function turns whatever SUMO throws (TraCIException,
// FatalTraCIError, or an undeclared ProcessError) into core::SimulatorError with SUMO's text; the caller adds
// time and log. Callers must check what SUMO would ignore silently.
//
// Only api_gateway.hpp and remote_gateway.cpp include SUMO's own headers. libsumo and libtraci declare the
// same functions in two namespaces, so api_gateway.hpp is compiled once for each
// (docs/decisions/0004-two-gateways.md).

namespace clearway::sumo::detail::gateway {

struct CollisionReport {
    std::string collider;
    std::string victim;
    std::string lane;
};

struct VehicleReading {
    double x_m = 0.0;  ///< Front bumper.
    double y_m = 0.0;
    double angle_deg = 0.0;  ///< Clockwise from north.
    double speed_mps = 0.0;
    double acceleration_mps2 = 0.0;
    double lane_position_m = 0.0;
    std::string lane;
    bool rests = false;  ///< It stands, and did so with the same values at the reading before.

    bool operator==(const VehicleReading&) const = default;
};
/// Where a vehicle of the simulation is. A parked one is beside its lane and comes back.
enum class Presence : std::uint8_t { on_road, parked, off_road };

struct BestLane {
    std::string lane;
    double length_m = 0.0;  ///< From the start of the lane.
    int offset = 0;
};

struct TypeReading {
    double length_m = 0.0;
    double width_m = 0.0;
    double minimum_gap_m = 0.0;
    double maximum_speed_mps = 0.0;
    double acceleration_mps2 = 0.0;
    double deceleration_mps2 = 0.0;
    double emergency_deceleration_mps2 = 0.0;
};

struct Insertion {
    std::string vehicle;
    std::string type;
    std::vector<std::string> edges;
    std::string depart;
    std::string depart_lane;
    std::string depart_speed;
    std::string arrival = "max";  ///< Position on the last edge.
};

/// Where a stop is: its lane and the end position on it, m.
using StopPoint = std::pair<std::string, double>;

struct Stop {
    std::string edge;
    int lane_number = 0;
    double position_m = 0.0;
    double duration_s = 0.0;
    traffic::StopPlace place = traffic::StopPlace::on_lane;
};

/// SUMO, wherever it runs. One simulation; single-threaded.
class Sumo {
  public:
    Sumo() = default;
    Sumo(const Sumo&) = delete;
    Sumo& operator=(const Sumo&) = delete;
    virtual ~Sumo() = default;

    // --- The simulation ---
    virtual void load(const std::vector<std::string>& arguments) = 0;
    virtual void step() = 0;
    virtual void close() = 0;
    virtual double time_s() = 0;
    virtual double step_length_s() = 0;
    virtual int expected_vehicles() = 0;
    virtual std::string option(const std::string& name) = 0;
    virtual std::string version() = 0;

    // --- What happened in the last step, as vehicle ids ---
    virtual std::vector<std::string> departed() = 0;
    virtual std::vector<std::string> arrived() = 0;
    virtual std::vector<std::string> teleports_started() = 0;
    virtual std::vector<std::string> teleports_ended() = 0;
    /// All contacts of the last step, lasting ones included.
    virtual std::vector<CollisionReport> collisions() = 0;

    // --- Vehicles ---
    /// All vehicles of the simulation, including teleported ones.
    virtual std::vector<std::string> vehicle_ids() = 0;
    /// Fills `reading`, which holds that of the step before, of a vehicle on the road. May ask a vehicle that
    /// rests for nothing but its speed and lane, because all else stays as it is.
    virtual Presence read(const std::string& vehicle, VehicleReading& reading) = 0;
    virtual std::uint32_t route_index(const std::string& vehicle) = 0;
    virtual std::string route_id(const std::string& vehicle) = 0;
    virtual std::vector<std::string> route_edges(const std::string& vehicle) = 0;
    virtual std::string type_of(const std::string& vehicle) = 0;
    virtual double speed_factor(const std::string& vehicle) = 0;
    virtual std::string edge_of(const std::string& vehicle) = 0;
    virtual int lane_number(const std::string& vehicle) = 0;
    virtual double lane_position_m(const std::string& vehicle) = 0;
    virtual double speed_mps(const std::string& vehicle) = 0;
    virtual double allowed_speed_mps(const std::string& vehicle) = 0;
    /// Direction is -1 or 1. The answer is SUMO's, from its last lane-change decision.
    virtual bool could_change_lane(const std::string& vehicle, int direction) = 0;
    virtual std::vector<BestLane> best_lanes(const std::string& vehicle) = 0;

    // --- Vehicle types ---
    virtual std::vector<std::string> type_ids() = 0;
    /// SUMO's vClass.
    virtual std::string permission_class(const std::string& type) = 0;
    virtual TypeReading read_type(const std::string& type) = 0;
    /// Empty when the type has no such parameter.
    virtual std::string type_parameter(const std::string& type, const std::string& parameter) = 0;
    /// Devices are chosen by parameters of the type; vehicles added from now on have them.
    virtual void set_type_parameter(const std::string& type, const std::string& parameter,
                                    const std::string& value) = 0;

    // --- Roads ---
    virtual std::vector<std::string> signal_ids() = 0;
    virtual int lane_count(const std::string& edge) = 0;
    virtual double lane_length_m(const std::string& lane) = 0;
    virtual bool has_person(const std::string& edge) = 0;
    virtual double lane_limit_mps(const std::string& lane) = 0;
    virtual void set_lane_limit(const std::string& lane, double limit_mps) = 0;
    /// vClasses; the list is empty where all may use the lane.
    virtual std::vector<std::string> allowed(const std::string& lane) = 0;
    virtual void allow(const std::string& lane, const std::vector<std::string>& classes) = 0;

    // --- Commands ---
    /// Where its route is closed, the vehicle takes the fastest open one between the same ends.
    virtual void add(const Insertion& insertion) = 0;
    /// A vehicle that stands at a place of a lane; SUMO puts it there as soon as there is room.
    virtual void add_obstacle(const std::string& vehicle, const std::string& type, const Stop& place) = 0;
    virtual void remove(const std::string& vehicle) = 0;
    /// From the edge where the vehicle is. Returns whether SUMO knows this as a way for it.
    virtual bool set_route(const std::string& vehicle, const std::vector<std::string>& edges) = 0;
    /// Of a vehicle with SUMO's rerouting device; others are left alone.
    virtual void stop_rerouting(const std::string& vehicle) = 0;
    /// Negative: SUMO decides again.
    virtual void set_speed(const std::string& vehicle, double speed_mps) = 0;
    virtual void set_speed_mode(const std::string& vehicle, int mode) = 0;
    virtual void set_lane_change_mode(const std::string& vehicle, int mode) = 0;
    virtual void change_lane(const std::string& vehicle, int lane_number, double duration_s) = 0;
    virtual std::string lateral_alignment(const std::string& vehicle) = 0;
    virtual void set_lateral_alignment(const std::string& vehicle, const std::string& alignment) = 0;
    /// To the left where it is positive.
    virtual void change_sublane(const std::string& vehicle, double shift_m) = 0;
    virtual void stop(const std::string& vehicle, const Stop& stop) = 0;
    virtual bool is_stopped(const std::string& vehicle) = 0;
    /// Planned stops and the running one, in the order of the route.
    virtual std::vector<StopPoint> stops(const std::string& vehicle) = 0;
    virtual void resume(const std::string& vehicle) = 0;
    /// By its number in `stops`, not for the one at which it stands.
    virtual void cancel_stop(const std::string& vehicle, int number) = 0;

    // --- Signals ---
    virtual std::string signal_state(const std::string& signal) = 0;
    virtual std::string signal_program(const std::string& signal) = 0;
    virtual std::uint32_t phase_count(const std::string& signal, const std::string& program) = 0;
    virtual void set_signal_state(const std::string& signal, const std::string& state) = 0;
    virtual void set_signal_program(const std::string& signal, const std::string& program) = 0;
    virtual void set_signal_phase(const std::string& signal, std::uint32_t phase) = 0;
    /// Remaining duration of the running phase.
    virtual void set_signal_phase_duration(const std::string& signal, double duration_s) = 0;

    // --- Drawing, which changes no result ---
    virtual void colour_vehicle(const std::string& vehicle, const Colour& colour) = 0;
    virtual void add_stroke(const std::string& name, const Stroke& stroke) = 0;
    virtual void move_stroke(const std::string& name, const std::vector<Spot>& points) = 0;
    virtual void remove_stroke(const std::string& name) = 0;
    // A SUMO in this process has no window.
    virtual bool has_view() { return false; }
    /// Shows at least this many metres to each side of a vehicle on the road.
    virtual void show_around(const std::string& /*vehicle*/, double /*metres*/) {}
    /// The view follows a vehicle; with an empty id it stays where it is.
    virtual void track(const std::string& /*vehicle*/) {}
};

/// libsumo: SUMO in this process, not loaded yet.
std::unique_ptr<Sumo> in_this_process();
/// libtraci: a SUMO that waits for a client at a port, with its simulation loaded. Reads by subscription,
/// because a request costs about 200 us. Throws core::EnvironmentError when nothing listens there, something
/// other than SUMO 1.15 does, or it does not answer within `patience`.
std::unique_ptr<Sumo> at(const std::string& host, int port, core::Seconds patience);

}  // namespace clearway::sumo::detail::gateway
