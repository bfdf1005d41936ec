#pragma once

#include <span>
#include <vector>

#include "roads/network.hpp"
#include "sumo/drawing.hpp"
#include "trace/recording.hpp"
#include "truth/snapshot.hpp"

namespace clearway::loop {

/// Draws what a person who watches a run should see. Like a recording it only observes: it sees the truth,
/// and nothing that makes decisions sees its drawing.
///
/// | what | shown as |
/// |---|---|
/// | emergency, automated, human vehicles | red, blue, yellow |
/// | those that did not report in the latest round (dark) | wine red, slate, grey |
/// | believed links nearest to an emergency vehicle | green lines; orange if an end is dark |
/// | signals that a policy holds | a magenta ring |
///
/// The view follows one emergency vehicle until it arrives, then another.
class Illustrator {
  public:
    /// `network` outlives the object.
    explicit Illustrator(const roads::Network& network)
        : network_(network), held_(network.signals().size(), false) {}

    /// Call it for every step, in order of time. The drawing is valid until the next call.
    const sumo::Drawing& draw(const trace::RecordedStep& step);

  private:
    struct Link {
        core::VehicleKey one;
        core::VehicleKey other;
    };

    bool is_dark(core::VehicleKey vehicle) const;
    void take_links(const traffic::BelievedGraph& belief);
    void take_held(std::span<const traffic::Command> commands);

    void colour_vehicles(const truth::Snapshot& snapshot);
    void draw_held();
    void draw_links(const truth::Snapshot& snapshot, const traffic::Roster& roster);
    void choose_followed(const truth::Snapshot& snapshot);

    const roads::Network& network_;
    std::vector<core::VehicleKey> dark_;  ///< Ascending.
    std::vector<Link> links_;             ///< Of the last decision.
    std::vector<bool> held_;              ///< By signal.
    sumo::Drawing drawing_;
};

/// Points of a closed ring around the stop lines of a signal; empty for a signal without stop lines.
std::vector<sumo::Spot> ring_around(const roads::Signal& signal, const roads::Network& network);

}  // namespace clearway::loop
