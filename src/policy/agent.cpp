#include "policy/agent.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "policy/detail/agent_sheet.hpp"
#include "policy/detail/belief_sheet.hpp"
#include "policy/navigate.hpp"

namespace clearway::policy {
namespace {

using detail::AgentColumn;

constexpr const char* agent_reason = "the environment's action";

constexpr std::size_t column(AgentColumn one) {
    return static_cast<std::size_t>(one);
}

std::vector<std::uint16_t> green_links(const std::string& state) {
    std::vector<std::uint16_t> links;
    for (std::size_t link = 0; link < state.size(); ++link) {
        if (traffic::is_green(state[link])) links.push_back(static_cast<std::uint16_t>(link));
    }
    return links;
}

std::vector<std::uint16_t> common(const std::vector<std::uint16_t>& left,
                                  const std::vector<std::uint16_t>& right) {
    std::vector<std::uint16_t> both;
    std::set_intersection(left.begin(), left.end(), right.begin(), right.end(), std::back_inserter(both));
    return both;
}

}  // namespace

AgentSizes agent_sizes(const roads::Network& network, std::uint32_t ways) {
    if (ways > most_agent_ways)
        throw core::InputError(
            {"ways", fmt::format("is {}", ways), fmt::format("0 to {}", most_agent_ways), ""});
    AgentSizes sizes;
    sizes.ways = ways;
    sizes.signals = static_cast<std::uint32_t>(network.signals().size());
    for (const roads::Signal& signal : network.signals()) {
        sizes.phases =
            std::max(sizes.phases, static_cast<std::uint32_t>(detail::green_phases(signal).size()));
        sizes.signal_links = std::max(sizes.signal_links, static_cast<std::uint32_t>(signal.links.size()));
    }
    return sizes;
}

std::string agent_greeting(const roads::Network& network, std::uint32_t ways) {
    using Json = nlohmann::ordered_json;
    const AgentSizes sizes = agent_sizes(network, ways);
    Json signals = Json::array();
    for (const roads::Signal& signal : network.signals())
        signals.push_back({signal.id, detail::green_phases(signal).size()});
    return Json{{"question", Json::parse(python::to_json(detail::agent_columns()))},
                {"answer", Json::parse(python::to_json(detail::agent_answer_columns()))},
                {"vehicles", sizes.vehicles},
                {"links", sizes.links},
                {"automated", sizes.automated},
                {"automated_choices", detail::automated_choices},
                {"signals", signals},
                {"phases", sizes.phases},
                {"signal_links", sizes.signal_links},
                {"ways", sizes.ways}}
        .dump();
}

struct Agent::State {
    State(const PolicyContext& run, const python::Channel& shared, AgentScore& kept,
          std::function<void(python::Bell)> leave, std::uint32_t ways_offered)
        : context(run),
          channel(shared),
          score(kept),
          left(std::move(leave)),
          sizes(agent_sizes(run.network, ways_offered)),
          question{shared.outgoing(), detail::agent_columns()},
          answer{shared.incoming(), detail::agent_answer_columns()} {
        if (ways_offered > 0) ways.emplace(run, NavigateConfig{});
    }

    PolicyContext context;
    const python::Channel& channel;
    AgentScore& score;
    std::function<void(python::Bell)> left;
    AgentSizes sizes;
    python::Sheet question, answer;
    std::optional<detail::BelievedWays> ways;  ///< Nothing where none are offered.
    std::vector<std::uint8_t> mask;
    std::uint32_t illegal = 0;
    detail::AgentScene scene;

    void look(const detail::View& view, const std::vector<traffic::BelievedVehicle>& emergency) {
        scene = {};
        if (emergency.empty()) return;
        scene.emergency = &emergency.front();
        scene.approaches = detail::approaches(view, *scene.emergency, detail::sheet_horizon);
        scene.ahead = view.vehicles_ahead(*scene.emergency, detail::sheet_horizon);
        for (const detail::VehicleAhead& one : scene.ahead) {
            if (one.vehicle->vehicle_class == traffic::VehicleClass::automated &&
                scene.automated.size() < sizes.automated)
                scene.automated.push_back(one.vehicle);
        }
        if (ways) scene.ways = ways->offers(view, *scene.emergency, sizes.ways);
    }
    void ask(const detail::View& view) {
        question.clear();
        question.room<double>(column(AgentColumn::time), 1)[0] = view.belief().time.value;
        const std::span<double> rewards = question.room<double>(column(AgentColumn::rewards), 2);
        rewards[0] = std::exchange(score.emergency_delay_s, 0.0);
        rewards[1] = std::exchange(score.others_delay_s, 0.0);
        const std::span<std::uint32_t> flags = question.room<std::uint32_t>(column(AgentColumn::flags), 2);
        flags[0] = score.all_arrived ? 1 : 0;
        flags[1] = std::exchange(illegal, 0);
        detail::write_agent_sheet(view, scene, sizes, question, mask);
        python::Bell bell{};
        if (!channel.ring(python::Bell::decide) || !channel.wait(bell)) bell = python::Bell::ended;
        if (bell != python::Bell::answer) left(bell);
    }
    /// The chosen action of an agent, or 0 where it is illegal.
    std::uint32_t chosen(std::int32_t action, std::size_t first, std::size_t choices) {
        if (action >= 0 && static_cast<std::size_t>(action) < choices &&
            mask[first + static_cast<std::size_t>(action)] != 0)
            return static_cast<std::uint32_t>(action);
        ++illegal;
        return 0;
    }
    void answer_signals(std::span<const std::int32_t> actions, detail::LeaseWriter& write) {
        const std::size_t choices = 1 + sizes.phases;
        for (std::uint32_t index = 0; index < sizes.signals; ++index) {
            const std::uint32_t action = chosen(actions[index], index * choices, choices);
            if (action == 0) continue;
            const roads::Signal& signal = context.network.signal(core::SignalIndex{index});
            const std::vector<std::uint16_t> links =
                green_links(signal.program[detail::green_phases(signal)[action - 1]].state);
            const auto approach =
                std::ranges::find(scene.approaches, core::SignalIndex{index}, &detail::Approach::signal);
            write.add(core::SignalIndex{index}, traffic::HoldGreen{links, common(approach->own_links, links)},
                      agent_reason, scene.emergency->key);
        }
    }
    void answer_automated(const detail::View& view, std::span<const std::int32_t> actions,
                          detail::LeaseWriter& write) {
        const std::size_t first = std::size_t{sizes.signals} * (1 + sizes.phases);
        for (std::size_t at = 0; at < sizes.automated; ++at) {
            const std::uint32_t action =
                chosen(actions[sizes.signals + at], first + at * detail::automated_choices,
                       detail::automated_choices);
            if (action == 0) continue;
            const traffic::BelievedVehicle& vehicle = *scene.automated[at];
            const std::uint32_t lane = action % detail::lane_choices;
            const std::uint32_t speed = action / detail::lane_choices;
            const std::uint32_t number = view.lane_number(vehicle);
            if (lane == 1) write.add(vehicle.key, traffic::HoldLane{}, agent_reason, scene.emergency->key);
            if (lane > 1)
                write.add(vehicle.key, traffic::ChangeLane{lane == 2 ? number - 1 : number + 1}, agent_reason,
                          scene.emergency->key);
            if (speed > 0)
                write.add(vehicle.key,
                          traffic::DriveAt{core::MetresPerSecond(detail::asked_shares[speed - 1] *
                                                                 view.allowed_speed(vehicle).value)},
                          agent_reason, scene.emergency->key);
        }
    }
    void answer_way(std::int32_t answered, detail::LeaseWriter& write) {
        const std::uint32_t action = chosen(answered, mask.size() - (1 + sizes.ways), 1 + sizes.ways);
        if (action == 0) return;
        write.add(scene.emergency->key, traffic::TakeRoute{scene.ways[action - 1].edges}, agent_reason,
                  scene.emergency->key);
    }
};

Agent::Agent(const PolicyContext& context, const python::Channel& channel, AgentScore& score,
             std::function<void(python::Bell)> left, std::uint32_t ways)
    : state_(std::make_unique<State>(context, channel, score, std::move(left), ways)) {}

Agent::~Agent() = default;

void Agent::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    State& state = *state_;
    if (state.ways) state.ways->see(belief);
    if (!state.score.any_departed) {
        state.score = {};
        return;
    }
    const detail::View view(state.context.network, belief);
    const std::vector<traffic::BelievedVehicle> emergency = view.emergency_vehicles();
    state.look(view, emergency);
    state.ask(view);
    const std::span<const std::int32_t> actions = state.answer.read<std::int32_t>(0);
    const std::size_t wanted = state.sizes.signals + state.sizes.automated + (state.ways ? 1 : 0);
    if (actions.size() != wanted)
        throw python::PartError(
            fmt::format("an environment answered {} actions instead of {}", actions.size(), wanted));
    detail::LeaseWriter write("agent", state.context.period, belief.time, leases);
    state.answer_signals(actions, write);
    state.answer_automated(view, actions, write);
    if (state.ways) state.answer_way(actions.back(), write);
}

}  // namespace clearway::policy
