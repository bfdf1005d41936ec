#pragma once

#include <optional>
#include <span>
#include <string>

#include "roads/network.hpp"
#include "trace/recording.hpp"
#include "traffic/incident.hpp"
#include "view/run_view.hpp"
#include "view/stream_config.hpp"

namespace clearway::view {

/// The words about a run that a page shows (`RunView::about`), and what blocks its roads. `title` is that of
/// the condition; empty: its name.
std::string about(const experiment::RunKey& key, const experiment::ConditionSpec& condition,
                  const roads::Network& network, std::span<const traffic::Incident> incidents,
                  const std::string& title = "");

/// Times of a recording that are shown, s; without them from its first, to its last step.
struct Window {
    std::optional<double> from_s, to_s;
};

/// Reads a recording to its end. `network` is that of the recording; this is not checked here. Throws as
/// trace::RecordingReader, and core::InputError when no step lies in the window.
RunView view_of(trace::RecordingReader& recording, const roads::Network& network, const Window& window,
                StreamConfig config, const std::string& title = "");

}  // namespace clearway::view
