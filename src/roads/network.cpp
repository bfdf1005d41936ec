#include "roads/network.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "roads/detail/network_builder.hpp"

namespace clearway::roads {
namespace {

template <class Index, class Rows>
std::optional<Index> find_row(const Rows& rows, std::string_view id) {
    const auto found = rows.find(id);
    if (found == rows.end()) return std::nullopt;
    return Index{found->second};
}

/// A place on a lane's shape: on the segment that starts at point `segment`, `fraction` of the way along.
struct ShapePlace {
    std::size_t segment = 0;
    double fraction = 0.0;
};

double segment_length(const std::vector<Point>& shape, std::size_t segment) {
    return std::hypot(shape[segment + 1].x_m - shape[segment].x_m,
                      shape[segment + 1].y_m - shape[segment].y_m);
}

/// SUMO stretches positions so that the stated length covers the whole shape.
ShapePlace place_on_shape(const Lane& lane, core::Metres position) {
    assert(lane.shape.size() >= 2);
    const double stretch = lane.length_m > 0.0F ? lane.shape_length_m / lane.length_m : 1.0;
    double left_m = std::max(0.0, position.value * stretch);
    const std::size_t last = lane.shape.size() - 2;
    for (std::size_t segment = 0;; ++segment) {
        const double length_m = segment_length(lane.shape, segment);
        if (left_m <= length_m || segment == last) {
            return {segment, length_m > 0.0 ? std::min(1.0, left_m / length_m) : 0.0};
        }
        left_m -= length_m;
    }
}

}  // namespace

Network Network::read(const std::filesystem::path& file,
                      const std::vector<std::filesystem::path>& additional_files) {
    NetworkBuilder builder(file);
    core::stream_xml(file, builder);
    for (const std::filesystem::path& additional : additional_files) {
        builder.begin_additional(additional);
        core::stream_xml(additional, builder);
    }
    return builder.finish();
}

std::optional<core::LaneIndex> Network::find_lane(std::string_view id) const {
    return find_row<core::LaneIndex>(lane_rows_, id);
}

std::optional<core::EdgeIndex> Network::find_edge(std::string_view id) const {
    return find_row<core::EdgeIndex>(edge_rows_, id);
}

std::optional<core::SignalIndex> Network::find_signal(std::string_view id) const {
    return find_row<core::SignalIndex>(signal_rows_, id);
}

core::LaneIndex Network::lane_of(core::EdgeIndex edge, std::uint32_t number) const {
    assert(edge.exists());
    const Edge& owner = edges_[edge.value];
    return number < owner.lane_count ? core::LaneIndex{owner.first_lane + number} : core::LaneIndex::none();
}

std::span<const Connection> Network::connections_from(core::LaneIndex lane) const {
    assert(lane.exists());
    const Lane& from = lanes_[lane.value];
    return std::span(connections_).subspan(from.first_connection, from.connection_count);
}

std::span<const core::EdgeIndex> Network::successors(core::EdgeIndex edge) const {
    assert(edge.exists());
    assert(first_successor_.size() == edges_.size() + 1);
    const std::uint32_t first = first_successor_[edge.value];
    return std::span(successors_).subspan(first, first_successor_[edge.value + 1] - first);
}

Point Network::point_at(core::LaneIndex lane, core::Metres position) const {
    const std::vector<Point>& shape = lanes_[lane.value].shape;
    const auto [segment, fraction] = place_on_shape(lanes_[lane.value], position);
    const Point& start = shape[segment];
    const Point& end = shape[segment + 1];
    return {static_cast<float>(start.x_m + fraction * (end.x_m - start.x_m)),
            static_cast<float>(start.y_m + fraction * (end.y_m - start.y_m))};
}

double Network::heading_at(core::LaneIndex lane, core::Metres position) const {
    const std::vector<Point>& shape = lanes_[lane.value].shape;
    const std::size_t segment = place_on_shape(lanes_[lane.value], position).segment;
    return std::atan2(shape[segment + 1].y_m - shape[segment].y_m,
                      shape[segment + 1].x_m - shape[segment].x_m);
}

}  // namespace clearway::roads
