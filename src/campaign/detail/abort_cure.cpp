#include "campaign/detail/abort_cure.hpp"

#include <csignal>

namespace clearway::campaign {

std::string cure_of_abort(const results::RunError& error) {
    if (error.cause != results::ErrorCause::signal || error.signal == SIGKILL) return "";
    if (error.log_tail.find("getBidiLane") != std::string::npos)
        return "SUMO itself aborted on multi-track rails with trains in both directions. Import the network "
               "again: the import separates such rails. If only road traffic matters, set restrict = "
               "\"largest_car_component\" in [network]";
    if (error.log_tail.find("clearway::") != std::string::npos ||
        error.log_tail.find("/include/c++/") !=
            std::string::npos)  // SUMO's package checks no standard library
        return "An assertion of Clearway itself failed: please report it with the command";
    return "SUMO itself aborted. If a teleport came before it, --time-to-teleport -1 avoids it; less traffic "
           "(--density 0.5) may help too";
}

}  // namespace clearway::campaign
