#include "roads/geography.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include "roads/detail/numbers.hpp"

namespace clearway::roads {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

struct Ellipsoid {
    double equator_m;
    double inverse_flattening;
};
constexpr Ellipsoid wgs84{6378137.0, 298.257223563};
constexpr Ellipsoid grs80{6378137.0, 298.257222101};

/// `+proj=utm +zone=32 +south` as names and values; a name without a value gets an empty one.
std::map<std::string, std::string, std::less<>> parameters_of(const std::string& projection) {
    std::map<std::string, std::string, std::less<>> parameters;
    detail::for_each_word(projection, ' ', [&](std::string_view word) {
        if (!word.starts_with('+')) return;
        const std::size_t equals = word.find('=');
        parameters[std::string(word.substr(1, equals - 1))] =
            equals == std::string_view::npos ? "" : std::string(word.substr(equals + 1));
    });
    return parameters;
}

/// Coefficients of Krueger's series: alpha from the sphere to the plane, beta back.
struct Series {
    double radius_m;  ///< Of the rectifying sphere.
    std::array<double, 3> alpha;
    std::array<double, 3> beta;
};

Series series_of(double equator_m, double n) {
    const double n2 = n * n;
    const double n3 = n2 * n;
    return {
        equator_m / (1.0 + n) * (1.0 + n2 / 4.0 + n2 * n2 / 64.0),
        {n / 2.0 - 2.0 * n2 / 3.0 + 5.0 * n3 / 16.0, 13.0 * n2 / 48.0 - 3.0 * n3 / 5.0, 61.0 * n3 / 240.0},
        {n / 2.0 - 2.0 * n2 / 3.0 + 37.0 * n3 / 96.0, n2 / 48.0 + n3 / 15.0, 17.0 * n3 / 480.0}};
}

/// Factor of the angle in term `j` of the series.
double order_of(std::size_t j) {
    return 2.0 * static_cast<double>(j + 1);
}

double eccentricity_of(double n) {
    return 2.0 * std::sqrt(n) / (1.0 + n);
}

/// Tangent of the conformal latitude.
double conformal(double tangent, double eccentricity) {
    const double sine = tangent / std::sqrt(1.0 + tangent * tangent);
    const double sigma = std::sinh(eccentricity * std::atanh(eccentricity * sine));
    return tangent * std::sqrt(1.0 + sigma * sigma) - sigma * std::sqrt(1.0 + tangent * tangent);
}

/// Northing of a latitude on the central meridian, divided by the scale.
double meridian_m(double latitude_rad, double equator_m, double n) {
    const Series series = series_of(equator_m, n);
    const double xi = std::atan(conformal(std::tan(latitude_rad), eccentricity_of(n)));
    double sum = xi;
    for (std::size_t j = 0; j < series.alpha.size(); ++j)
        sum += series.alpha[j] * std::sin(order_of(j) * xi);
    return series.radius_m * sum;
}

}  // namespace

std::optional<Geography> Geography::of(const Location& location) {
    const auto parameters = parameters_of(location.projection);
    const auto number = [&](std::string_view name, double missing) {
        const auto found = parameters.find(name);
        return found == parameters.end() ? missing : detail::parse_number(found->second).value_or(missing);
    };
    const auto projection = parameters.find("proj");
    if (projection == parameters.end()) return std::nullopt;
    const auto ellipsoid = parameters.find("ellps");
    if (ellipsoid != parameters.end() && ellipsoid->second != "WGS84" && ellipsoid->second != "GRS80")
        return std::nullopt;
    const Ellipsoid& earth = ellipsoid != parameters.end() && ellipsoid->second == "GRS80" ? grs80 : wgs84;
    Geography geography;
    geography.equator_m_ = earth.equator_m;
    const double flattening = 1.0 / earth.inverse_flattening;
    geography.third_flattening_ = flattening / (2.0 - flattening);
    geography.offset_x_m_ = location.offset_x_m;
    geography.offset_y_m_ = location.offset_y_m;
    if (projection->second == "utm") {
        geography.central_meridian_rad_ = (6.0 * number("zone", 31.0) - 183.0) * degree;
        geography.scale_ = 0.9996;
        geography.false_easting_m_ = 500000.0;
        geography.false_northing_m_ = parameters.contains("south") ? 10000000.0 : 0.0;
    } else if (projection->second == "tmerc") {
        geography.central_meridian_rad_ = number("lon_0", 0.0) * degree;
        geography.scale_ = number("k", number("k_0", 1.0));
        geography.false_easting_m_ = number("x_0", 0.0);
        geography.false_northing_m_ =
            number("y_0", 0.0) - geography.scale_ * meridian_m(number("lat_0", 0.0) * degree, earth.equator_m,
                                                               geography.third_flattening_);
    } else {
        return std::nullopt;
    }
    if (!(geography.scale_ > 0.0)) return std::nullopt;
    return geography;
}

Point Geography::point(Coordinates place) const {
    assert(scale_ > 0.0);
    const Series series = series_of(equator_m_, third_flattening_);
    const double tangent =
        conformal(std::tan(place.latitude_deg * degree), eccentricity_of(third_flattening_));
    const double longitude = place.longitude_deg * degree - central_meridian_rad_;
    const double xi = std::atan2(tangent, std::cos(longitude));
    const double eta = std::asinh(std::sin(longitude) / std::hypot(tangent, std::cos(longitude)));
    double north = xi;
    double east = eta;
    for (std::size_t j = 0; j < series.alpha.size(); ++j) {
        const double order = order_of(j);
        north += series.alpha[j] * std::sin(order * xi) * std::cosh(order * eta);
        east += series.alpha[j] * std::cos(order * xi) * std::sinh(order * eta);
    }
    return {static_cast<float>(false_easting_m_ + scale_ * series.radius_m * east + offset_x_m_),
            static_cast<float>(false_northing_m_ + scale_ * series.radius_m * north + offset_y_m_)};
}

Coordinates Geography::coordinates(double x_m, double y_m) const {
    assert(scale_ > 0.0);
    const Series series = series_of(equator_m_, third_flattening_);
    const double xi = (y_m - offset_y_m_ - false_northing_m_) / (scale_ * series.radius_m);
    const double eta = (x_m - offset_x_m_ - false_easting_m_) / (scale_ * series.radius_m);
    double north = xi;
    double east = eta;
    for (std::size_t j = 0; j < series.beta.size(); ++j) {
        const double order = order_of(j);
        north -= series.beta[j] * std::sin(order * xi) * std::cosh(order * eta);
        east -= series.beta[j] * std::cos(order * xi) * std::sinh(order * eta);
    }
    const double wanted = std::sin(north) / std::hypot(std::sinh(east), std::cos(north));
    const double eccentricity = eccentricity_of(third_flattening_);
    const double shape = 1.0 - eccentricity * eccentricity;
    double tangent = wanted;
    for (int round = 0; round < 4; ++round) {  // Newton's method, Karney's equations 19 to 21
        const double now = conformal(tangent, eccentricity);
        tangent += (wanted - now) / std::sqrt(1.0 + now * now) * (1.0 + shape * tangent * tangent) /
                   (shape * std::sqrt(1.0 + tangent * tangent));
    }
    return {(central_meridian_rad_ + std::atan2(std::sinh(east), std::cos(north))) / degree,
            std::atan(tangent) / degree};
}

}  // namespace clearway::roads
