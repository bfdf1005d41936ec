#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::graph {

/// Which pairs of classes may be linked (dissertation 4.1). Human and human never are: human drivers are
/// passive.
struct LinkRules {
    double radius_m =
        50.0;  ///< Link when the distance is below this; (0, 1000]. 50 m assumed: the source states none.
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

/// Positions and classes, one row a vehicle.
struct Places {
    std::span<const float> x_m;
    std::span<const float> y_m;
    std::span<const traffic::VehicleClass> vehicle_class;
};

/// Builds proximity graphs with a sorted uniform grid: O(n + pairs that are near, whatever their class),
/// however far apart the vehicles lie. Distance is Euclidean: equation (1) of the dissertation *corrected*
/// (it prints a minus sign), in single precision; a pair is near when that distance is below the radius.
/// Keeps its buffers: no allocation once they have grown. One builder, one thread. A k-d tree (nanoflann) was
/// 4 to 11 times slower; a plain grid over the bounding box pays for one far outlier with its area.
class ProximityBuilder {
  public:
    /// How pairs are compared. Both give the same graph, bit for bit; `scalar` is for machines without AVX2
    /// and for the test that says so.
    enum class Kernel : std::uint8_t { fastest_here, scalar };
    explicit ProximityBuilder(Kernel kernel = Kernel::fastest_here);

    /// Links allowed by `rules`. Throws std::invalid_argument for a position that is no finite number,
    /// columns of different lengths, or a radius outside (0, 1000].
    void build(const Places& places, const LinkRules& rules, ProximityGraph& graph);
    /// All pairs within `radius_m`, whatever their class. Throws likewise.
    void build_all_pairs(const Places& places, double radius_m, ProximityGraph& graph);

  private:
    /// By class of one end, bit c: a link to class c is allowed.
    using AllowedClasses = std::array<std::uint32_t, traffic::vehicle_classes.size()>;

    void build_with(const Places& places, double radius_m, const AllowedClasses& allowed,
                    ProximityGraph& graph);
    void find_cells(const Places& places, double radius_m);
    void sort_by_cell();
    void copy_in_cell_order(const Places& places);
    void collect_links(double radius_m, const AllowedClasses& allowed);
    void write_rows(ProximityGraph& graph);

    Kernel kernel_;
    std::uint64_t columns_ = 0;  ///< Of the grid, a margin of one cell on each side included.
    std::uint64_t last_cell_ = 0;
    std::vector<std::uint64_t> cell_;        ///< Sorted, once `sort_by_cell` is done.
    std::vector<core::VehicleIndex> order_;  ///< Vehicles by cell, then by row.
    std::vector<std::uint64_t> spare_cell_;  ///< The other side of each pass of sorting.
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
