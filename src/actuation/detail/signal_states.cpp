#include "actuation/detail/signal_states.hpp"

#include <algorithm>
#include <cassert>

#include "traffic/signal.hpp"

namespace clearway::actuation::detail {
namespace {

bool is_foe_of_any(const roads::Signal& signal, std::size_t link, const Links& links) {
    return std::ranges::any_of(links, [&](std::uint16_t other) { return are_foes(signal, link, other); });
}

bool serves_all(const std::string& state, const Links& links) {
    return std::ranges::all_of(links, [&](std::uint16_t link) { return traffic::is_green_for(state, link); });
}

}  // namespace

bool are_foes(const roads::Signal& signal, std::size_t left, std::size_t right) {
    assert(left < signal.foes.size() && right < signal.foes.size());
    return signal.foes[left][right] || signal.foes[right][left];
}

std::string hold_state(const roads::Signal& signal, const std::string& shown, const Links& links) {
    assert(shown.size() >= signal.links.size() && std::ranges::is_sorted(links));
    std::string state(shown.size(), 'r');
    const auto add_green = [&](const std::string& from, const Links& kept) {
        for (std::size_t link = 0; link < from.size() && link < signal.links.size(); ++link) {
            const bool is_known = !signal.links[link].empty();
            const bool begins_to_walk = signal.crossings[link] && !traffic::is_green(shown[link]);
            if (is_known && !begins_to_walk && traffic::is_green(from[link]) &&
                !is_foe_of_any(signal, link, kept))
                state[link] = from[link];
        }
    };
    const auto best = best_phase(signal, links);
    const std::string none;
    const std::string& phase = best ? signal.program[*best].state : none;
    add_green(phase, links);
    Links granted = green_links(state);
    granted.insert(granted.end(), links.begin(), links.end());
    add_green(shown, granted);
    const bool phase_serves_all = serves_all(phase, links);
    Links earlier;
    for (const std::uint16_t link : links) {
        state[link] = 'G';
        if (is_foe_of_any(signal, link, links)) {
            if (phase_serves_all)
                state[link] = phase[link];
            else if (is_foe_of_any(signal, link, earlier))
                state[link] = 'g';
        }
        earlier.push_back(link);
    }
    return state;
}

Links green_links(const std::string& state) {
    Links links;
    for (std::size_t link = 0; link < state.size(); ++link) {
        if (traffic::is_green(state[link])) links.push_back(static_cast<std::uint16_t>(link));
    }
    return links;
}

Links losing_links(const std::string& shown, const std::string& target) {
    Links links;
    for (const std::uint16_t link : green_links(shown)) {
        if (!traffic::is_green_for(target, link)) links.push_back(link);
    }
    return links;
}

bool serves_any(const std::string& state, const Links& links) {
    return std::ranges::any_of(links, [&](std::uint16_t link) { return traffic::is_green_for(state, link); });
}

std::optional<std::uint32_t> green_phase(const roads::Signal& signal, const std::string& state) {
    const bool is_green_phase =
        std::ranges::any_of(state, traffic::is_green) && std::ranges::none_of(state, traffic::is_yellow);
    if (!is_green_phase || std::ranges::count(signal.program, state, &roads::Phase::state) != 1)
        return std::nullopt;
    const auto shown = std::ranges::find(signal.program, state, &roads::Phase::state);
    return static_cast<std::uint32_t>(shown - signal.program.begin());
}

double least_green_s(const roads::Signal& signal, std::uint16_t link, std::optional<std::uint32_t> phase) {
    assert(!phase || *phase < signal.program.size());
    if (phase) return signal.program[*phase].least_s;
    std::optional<double> shortest_s;
    for (const roads::Phase& row : signal.program) {
        if (traffic::is_green_for(row.state, link))
            shortest_s = std::min(shortest_s.value_or(row.least_s), row.least_s);
    }
    return shortest_s.value_or(0.0);
}

bool conflict(const roads::Signal& signal, const Links& left, const Links& right) {
    return std::ranges::any_of(left, [&](std::uint16_t link) { return is_foe_of_any(signal, link, right); });
}

std::optional<std::uint32_t> best_phase(const roads::Signal& signal, const Links& links) {
    std::optional<std::uint32_t> best;
    long most = 0;
    for (std::uint32_t row = 0; row < signal.program.size(); ++row) {
        const std::string& state = signal.program[row].state;
        if (std::ranges::any_of(state, traffic::is_yellow)) continue;
        const long served = std::ranges::count_if(
            links, [&](std::uint16_t link) { return traffic::is_green_for(state, link); });
        if (served > most) {
            most = served;
            best = row;
        }
    }
    return best;
}

bool a_phase_serves(const roads::Signal& signal, const Links& links, const Links& own) {
    const auto best = best_phase(signal, links);
    if (!best) return false;
    const std::string& state = signal.program[*best].state;
    return serves_all(state, links) && std::ranges::all_of(own, [&](std::uint16_t link) {
               return state[link] == 'G' || !is_foe_of_any(signal, link, links);
           });
}

}  // namespace clearway::actuation::detail
