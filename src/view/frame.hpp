#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <vector>

namespace clearway::view {

/// Unit of places in frames and in the drawing of the network, m: a third of a hand's breadth on the road.
inline constexpr double quantum_m = 0.1;
/// Steps of a full turn: a heading is right to 0.7 degrees.
inline constexpr int headings = 256;
/// Unit of speeds in frames, m/s.
inline constexpr double speed_quantum_mps = 0.1;

/// Number of a vehicle in the order in which a viewer was told of it; valid for one stream.
using Slot = std::uint32_t;

/// A vehicle on the road. Places are multiples of `quantum_m` from the drawing's origin, front bumper.
struct SeenVehicle {
    Slot slot = 0;
    std::int32_t x = 0, y = 0;
    std::uint8_t heading = 0;  ///< Counter-clockwise from the x axis, of `headings`.
    std::int32_t speed = 0;    ///< Multiples of `speed_quantum_mps`.
    bool dark = false;         ///< Its newest report did not arrive.
    bool operator==(const SeenVehicle&) const = default;
};

/// Where a dark vehicle is believed to be. It may have left the road meanwhile.
struct Ghost {
    Slot slot = 0;
    std::int32_t x = 0, y = 0;
    std::uint32_t sigma = 0;  ///< Standard deviation along the route, multiples of `quantum_m`.
    std::uint32_t age = 0;    ///< Of the report that the belief rests on, tenths of a second.
    bool operator==(const Ghost&) const = default;
};

/// Two vehicles, the lower slot first.
struct Link {
    Slot one = 0, other = 0;
    auto operator<=>(const Link&) const = default;
};
/// Links that are true, that the reports show, and that are believed, in this order.
enum class Layer : std::uint8_t { true_links, observed_links, believed_links };
inline constexpr std::size_t layers = 3;

/// A lease in force. `policy` and `reason` are numbers of texts.
struct SeenLease {
    bool on_signal = false;
    std::uint32_t target = 0;  ///< Slot, or number of the signal.
    std::uint8_t action = 0;   ///< Alternative of traffic::Action.
    /// Lane number, speed in `speed_quantum_mps`, side (0 right), links of a hold, a way that was considered
    /// (its number + 1; 0 for none).
    std::int32_t amount = 0;
    std::uint32_t policy = 0, reason = 0;
    std::uint32_t beneficiary = 0;  ///< Slot + 1; 0 for none.
    auto operator<=>(const SeenLease&) const = default;
};

/// The way of an emergency vehicle on the road.
struct SeenWay {
    Slot slot = 0;
    std::uint32_t way = 0;  ///< Number of a way of Names.
    std::uint32_t at = 0;   ///< Place in it of the last edge outside junctions that was entered.
    bool operator==(const SeenWay&) const = default;
};

/// What is marked on the time line.
enum class MarkKind : std::uint8_t { request, grant, braking, collision, departure, arrival, teleport };
inline constexpr std::array<const char*, 7> mark_names = {"request",   "grant",   "braking", "collision",
                                                          "departure", "arrival", "teleport"};

/// Something that happened since the frame before.
struct Mark {
    MarkKind kind = MarkKind::request;
    double time_s = 0.0;
    std::uint32_t vehicle = 0;  ///< Slot + 1 of the vehicle, or of the one that a signal was asked for.
    std::uint32_t other = 0;    ///< Slot + 1 of the other vehicle, number of the signal + 1, or 0.
    bool operator==(const Mark&) const = default;
};

/// What a viewer sees of one moment. Vehicles, ghosts and ways ascend by slot; links, leases and edges
/// ascend.
struct Frame {
    double time_s = 0.0;
    std::vector<SeenVehicle> vehicles;
    std::vector<std::string> signals;  ///< By number; SUMO's letters.
    std::array<std::vector<Link>, layers> links;
    std::vector<Ghost> ghosts;
    std::vector<SeenLease> leases;
    std::vector<SeenWay> ways;
    std::vector<std::uint32_t> known_blocks;  ///< Edges of incidents that last and are known.
    std::vector<Mark> marks;
};

/// A vehicle of which a viewer is told, once.
struct NamedVehicle {
    std::string id;  ///< SUMO's; text from a file.
    std::uint8_t vehicle_class = 0;
    std::uint8_t kind = 0;
    std::uint32_t length = 0, width = 0;  ///< Multiples of `quantum_m`.
};

/// Names that appeared since the last ones. Slots and numbers of texts and ways go on from there.
struct Names {
    std::vector<NamedVehicle> vehicles;
    std::vector<std::string> texts;
    std::vector<std::vector<std::uint32_t>> ways;  ///< Numbers of their edges, in driving order.
    bool empty() const { return vehicles.empty() && texts.empty() && ways.empty(); }
};

}  // namespace clearway::view
