#include "view/run_stream.hpp"

#include "core/units.hpp"

namespace clearway::view {
namespace {

bool is_due(const std::optional<double>& last_s, double period_s, double now_s) {
    return !last_s || now_s >= *last_s + period_s - core::clock_tolerance_s;
}

}  // namespace

void RunStream::step(const trace::RecordedStep& step, std::string& stream) {
    builder_.look(step);
    const double now_s = step.snapshot->time.value;
    if (!is_due(last_s_, config_.period_s, now_s)) return;
    const Frame& frame = builder_.frame(step);
    if (const Names names = builder_.take_names(); !names.empty()) FrameEncoder::encode(names, stream);
    if (is_due(last_key_s_, config_.key_period_s, now_s)) {
        encoder_.encode_key(frame, stream);
        last_key_s_ = now_s;
    } else {
        encoder_.encode_delta(frame, stream);
    }
    last_s_ = now_s;
    ++frames_;
}

}  // namespace clearway::view
