#include "policy/corridor.hpp"

#include <string>
#include <tuple>

namespace clearway::policy {
namespace {

template <class Part, class... Config>
Part part(const char* name, const PolicyContext& context, const core::Settings& settings) {
    std::tuple<Config...> config;
    return std::apply(
        [&](auto&... numbers) {
            core::set_all(core::settings_of(settings, name), std::string(name) + ".", numbers...);
            return Part(context, numbers...);
        },
        config);
}

}  // namespace

Corridor::Corridor(const PolicyContext& context, const core::Settings& settings)
    : preempt_signals_(part<PreemptSignals, PreemptSignalsConfig, RequestMemorySettings>("preempt_signals",
                                                                                         context, settings)),
      recover_signals_(part<RecoverSignals, RecoverSignalsConfig>("recover_signals", context, settings)),
      clear_lane_(part<ClearLane, ClearLaneConfig>("clear_lane", context, settings)),
      give_way_(part<GiveWay, GiveWayConfig>("give_way", context, settings)) {}

void Corridor::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    preempt_signals_.act(belief, leases);
    recover_signals_.act(belief, leases);
    clear_lane_.act(belief, leases);
    give_way_.act(belief, leases);
}

}  // namespace clearway::policy
