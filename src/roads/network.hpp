#pragma once

#include <cstdint>
#include <filesystem>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"

namespace clearway::roads {

/// A point of the network's plane, m.
struct Point {
    float x_m = 0.0F;
    float y_m = 0.0F;
};

/// A lane, internal lanes of junctions included.
struct Lane {
    std::string id;
    core::EdgeIndex edge;
    std::uint32_t number = 0;  ///< 0 is the outermost (right where traffic drives on the right).
    float length_m = 0.0F;     ///< As SUMO states it; may differ from the length of `shape`.
    float speed_limit_mps = 0.0F;
    float width_m = 3.2F;
    bool allows_cars = true;         ///< vClass passenger may use it.
    bool allows_emergency = true;    ///< vClass emergency may use it.
    bool allows_pedestrians = true;  ///< vClass pedestrian may use it.
    std::vector<Point> shape;        ///< At least two points.
    float shape_length_m = 0.0F;     ///< Length of `shape`; positions along the lane are stretched to it.
    std::uint32_t first_connection = 0;
    std::uint32_t connection_count = 0;
};

/// An edge, internal edges of junctions included.
struct Edge {
    std::string id;
    std::string name;  ///< Street name, or empty. Text from a file.
    std::string type;
    std::string from_junction;
    std::string to_junction;
    std::uint32_t first_lane = 0;  ///< Lanes of an edge are consecutive, by number.
    std::uint32_t lane_count = 0;
    float length_m = 0.0F;
    bool internal = false;
    bool crossing = false;  ///< For pedestrians; such an edge is internal.
    bool roundabout = false;
    bool walking_area = false;  ///< Where sidewalks and crossings of a junction meet; internal.
    int priority = 0;
};

/// A way from the end of one lane to the start of another.
struct Connection {
    core::LaneIndex from;
    core::LaneIndex to;
    core::LaneIndex via;       ///< First internal lane, or none.
    core::SignalIndex signal;  ///< Or none.
    std::uint16_t signal_link = 0;
    char direction = 's';          ///< SUMO's letter: s straight, r, l, t turn, R, L partial.
    bool allows_cars = true;       ///< Both lanes, the way between them and the connection itself do.
    bool allows_emergency = true;  ///< Likewise for vClass emergency.
    std::uint32_t first_prior = 0;
    std::uint32_t prior_count = 0;
};

struct Phase {
    double duration_s = 0.0;
    std::string state;
    /// Of a program that vehicles actuate, 0 where none is given: shortest duration (`minDur`), and, with
    /// SUMO's controller NEMA, what follows the phase without being a phase (`yellow`, `red`).
    double least_s = 0.0;
    double yellow_s = 0.0;
    double red_s = 0.0;
    std::string name = {};  ///< Of the phase, where the program names it.
};

/// A link of a signal: one connection that it controls.
struct SignalLink {
    core::LaneIndex from;
    core::LaneIndex to;
    core::LaneIndex via;
};

/// A traffic signal and its initial program: of several programs the last one read, as in SUMO. Railway
/// signals and railway crossings are left out: they have no program and must not be preempted.
struct Signal {
    std::string id;
    /// By link number, one per letter of a phase. A link may have several connections or none. Pedestrian
    /// crossings are links too.
    std::vector<std::vector<SignalLink>> links;
    std::vector<bool> crossings;  ///< By link number: whether it is a crossing.
    std::vector<Phase> program;
    std::string program_id;
    /// What runs the program, as SUMO spells it: `static`, `actuated`, `delay_based`, `NEMA`, ...
    std::string controller = "static";
    double offset_s = 0.0;    ///< The program restarts whenever time - offset is a multiple of its cycle.
    bool fixed_time = false;  ///< Not actuated by vehicles, so it stays coordinated with its neighbours.
    /// foes[a][b]: the ways of links a and b cross or merge, by the right-of-way table of their junction.
    /// Symmetric, false on the diagonal and between links of different junctions.
    std::vector<std::vector<bool>> foes;

    double cycle_s() const {
        return std::accumulate(program.begin(), program.end(), 0.0,
                               [](double sum_s, const Phase& phase) { return sum_s + phase.duration_s; });
    }
};

/// Where a network lies on the globe, for conversion to WGS 84.
struct Location {
    double offset_x_m = 0.0;
    double offset_y_m = 0.0;
    std::string projection;  ///< PROJ string, `!` if there is none.
    double x_minimum_m = 0.0, y_minimum_m = 0.0, x_maximum_m = 0.0, y_maximum_m = 0.0;
};

/// The map, which is known to everybody: SUMO's network file in memory. Immutable after reading, so threads
/// may share it.
class Network {
  public:
    /// Reads `.net.xml` or `.net.xml.gz`, streaming, then the signal programs of SUMO's additional files in
    /// their order. Throws core::InputError naming file and line for a file that is missing, not XML, not a
    /// network, or inconsistent.
    static Network read(const std::filesystem::path& file,
                        const std::vector<std::filesystem::path>& additional_files = {});

    std::span<const Lane> lanes() const { return lanes_; }
    std::span<const Edge> edges() const { return edges_; }
    std::span<const Signal> signals() const { return signals_; }
    const Lane& lane(core::LaneIndex index) const { return lanes_[index.value]; }
    const Edge& edge(core::EdgeIndex index) const { return edges_[index.value]; }
    const Signal& signal(core::SignalIndex index) const { return signals_[index.value]; }
    const Location& location() const { return location_; }

    /// By SUMO's id. Nothing when there is no such id.
    std::optional<core::LaneIndex> find_lane(std::string_view id) const;
    std::optional<core::EdgeIndex> find_edge(std::string_view id) const;
    std::optional<core::SignalIndex> find_signal(std::string_view id) const;

    /// Lane `number` of an edge; none when the edge has fewer lanes.
    core::LaneIndex lane_of(core::EdgeIndex edge, std::uint32_t number) const;
    /// In the order of the file, which is that of SUMO's link numbers.
    std::span<const Connection> connections_from(core::LaneIndex lane) const;
    /// Connections, by `connection`, to whose vehicles those on `way` must yield at a junction without a
    /// signal, by its right-of-way table; those that cars may not take are left out. Empty at signals and
    /// where the file has no table that fits.
    std::span<const std::uint32_t> prior_to(const Connection& way) const {
        return std::span(prior_).subspan(way.first_prior, way.prior_count);
    }
    const Connection& connection(std::uint32_t row) const { return connections_[row]; }
    /// Edges outside junctions that can be reached directly from `edge` by a car, each once, ascending.
    std::span<const core::EdgeIndex> successors(core::EdgeIndex edge) const;

    /// Point and heading (rad, counter-clockwise from the x axis) at `position` along a lane; clamped to its
    /// ends.
    Point point_at(core::LaneIndex lane, core::Metres position) const;
    double heading_at(core::LaneIndex lane, core::Metres position) const;

  private:
    friend class NetworkBuilder;
    Network() = default;

    std::vector<Lane> lanes_;
    std::vector<Edge> edges_;
    std::vector<Signal> signals_;
    std::vector<Connection> connections_;
    std::vector<std::uint32_t> prior_;
    std::vector<core::EdgeIndex> successors_;
    std::vector<std::uint32_t> first_successor_;
    /// Allows lookups by std::string_view.
    struct TextHash {
        using is_transparent = void;
        std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
    };
    using Rows = std::unordered_map<std::string, std::uint32_t, TextHash, std::equal_to<>>;
    Rows lane_rows_, edge_rows_, signal_rows_;
    Location location_;
};

/// Edges outside junctions, open to cars, in the largest set in which every edge reaches every other.
/// Ascending.
std::vector<core::EdgeIndex> largest_car_component(const Network& network);

}  // namespace clearway::roads
