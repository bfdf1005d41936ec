#pragma once

#include <algorithm>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <libsumo/libsumo.h>

#include "core/error.hpp"
#include "sumo/detail/gateway.hpp"

// The gateway over libsumo, or over libtraci in a file that includes <libsumo/libtraci.h> first: both declare
// the same functions, each in its own namespace, which LIBSUMO_NAMESPACE names. One file cannot include both.

namespace clearway::sumo::detail::gateway::LIBSUMO_NAMESPACE {

namespace api = ::LIBSUMO_NAMESPACE;

/// Calls SUMO. Its exceptions have no common base but std::exception.
template <class Call, class... Arguments>
auto call(Call&& to_sumo, Arguments&&... arguments) {
    try {
        return to_sumo(std::forward<Arguments>(arguments)...);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& fault) {
        throw core::SimulatorError(fault.what());
    }
}

// SUMO's lane-change state (LCA_* of its TraCI constants, which its C++ headers leave out).
inline constexpr int change_to_left = 1 << 1;
inline constexpr int change_to_right = 1 << 2;
inline constexpr int change_unknown = 1 << 30;
inline constexpr int change_blocked =
    (1 << 9) | (1 << 10) | (1 << 11) | (1 << 12) | (1 << 14) | (1 << 28);  // vehicles, space, speed
inline constexpr int parking_flag = 1;                                     // bit 0 of the flags of setStop
inline constexpr int stopped_flag = 1;                                     // bit 0 of the stop state

inline constexpr int above_vehicles = 200;  // a layer of sumo-gui

inline ::libsumo::TraCIColor of_sumo(const Colour& colour) {
    return {colour.red, colour.green, colour.blue};
}

inline ::libsumo::TraCIPositionVector of_sumo(const std::vector<Spot>& points) {
    ::libsumo::TraCIPositionVector shape;
    for (const Spot& point : points) {
        ::libsumo::TraCIPosition at;
        at.x = point.x_m;
        at.y = point.y_m;
        shape.value.push_back(at);
    }
    return shape;
}

class ApiGateway : public Sumo {
  public:
    void load(const std::vector<std::string>& arguments) override {
        call([&] { api::Simulation::load(arguments); });
    }

    void step() override {
        call([] { api::Simulation::step(); });
    }

    void close() override {
        call([] { api::Simulation::close(); });
    }

    double time_s() override { return call(api::Simulation::getTime); }
    double step_length_s() override { return call(api::Simulation::getDeltaT); }
    int expected_vehicles() override { return call(api::Simulation::getMinExpectedNumber); }
    std::string option(const std::string& name) override { return call(api::Simulation::getOption, name); }

    std::string version() override {
        return call([] { return api::Simulation::getVersion().second; });
    }

    std::vector<std::string> departed() override { return call(api::Simulation::getDepartedIDList); }
    std::vector<std::string> arrived() override { return call(api::Simulation::getArrivedIDList); }
    std::vector<std::string> teleports_started() override {
        return call(api::Simulation::getStartingTeleportIDList);
    }
    std::vector<std::string> teleports_ended() override {
        return call(api::Simulation::getEndingTeleportIDList);
    }

    std::vector<CollisionReport> collisions() override {
        return call([] {
            std::vector<CollisionReport> reports;
            for (const auto& collision : api::Simulation::getCollisions()) {
                reports.push_back({collision.collider, collision.victim, collision.lane});
            }
            return reports;
        });
    }

    std::vector<std::string> vehicle_ids() override { return call(api::Vehicle::getIDList); }

    Presence read(const std::string& vehicle, VehicleReading& reading) override {
        return call([&] {
            const double speed_mps = api::Vehicle::getSpeed(vehicle);
            if (speed_mps == ::libsumo::INVALID_DOUBLE_VALUE) return Presence::off_road;
            std::string lane = api::Vehicle::getLaneID(vehicle);
            if (reading.rests && speed_mps == 0.0 && lane == reading.lane && !moves_sideways())
                return Presence::on_road;
            const auto position = api::Vehicle::getPosition(vehicle);
            VehicleReading now{.x_m = position.x,
                               .y_m = position.y,
                               .angle_deg = api::Vehicle::getAngle(vehicle),
                               .speed_mps = speed_mps,
                               .lane = std::move(lane)};
            const Presence presence = now.lane.empty() ? Presence::parked : Presence::on_road;
            if (presence == Presence::on_road) {
                now.acceleration_mps2 = api::Vehicle::getAcceleration(vehicle);
                now.lane_position_m = api::Vehicle::getLanePosition(vehicle);
                reading.rests = false;
                now.rests = speed_mps == 0.0 && now == reading;
            }
            reading = std::move(now);
            return presence;
        });
    }

    std::uint32_t route_index(const std::string& vehicle) override {
        return call(
            [&] { return static_cast<std::uint32_t>(std::max(0, api::Vehicle::getRouteIndex(vehicle))); });
    }

    std::string route_id(const std::string& vehicle) override {
        return call(api::Vehicle::getRouteID, vehicle);
    }
    std::vector<std::string> route_edges(const std::string& vehicle) override {
        return call(api::Vehicle::getRoute, vehicle);
    }
    std::string type_of(const std::string& vehicle) override {
        return call(api::Vehicle::getTypeID, vehicle);
    }
    double speed_factor(const std::string& vehicle) override {
        return call(api::Vehicle::getSpeedFactor, vehicle);
    }
    std::string edge_of(const std::string& vehicle) override {
        return call(api::Vehicle::getRoadID, vehicle);
    }
    int lane_number(const std::string& vehicle) override { return call(api::Vehicle::getLaneIndex, vehicle); }
    double lane_position_m(const std::string& vehicle) override {
        return call(api::Vehicle::getLanePosition, vehicle);
    }
    double speed_mps(const std::string& vehicle) override { return call(api::Vehicle::getSpeed, vehicle); }
    double allowed_speed_mps(const std::string& vehicle) override {
        return call(api::Vehicle::getAllowedSpeed, vehicle);
    }

    bool could_change_lane(const std::string& vehicle, int direction) override {
        return call([&] {
            const auto [own, commanded] = api::Vehicle::getLaneChangeState(vehicle, direction);
            const int wanted = direction < 0 ? change_to_right : change_to_left;
            // A vehicle that wanted to change and could has just done so: its state is that of the former
            // lane.
            const bool has_changed = (commanded & change_blocked) == 0 && (commanded & wanted) != 0;
            return own != change_unknown && !has_changed && (own & change_blocked) == 0;
        });
    }

    std::vector<BestLane> best_lanes(const std::string& vehicle) override {
        return call([&] {
            auto known = api::Vehicle::getBestLanes(vehicle);
            std::vector<BestLane> lanes;
            lanes.reserve(known.size());
            for (auto& lane : known)
                lanes.push_back({std::move(lane.laneID), lane.length, lane.bestLaneOffset});
            return lanes;
        });
    }

    std::vector<std::string> type_ids() override { return call(api::VehicleType::getIDList); }
    std::string permission_class(const std::string& type) override {
        return call(api::VehicleType::getVehicleClass, type);
    }

    TypeReading read_type(const std::string& type) override {
        return call([&] {
            return TypeReading{.length_m = api::VehicleType::getLength(type),
                               .width_m = api::VehicleType::getWidth(type),
                               .minimum_gap_m = api::VehicleType::getMinGap(type),
                               .maximum_speed_mps = api::VehicleType::getMaxSpeed(type),
                               .acceleration_mps2 = api::VehicleType::getAccel(type),
                               .deceleration_mps2 = api::VehicleType::getDecel(type),
                               .emergency_deceleration_mps2 = api::VehicleType::getEmergencyDecel(type)};
        });
    }

    std::string type_parameter(const std::string& type, const std::string& parameter) override {
        return call(api::VehicleType::getParameter, type, parameter);
    }
    std::vector<std::string> signal_ids() override { return call(api::TrafficLight::getIDList); }
    int lane_count(const std::string& edge) override { return call(api::Edge::getLaneNumber, edge); }
    double lane_length_m(const std::string& lane) override { return call(api::Lane::getLength, lane); }

    bool has_person(const std::string& edge) override {
        return call([&] { return !api::Edge::getLastStepPersonIDs(edge).empty(); });
    }

    double lane_limit_mps(const std::string& lane) override { return call(api::Lane::getMaxSpeed, lane); }
    void set_lane_limit(const std::string& lane, double limit_mps) override {
        call(api::Lane::setMaxSpeed, lane, limit_mps);
    }
    std::vector<std::string> allowed(const std::string& lane) override {
        return call(api::Lane::getAllowed, lane);
    }
    void allow(const std::string& lane, const std::vector<std::string>& classes) override {
        // SUMO reads an empty list as nobody, although it reports everybody so.
        const std::vector<std::string> all = {"all"};
        call([&] { api::Lane::setAllowed(lane, classes.empty() ? all : classes); });
    }

    void set_type_parameter(const std::string& type, const std::string& parameter,
                            const std::string& value) override {
        call(api::VehicleType::setParameter, type, parameter, value);
    }

    void add(const Insertion& insertion) override {
        call([&] {
            const std::string route = "clearway:" + insertion.vehicle;
            const auto add_on = [&](const std::string& id, const std::vector<std::string>& edges) {
                api::Route::add(id, edges);
                api::Vehicle::add(insertion.vehicle, id, insertion.type, insertion.depart,
                                  insertion.depart_lane, "base", insertion.depart_speed, "current",
                                  insertion.arrival);
            };
            try {
                add_on(route, insertion.edges);
            } catch (const ::libsumo::TraCIException& refused) {
                const bool is_closed =
                    std::string_view(refused.what()).find("no valid route") != std::string_view::npos;
                if (!is_closed) throw;
                const auto way = api::Simulation::findRoute(insertion.edges.front(), insertion.edges.back(),
                                                            insertion.type);
                if (way.edges.empty()) throw;
                add_on(route + ":open", way.edges);
            }
        });
    }

    void add_obstacle(const std::string& vehicle, const std::string& type, const Stop& place) override {
        call([&] {
            const std::vector<std::string> known = api::VehicleType::getIDList();
            if (std::find(known.begin(), known.end(), type) == known.end()) {
                api::VehicleType::copy("DEFAULT_VEHTYPE", type);
                api::VehicleType::setVehicleClass(type, "ignoring");
                api::VehicleType::setMinGap(type, 0.0);
            }
            const std::string route = "clearway:" + vehicle;
            api::Route::add(route, {place.edge});
            // Rounded text must not lie behind the stop.
            const std::string position_m = std::to_string(std::max(0.0, place.position_m - 0.001));
            api::Vehicle::add(vehicle, route, type, "now", std::to_string(place.lane_number), position_m,
                              "0");
            api::Vehicle::setStop(vehicle, place.edge, place.position_m, place.lane_number, place.duration_s);
        });
    }
    void remove(const std::string& vehicle) override {
        call([&] { api::Vehicle::remove(vehicle); });
    }

    bool set_route(const std::string& vehicle, const std::vector<std::string>& edges) override {
        return call([&] {
            try {
                api::Vehicle::setRoute(vehicle, edges);
                return true;
            } catch (const ::libsumo::TraCIException&) {
                return false;
            }
        });
    }
    void stop_rerouting(const std::string& vehicle) override {
        call([&] {
            if (api::Vehicle::getParameter(vehicle, "has.rerouting.device") == "true")
                api::Vehicle::setParameter(vehicle, "device.rerouting.period", "0");
        });
    }
    void set_speed(const std::string& vehicle, double speed_mps) override {
        call(api::Vehicle::setSpeed, vehicle, speed_mps);
    }
    void set_speed_mode(const std::string& vehicle, int mode) override {
        call(api::Vehicle::setSpeedMode, vehicle, mode);
    }
    void set_lane_change_mode(const std::string& vehicle, int mode) override {
        call(api::Vehicle::setLaneChangeMode, vehicle, mode);
    }
    void change_lane(const std::string& vehicle, int lane_number, double duration_s) override {
        call(api::Vehicle::changeLane, vehicle, lane_number, duration_s);
    }
    std::string lateral_alignment(const std::string& vehicle) override {
        return call(api::Vehicle::getLateralAlignment, vehicle);
    }
    void set_lateral_alignment(const std::string& vehicle, const std::string& alignment) override {
        call(api::Vehicle::setLateralAlignment, vehicle, alignment);
    }
    void change_sublane(const std::string& vehicle, double shift_m) override {
        call(api::Vehicle::changeSublane, vehicle, shift_m);
    }

    void stop(const std::string& vehicle, const Stop& stop) override {
        call([&] {
            const int flags = stop.place == traffic::StopPlace::beside_road ? parking_flag : 0;
            api::Vehicle::setStop(vehicle, stop.edge, stop.position_m, stop.lane_number, stop.duration_s,
                                  flags);
        });
    }

    bool is_stopped(const std::string& vehicle) override {
        return call([&] { return (api::Vehicle::getStopState(vehicle) & stopped_flag) != 0; });
    }

    std::vector<StopPoint> stops(const std::string& vehicle) override {
        return call([&] {
            std::vector<StopPoint> points;
            for (const auto& stop : api::Vehicle::getStops(vehicle))
                points.emplace_back(stop.lane, stop.endPos);
            return points;
        });
    }

    void resume(const std::string& vehicle) override { call(api::Vehicle::resume, vehicle); }

    void cancel_stop(const std::string& vehicle, int number) override {
        call([&] { api::Vehicle::replaceStop(vehicle, number, ""); });
        // Without this SUMO goes on with lanes that end at the stop, and the vehicle stands there until it is
        // teleported.
        call([&] { api::Vehicle::updateBestLanes(vehicle); });
    }

    std::string signal_state(const std::string& signal) override {
        return call(api::TrafficLight::getRedYellowGreenState, signal);
    }
    std::string signal_program(const std::string& signal) override {
        return call(api::TrafficLight::getProgram, signal);
    }

    std::uint32_t phase_count(const std::string& signal, const std::string& program) override {
        return call([&] {
            for (const auto& logic : api::TrafficLight::getAllProgramLogics(signal)) {
                if (logic.programID == program) return static_cast<std::uint32_t>(logic.phases.size());
            }
            return std::uint32_t{0};
        });
    }

    void set_signal_state(const std::string& signal, const std::string& state) override {
        call(api::TrafficLight::setRedYellowGreenState, signal, state);
    }
    void set_signal_program(const std::string& signal, const std::string& program) override {
        call(api::TrafficLight::setProgram, signal, program);
    }

    void set_signal_phase(const std::string& signal, std::uint32_t phase) override {
        call(api::TrafficLight::setPhase, signal, static_cast<int>(phase));
    }

    void set_signal_phase_duration(const std::string& signal, double duration_s) override {
        call(api::TrafficLight::setPhaseDuration, signal, duration_s);
    }

    void colour_vehicle(const std::string& vehicle, const Colour& colour) override {
        call(api::Vehicle::setColor, vehicle, of_sumo(colour));
    }

    void add_stroke(const std::string& name, const Stroke& stroke) override {
        call([&] {
            api::Polygon::add(name, of_sumo(stroke.points), of_sumo(stroke.colour), false, "clearway",
                              above_vehicles, stroke.width_m);
        });
    }

    void move_stroke(const std::string& name, const std::vector<Spot>& points) override {
        call(api::Polygon::setShape, name, of_sumo(points));
    }

    void remove_stroke(const std::string& name) override { call(api::Polygon::remove, name, above_vehicles); }

  private:
    /// Vehicles of the sublane model may move across their lane while they stand.
    bool moves_sideways() {
        if (!has_sublanes_) has_sublanes_ = std::stod(option("lateral-resolution")) > 0.0;
        return *has_sublanes_;
    }

    std::optional<bool> has_sublanes_;  ///< Asked for once.
};

}  // namespace clearway::sumo::detail::gateway::LIBSUMO_NAMESPACE
