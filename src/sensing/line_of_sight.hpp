#pragma once

namespace clearway::sensing {

struct Place {
    float x_m = 0.0F;
    float y_m = 0.0F;
};

/// A vehicle seen from above: a rectangle.
struct Box {
    Place centre;
    float heading_rad = 0.0F;  ///< Counter-clockwise from the x axis.
    float half_length_m = 2.5F;
    float half_width_m = 0.9F;
};

/// The box of a vehicle from its front bumper, as snapshots have it.
Box box_from(Place front, float heading_rad, float length_m, float width_m);

/// Whether the straight line between two places meets the box, its edge included.
bool blocks(const Box& box, Place from, Place to);

}  // namespace clearway::sensing
