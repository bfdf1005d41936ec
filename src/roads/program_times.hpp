#pragma once

#include <optional>
#include <vector>

#include "roads/network.hpp"

namespace clearway::roads {

/// What a signal's own program gives each of its links, by link, s. Nothing where the program does not say.
/// Where it gives different times in one cycle, the shortest.
struct ProgramTimes {
    std::vector<std::optional<double>> yellow_s;
    /// From the end of yellow (pedestrians: of green) until any link gets green, unless links with which that
    /// link conflicts have green in between: then the time serves other traffic and is not a clearance.
    /// 0 where a link opens during the yellow already.
    std::vector<std::optional<double>> red_s;
    /// The program's own least green (`minDur`), else `assumed_least_green_s`, for people on foot
    /// `assumed_walk_s`; never more than the shortest green that the program itself shows.
    std::vector<std::optional<double>> green_s;
};
/// Usual where a program states no minimum: NTCIP 1202 v03, preemptMinimumGreen, is set by the city and 5 s
/// is usual; a walk is never shorter than 4 s (MUTCD 2009, 4E.06).
inline constexpr double assumed_least_green_s = 5.0;
inline constexpr double assumed_walk_s = 4.0;

/// By playing the program for two cycles, second by second where it changes. The controller NEMA has phases
/// that run side by side, not one after the other; there, yellow and red are those of the phases that serve
/// the link. It is apart from what the transitions of holds are made of, because it is what they are audited
/// against.
ProgramTimes program_times(const Signal& signal);

}  // namespace clearway::roads
