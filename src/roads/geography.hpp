#pragma once

#include <optional>

#include "roads/network.hpp"

namespace clearway::roads {

/// A place on the globe, WGS 84, degrees.
struct Coordinates {
    double longitude_deg = 0.0;
    double latitude_deg = 0.0;
};

/// Converts between the plane of a network and the globe, for networks in a transverse Mercator projection
/// (UTM, which netconvert chooses, and `+proj=tmerc`), on WGS 84 or GRS 80. Krueger's series to the third
/// order (Karney 2011, "Transverse Mercator with an accuracy of a few nanometers", equations 35 and 36): the
/// error is below 1 mm within 10 degrees of the central meridian.
class Geography {
  public:
    /// Nothing when the network has no projection or another one.
    static std::optional<Geography> of(const Location& location);

    Coordinates coordinates(double x_m, double y_m) const;
    /// The point may lie outside the network.
    Point point(Coordinates place) const;

  private:
    Geography() = default;

    double offset_x_m_ = 0.0, offset_y_m_ = 0.0;
    double central_meridian_rad_ = 0.0;
    double scale_ = 1.0;
    double false_easting_m_ = 0.0, false_northing_m_ = 0.0;  ///< The northing includes the origin's latitude.
    double equator_m_ = 6378137.0;                           ///< Semi-major axis.
    double third_flattening_ = 0.0;
};

}  // namespace clearway::roads
