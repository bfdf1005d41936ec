#include "drivers/siren.hpp"

#include <cmath>

#include "roads/route.hpp"

namespace clearway::drivers {

namespace {

/// How long a driver tries to reach one lane before choosing again: assumed.
constexpr core::Seconds lane_request{2.0};

}  // namespace

Siren::Siren(const roads::Network& network, const core::KeyedRandom& random, const SirenConfig& config)
    : network_(network),
      config_(config),
      reactions_(random,
                 {.compliance = config.compliance,
                  .mean_s = config.reaction_mean_s,
                  .deviation_s = config.reaction_deviation_s},
                 detail::siren_draws) {}

void Siren::step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                 const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands) {
    if (config_.compliance <= 0.0) return;
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] == traffic::VehicleClass::emergency) hear(snapshot, roster, row);
    }
    for (auto& [key, driver] : drivers_)
        act(key, driver, snapshot, self, commands);
    std::erase_if(drivers_, [&](const auto& entry) {
        const bool is_over = (snapshot.time - entry.second.last_heard).value > detail::memory_s;
        return is_over && !entry.second.is_holding;
    });
}

void Siren::hear(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                 core::VehicleIndex emergency) {
    const traffic::VehicleInfo* info = roster.find(snapshot.key[emergency]);
    const traffic::MotionState state = snapshot.motion(emergency);
    if (info == nullptr || !info->route.exists() || !state.lane.exists()) return;
    const roads::Route route = roster.route(info->route);
    if (state.route_edge >= route.size()) return;
    const auto reach = static_cast<float>(config_.audible_m);
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] != traffic::VehicleClass::human) continue;
        if (std::abs(snapshot.x_m[row] - state.x_m) > reach ||
            std::abs(snapshot.y_m[row] - state.y_m) > reach)
            continue;
        const auto distance = roads::distance_ahead(network_, route, state, snapshot.motion(row),
                                                    core::Metres(config_.audible_m));
        if (!distance || !reactions_.complies(snapshot.key[row])) continue;
        const bool in_lane =
            roads::advance(network_, route, state, *distance).state.lane == snapshot.lane[row];
        Driver fresh;
        fresh.noticed = snapshot.time;
        Driver& driver = drivers_.try_emplace(snapshot.key[row], fresh).first->second;
        driver.last_heard = snapshot.time;
        driver.position = in_lane ? Position::in_lane : Position::beside;
    }
}

void Siren::act(core::VehicleKey key, Driver& driver, const truth::Snapshot& snapshot,
                const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands) {
    if (!snapshot.row_of(key)) return;
    const bool is_heard = (snapshot.time - driver.last_heard).value <= detail::memory_s;
    const bool has_reacted = (snapshot.time - driver.noticed).value >= reactions_.reaction_s(key);
    const bool holds = is_heard && has_reacted && driver.position == Position::beside;
    if (holds != driver.is_holding) {
        driver.is_holding = holds;
        commands.push_back(traffic::SetLaneChangeFreedom{
            key, holds ? traffic::LaneChangeFreedom::strategic_only : traffic::LaneChangeFreedom::normal});
    }
    if (is_heard && has_reacted && driver.position == Position::in_lane)
        leave_lane(key, driver, snapshot, self, commands);
}

void Siren::leave_lane(core::VehicleKey key, Driver& driver, const truth::Snapshot& snapshot,
                       const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands) {
    if (snapshot.time < driver.asked_until) return;
    const roads::Lane& lane = network_.lane(snapshot.lane[*snapshot.row_of(key)]);
    if (network_.edge(lane.edge).internal) return;
    const auto outlook = self.lane_outlook(key);
    if (!outlook) return;
    for (const truth::Neighbour side : {truth::Neighbour::lower, truth::Neighbour::higher}) {
        const auto number = static_cast<std::int64_t>(lane.number) + static_cast<int>(side);
        if (number < 0 || number >= static_cast<std::int64_t>(outlook->size())) continue;
        const truth::LaneOutlook& there = (*outlook)[static_cast<std::size_t>(number)];
        const bool continues = there.best_offset == 0 || there.drivable_m > roads::worth_following.value;
        if (!continues || !self.could_change_lane(key, side).value_or(false)) continue;
        commands.push_back(traffic::RequestLane{key, static_cast<std::uint32_t>(number), lane_request});
        driver.asked_until = snapshot.time + lane_request;
        return;
    }
}

void Siren::restore_all(std::vector<traffic::Command>& commands) {
    for (const auto& [key, driver] : drivers_) {
        if (driver.is_holding)
            commands.push_back(traffic::SetLaneChangeFreedom{key, traffic::LaneChangeFreedom::normal});
    }
    drivers_.clear();
}

}  // namespace clearway::drivers
