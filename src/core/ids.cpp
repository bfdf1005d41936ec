#include "core/ids.hpp"

#include "core/random.hpp"

namespace clearway::core {

VehicleKey vehicle_key(std::string_view sumo_id) {
    return VehicleKey{mix64(fnv1a64(sumo_id))};
}

}  // namespace clearway::core
