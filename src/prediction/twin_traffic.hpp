#pragma once

#include <cstdint>
#include <vector>

#include "prediction/car_following_config.hpp"
#include "prediction/detail/vehicle_on_lane.hpp"
#include "prediction/motion_filter.hpp"
#include "prediction/tracks.hpp"
#include "roads/network.hpp"
#include "roads/route.hpp"
#include "traffic/observation.hpp"

namespace clearway::prediction {

/// Acceleration by the Intelligent Driver Model, m/s^2 (Treiber, Hennecke, Helbing 2000, "Congested traffic
/// states in empirical observations and microscopic simulations", eqs. 2 to 4):
///
///     a [1 - (v / v0)^delta - (s* / s)^2],     s* = s0 + max(0, v T + v dv / (2 sqrt(a b)))
struct IdmDriver {
    float acceleration_mps2 = 2.6F;  ///< a
    float deceleration_mps2 = 4.5F;  ///< b
    float headway_s = 1.0F;          ///< T
    float min_gap_m = 2.5F;          ///< s0
    float exponent = 4.0F;           ///< delta

    /// a [1 - (v / v0)^delta], with v0 > 0.
    float free(float speed_mps, float desired_mps) const;
    /// a (s* / s)^2; gaps below 0.1 m count as 0.1 m.
    float interaction(float speed_mps, float gap_m, float closing_mps) const;
};

/// Vehicles that drive on while nobody hears them: one twin for each vehicle of the observations.
///
/// A report puts a twin where it says. From then on the twin drives along its route by the IDM: behind the
/// nearest vehicle on its way, fresh or twin, also across junctions; up to stop lines that show red or yellow
/// (at yellow only if it can stop at its comfortable deceleration, at red if it can stop at all); and slowly
/// enough for lower limits ahead. Where its lane does not lead to the next edge of its route, it changes to
/// one that does as soon as there is room, and waits at the end of its own until then. A vehicle that
/// reported meanwhile is taken to have come at its present speed.
///
/// A vehicle whose route is not known is no twin and keeps its speed and heading (`Tracks`). Vehicles
/// that never reported do not exist here. Deterministic; no allocation once buffers have grown; one thread.
class TwinTraffic {
  public:
    /// `network` outlives the twins.
    explicit TwinTraffic(const roads::Network& network, const CarFollowingConfig& config = {});

    /// Takes in an observation and its tracks, and drives all twins to its time. Call it with every
    /// observation, in order; one that is older than the last starts anew.
    void follow(const traffic::Observation& observation, const Tracks& tracks);

    /// Whether the vehicle of a row drives as a twin.
    bool is_twin(std::uint32_t row) const { return twin_of(row).on_route; }
    /// Of a twin: on its lane now.
    traffic::MotionState state(std::uint32_t row) const;
    /// Standard deviation of the place where the vehicle was last seen, filtered, m.
    float seen_sigma_m(std::uint32_t row) const;
    /// The twin has come to the end of its route.
    bool at_end(std::uint32_t row) const { return twin_of(row).at_end; }
    /// Of a twin: where it is on its lane now, and how fast.
    core::LaneIndex lane(std::uint32_t row) const { return twin_of(row).lane; }
    float lane_position_m(std::uint32_t row) const { return twin_of(row).lane_position_m; }
    float speed_mps(std::uint32_t row) const { return twin_of(row).speed_mps; }
    /// Of a twin: driven along its route since its report, m.
    float driven_m(std::uint32_t row) const;
    /// Of a twin: it waits for room in a lane that leads on.
    bool waits(std::uint32_t row) const;

    /// A vehicle before or behind a twin, fresh or a twin itself.
    struct Neighbour {
        bool exists = false;
        std::uint32_t row = 0;
        float gap_m = 0.0F;  ///< From bumper to bumper; negative where they overlap.
        float speed_mps = 0.0F;
    };
    /// A stop line with a signal before a twin.
    struct Line {
        float distance_m = -1.0F;  ///< Negative: there is none.
        char state = 0;            ///< SUMO's letter.
    };
    struct Surroundings {
        Neighbour leader;    ///< On its way, as far as it looks.
        Neighbour follower;  ///< In its lane.
        Line line;           ///< Within its path.
    };
    /// Of a twin, at the time of `observation`, which is the one followed last. O(log vehicles + lanes
    /// ahead).
    Surroundings surroundings(const traffic::Observation& observation, std::uint32_t row) const;

  private:
    /// One lane of a twin's way.
    struct Step {
        roads::RouteStep road;
        core::LaneIndex exit_lane;  ///< Of the same edge: the nearest that leads on.
        float limit_mps = 0.0F;
    };
    struct Twin {
        core::VehicleKey key;
        std::uint32_t row = 0;
        double time_s = 0.0;    ///< Of its place.
        double report_s = 0.0;  ///< Of the report that it started from.
        traffic::MotionState seen;
        MotionFilter filter;
        core::RouteIndex route;
        IdmDriver driver;
        float length_m = 5.0F;
        float maximum_speed_mps = 55.6F;
        float speed_factor = 1.0F;
        bool on_route = false;
        bool at_end = false;
        // Of its motion along `path`, in metres from the place where the path begins.
        std::vector<Step> path;
        std::uint32_t at = 0;  ///< The step that it is on.
        bool ends = false;     ///< The route ends with the path.
        float travelled_m = 0.0F;
        float before_path_m = 0.0F;  ///< Driven since its report before the path begins.
        float speed_mps = 0.0F;
        float next_speed_mps = 0.0F;
        core::LaneIndex lane;
        float lane_position_m = 0.0F;
        std::uint32_t route_edge = 0;
    };
    /// What a twin has ahead: the largest interaction, and the least acceleration that limits demand.
    struct Ahead {
        float interaction_mps2 = 0.0F;
        float limit_mps2 = 1e9F;
    };

    const Twin& twin_of(std::uint32_t row) const { return twins_[twin_of_row_[row]]; }
    void match_rows(const Tracks& tracks);
    void take_report(const traffic::Observation& observation, const Tracks& tracks, std::uint32_t row);
    void register_driver(const traffic::VehicleInfo* info, Twin& twin) const;
    void learn_speed(const traffic::MotionState& seen, bool is_new, Twin& twin) const;
    void lay_path(const traffic::Observation& observation, Twin& twin);
    core::LaneIndex exit_lane(const roads::RouteStep& step, const roads::RouteStep& next) const;
    void list_places(double time_s);
    void drive(const traffic::Observation& observation, double from_s, double to_s);
    float acceleration(const traffic::Observation& observation, const Twin& twin) const;
    void look_ahead(const traffic::Observation& observation, const Twin& twin, Ahead& ahead) const;
    Neighbour next_on(const Twin& twin, std::size_t step) const;
    Neighbour leader_of(const Twin& twin) const;
    Neighbour follower_of(const Twin& twin) const;
    static const char* letter_of(const traffic::Observation& observation, const roads::RouteStep& step);
    bool heed_signal(const traffic::Observation& observation, const Twin& twin, const roads::RouteStep& step,
                     Ahead& ahead) const;
    void change_lane(Twin& twin) const;
    bool has_room(const Twin& twin, core::LaneIndex lane) const;
    void move(double to_s, Twin& twin) const;
    float desired_speed_mps(const Twin& twin, float limit_mps) const;

    const roads::Network& network_;
    CarFollowingConfig config_;
    std::vector<Twin> twins_;  ///< A twin keeps its place as long as its vehicle is observed.
    std::vector<std::uint32_t> unused_;
    std::vector<std::uint32_t> twin_of_row_, old_twin_of_row_;
    std::vector<std::uint32_t> lagging_;         ///< Twins that have not reached the observation's time.
    std::vector<detail::VehicleOnLane> places_;  ///< At the time of a step, by place in `twins_`; sorted.
    std::vector<detail::VehicleOnLane> moved_;
    /// All twins in the order of `places_` when these were last listed, which they nearly have the next time,
    /// too.
    std::vector<std::uint32_t> in_order_, left_out_;
    std::vector<roads::RouteStep> walked_;
};

}  // namespace clearway::prediction
