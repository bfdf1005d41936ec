#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.hpp"
#include "core/match_rows.hpp"

namespace clearway::links {

/// How far ahead along the lane the next vehicle is looked for, m.
inline constexpr float next_ahead_horizon_m = 100.0F;

/// Vehicles in the order of their lanes, to find the next one ahead in a lane. Keeps its buffer.
class LaneOrder {
  public:
    void clear() { places_.clear(); }
    /// A vehicle without a lane is nobody's next and has none.
    void add(core::VehicleIndex row, core::LaneIndex lane, float lane_position_m);
    /// Call after the last `add`.
    void sort();

    /// Row of the nearest vehicle further ahead on the lane, at most `next_ahead_horizon_m` along it;
    /// `core::no_row` if there is none. A vehicle at the same position is not ahead. O(log vehicles).
    core::VehicleIndex next_ahead(core::LaneIndex lane, float lane_position_m) const;

  private:
    struct Place {
        core::LaneIndex lane;
        float position_m = 0.0F;
        core::VehicleIndex row = 0;
    };
    std::vector<Place> places_;
};

/// The grid on which distances between believed and true places are counted: bins of 0.1 m below 200 m, of
/// 1 m below 2,000 m, and one for everything above.
struct PlaceGrid {
    static constexpr std::uint32_t size = 2000 + 1800 + 1;
    /// `error_m` is not negative; not checked.
    static std::uint32_t bin_of(double error_m);
    /// The smallest error of a bin, m; for `size`, the end of the grid, that of the last bin: it has no
    /// width.
    static double lower_edge_m(std::uint32_t bin);
};

/// Place errors, counted on the grid. Integers, so the order in which runs are added does not matter.
struct PlaceErrors {
    struct Bin {
        std::uint32_t bin = 0;  ///< On PlaceGrid.
        std::uint64_t vehicles = 0;
        bool operator==(const Bin&) const = default;
    };
    std::vector<Bin> bins;  ///< Non-empty ones, ascending.

    std::uint64_t vehicles() const;
    /// Adds all counts; linear in the bins of both.
    void add(const PlaceErrors& other);
    bool operator==(const PlaceErrors&) const = default;
};

/// Counts errors one by one. O(1) each; allocates at the first one.
class PlaceHistogram {
  public:
    void add(double error_m);
    PlaceErrors errors() const;

  private:
    std::vector<std::uint64_t> counts_;  ///< By bin; empty until the first error.
};

/// The error that a share of the vehicles does not exceed, m, linear within a bin; empty without vehicles.
/// Errors above 2,000 m count as 2,000 m.
std::optional<double> quantile_m(const PlaceErrors& errors, double share);

}  // namespace clearway::links
