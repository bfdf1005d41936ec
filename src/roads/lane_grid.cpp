#include "roads/lane_grid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace clearway::roads {
namespace {

/// Side of a cell: a few times the reach of a usual search, so that a search reads few cells.
constexpr double cell_m = 40.0;

bool is_for_vehicles(const Network& network, const Lane& lane) {
    const Edge& edge = network.edge(lane.edge);
    const bool only_pedestrians = lane.allows_pedestrians && !lane.allows_cars && !lane.allows_emergency;
    return !edge.crossing && !edge.walking_area && !only_pedestrians;
}

/// The cell of a coordinate; those outside count to the cells at the edge.
std::uint32_t cell_at(double offset_m, std::uint32_t count) {
    return static_cast<std::uint32_t>(std::clamp(std::floor(offset_m / cell_m), 0.0, count - 1.0));
}

std::uint32_t cell_count(float low_m, float high_m) {
    assert(low_m <= high_m);
    return 1U + static_cast<std::uint32_t>(std::max(0.0, std::floor((high_m - low_m) / cell_m)));
}

}  // namespace

LaneGrid::LaneGrid(const Network& network) : network_(network) {
    constexpr float far = std::numeric_limits<float>::max();
    low_ = {far, far};
    Point high{-far, -far};
    for (std::uint32_t row = 0; row < network.lanes().size(); ++row) {
        const Lane& lane = network.lanes()[row];
        if (!is_for_vehicles(network, lane)) continue;
        float along_m = 0.0F;
        for (std::uint32_t segment = 0; segment + 1 < lane.shape.size(); ++segment) {
            pieces_.push_back({core::LaneIndex{row}, segment, along_m});
            const Point& one = lane.shape[segment];
            const Point& other = lane.shape[segment + 1];
            along_m += std::hypot(other.x_m - one.x_m, other.y_m - one.y_m);
        }
        for (const Point& point : lane.shape) {
            low_ = {std::min(low_.x_m, point.x_m), std::min(low_.y_m, point.y_m)};
            high = {std::max(high.x_m, point.x_m), std::max(high.y_m, point.y_m)};
        }
    }
    if (!pieces_.empty()) {
        columns_ = cell_count(low_.x_m, high.x_m);
        rows_ = cell_count(low_.y_m, high.y_m);
    }
    // Counts first, then fills each cell from its end.
    first_.assign(std::size_t{columns_} * rows_ + 1, 0);
    for (const Piece& piece : pieces_)
        for_each_cell(cells_of(piece), [&](std::size_t cell) { ++first_[cell]; });
    for (std::size_t cell = 1; cell < first_.size(); ++cell)
        first_[cell] += first_[cell - 1];
    in_cell_.resize(first_.back());
    for (std::size_t row = pieces_.size(); row-- > 0;) {
        for_each_cell(cells_of(pieces_[row]),
                      [&](std::size_t cell) { in_cell_[--first_[cell]] = static_cast<std::uint32_t>(row); });
    }
}

template <class Visitor>
void LaneGrid::for_each_cell(const Cells& cells, const Visitor& visit) const {
    for (std::uint32_t row = cells.first_row; row <= cells.last_row; ++row) {
        for (std::uint32_t column = cells.first_column; column <= cells.last_column; ++column)
            visit(std::size_t{row} * columns_ + column);
    }
}

LaneGrid::Cells LaneGrid::cells_of(const Point& low, const Point& high) const {
    assert(columns_ > 0 && rows_ > 0);
    return {.first_column = cell_at(low.x_m - low_.x_m, columns_),
            .last_column = cell_at(high.x_m - low_.x_m, columns_),
            .first_row = cell_at(low.y_m - low_.y_m, rows_),
            .last_row = cell_at(high.y_m - low_.y_m, rows_)};
}

LaneGrid::Cells LaneGrid::cells_of(const Piece& piece) const {
    const std::vector<Point>& shape = network_.lane(piece.lane).shape;
    const Point& one = shape[piece.segment];
    const Point& other = shape[piece.segment + 1];
    return cells_of({std::min(one.x_m, other.x_m), std::min(one.y_m, other.y_m)},
                    {std::max(one.x_m, other.x_m), std::max(one.y_m, other.y_m)});
}

LanePlace LaneGrid::nearest_on(const Piece& piece, const Point& point) const {
    const Lane& lane = network_.lane(piece.lane);
    assert(piece.segment + 1 < lane.shape.size());
    const Point& start = lane.shape[piece.segment];
    const double dx_m = lane.shape[piece.segment + 1].x_m - start.x_m;
    const double dy_m = lane.shape[piece.segment + 1].y_m - start.y_m;
    const double length_m = std::hypot(dx_m, dy_m);
    double along_m = 0.0;
    if (length_m > 0.0) {
        const double dot = (point.x_m - start.x_m) * dx_m + (point.y_m - start.y_m) * dy_m;
        along_m = std::clamp(dot / length_m, 0.0, length_m);
    }
    const double share = length_m > 0.0 ? along_m / length_m : 0.0;
    const double stretch = lane.shape_length_m > 0.0F ? lane.length_m / lane.shape_length_m : 1.0;
    return {.lane = piece.lane,
            .position_m = std::min(lane.length_m, static_cast<float>((piece.start_m + along_m) * stretch)),
            .distance_m = static_cast<float>(
                std::hypot(start.x_m + share * dx_m - point.x_m, start.y_m + share * dy_m - point.y_m)),
            .heading_rad = static_cast<float>(std::atan2(dy_m, dx_m))};
}

void LaneGrid::near(const Point& point, core::Metres reach, std::vector<LanePlace>& places) const {
    assert(reach.value >= 0.0);
    places.clear();
    if (pieces_.empty()) return;
    const auto reach_m = static_cast<float>(reach.value);
    const Cells cells =
        cells_of({point.x_m - reach_m, point.y_m - reach_m}, {point.x_m + reach_m, point.y_m + reach_m});
    for_each_cell(cells, [&](std::size_t cell) {
        for (std::uint32_t at = first_[cell]; at < first_[cell + 1]; ++at) {
            const LanePlace place = nearest_on(pieces_[in_cell_[at]], point);
            if (place.distance_m < reach_m) places.push_back(place);
        }
    });
    const auto order = [](const LanePlace& one, const LanePlace& other) {
        if (one.lane != other.lane) return one.lane.value < other.lane.value;
        if (one.distance_m != other.distance_m) return one.distance_m < other.distance_m;
        return one.position_m < other.position_m;
    };
    std::ranges::sort(places, order);
    const auto same_lane = [](const LanePlace& one, const LanePlace& other) {
        return one.lane == other.lane;
    };
    places.erase(std::unique(places.begin(), places.end(), same_lane), places.end());
}

}  // namespace clearway::roads
