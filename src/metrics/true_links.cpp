#include "metrics/true_links.hpp"

#include <algorithm>

namespace clearway::metrics {

void TrueLinks::look(const truth::Snapshot& snapshot) {
    builder_.build({snapshot.x_m, snapshot.y_m, snapshot.vehicle_class}, rules_, graph_);
}

bool TrueLinks::linked(core::VehicleIndex left, core::VehicleIndex right) const {
    return left != core::no_row && right != core::no_row &&
           std::ranges::binary_search(graph_.neighbours_of(left), right);
}

}  // namespace clearway::metrics
