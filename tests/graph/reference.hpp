#pragma once

#include <cmath>
#include <vector>

#include "graph/proximity.hpp"

namespace clearway::graph {

/// Owns what `Places` views.
struct Crowd {
    std::vector<float> x_m;
    std::vector<float> y_m;
    std::vector<traffic::VehicleClass> vehicle_class;

    Places places() const { return {x_m, y_m, vehicle_class}; }
    std::size_t size() const { return x_m.size(); }
    void add(float x, float y, traffic::VehicleClass vehicle) {
        x_m.push_back(x);
        y_m.push_back(y);
        vehicle_class.push_back(vehicle);
    }
};

/// The definition, pair by pair: O(n^2).
template <class Allows>
ProximityGraph reference_graph(const Crowd& crowd, float radius_m, const Allows& allows) {
    ProximityGraph graph;
    graph.first.push_back(0);
    for (core::VehicleIndex row = 0; row < crowd.size(); ++row) {
        for (core::VehicleIndex other = 0; other < crowd.size(); ++other) {
            const float dx_m = crowd.x_m[row] - crowd.x_m[other];
            const float dy_m = crowd.y_m[row] - crowd.y_m[other];
            const float distance_m = std::sqrt(dx_m * dx_m + dy_m * dy_m);
            if (row == other || !(distance_m < radius_m)) continue;
            if (!allows(crowd.vehicle_class[row], crowd.vehicle_class[other])) continue;
            graph.neighbour.push_back(other);
            graph.distance_m.push_back(distance_m);
        }
        graph.first.push_back(static_cast<std::uint32_t>(graph.neighbour.size()));
    }
    return graph;
}

inline bool operator==(const ProximityGraph& left, const ProximityGraph& right) {
    return left.first == right.first && left.neighbour == right.neighbour &&
           left.distance_m == right.distance_m;
}

}  // namespace clearway::graph
