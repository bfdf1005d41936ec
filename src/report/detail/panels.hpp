#pragma once

#include <cstddef>
#include <utility>

namespace clearway::report::detail {

// Small multiples: panels of one scale, two beside each other in one drawing.

inline constexpr std::size_t panel_columns = 2;
inline constexpr double panel_width = 150.0;
inline constexpr double panel_height = 104.0;
inline constexpr double panels_top = 58.0;    ///< Room for the label and the first titles.
inline constexpr double panel_below = 168.0;  ///< From one panel's top to the next one's.

/// Left and upper edge of a panel's axes, by its number.
inline std::pair<double, double> panel_place(std::size_t number) {
    constexpr double left = 44.0;     // room for the labels of y
    constexpr double beside = 194.0;  // from one panel's left edge to the next one's
    const std::size_t column = number % panel_columns;
    const std::size_t row = number / panel_columns;
    return {left + beside * static_cast<double>(column), panels_top + panel_below * static_cast<double>(row)};
}

}  // namespace clearway::report::detail
