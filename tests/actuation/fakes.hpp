#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "actuation/actuator.hpp"
#include "support/crossing_scene.hpp"
#include "truth/self_knowledge.hpp"
#include "truth/snapshot.hpp"

namespace clearway::testing {

using traffic::LeaseKind;
using traffic::Refusal;

/// Vehicles that answer as the test tells them to.
class FakeSelfKnowledge : public truth::SelfKnowledge {
  public:
    FakeSelfKnowledge() {
        for (std::uint32_t number = 0; number < 2; ++number)
            outlook[number] = {number, 800.0F, 0};
    }

    std::optional<bool> could_change_lane(core::VehicleKey, truth::Neighbour) const override {
        return room_beside;
    }
    std::optional<std::vector<truth::LaneOutlook>> lane_outlook(core::VehicleKey) const override {
        return outlook;
    }
    std::optional<core::MetresPerSecond> allowed_speed(core::VehicleKey) const override {
        return core::MetresPerSecond(allowed_mps);
    }

    bool has_pedestrian(core::LaneIndex crossing) const override { return walked_on.contains(crossing); }

    std::string running_program(core::SignalIndex) const override { return program; }

    std::string program = "0";  ///< That all signals run.
    bool room_beside = true;
    std::set<core::LaneIndex> walked_on;
    double allowed_mps = 16.67;
    /// Two lanes that both continue.
    std::vector<truth::LaneOutlook> outlook = std::vector<truth::LaneOutlook>(2);
};

/// A road with sidewalks and a signal `J` where a crossing leads over it; see data/footway.net.xml.
inline const roads::Network& footway() {
    static const roads::Network network =
        roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/footway.net.xml");
    return network;
}

/// Transitions of the same length everywhere, so that tests of everything else have few numbers.
inline actuation::ActuatorConfig fixed_clearance() {
    actuation::ActuatorConfig config;
    config.clearance = actuation::ClearanceRule::fixed;
    config.entry_green_s = 0.0;
    config.walk_s = 0.0;
    return config;
}

/// An actuator with the two crossings, or another network, a clock and a record of every command.
class ActuationBench {
  public:
    explicit ActuationBench(double step_s = 0.25, actuation::Actuator::Config config = fixed_clearance(),
                            const roads::Network& network = two_crossings())
        : step_s_(step_s), network_(network), actuator(network, config) {
        now = core::Seconds(0.0);
        for (const roads::Signal& signal : network.signals()) {
            shown.push_back(signal.program.front().state);
        }
    }

    core::VehicleKey add(const SceneVehicle& vehicle) {
        const core::VehicleKey key = scene.add(vehicle);
        on_road[key] = scene.belief().find(key)->state;
        return key;
    }

    /// One step; the commands of that step. Signals show what they were told; a restored one its first phase.
    std::vector<traffic::Command> step() {
        now = core::Seconds(step_s_ * ++steps_);
        truth::Snapshot snapshot;
        snapshot.time = now;
        snapshot.signals.state = shown;
        for (const auto& [key, state] : on_road) {
            snapshot.key.push_back(key);
            snapshot.vehicle_class.push_back(scene.roster().find(key)->vehicle_class);
            snapshot.x_m.push_back(state.x_m);
            snapshot.y_m.push_back(state.y_m);
            snapshot.heading_rad.push_back(state.heading_rad);
            snapshot.speed_mps.push_back(state.speed_mps);
            snapshot.acceleration_mps2.push_back(0.0F);
            snapshot.lane.push_back(state.lane);
            snapshot.lane_position_m.push_back(state.lane_position_m);
            snapshot.route_edge.push_back(state.route_edge);
        }
        std::vector<traffic::Command> commands;
        actuator.step(snapshot, scene.roster(), self, commands);
        obey(commands);
        return commands;
    }

    /// Steps until `time`; all commands on the way.
    std::vector<traffic::Command> run_until(double time_s) {
        std::vector<traffic::Command> all;
        while (now.value < time_s - 1e-9) {
            const std::vector<traffic::Command> commands = step();
            all.insert(all.end(), commands.begin(), commands.end());
        }
        return all;
    }

    void offer(traffic::Target target, traffic::Action action, double duration_s = 2.0, int priority = 0,
               const char* policy = "policy", core::VehicleKey beneficiary = {}) {
        const traffic::Lease lease{
            target,   std::move(action), now + core::Seconds(duration_s), priority, policy,
            "a test", beneficiary,
        };
        actuator.accept(std::vector{lease}, now);
    }

    const actuation::LeaseCounts& counts(LeaseKind kind, const char* policy = "policy") const {
        return actuator.counts().at({policy, kind});
    }

    template <class Kind>
    static std::vector<Kind> only(const std::vector<traffic::Command>& commands) {
        std::vector<Kind> found;
        for (const traffic::Command& command : commands) {
            if (const auto* kind = std::get_if<Kind>(&command)) found.push_back(*kind);
        }
        return found;
    }

  private:
    void obey(const std::vector<traffic::Command>& commands) {
        for (const auto& set : only<traffic::SetSignalState>(commands))
            shown[set.signal.value] = set.state;
        for (const auto& restore : only<traffic::RestoreProgram>(commands)) {
            shown[restore.signal.value] =
                network_.signal(restore.signal).program[restore.phase.value_or(0)].state;
        }
    }

    double step_s_;
    const roads::Network& network_;
    int steps_ = 0;

  public:
    core::Seconds now;
    FakeSelfKnowledge self;
    CrossingScene scene;
    std::map<core::VehicleKey, traffic::MotionState> on_road;
    std::vector<std::string> shown;
    actuation::Actuator actuator;
};

}  // namespace clearway::testing
