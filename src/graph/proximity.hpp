#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::graph {

/// Which pairs of classes may be linked (dissertation 4.1). Two human drivers never are: they are passive.
struct LinkRules {
    /// Vehicles nearer than this are linked, m; (0, 1000]. 50 m is assumed: the source states no value.
    double radius_m = 50.0;
    enum class Pairs : std::uint8_t { excluded, included };
    Pairs automated_automated = Pairs::excluded;
    Pairs emergency_emergency = Pairs::excluded;

    bool allows(traffic::VehicleClass left, traffic::VehicleClass right) const;
};

/// Undirected graph in CSR form: the neighbours of row i are neighbour[first[i]] ... neighbour[first[i + 1] -
/// 1], ascending. Every link is stored from both ends.
struct ProximityGraph {
    std::vector<std::uint32_t> first;
    std::vector<core::VehicleIndex> neighbour;
    std::vector<float> distance_m;

    std::size_t vehicle_count() const { return first.empty() ? 0 : first.size() - 1; }
    std::size_t link_count() const { return neighbour.size() / 2; }
    std::span<const core::VehicleIndex> neighbours_of(core::VehicleIndex row) const {
        return std::span(neighbour).subspan(first[row], first[row + 1] - first[row]);
    }
    std::span<const float> distances_of(core::VehicleIndex row) const {
        return std::span(distance_m).subspan(first[row], first[row + 1] - first[row]);
    }
};

/// Positions and classes, one row per vehicle.
struct Places {
    std::span<const float> x_m;
    std::span<const float> y_m;
    std::span<const traffic::VehicleClass> vehicle_class;
};

/// Builds proximity graphs with a sorted uniform grid: O(n + near pairs of any class), however far apart the
/// vehicles are. Distance is Euclidean: equation (1) of the dissertation *corrected* (it prints a minus
/// sign), in single precision; a pair is near when that distance is below the radius. Keeps its buffers: no
/// allocation once they have grown. Use one builder per thread. A k-d tree (nanoflann) was 4 to 11 times
/// slower; a plain grid over the bounding box gets huge when one vehicle is far away.
class ProximityBuilder {
  public:
    /// How pairs are compared. Both give the same graph, bit for bit, which a test checks; `scalar` is for
    /// machines without AVX2.
    enum class Kernel : std::uint8_t { fastest_here, scalar };
    explicit ProximityBuilder(Kernel kernel = Kernel::fastest_here);

    /// Links allowed by `rules`. Throws std::invalid_argument for a position that is not finite, columns of
    /// different lengths, or a radius outside (0, 1070].
    void build(const Places& places, const LinkRules& rules, ProximityGraph& graph);
    /// All pairs within `radius_m`, whatever their class. Throws as `build` does.
    void build_all_pairs(const Places& places, double radius_m, ProximityGraph& graph);

  private:
    /// Indexed by the class of one end; bit c is set when a link to class c is allowed.
    using AllowedClasses = std::array<std::uint32_t, traffic::vehicle_classes.size()>;

    void build_with(const Places& places, double radius_m, const AllowedClasses& allowed,
                    ProximityGraph& graph);
    void find_cells(const Places& places, double radius_m);
    void sort_by_cell();
    void copy_in_cell_order(const Places& places);
    void collect_links(double radius_m, const AllowedClasses& allowed);
    void write_rows(ProximityGraph& graph);

    Kernel kernel_;
    std::uint64_t columns_ = 0;  ///< Columns of the grid, including a margin of one cell on each side.
    std::uint64_t last_cell_ = 0;
    std::vector<std::uint64_t> cell_;        ///< Sorted, once `sort_by_cell` is done.
    std::vector<core::VehicleIndex> order_;  ///< Vehicles by cell, then by row.
    std::vector<std::uint64_t> spare_cell_;  ///< Output buffer of a sorting pass.
    std::vector<core::VehicleIndex> spare_order_;
    std::vector<float> sorted_x_, sorted_y_;  ///< In the order of `order_`, with a margin for vector loads.
    std::vector<std::uint32_t> sorted_class_;
    std::vector<std::uint32_t> found_first_;  ///< Links found, by place in `order_`.
    std::vector<core::VehicleIndex> found_neighbour_;
    std::vector<float> found_squared_m2_;
    std::vector<std::uint32_t> place_of_;
    std::vector<std::uint32_t> next_free_;
};

}  // namespace clearway::graph
