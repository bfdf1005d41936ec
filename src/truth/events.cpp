#include "truth/events.hpp"

namespace clearway::truth {

void Events::clear() {
    departed.clear();
    arrived.clear();
    teleported.clear();
    removed.clear();
    collisions.clear();
    emergency_brakings.clear();
}

}  // namespace clearway::truth
