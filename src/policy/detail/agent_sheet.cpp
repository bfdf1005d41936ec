#include "policy/detail/agent_sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "policy/detail/belief_sheet.hpp"

namespace clearway::policy::detail {
namespace {

using python::Sheet;

namespace agent_column {
enum Number : std::size_t {
    time,
    rewards,
    flags,
    emergency,
    vehicles,
    vehicle_mask,
    edges,
    edge_features,
    edge_mask,
    signals,
    signal_states,
    signal_phases,
    ways,
    way_mask,
    action_mask,
    agents,
    count,
};
}  // namespace agent_column

constexpr std::array<python::Column, agent_column::count> agent_sheet_columns = {{
    {"time_s", "f8", "s", "Simulation time"},
    {"score_s", "f8", "s", "Delay of emergency vehicles and of the others since the last decision"},
    {"flags", "u4", "1", "All emergency vehicles have arrived; illegal actions of the last decision"},
    {"emergency", "f4", "",
     "Present, speed m/s, allowed speed m/s, lane, lanes of the edge, m to the next stop line"},
    {"vehicles", "f4", "",
     "m ahead, m to the left, speed m/s, cos and sin of the heading against the EV's, human, automated, "
     "emergency, age s, "
     "sigma m, m along its route or -1, same lane"},
    {"vehicle_mask", "u1", "1", "1: the row is a vehicle"},
    {"edges", "i4", "", "Rows of both ends of believed links"},
    {"edge_features", "f4", "", "Distance m, probability"},
    {"edge_mask", "u1", "1", "1: the row is a link"},
    {"signals", "f4", "",
     "Ahead on the EV's route, m to the stop line or 300, share of its own links that are green"},
    {"signal_states", "u1", "", "Of each link: 0 none or not known, 1 red, 2 yellow, 3 green"},
    {"signal_phases", "f4", "1", "Of each green phase: share of the EV's own links that it serves"},
    {"ways", "f4", "",
     "Ways that the EV could take, the fastest first: believed time to the destination s, length m, share of "
     "the length in common with the present way"},
    {"way_mask", "u1", "1", "1: the row is a way"},
    {"action_mask", "u1", "1", "1: legal; signals, automated vehicles, the way"},
    {"agents", "u8", "", "Keys of the automated vehicles that take actions; 0: none"},
}};

constexpr std::array<python::Column, 1> answers = {{
    {"actions", "i4", "", "One for each signal, then one for each automated vehicle, then one for the way"},
}};

constexpr std::size_t vehicle_width = 12;
constexpr std::size_t way_width = 3;

std::uint8_t colour(char letter) {
    if (traffic::is_green(letter)) return 3;
    if (letter == 'y' || letter == 'Y' || letter == 'u') return 2;
    return 1;
}

/// The nearest vehicles in the plane, the emergency vehicle itself left out.
std::vector<std::uint32_t> nearest_rows(const View& view, const traffic::BelievedVehicle& emergency,
                                        std::size_t most) {
    const auto reach = static_cast<float>(sheet_horizon.value);
    std::vector<std::pair<float, std::uint32_t>> near;
    const std::vector<traffic::BelievedVehicle>& vehicles = view.belief().vehicles;
    for (std::uint32_t row = 0; row < vehicles.size(); ++row) {
        const float across = vehicles[row].state.x_m - emergency.state.x_m;
        const float along = vehicles[row].state.y_m - emergency.state.y_m;
        if (std::abs(across) > reach || std::abs(along) > reach || vehicles[row].key == emergency.key)
            continue;
        near.emplace_back(across * across + along * along, row);
    }
    const std::size_t kept = std::min(most, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(kept), near.end());
    std::vector<std::uint32_t> rows;
    for (std::size_t at = 0; at < kept; ++at)
        rows.push_back(near[at].second);
    return rows;
}

void write_vehicle(const View& view, const AgentScene& scene, std::uint32_t row, std::span<float> target) {
    const traffic::BelievedVehicle& vehicle = view.belief().vehicles[row];
    const traffic::MotionState& self = scene.emergency->state;
    const float cosine = std::cos(self.heading_rad);
    const float sine = std::sin(self.heading_rad);
    const float across = vehicle.state.x_m - self.x_m;
    const float along = vehicle.state.y_m - self.y_m;
    const float turned = vehicle.state.heading_rad - self.heading_rad;
    const auto ahead = std::ranges::find(scene.ahead, &vehicle, &VehicleAhead::vehicle);
    const auto is = [&](traffic::VehicleClass one) { return vehicle.vehicle_class == one ? 1.0F : 0.0F; };
    const std::array<float, vehicle_width> values = {
        across * cosine + along * sine,
        along * cosine - across * sine,
        vehicle.state.speed_mps,
        std::cos(turned),
        std::sin(turned),
        is(traffic::VehicleClass::human),
        is(traffic::VehicleClass::automated),
        is(traffic::VehicleClass::emergency),
        vehicle.age_s,
        vehicle.sigma_m,
        ahead == scene.ahead.end() ? -1.0F : static_cast<float>(ahead->distance_m),
        vehicle.state.lane.exists() && vehicle.state.lane == self.lane ? 1.0F : 0.0F};
    std::ranges::copy(values, target.begin());
}

template <class Value>
std::span<Value> zeros(Sheet& sheet, std::size_t number, std::size_t count) {
    const std::span<Value> target = sheet.room<Value>(number, count);
    std::ranges::fill(target, Value{});
    return target;
}

void write_vehicles(const View& view, const AgentScene& scene, const AgentSizes& sizes, Sheet& sheet) {
    const auto target = zeros<float>(sheet, agent_column::vehicles, sizes.vehicles * vehicle_width);
    const auto mask = zeros<std::uint8_t>(sheet, agent_column::vehicle_mask, sizes.vehicles);
    const auto edges = zeros<std::int32_t>(sheet, agent_column::edges, 2 * std::size_t{sizes.links});
    const auto features = zeros<float>(sheet, agent_column::edge_features, 2 * std::size_t{sizes.links});
    const auto edge_mask = zeros<std::uint8_t>(sheet, agent_column::edge_mask, sizes.links);
    if (scene.emergency == nullptr) return;
    const std::vector<std::uint32_t> rows = nearest_rows(view, *scene.emergency, sizes.vehicles);
    std::size_t link = 0;
    for (std::uint32_t at = 0; at < rows.size(); ++at) {
        write_vehicle(view, scene, rows[at], target.subspan(at * vehicle_width, vehicle_width));
        mask[at] = 1;
        for (const traffic::BelievedLink& one : view.belief().links_of(rows[at])) {
            const auto other = std::ranges::find(rows, one.neighbour) - rows.begin();
            if (other <= at || other == std::ssize(rows) || link == sizes.links) continue;
            edges[link] = static_cast<std::int32_t>(at);
            edges[sizes.links + link] = static_cast<std::int32_t>(other);
            features[2 * link] = one.distance_m;
            features[2 * link + 1] = one.probability;
            edge_mask[link++] = 1;
        }
    }
}

void write_emergency(const View& view, const AgentScene& scene, Sheet& sheet) {
    const auto target = zeros<float>(sheet, agent_column::emergency, 6);
    if (scene.emergency == nullptr) return;
    const roads::Lane& lane = view.network().lane(scene.emergency->state.lane);
    target[0] = 1.0F;
    target[1] = scene.emergency->state.speed_mps;
    target[2] = static_cast<float>(view.allowed_speed(*scene.emergency).value);
    target[3] = static_cast<float>(lane.number);
    target[4] = static_cast<float>(view.network().edge(lane.edge).lane_count);
    target[5] =
        static_cast<float>(scene.approaches.empty() ? sheet_horizon.value : scene.approaches[0].distance_m);
}

float green_share(const std::vector<std::uint16_t>& links, const std::string& letters) {
    if (links.empty()) return 0.0F;
    const auto green = std::ranges::count_if(
        links, [&](std::uint16_t link) { return traffic::is_green_for(letters, link); });
    return static_cast<float>(green) / static_cast<float>(links.size());
}

void write_signals(const View& view, const AgentScene& scene, const AgentSizes& sizes, Sheet& sheet) {
    const auto target = zeros<float>(sheet, agent_column::signals, 3 * std::size_t{sizes.signals});
    const auto states = zeros<std::uint8_t>(sheet, agent_column::signal_states,
                                            std::size_t{sizes.signals} * sizes.signal_links);
    const auto phases =
        zeros<float>(sheet, agent_column::signal_phases, std::size_t{sizes.signals} * sizes.phases);
    const std::vector<std::string>& letters = view.belief().signals.state;
    for (std::size_t signal = 0; signal < sizes.signals; ++signal) {
        target[3 * signal + 1] = static_cast<float>(sheet_horizon.value);
        if (signal >= letters.size()) continue;
        for (std::size_t link = 0; link < letters[signal].size(); ++link)
            states[signal * sizes.signal_links + link] = colour(letters[signal][link]);
    }
    for (const Approach& approach : scene.approaches) {
        const std::size_t signal = approach.signal.value;
        if (target[3 * signal] > 0.0F) continue;  // the nearer stop line counts
        target[3 * signal] = 1.0F;
        target[3 * signal + 1] = static_cast<float>(approach.distance_m);
        if (signal < letters.size())
            target[3 * signal + 2] = green_share(approach.own_links, letters[signal]);
        const roads::Signal& plan = view.network().signal(approach.signal);
        std::size_t at = signal * sizes.phases;
        for (const std::size_t phase : green_phases(plan))
            phases[at++] = green_share(approach.own_links, plan.program[phase].state);
    }
}

void write_ways(const AgentScene& scene, const AgentSizes& sizes, Sheet& sheet) {
    const auto target = zeros<float>(sheet, agent_column::ways, way_width * sizes.ways);
    const auto mask = zeros<std::uint8_t>(sheet, agent_column::way_mask, sizes.ways);
    for (std::size_t at = 0; at < scene.ways.size(); ++at) {
        const OfferedWay& way = scene.ways[at];
        target[way_width * at] = static_cast<float>(way.time_s);
        target[way_width * at + 1] = static_cast<float>(way.length_m);
        target[way_width * at + 2] = static_cast<float>(way.common_share);
        mask[at] = 1;
    }
}

void write_masks(const View& view, const AgentScene& scene, const AgentSizes& sizes, Sheet& sheet,
                 std::vector<std::uint8_t>& mask) {
    const std::size_t signal_choices = 1 + sizes.phases;
    const std::size_t way_first =
        sizes.signals * signal_choices + std::size_t{sizes.automated} * automated_choices;
    mask.assign(way_first + (sizes.ways > 0 ? 1 + sizes.ways : 0), 0);
    if (sizes.ways > 0) std::fill_n(&mask[way_first], 1 + scene.ways.size(), std::uint8_t{1});
    for (std::size_t signal = 0; signal < sizes.signals; ++signal)
        mask[signal * signal_choices] = 1;
    for (const Approach& approach : scene.approaches) {
        const std::size_t phases = green_phases(view.network().signal(approach.signal)).size();
        std::fill_n(&mask[approach.signal.value * signal_choices], 1 + phases, std::uint8_t{1});
    }
    const auto agents = zeros<std::uint64_t>(sheet, agent_column::agents, sizes.automated);
    for (std::size_t at = 0; at < sizes.automated; ++at) {
        std::uint8_t* const own = &mask[sizes.signals * signal_choices + at * automated_choices];
        own[0] = 1;
        if (at >= scene.automated.size()) continue;
        const traffic::BelievedVehicle& vehicle = *scene.automated[at];
        agents[at] = vehicle.key.value;
        const std::uint32_t number = view.lane_number(vehicle);
        const std::array<bool, lane_choices> open = {true, true,
                                                     number > 0 && view.may_use_lane(vehicle, number - 1),
                                                     view.may_use_lane(vehicle, number + 1)};
        for (std::uint32_t choice = 0; choice < automated_choices; ++choice)
            own[choice] = open[choice % lane_choices] ? 1 : 0;
    }
    sheet.put(agent_column::action_mask, mask);
}

}  // namespace

std::span<const python::Column> agent_columns() {
    return agent_sheet_columns;
}

std::span<const python::Column> agent_answer_columns() {
    return answers;
}

std::vector<std::size_t> green_phases(const roads::Signal& signal) {
    std::vector<std::size_t> phases;
    for (std::size_t number = 0; number < signal.program.size(); ++number) {
        const std::string& state = signal.program[number].state;
        const bool has_green = std::ranges::any_of(state, traffic::is_green);
        if (has_green && state.find_first_of("yY") == std::string::npos) phases.push_back(number);
    }
    return phases;
}

void write_agent_sheet(const View& view, const AgentScene& scene, const AgentSizes& sizes, Sheet& sheet,
                       std::vector<std::uint8_t>& mask) {
    write_emergency(view, scene, sheet);
    write_vehicles(view, scene, sizes, sheet);
    write_signals(view, scene, sizes, sheet);
    write_ways(scene, sizes, sheet);
    write_masks(view, scene, sizes, sheet, mask);
}

}  // namespace clearway::policy::detail
