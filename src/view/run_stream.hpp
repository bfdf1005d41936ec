#pragma once

#include <optional>
#include <string>

#include "view/frame_builder.hpp"
#include "view/frame_encoder.hpp"

namespace clearway::view {

/// How much of a run a stream holds.
struct StreamConfig {
    /// Time between frames, s; 0: one for each step. Marks keep the time of their step.
    double period_s = 0.0;
    /// A key frame at least this often, s: how far a viewer decodes to jump, or waits when frames were lost.
    double key_period_s = 5.0;
    Area area = {};
};

/// Turns the steps of a run into the blocks of a stream. One thread.
class RunStream {
  public:
    RunStream(const Origin& origin, const graph::LinkRules& rules, StreamConfig config = {})
        : config_(std::move(config)), builder_(origin, rules, config_.area) {}

    /// Appends the blocks of a step: new names, and a frame where one is due.
    void step(const trace::RecordedStep& step, std::string& stream);
    /// Only what later frames need: leases, reports and marks of before a cut.
    void skip(const trace::RecordedStep& step) { builder_.look(step); }

    std::size_t frames() const { return frames_; }

  private:
    StreamConfig config_;
    FrameBuilder builder_;
    FrameEncoder encoder_;
    std::size_t frames_ = 0;
    std::optional<double> last_s_, last_key_s_;
};

}  // namespace clearway::view
