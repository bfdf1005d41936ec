#include "sensing/line_of_sight.hpp"

#include <algorithm>
#include <cmath>

namespace clearway::sensing {
namespace {

/// Narrows [enter, leave], the part of the line that is inside so far, to where |start + t x change| <= half.
bool clip(float start, float change, float half, float& enter, float& leave) {
    if (change == 0.0F) return std::abs(start) <= half;
    const float one = (-half - start) / change;
    const float other = (half - start) / change;
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
    return enter <= leave;
}

}  // namespace

Box box_from(Place front, float heading_rad, float length_m, float width_m) {
    return {{front.x_m - std::cos(heading_rad) * length_m / 2.0F,
             front.y_m - std::sin(heading_rad) * length_m / 2.0F},
            heading_rad,
            length_m / 2.0F,
            width_m / 2.0F};
}

bool blocks(const Box& box, Place from, Place to) {
    const float cosine = std::cos(box.heading_rad);
    const float sine = std::sin(box.heading_rad);
    const auto turned = [&](float x_m, float y_m) {
        return Place{cosine * x_m + sine * y_m, cosine * y_m - sine * x_m};
    };
    const Place start = turned(from.x_m - box.centre.x_m, from.y_m - box.centre.y_m);
    const Place change = turned(to.x_m - from.x_m, to.y_m - from.y_m);
    float enter = 0.0F;
    float leave = 1.0F;
    return clip(start.x_m, change.x_m, box.half_length_m, enter, leave) &&
           clip(start.y_m, change.y_m, box.half_width_m, enter, leave);
}

}  // namespace clearway::sensing
