#include "actuation/detail/lease_queue.hpp"

#include <algorithm>
#include <cassert>
#include <string_view>

namespace clearway::actuation::detail {

namespace {

bool same_links(const traffic::Action& one, const traffic::Action& other) {
    const auto* const left = std::get_if<traffic::HoldGreen>(&one);
    const auto* const right = std::get_if<traffic::HoldGreen>(&other);
    return left != nullptr && right != nullptr && left->links == right->links;
}

}  // namespace

void LeaseQueue::offer(const traffic::Lease& lease, Ledger& ledger) {
    assert(*lease.policy != '\0');
    const auto same = std::ranges::find_if(held_, [&](const HeldLease& held) {
        return held.lease.beneficiary == lease.beneficiary &&
               std::string_view(held.lease.policy) == lease.policy;
    });
    LeaseCounts& counts = ledger.of(lease);
    if (same != held_.end()) {
        const bool same_kind = same->lease.action.index() == lease.action.index();
        ++(same_kind ? counts.renewed : counts.issued);
        if (!same_kind) {
            same->counted_refusals.clear();
            same->counted_act = false;
        }
        same->edge = core::EdgeIndex::none();
        same->served = same->served && same_links(same->lease.action, lease.action);
        same->lease = lease;
    } else {
        ++counts.issued;
        held_.push_back({lease, core::EdgeIndex::none(), core::EdgeIndex::none(), {}});
    }
    assert(held_.front().lease.target == lease.target);
    // Stable: at equal priority the earlier lease stays first.
    held_.sort([](const HeldLease& left, const HeldLease& right) {
        return left.lease.priority > right.lease.priority;
    });
}

void LeaseQueue::expire(core::Seconds now, Ledger& ledger) {
    std::erase_if(held_, [&](const HeldLease& held) {
        if (held.lease.expiry.value > now.value + time_tolerance_s) return false;
        ++ledger.of(held.lease).expired;
        return true;
    });
}

void LeaseQueue::refuse(HeldLease& held, traffic::Refusal reason, Ledger& ledger) {
    if (std::ranges::find(held.counted_refusals, reason) != held.counted_refusals.end()) return;
    held.counted_refusals.push_back(reason);
    ++ledger.of(held.lease).refused[reason];
}

void LeaseQueue::act(HeldLease& held, Ledger& ledger) {
    if (held.counted_act) return;
    held.counted_act = true;
    ++ledger.of(held.lease).acted;
}

void LeaseQueue::drop_all(traffic::Refusal reason, Ledger& ledger) {
    for (HeldLease& held : held_)
        refuse(held, reason, ledger);
    held_.clear();
}

void LeaseQueue::end_best(Ledger& ledger) {
    assert(!held_.empty());
    ++ledger.of(held_.front().lease).expired;
    held_.pop_front();
}

}  // namespace clearway::actuation::detail
