#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "graph/proximity.hpp"
#include "metrics/true_links.hpp"
#include "trace/recording.hpp"
#include "view/detail/leases_in_force.hpp"
#include "view/drawing.hpp"
#include "view/frame.hpp"
#include "view/stream_config.hpp"

namespace clearway::view {

/// Makes frames of the steps of a run, recorded or happening. Like a recording it only observes: it sees the
/// truth, and nothing that makes decisions sees its frames. One thread.
class FrameBuilder {
  public:
    /// Vehicles outside `area` are left out, but for emergency vehicles; an empty one shows everything.
    FrameBuilder(const Origin& origin, const graph::LinkRules& rules, Area area = {})
        : origin_(origin), area_(std::move(area)), true_links_(rules) {}

    /// Call it for every step, in order of time.
    void look(const trace::RecordedStep& step);
    /// The frame of the step that was just looked at, with the marks since the frame before. Valid until the
    /// next call.
    const Frame& frame(const trace::RecordedStep& step);
    /// Names that the frames so far use and that were not taken before.
    Names take_names();

  private:
    struct LinkedPair {
        core::VehicleKey one, other;
    };
    Slot slot_of(core::VehicleKey key, const traffic::Roster& roster);
    std::uint32_t text_of(const std::string& text);
    std::uint32_t way_of(core::RouteIndex route, const traffic::Roster& roster);
    std::uint32_t considered_way_of(core::VehicleKey vehicle, const std::vector<core::EdgeIndex>& edges);
    std::uint32_t name_way(std::span<const core::EdgeIndex> edges);
    std::vector<LinkedPair>& links(Layer layer) { return links_[static_cast<std::size_t>(layer)]; }
    bool shows(double x_m, double y_m) const { return !area_ || area_(x_m, y_m); }

    void take_links(const trace::RecordedStep& step);
    void take_observed_links(const traffic::Observation& observation);
    void take_believed_links(const traffic::BelievedGraph& belief);
    void take_known_blocks(const traffic::Observation& observation);
    void take_ghosts(const trace::RecordedStep& step);
    void mark(MarkKind kind, double time_s, std::uint32_t vehicle, std::uint32_t other = 0);
    void mark_events(const trace::RecordedStep& step);
    void mark_requests(const trace::RecordedStep& step);
    void draw_vehicles(const trace::RecordedStep& step);
    void draw_ways(const trace::RecordedStep& step);
    void draw_leases(const trace::RecordedStep& step);
    std::vector<std::uint32_t> targets_of(const traffic::Target& target, const trace::RecordedStep& step);
    /// Keeps the links whose ends are drawn.
    void draw_links();
    /// Number of a vehicle that the frame draws, as itself or as a ghost.
    std::optional<Slot> drawn(core::VehicleKey key) const;

    Origin origin_;
    Area area_;
    metrics::TrueLinks true_links_;
    graph::ProximityBuilder proximity_;
    detail::LeasesInForce leases_;
    std::unordered_map<core::VehicleKey, Slot> slots_;
    std::unordered_map<std::string, std::uint32_t> texts_;
    std::unordered_map<std::uint32_t, std::uint32_t> ways_;  ///< Their numbers, by core::RouteIndex.
    struct ConsideredWay {
        std::vector<core::EdgeIndex> edges;
        std::uint32_t number = 0;
    };
    std::unordered_map<core::VehicleKey, ConsideredWay> considered_;  ///< The newest.
    std::uint32_t way_count_ = 0;
    Names new_names_;
    std::vector<core::VehicleKey> dark_;  ///< Ascending.
    std::array<std::vector<LinkedPair>, layers> links_;
    bool is_shown_ = false;  ///< Whether the marks of `frame_` were shown.
    Frame frame_;
};

}  // namespace clearway::view
