#pragma once

#include <functional>
#include <string>
#include <vector>

#include "actuation/detail/signal_states.hpp"
#include "actuation/detail/signal_timing.hpp"
#include "core/units.hpp"
#include "roads/network.hpp"

namespace clearway::actuation::detail {

/// What a transition depends on in one step.
struct TransitionContext {
    core::Seconds now;
    const SignalTiming& timing;
    const SignalDuties& duties;
    /// Whether anybody is on a way of this link, in a vehicle or on foot.
    const std::function<bool(std::uint16_t)>& has_vehicle;
    const std::function<bool(std::uint16_t)>& has_pedestrian;
};

/// The transition of a signal from what it shows to a target, in which each link ends, waits and opens by
/// itself: a yellow lasts as long as its link needs, and a link opens as soon as every link that conflicts
/// with it has been red for as long as both together need and their ways are clear, or have been waited for
/// long enough. Links that wait for others hold nobody up. Links that must yield from now on show it at once,
/// `all_red_s` before those open to which they yield.
class LinkTransition {
  public:
    /// The signal outlives the object.
    explicit LinkTransition(const roads::Signal& signal) : signal_(signal) {}

    /// Begins a transition, or turns one that is not over to another target. `gaining`: links that must be
    /// clear of all that conflicts with them before it is over.
    void begin(const std::string& shown, const std::string& target, const Links& gaining, core::Seconds now);
    /// Call when it is over: the next one starts from what is shown then.
    void end() { yields_.assign(yields_.size(), false); }
    /// What to show now instead of `shown`.
    std::string next_state(const std::string& shown, const TransitionContext& around) const;
    /// Whether `shown` is the target and the gaining links are clear.
    bool is_over(const std::string& shown, const TransitionContext& around) const;

  private:
    std::uint16_t link_count() const { return static_cast<std::uint16_t>(signal_.links.size()); }
    bool is_crossing(std::size_t link) const {
        return link < signal_.crossings.size() && signal_.crossings[link];
    }
    /// Whether a link keeps its green and its right of way.
    bool keeps(std::uint16_t link) const;
    double open_for_s(std::uint16_t link, const std::string& shown, const TransitionContext& around) const;
    bool may_open(std::uint16_t link, const std::string& shown, const TransitionContext& around) const;
    char next_letter(std::uint16_t link, const std::string& shown, const TransitionContext& around) const;
    bool is_yellow_over(std::uint16_t link, const TransitionContext& around) const;

    const roads::Signal& signal_;
    std::string target_;
    Links gaining_;
    core::Seconds since_;
    std::vector<bool> yields_;  ///< By letter: links that had right of way and must yield from now on.
};

}  // namespace clearway::actuation::detail
