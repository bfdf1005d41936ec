#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace clearway::traffic {

/// What every signal shows now, indexed by `core::SignalIndex`. A state holds one of SUMO's letters per link
/// (`GgyrRuosO`), or nothing where it is not known (see failures::FailureConfig::signals_known).
struct SignalStates {
    std::vector<std::string> state;
};

/// True for letters that let vehicles pass now: `G` (priority), `g` (yielding), `o`/`O` (blinking, off).
constexpr bool is_green(char letter) {
    return letter == 'G' || letter == 'g' || letter == 'o' || letter == 'O';
}

/// Whether a link is green in a state; not if the state has no letter for it.
constexpr bool is_green_for(std::string_view state, std::size_t link) {
    return link < state.size() && is_green(state[link]);
}

constexpr bool is_yellow(char letter) {
    return letter == 'y' || letter == 'Y';
}

/// Neither green nor yellow.
constexpr bool is_red(char letter) {
    return !is_green(letter) && !is_yellow(letter);
}

}  // namespace clearway::traffic
