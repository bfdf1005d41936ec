#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace clearway::support {

/// A drawing taken apart: see `Scene` for the format. Rows count from the bottom.
struct Drawing {
    struct Edge {
        double length_m = 0.0;
        double start_m = 0.0;
        std::vector<bool> has_row;  ///< Whether the lane of each row exists.
        std::string letters;        ///< What the signal at its end shows, by row; empty without signal.
        std::size_t lane_number(std::size_t row) const;
    };
    struct Vehicle {
        std::string id;
        std::size_t row = 0;
        std::size_t edge = 0;
        double position_m = 0.0;  ///< From the start of its edge.
    };

    double cell_m = 0.0;
    double limit_mps = 13.89;
    double speed_mps = 13.89;
    std::size_t rows = 0;
    std::vector<Edge> edges;
    std::vector<Vehicle> vehicles;  ///< In reading order.
};

/// Throws std::invalid_argument for a drawing that breaks the rules.
Drawing parse_drawing(std::string_view text);

/// The drawing as a SUMO network.
std::string network_text(const Drawing& drawing);

/// The letter that the crossing street of an edge's signal shows.
char cross_letter(const Drawing::Edge& edge);

}  // namespace clearway::support
