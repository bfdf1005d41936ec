#pragma once

#include <compare>

namespace clearway::core {

/// A number with an SI unit in its type, for use at module boundaries. Inside modules, plain `float` or
/// `double` arrays with the unit in their name are the rule. Arithmetic that changes the unit must go through
/// `.value`, on purpose.
template <class Tag>
struct Quantity {
    double value = 0.0;

    constexpr Quantity() = default;
    constexpr explicit Quantity(double number) : value(number) {}

    constexpr auto operator<=>(const Quantity&) const = default;
    constexpr Quantity operator+(Quantity other) const { return Quantity(value + other.value); }
    constexpr Quantity operator-(Quantity other) const { return Quantity(value - other.value); }
    constexpr Quantity operator*(double factor) const { return Quantity(value * factor); }
    constexpr Quantity& operator+=(Quantity other) {
        value += other.value;
        return *this;
    }
    /// Ratio of two quantities of one unit.
    constexpr double operator/(Quantity other) const { return value / other.value; }
};

using Metres = Quantity<struct MetresTag>;
using Seconds = Quantity<struct SecondsTag>;
using MetresPerSecond = Quantity<struct MetresPerSecondTag>;

/// Times that differ by less are the same moment, s. SUMO's clock counts milliseconds; times are sums of
/// steps and carry rounding errors, which stay far below half of one.
inline constexpr double clock_tolerance_s = 0.0005;

constexpr MetresPerSecond from_kmh(double kilometres_per_hour) {
    return MetresPerSecond(kilometres_per_hour / 3.6);
}

}  // namespace clearway::core
