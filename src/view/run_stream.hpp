#pragma once

#include <optional>
#include <string>

#include "view/frame_builder.hpp"
#include "view/frame_encoder.hpp"
#include "view/stream_config.hpp"

namespace clearway::view {

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
