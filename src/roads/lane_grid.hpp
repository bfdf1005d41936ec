#pragma once

#include <cstdint>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "roads/network.hpp"

namespace clearway::roads {

/// The place of a lane's middle line that is nearest to a point.
struct LanePlace {
    core::LaneIndex lane;
    float position_m = 0.0F;   ///< From the start of the lane, as SUMO counts it.
    float distance_m = 0.0F;   ///< From the point.
    float heading_rad = 0.0F;  ///< Of the lane there, counter-clockwise from the x axis.
};

/// Finds lanes near a point: the pieces of all middle lines, sorted into square cells. Lanes for vehicles
/// only: without crossings, walking areas and lanes that only pedestrians may use. Immutable after
/// construction, so threads may share it; the network outlives it.
class LaneGrid {
  public:
    explicit LaneGrid(const Network& network);

    /// Every lane nearer than `reach` with its nearest place, each once, by lane; `places` is reused. Cost:
    /// linear in the pieces of the cells within reach.
    void near(const Point& point, core::Metres reach, std::vector<LanePlace>& places) const;

  private:
    /// One segment of a lane's shape.
    struct Piece {
        core::LaneIndex lane;
        std::uint32_t segment = 0;
        float start_m = 0.0F;  ///< Along the shape.
    };
    /// Cells that a box covers, both ends included.
    struct Cells {
        std::uint32_t first_column = 0, last_column = 0, first_row = 0, last_row = 0;
    };

    Cells cells_of(const Point& low, const Point& high) const;
    Cells cells_of(const Piece& piece) const;
    LanePlace nearest_on(const Piece& piece, const Point& point) const;
    template <class Visitor>
    void for_each_cell(const Cells& cells, const Visitor& visit) const;

    const Network& network_;
    Point low_;
    std::uint32_t columns_ = 1, rows_ = 1;
    std::vector<Piece> pieces_;
    std::vector<std::uint32_t> first_;    ///< By cell: its first entry in `in_cell_`; cells + 1 numbers.
    std::vector<std::uint32_t> in_cell_;  ///< Rows of `pieces_`.
};

}  // namespace clearway::roads
