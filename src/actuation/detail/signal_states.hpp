#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roads/network.hpp"

namespace clearway::actuation::detail {

/// Link numbers of one signal, ascending, without repetition.
using Links = std::vector<std::uint16_t>;

/// Letters to show for a hold of `links` when the signal shows `shown` now: green for them, red for what
/// conflicts and for links whose ways are unknown (pedestrian crossings), and for the rest green where it is
/// green already, so that nobody else loses green without need. Where two of `links` conflict with each other
/// (joined junctions), their letters come from a phase of the program that serves them all, or else the later
/// one yields.
std::string hold_state(const roads::Signal& signal, const std::string& shown, const Links& links);

/// Yellow for the links that are green in `shown` and not in `target`, and for those that are yellow now.
std::string yellow_state(const std::string& shown, const std::string& target);
/// Green only for the links that are green in `shown` and in `target`.
std::string all_red_state(const std::string& shown, const std::string& target);

/// Whether any link is or would become yellow on the way from `shown` to `target`.
bool needs_yellow(const std::string& shown, const std::string& target);
/// Whether any link turns from not green to green.
bool needs_all_red(const std::string& shown, const std::string& target);

/// Links that are green in a state, ascending.
Links green_links(const std::string& state);
/// Links that are green in `shown` and not in `target`, ascending.
Links losing_links(const std::string& shown, const std::string& target);
/// Whether any of `links` is green in a state.
bool serves_any(const std::string& state, const Links& links);
/// The phase after the one that shows `state`, if that is one phase alone and lets anybody pass without
/// yellow.
std::optional<std::uint32_t> phase_after_green(const roads::Signal& signal, const std::string& state);

/// Whether a link of `left` conflicts with one of `right`.
bool conflict(const roads::Signal& signal, const Links& left, const Links& right);

/// The phase of the program that shows green for most of `links`, the earliest of equals; nothing when none
/// serves any.
std::optional<std::uint32_t> best_phase(const roads::Signal& signal, const Links& links);

}  // namespace clearway::actuation::detail
