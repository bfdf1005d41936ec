#include "roads/signal_numbers.hpp"

#include <algorithm>
#include <cassert>
#include <map>
#include <string>

#include "core/number.hpp"
#include "traffic/signal.hpp"

namespace clearway::roads {
namespace {

/// The colours of a link through the program; what links of one group have in common.
std::string colours(const Signal& signal, std::size_t link) {
    std::string text(1, signal.crossings[link] ? 'c' : 'v');
    for (const Phase& phase : signal.program) {
        const char letter = link < phase.state.size() ? phase.state[link] : 'r';
        text += traffic::is_green(letter) ? 'g' : traffic::is_yellow(letter) ? 'y' : 'r';
    }
    return text;
}

/// The number in a phase's name; 0 for another name.
std::uint32_t number_in(const std::string& name) {
    return core::number_from<std::uint32_t>(name).value_or(0);
}

/// Phases that run side by side and are named by numbers, as in SUMO's controller NEMA.
bool has_numbered_phases(const Signal& signal) {
    return !signal.program.empty() && std::ranges::all_of(signal.program, [](const Phase& phase) {
        return (phase.yellow_s > 0.0 || phase.red_s > 0.0) && number_in(phase.name) > 0;
    });
}

/// Of the phases that serve a link the one with the lowest number; 0 if none does.
std::uint32_t named_phase(const Signal& signal, std::size_t link) {
    std::uint32_t least = 0;
    for (const Phase& phase : signal.program) {
        if (link >= phase.state.size() || !traffic::is_green(phase.state[link])) continue;
        const std::uint32_t number = number_in(phase.name);
        least = least == 0 ? number : std::min(least, number);
    }
    return least;
}

template <class Key>
std::uint32_t number_of(std::map<Key, std::uint32_t>& numbers, const Key& key) {
    return numbers.try_emplace(key, static_cast<std::uint32_t>(numbers.size() + 1)).first->second;
}

}  // namespace

SignalNumbers signal_numbers(const Network& network, const Signal& signal) {
    const std::size_t count = signal.links.size();
    assert(signal.crossings.size() == count);
    SignalNumbers numbers{std::vector<std::uint32_t>(count), std::vector<std::uint32_t>(count)};
    const bool is_numbered = has_numbered_phases(signal);
    std::map<std::string, std::uint32_t> phases;
    std::map<std::uint32_t, std::uint32_t> approaches;
    for (std::size_t link = 0; link < count; ++link) {
        if (signal.links[link].empty()) continue;
        numbers.phase[link] =
            is_numbered ? named_phase(signal, link) : number_of(phases, colours(signal, link));
        if (signal.crossings[link]) continue;
        numbers.approach[link] =
            number_of(approaches, network.lane(signal.links[link].front().from).edge.value);
    }
    return numbers;
}

}  // namespace clearway::roads
