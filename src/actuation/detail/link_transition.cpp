#include "actuation/detail/link_transition.hpp"

#include <algorithm>
#include <cassert>

#include "actuation/detail/lease_queue.hpp"
#include "traffic/signal.hpp"

namespace clearway::actuation::detail {

void LinkTransition::begin(const std::string& shown, const std::string& target, const Links& gaining,
                           core::Seconds now) {
    assert(shown.size() == target.size());
    assert(target.size() >= signal_.links.size());
    target_ = target;
    gaining_ = gaining;
    since_ = now;
    yields_.resize(target.size(), false);
    for (std::size_t link = 0; link < target.size(); ++link)
        yields_[link] = target[link] == 'g' && (shown[link] == 'G' || (shown[link] == 'g' && yields_[link]));
}

bool LinkTransition::keeps(std::uint16_t link) const {
    assert(link < target_.size() && link < yields_.size());
    return traffic::is_green(target_[link]) && !yields_[link];
}

bool LinkTransition::is_yellow_over(std::uint16_t link, const TransitionContext& around) const {
    const double own_s = link < link_count() ? around.duties.clearance.yellow_s(link) : 0.0;
    return around.duties.history.yellow_s(link, around.now) >=
           std::max(around.timing.yellow_s, own_s) - time_tolerance_s;
}

/// For how long a link could have been green if the junction had been clear, s; negative while it must not.
double LinkTransition::open_for_s(std::uint16_t link, const std::string& shown,
                                  const TransitionContext& around) const {
    const double since_s = (around.now - since_).value;
    double open_s = since_s;
    for (std::uint16_t other = 0; other < link_count(); ++other) {
        if (keeps(other) || !are_foes(signal_, link, other)) continue;
        if (yields_[other])
            open_s = std::min(open_s, since_s - around.timing.all_red_s);
        else if (!traffic::is_red(shown[other]))
            return -around.duties.clearance.red_s(other, link) - 1.0;
        else
            open_s = std::min(open_s, around.duties.history.red_s(other, around.now) -
                                          around.duties.clearance.red_s(other, link));
    }
    return open_s;
}

bool LinkTransition::may_open(std::uint16_t link, const std::string& shown,
                              const TransitionContext& around) const {
    const double open_s = open_for_s(link, shown, around) + time_tolerance_s;
    if (open_s < 0.0) return false;
    bool has_vehicle = false;
    bool has_pedestrian = false;
    for (std::uint16_t other = 0; other < link_count(); ++other) {
        if (keeps(other) || !are_foes(signal_, link, other)) continue;
        has_vehicle = has_vehicle || around.has_vehicle(other);
        has_pedestrian = has_pedestrian || (is_crossing(other) && around.has_pedestrian(other));
    }
    const double vehicles_s = is_crossing(link) ? around.timing.walking_s : around.timing.clearing_s;
    return (!has_vehicle || open_s >= vehicles_s) && (!has_pedestrian || open_s >= around.timing.walking_s);
}

char LinkTransition::next_letter(std::uint16_t link, const std::string& shown,
                                 const TransitionContext& around) const {
    const char now = shown[link];
    const char then = target_[link];
    if (traffic::is_yellow(now)) return is_yellow_over(link, around) ? 'r' : now;
    if (!traffic::is_green(then)) return traffic::is_green(now) && !is_crossing(link) ? 'y' : then;
    const bool opens = !traffic::is_green(now) || (now == 'g' && then == 'G');
    if (!opens) return then;
    // A link that was yellow a moment ago is seen red before it is green again.
    const bool rested = traffic::is_green(now) || around.duties.history.red_s(link, around.now) > 0.0;
    return rested && may_open(link, shown, around) ? then : now;
}

std::string LinkTransition::next_state(const std::string& shown, const TransitionContext& around) const {
    assert(shown.size() == target_.size());
    assert((around.now - since_).value < 600.0 && "a transition ends");
    std::string state = shown;
    for (std::size_t link = 0; link < shown.size(); ++link)
        state[link] = next_letter(static_cast<std::uint16_t>(link), shown, around);
    return state;
}

bool LinkTransition::is_over(const std::string& shown, const TransitionContext& around) const {
    return shown == target_ && std::ranges::all_of(gaining_, [&](std::uint16_t link) {
               return traffic::is_green(shown[link]) || may_open(link, shown, around);
           });
}

}  // namespace clearway::actuation::detail
