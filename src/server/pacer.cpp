#include "server/pacer.hpp"

#include <algorithm>

#include "core/units.hpp"

namespace clearway::server {

double Pacer::slowest() const {
    return progress_.empty() ? over : *std::ranges::min_element(progress_);
}

void Pacer::step() {
    paused_ = true;
    const double now_s = slowest();
    // A run that has not passed this moment makes one step, which takes it beyond.
    if (now_s > waiting && now_s < over)
        allowed_s_ = std::max(allowed_s_, now_s + 2.0 * core::clock_tolerance_s);
}

double Pacer::allow(double passed_s) {
    const double now_s = slowest();
    if (paused_ || now_s == waiting || now_s == over) return allowed_s_;
    // Not from where the runs are: each goes beyond what is allowed by up to a step.
    const double begun_s = allowed_s_ == waiting ? now_s : allowed_s_;
    const double wanted_s = speed_ == 0.0 ? now_s + lead_s : begun_s + passed_s * speed_;
    allowed_s_ = std::max(allowed_s_, std::min(wanted_s, now_s + lead_s));
    return allowed_s_;
}

}  // namespace clearway::server
