#pragma once

#include <string>
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

constexpr bool is_yellow(char letter) {
    return letter == 'y' || letter == 'Y';
}

/// Neither green nor yellow.
constexpr bool is_red(char letter) {
    return !is_green(letter) && !is_yellow(letter);
}

}  // namespace clearway::traffic
