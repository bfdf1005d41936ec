#pragma once

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

/// Builds proximity graphs with a sorted uniform grid: O(n + links). Distance is Euclidean: equation (1) of
/// the dissertation *corrected* (it prints a minus sign). Keeps its buffers: no allocation once they have
/// grown. One builder, one thread.
class ProximityBuilder {
  public:
    /// Links allowed by `rules`.
    void build(const Places& places, const LinkRules& rules, ProximityGraph& graph);
    /// All pairs within `radius_m`, whatever their class.
    void build_all_pairs(const Places& places, double radius_m, ProximityGraph& graph);

  private:
    template <class Allows>
    void build_with(const Places& places, double radius_m, const Allows& allows, ProximityGraph& graph);
    void sort_into_cells(const Places& places, double cell_m);

    std::vector<std::uint32_t> cell_start_;
    std::vector<std::uint32_t> cell_of_;
    std::vector<core::VehicleIndex> order_;
    std::vector<float> sorted_x_, sorted_y_;
    std::uint32_t columns_ = 0;
    std::uint32_t rows_ = 0;
};

}  // namespace clearway::graph
