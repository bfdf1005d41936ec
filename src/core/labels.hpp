#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace clearway::core {

/// A point of a picture in its units, y down.
struct Spot {
    double x = 0.0;
    double y = 0.0;

    bool operator==(const Spot&) const = default;
};

/// What is drawn at a place.
enum class Mark : std::uint8_t {
    disc,  ///< With a number in it.
    dot,   ///< Without one; stays where it is.
};

/// Units of the picture.
inline constexpr double disc_radius = 8.0;
inline constexpr double dot_radius = 4.0;

/// A rectangle of a plane, m, y up.
struct Extent {
    double left = 1e30;
    double bottom = 1e30;
    double right = -1e30;
    double top = -1e30;

    void add(double x, double y);
    double width() const { return right - left; }
    double height() const { return top - bottom; }
};

/// What to draw of a network that takes up `all`, so that its signals can be told apart: where they and a
/// margin take less than a third of it, that part; otherwise all.
Extent drawn_part(const Extent& all, const Extent& signals);

/// Of words that are to fit into a disc: `7`, `#12`, `#123`.
inline double disc_text_size(const std::string& words) {
    return words.size() < 2 ? 11.0 : words.size() == 2 ? 10.0 : words.size() == 3 ? 8.5 : 6.5;
}

/// Where to draw the marks of `places`, so that no disc lies on another one or hides the place of another
/// mark. A disc with enough room stays at its place. The others take the nearest free spot round theirs,
/// first on the side away from other marks, in the order of the list, and inside a picture of `size`; a disc
/// for which even the farthest spots are taken stays. Equal places give equal spots. Time grows with the
/// square of the number of places.
std::vector<Spot> spread(const std::vector<Spot>& places, const std::vector<Mark>& marks, Spot size);

}  // namespace clearway::core
