#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/labels.hpp"
#include "report/detail/canvas.hpp"
#include "report/map.hpp"

namespace clearway::report::detail {

/// Draws roads to scale, north up, with a scale bar. A network that is much wider than high is stretched
/// across, at most tenfold, and says so.
class MapCanvas : public Canvas {
  public:
    MapCanvas(const std::string& title, const RoadMap& map);
    /// The part of the map where its signals are, where that is small; what goes on beyond it is cut off.
    static MapCanvas of_signals(const std::string& title, const RoadMap& map);

    /// One line through the shape of an edge, with CSS classes.
    void edge(const MapEdge& edge, const std::string& style);
    /// Many edges as one path, with CSS classes.
    void edges(std::span<const MapEdge* const> edges, const std::string& style);
    /// In figure units.
    std::pair<double, double> place(const MapPlace& place) const;
    void scale_bar();
    /// A diamond at the start of the edge of each station on the drawing, with its name or, where there is
    /// room, its kind.
    void stations(const RoadMap& map);
    /// No entry in the middle of each blocked edge.
    void incidents(const RoadMap& map);
    /// What the map's data requires, below the scale bar; nothing where it is empty.
    void credit(const std::string& words);
    /// Of the drawing, scale bar included, in figure units.
    double height() const { return frame_.height; }

  private:
    struct Frame {
        double scale = 1.0;    ///< Units a metre.
        double stretch = 1.0;  ///< Of y relative to x.
        double left = 0.0;
        double left_m = 0.0;
        double top_m = 0.0;
        double height = 0.0;
        bool is_part = false;  ///< Roads go on beyond it.
    };
    static Frame frame_of(const core::Extent& extent);
    MapCanvas(const std::string& title, const Frame& frame);

    bool is_inside(double x, double y) const;

    Frame frame_;
};

/// `hospital or fire station`: the kinds of a map's stations.
std::string station_words(const RoadMap& map);

/// The sign of a station in a legend.
inline constexpr const char* station_sign = "<path class=\"station\" d=\"M20 -1l6 6l-6 6l-6 -6z\"/>";

/// The sign of a blocked road: a bar on a disc.
inline constexpr const char* incident_sign =
    "<circle class=\"block\" cx=\"20.0\" cy=\"5.0\" r=\"7\"/><path class=\"blockBar\" d=\"M16.0 "
    "3.5h8v3h-8z\"/>\n";

/// Of edges in the style `way considered`.
inline LegendEntry considered_entry() {
    return stripe_entry("way considered", "on a way considered, not taken: it gains too little");
}

std::vector<const MapEdge*> all_edges(const RoadMap& map);

/// Whether there is something to draw.
bool is_drawable(const RoadMap& map);

}  // namespace clearway::report::detail
