#include "graph/proximity.hpp"

namespace clearway::graph {

bool LinkRules::allows(traffic::VehicleClass left, traffic::VehicleClass right) const {
    using traffic::VehicleClass;
    if (left != right) return true;
    if (left == VehicleClass::automated) return automated_automated == Pairs::included;
    if (left == VehicleClass::emergency) return emergency_emergency == Pairs::included;
    return false;
}

}  // namespace clearway::graph
