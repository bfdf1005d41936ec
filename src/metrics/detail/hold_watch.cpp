#include "metrics/detail/hold_watch.hpp"

#include <algorithm>
#include <cassert>
#include <string>

#include "traffic/signal.hpp"

namespace clearway::metrics::detail {
namespace {

bool any_green(const std::string& state, const std::vector<std::uint16_t>& links) {
    return std::ranges::any_of(links, [&](std::uint16_t link) { return traffic::is_green_for(state, link); });
}

}  // namespace

HoldWatch::HoldWatch(const RoadLayout& layout) : layout_(layout), holds_(layout.signals.size()) {}

void HoldWatch::step(const truth::Snapshot& snapshot, std::span<const traffic::Lease> leases) {
    const double now_s = snapshot.time.value;
    const double before_s = last_s_ < 0.0 ? now_s : last_s_;
    assert(now_s >= before_s);
    last_s_ = now_s;
    for (std::size_t signal = 0; signal < holds_.size(); ++signal) {
        Hold& hold = holds_[signal];
        if (hold.until_s > before_s && signal < snapshot.signals.state.size() &&
            any_green(snapshot.signals.state[signal], hold.links))
            hold.held_s += std::min(now_s, hold.until_s) - before_s;
    }
    for (const traffic::Lease& lease : leases) {
        const auto* const signal = std::get_if<core::SignalIndex>(&lease.target);
        const auto* const green = std::get_if<traffic::HoldGreen>(&lease.action);
        if (signal == nullptr || green == nullptr || signal->value >= holds_.size()) continue;
        Hold& hold = holds_[signal->value];
        if (hold.until_s < now_s) ++hold.count;
        hold.until_s = std::max(hold.until_s, lease.expiry.value);
        hold.links = green->links;
    }
}

std::vector<SignalHoldRow> HoldWatch::rows() const {
    std::vector<SignalHoldRow> rows;
    for (std::size_t signal = 0; signal < holds_.size(); ++signal) {
        const Hold& hold = holds_[signal];
        if (hold.count > 0) rows.push_back({layout_.signals[signal], hold.count, hold.held_s});
    }
    return rows;
}

}  // namespace clearway::metrics::detail
