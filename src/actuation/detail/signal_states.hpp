#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roads/network.hpp"

namespace clearway::actuation::detail {

/// Link numbers of one signal, ascending, without duplicates.
using Links = std::vector<std::uint16_t>;

/// The state for a hold of `links` when the signal shows `shown`. Green for `links`; then for links that do
/// not conflict with them and are green in the program's phase that serves most of them (but no crossing
/// turns green); then for links that are green already and conflict with none of these. So no link loses
/// green without need, and the rest of a joined junction goes on. Red for all others and for links whose ways
/// are unknown. If two of `links` conflict with each other (joined junctions), their letters come from a
/// phase that serves them all; without one, the later link yields.
std::string hold_state(const roads::Signal& signal, const std::string& shown, const Links& links);

/// Links that are green in a state, ascending.
Links green_links(const std::string& state);
/// Links that are green in `shown` and not in `target`, ascending.
Links losing_links(const std::string& shown, const std::string& target);
/// Whether any of `links` is green in a state.
bool serves_any(const std::string& state, const Links& links);
/// The phase that shows `state`, if exactly one phase does and it has green without yellow.
std::optional<std::uint32_t> green_phase(const roads::Signal& signal, const std::string& state);

/// Shortest green that the program gives a link in this phase, s. Where it is unknown which phase runs (dual
/// rings show what no single phase does): the shortest of the phases in which the link is green.
double least_green_s(const roads::Signal& signal, std::uint16_t link, std::optional<std::uint32_t> phase);

/// Whether two links conflict.
bool are_foes(const roads::Signal& signal, std::size_t left, std::size_t right);
/// Whether a link of `left` conflicts with one of `right`.
bool conflict(const roads::Signal& signal, const Links& left, const Links& right);

/// The phase of the program with green for most of `links`, the earliest of equals, among those in which no
/// link ends: a signal that goes to such a phase would show yellow for ever. Nothing when no phase serves
/// any.
std::optional<std::uint32_t> best_phase(const roads::Signal& signal, const Links& links);
/// Whether one phase of the program shows green for all of `links`, and those in `own` yield to none of them.
bool a_phase_serves(const roads::Signal& signal, const Links& links, const Links& own);

}  // namespace clearway::actuation::detail
