#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "graph/proximity.hpp"
#include "roads/network.hpp"
#include "support/temporary_folder.hpp"
#include "traffic/belief.hpp"
#include "traffic/observation.hpp"
#include "traffic/vehicle.hpp"
#include "truth/snapshot.hpp"

namespace clearway::support {

/// A straight road with vehicles, drawn with letters, for tests of every stage.
///
///     const Scene scene(R"(
///         10 m per cell, limit 20 m/s, speed 15 m/s
///         ..h..a...|G....h
///         ..e......|r.....
///     )");
///
/// The first line gives the scale and, if wanted, the speed limit (13.89 m/s by default) and the speed of all
/// vehicles (the limit by default). Each further line is a lane; the upper one is further left, and the last
/// is lane 0. Traffic drives to the right (x grows); lane rows lie 3.2 m apart (y = 0 for the last line).
///
/// | cell | meaning |
/// |---|---|
/// | `.` | road |
/// | `h` `a` `e` | human, automated, emergency vehicle; its front bumper is in the middle of the cell |
/// | `#` | no road: the lane does not exist on this edge (whole edges only) |
/// | `|` and a letter | stop line of a signal that shows this letter (`G g y r`...) to the lane; no width |
/// | `+` | an edge ends and the next begins, without a signal; no width |
///
/// Stop lines and `+` stand in the same column in every lane. They cut the road into the edges `road_0`,
/// `road_1`, ...; lanes of an edge are numbered from the lowest line that exists there. Junctions have no
/// width and no internal lanes; each lane leads to the same line of the next edge where that exists.
///
/// The signals are `signal_0`, `signal_1`, ... from left to right. Link n is the way straight on from lane n;
/// the last link is a street of one lane that crosses (`cross_0_in` to `cross_0_out`), a foe of all others.
/// It shows green when all lanes have red, else red. The program is 30 s green along the road, 3 s yellow, 30
/// s for the crossing street, 3 s yellow.
///
/// Vehicles are `h1`, `h2`, ..., `a1`, ..., `e1`, ... in reading order (upper line first). All follow the
/// road to its end: their route is `road_0`, `road_1`, ... and `route_edge` counts in it. Emergency vehicles
/// are of kind ambulance, the others cars; the other properties are the defaults of `traffic::VehicleInfo`.
/// Time is 100 s. Throws std::invalid_argument for a drawing that breaks these rules.
class Scene {
  public:
    explicit Scene(std::string_view drawing);
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    const roads::Network& network() const { return network_; }
    const traffic::Roster& roster() const { return roster_; }
    const truth::Snapshot& snapshot() const { return snapshot_; }
    /// For changes that a drawing cannot express. Keep the rows ordered by key.
    truth::Snapshot& snapshot() { return snapshot_; }
    /// The network as SUMO would read it; goes with the scene.
    std::filesystem::path network_file() const { return folder_.path() / "scene.net.xml"; }

    /// By the names above; std::out_of_range for others.
    core::VehicleKey key(const std::string& id) const;
    core::VehicleIndex row(const std::string& id) const;
    /// `h2`, for messages.
    std::string id(core::VehicleKey key) const;

    void set_speed(const std::string& id, core::MetresPerSecond speed);
    /// Lets `duration` pass: every vehicle drives on at its speed, on its lane, and stops at the road's end.
    void pass(core::Seconds duration);

  private:
    support::TemporaryFolder folder_;
    roads::Network network_;
    traffic::Roster roster_;
    truth::Snapshot snapshot_;
};

/// What perfect sensors report of a scene, now.
traffic::Observation perfect_observation(const Scene& scene);

/// What is believed when everything is known: states as they are, and the links of `rules`, with
/// probability 1.
traffic::BelievedGraph perfect_belief(const Scene& scene, const graph::LinkRules& rules = {});

}  // namespace clearway::support
