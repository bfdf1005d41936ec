#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Every call to SUMO, in plain types. Each function turns whatever SUMO throws (TraCIException,
// FatalTraCIError, or an undeclared ProcessError) into core::SimulatorError with SUMO's text; the caller adds
// time and log. Nothing here checks what SUMO would swallow: that is for the callers.
//
// gateway.cpp is the only file that includes libsumo. It names the library's namespace once, so that the same
// file can be compiled again for a remote simulator.

namespace clearway::sumo::detail::gateway {

// --- The simulation ---
void load(const std::vector<std::string>& arguments);
void step();
void close();
double time_s();
double step_length_s();
int expected_vehicles();
std::string option(const std::string& name);
std::string version();

// --- What happened in the last step, as vehicle ids ---
std::vector<std::string> departed();
std::vector<std::string> arrived();
std::vector<std::string> teleports_started();
std::vector<std::string> teleports_ended();

struct CollisionReport {
    std::string collider;
    std::string victim;
    std::string lane;
};
/// All contacts of the last step, lasting ones included.
std::vector<CollisionReport> collisions();

// --- One vehicle ---
struct VehicleReading {
    double x_m = 0.0;  ///< Front bumper.
    double y_m = 0.0;
    double angle_deg = 0.0;  ///< Clockwise from north.
    double speed_mps = 0.0;
    double acceleration_mps2 = 0.0;
    double lane_position_m = 0.0;
    std::string lane;
};
/// Where a vehicle of the simulation is. A parked one stands beside its lane and comes back.
enum class Presence : std::uint8_t { on_road, parked, off_road };
/// Fills `reading` of a vehicle on the road.
Presence read(const std::string& vehicle, VehicleReading& reading);
std::uint32_t route_index(const std::string& vehicle);
std::string route_id(const std::string& vehicle);
std::vector<std::string> route_edges(const std::string& vehicle);
std::string type_of(const std::string& vehicle);
double speed_factor(const std::string& vehicle);
std::string edge_of(const std::string& vehicle);
int lane_number(const std::string& vehicle);
double lane_position_m(const std::string& vehicle);
double speed_mps(const std::string& vehicle);
double allowed_speed_mps(const std::string& vehicle);
/// Direction -1 or 1. SUMO's judgement of its last lane-change decision.
bool could_change_lane(const std::string& vehicle, int direction);

struct BestLane {
    std::string lane;
    double length_m = 0.0;  ///< From the start of the lane.
    int offset = 0;
};
std::vector<BestLane> best_lanes(const std::string& vehicle);

// --- Vehicle types ---
struct TypeReading {
    double length_m = 0.0;
    double width_m = 0.0;
    double minimum_gap_m = 0.0;
    double maximum_speed_mps = 0.0;
    double acceleration_mps2 = 0.0;
    double deceleration_mps2 = 0.0;
    double emergency_deceleration_mps2 = 0.0;
};
bool type_exists(const std::string& type);
TypeReading read_type(const std::string& type);
/// Empty when the type has no such parameter.
std::string type_parameter(const std::string& type, const std::string& parameter);
/// Devices are chosen by parameters of the type; vehicles added from now on have them.
void set_type_parameter(const std::string& type, const std::string& parameter, const std::string& value);

// --- Roads ---
std::vector<std::string> lane_ids();
std::vector<std::string> signal_ids();
int lane_count(const std::string& edge);
double lane_length_m(const std::string& lane);

// --- Commands ---
struct Insertion {
    std::string vehicle;
    std::string type;
    std::vector<std::string> edges;
    std::string depart;
    std::string depart_lane;
    std::string depart_speed;
};
void add(const Insertion& insertion);
/// Negative: SUMO decides again.
void set_speed(const std::string& vehicle, double speed_mps);
void set_speed_mode(const std::string& vehicle, int mode);
void set_lane_change_mode(const std::string& vehicle, int mode);
void change_lane(const std::string& vehicle, int lane_number, double duration_s);
std::string lateral_alignment(const std::string& vehicle);
void set_lateral_alignment(const std::string& vehicle, const std::string& alignment);

struct Stop {
    std::string edge;
    int lane_number = 0;
    double position_m = 0.0;
    double duration_s = 0.0;
};
void stop(const std::string& vehicle, const Stop& stop);
bool is_stopped(const std::string& vehicle);
/// Lane and end position of the next planned or running stop.
std::optional<std::pair<std::string, double>> next_stop(const std::string& vehicle);
void resume(const std::string& vehicle);
void cancel_next_stop(const std::string& vehicle);

// --- Signals ---
std::string signal_state(const std::string& signal);
std::string signal_program(const std::string& signal);
std::uint32_t phase_count(const std::string& signal, const std::string& program);
void set_signal_state(const std::string& signal, const std::string& state);
void set_signal_program(const std::string& signal, const std::string& program);
void set_signal_phase(const std::string& signal, std::uint32_t phase);

}  // namespace clearway::sumo::detail::gateway
