#include "policy/corridor.hpp"

#include <tuple>

#include "policy/clear_lane.hpp"
#include "policy/give_way.hpp"
#include "policy/preempt_signals.hpp"
#include "policy/recover_signals.hpp"

namespace clearway::policy {
namespace {

template <class Kind, class... Config>
std::unique_ptr<Policy> configured(const char* name, const PolicyContext& context,
                                   const core::Settings& settings) {
    std::tuple<Config...> config;
    return std::apply(
        [&](auto&... parts) -> std::unique_ptr<Policy> {
            core::set_all(core::settings_of(settings, name), std::string(name) + ".", parts...);
            return std::make_unique<Kind>(context, parts...);
        },
        config);
}

}  // namespace

Corridor::Corridor(const PolicyContext& context, const core::Settings& settings) {
    policies_.push_back(configured<PreemptSignals, PreemptSignalsConfig, RequestMemorySettings>(
        "preempt_signals", context, settings));
    policies_.push_back(
        configured<RecoverSignals, RecoverSignalsConfig>("recover_signals", context, settings));
    policies_.push_back(configured<ClearLane, ClearLaneConfig>("clear_lane", context, settings));
    policies_.push_back(configured<GiveWay, GiveWayConfig>("give_way", context, settings));
}

void Corridor::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    for (const std::unique_ptr<Policy>& policy : policies_)
        policy->act(belief, leases);
}

}  // namespace clearway::policy
