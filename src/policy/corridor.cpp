#include "policy/corridor.hpp"

#include "policy/clear_lane.hpp"
#include "policy/preempt_signals.hpp"
#include "policy/recover_signals.hpp"

namespace clearway::policy {

Corridor::Corridor(const PartContext& context) {
    parts_.push_back(std::make_unique<PreemptSignals>(context));
    parts_.push_back(std::make_unique<RecoverSignals>(context));
    parts_.push_back(std::make_unique<ClearLane>(context));
}

void Corridor::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    for (const std::unique_ptr<Part>& part : parts_)
        part->act(belief, leases);
}

}  // namespace clearway::policy
