#include "roads/permissions.hpp"

#include "roads/detail/numbers.hpp"

namespace clearway::roads {
namespace {

Permissions listed(std::string_view classes) {
    Permissions result{false, false, false};
    detail::for_each_word(classes, ' ', [&](std::string_view word) {
        result.cars |= word == "passenger" || word == "all";
        result.emergency |= word == "emergency" || word == "all";
        result.pedestrians |= word == "pedestrian" || word == "all";
    });
    return result;
}

}  // namespace

Permissions permissions_of(const core::XmlAttributes& attributes) {
    const auto allow = attributes.find("allow");
    if (allow && !allow->empty()) return listed(*allow);
    const auto disallow = attributes.find("disallow");
    if (!disallow) return {};
    const Permissions forbidden = listed(*disallow);
    return {!forbidden.cars, !forbidden.emergency, !forbidden.pedestrians};
}

}  // namespace clearway::roads
