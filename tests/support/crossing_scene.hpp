#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.hpp"
#include "roads/network.hpp"
#include "roads/route.hpp"
#include "traffic/belief.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::testing {

/// Two signalised crossings A and B, 300 m apart, on a road from west to east; see
/// data/two_crossings.net.xml.
inline const roads::Network& two_crossings() {
    static const roads::Network network =
        roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml");
    return network;
}

/// Four signalised crossings at the corners of a square of 110 m, A0 and A1 in the west, B0 and B1 in the
/// east, and a fifth one, T, 110 m east of B0; see data/short_square.net.xml.
inline const roads::Network& short_square() {
    static const roads::Network network =
        roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/short_square.net.xml");
    return network;
}

/// Two squares like that without T, one side of each cut into two edges; in the second, a side street leaves
/// where it is cut. Corners are asw, ase, ane, anw and bsw to bnw; see data/cut_squares.net.xml.
inline const roads::Network& cut_squares() {
    static const roads::Network network =
        roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/cut_squares.net.xml");
    return network;
}

/// A vehicle of a scene.
struct SceneVehicle {
    std::string id;
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    std::vector<std::string> route;  ///< It is on the first edge.
    std::uint32_t lane_number = 0;
    double position_m = 0.0;
    double speed_mps = 0.0;
};

/// From west to east over both crossings; the approach west_A, where 16.67 m/s are allowed, ends at `line_m`.
inline const std::vector<std::string> eastbound = {"west_A", "A_B", "B_east"};
inline constexpr double line_m = 489.6;

/// Vehicles on a network, and what is believed of them when sensors are perfect.
class CrossingScene {
  public:
    explicit CrossingScene(double time_s = 100.0, const roads::Network& network = two_crossings())
        : network_(&network) {
        belief_.time = core::Seconds(time_s);
    }

    core::VehicleKey add(const SceneVehicle& vehicle) {
        const roads::Network& network = *network_;
        std::vector<core::EdgeIndex> edges;
        for (const std::string& edge : vehicle.route)
            edges.push_back(network.find_edge(edge).value());
        traffic::VehicleInfo info;
        info.key = core::vehicle_key(vehicle.id);
        info.id = vehicle.id;
        info.vehicle_class = vehicle.vehicle_class;
        info.route = roster_.add_route(edges);
        roster_.add(info);
        traffic::BelievedVehicle believed;
        believed.key = info.key;
        believed.vehicle_class = vehicle.vehicle_class;
        believed.state.lane = network.lane_of(edges.front(), vehicle.lane_number);
        believed.state.lane_position_m = static_cast<float>(vehicle.position_m);
        believed.state.speed_mps = static_cast<float>(vehicle.speed_mps);
        const roads::Point point = network.point_at(believed.state.lane, core::Metres(vehicle.position_m));
        believed.state.x_m = point.x_m;
        believed.state.y_m = point.y_m;
        believed.state.heading_rad =
            static_cast<float>(network.heading_at(believed.state.lane, core::Metres(vehicle.position_m)));
        belief_.vehicles.push_back(believed);
        if (vehicle.vehicle_class == traffic::VehicleClass::emergency) belief_.own_states.push_back(believed);
        return info.key;
    }

    /// The belief with links between all pairs of the dissertation's classes nearer than 50 m, and signals
    /// that show `signals` (both alike), or the first phase of their program.
    traffic::BelievedGraph& belief(const std::optional<std::string>& signals = std::nullopt) {
        std::ranges::sort(belief_.vehicles, {}, &traffic::BelievedVehicle::key);
        std::ranges::sort(belief_.own_states, {}, &traffic::BelievedVehicle::key);
        belief_.first_link.assign(1, 0);
        belief_.links.clear();
        for (const traffic::BelievedVehicle& left : belief_.vehicles) {
            for (std::uint32_t row = 0; row < belief_.vehicles.size(); ++row)
                link(left, row);
            belief_.first_link.push_back(static_cast<std::uint32_t>(belief_.links.size()));
        }
        belief_.signals.state.clear();
        for (const roads::Signal& signal : network_->signals()) {
            belief_.signals.state.push_back(signals.value_or(signal.program.front().state));
        }
        belief_.roster = &roster_;
        return belief_;
    }
    traffic::Roster& roster() { return roster_; }
    void remove(core::VehicleKey key) {
        const auto is_it = [&](const traffic::BelievedVehicle& vehicle) { return vehicle.key == key; };
        std::erase_if(belief_.vehicles, is_it);
        std::erase_if(belief_.own_states, is_it);
    }

  private:
    void link(const traffic::BelievedVehicle& left, std::uint32_t row) {
        const traffic::BelievedVehicle& right = belief_.vehicles[row];
        if (left.key == right.key || left.vehicle_class == right.vehicle_class) return;
        const float distance = std::hypot(left.state.x_m - right.state.x_m, left.state.y_m - right.state.y_m);
        if (distance < 50.0F) belief_.links.push_back({row, distance, 1.0F});
    }

    const roads::Network* network_;
    traffic::Roster roster_;
    traffic::BelievedGraph belief_;
};

}  // namespace clearway::testing
