#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roads/network.hpp"

namespace clearway::actuation::detail {

/// Link numbers of one signal, ascending, without repetition.
using Links = std::vector<std::uint16_t>;

/// Letters to show for a hold of `links` when the signal shows `shown` now: green for them; of what does not
/// conflict with them, green for what has it in the phase of the program that serves most of them, crossings
/// left out, and then for what shows it already and does not conflict with those either. So nobody else loses
/// green without need, and the rest of a joined junction goes on. Red for all else and for links whose ways
/// are unknown. Where two of `links` conflict with each other (joined junctions), their letters come from a
/// phase that serves them all, or else the later one yields.
std::string hold_state(const roads::Signal& signal, const std::string& shown, const Links& links);

/// Yellow for the links that are green in `shown` and not in `target`, and for those that are yellow now; red
/// at once for crossings: pedestrians know no yellow.
std::string yellow_state(const roads::Signal& signal, const std::string& shown, const std::string& target);
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
/// The phase that shows `state`, if that is one phase alone and lets anybody pass without yellow.
std::optional<std::uint32_t> green_phase(const roads::Signal& signal, const std::string& state);

/// Whether a link of `left` conflicts with one of `right`.
bool conflict(const roads::Signal& signal, const Links& left, const Links& right);

/// The phase of the program that shows green for most of `links`, the earliest of equals; nothing when none
/// serves any.
std::optional<std::uint32_t> best_phase(const roads::Signal& signal, const Links& links);
/// Whether one phase of the program shows green for all of `links`, while those of them in `own` yield to
/// none.
bool a_phase_serves(const roads::Signal& signal, const Links& links, const Links& own);

}  // namespace clearway::actuation::detail
