#include "traffic/lease.hpp"

#include <array>

namespace clearway::traffic {

std::string_view name(const Action& action) {
    static constexpr std::array<std::string_view, std::variant_size_v<Action>> names = {
        "drive_at",     "change_lane", "hold_lane",    "pull_aside",
        "stop_at_line", "hold_green",  "adjust_green", "pass_red"};
    return names[action.index()];
}

}  // namespace clearway::traffic
