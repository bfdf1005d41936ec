#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "prediction/candidates.hpp"
#include "prediction/detail/detections.hpp"
#include "prediction/detail/vehicle_on_lane.hpp"
#include "prediction/motion_filter.hpp"
#include "roads/network.hpp"
#include "roads/route.hpp"
#include "traffic/observation.hpp"

namespace clearway::prediction {

/// Points of the way ahead of a vehicle that was not heard, from where it was last seen.
inline constexpr std::size_t path_points = 16;

/// Where a displacement takes a vehicle: points at displacements 0 ... reach, evenly spaced.
struct Path {
    std::array<roads::Point, path_points> points;

    /// Place at a displacement (clamped to the reach, which is > 0), and the direction of travel there (a
    /// unit vector).
    roads::Point place_at(float displacement_m, float reach_m) const;
    roads::Point direction_at(float displacement_m, float reach_m) const;
};

/// Another vehicle on the way ahead, as it is believed now.
struct VehicleOnWay {
    bool exists = false;
    bool known = false;  ///< It was heard just now.
    std::uint32_t row = 0;
    float distance_m = 0.0F;  ///< Of its front from the place where the vehicle itself was last seen.
    float length_m = 0.0F;
    float speed_mps = 0.0F;
};

/// A stop line with a signal on the way.
struct LineOnWay {
    float distance_m = -1.0F;  ///< Negative: there is none.
    char state = 0;            ///< What the signal shows for the vehicle's link (SUMO's letter).
    float state_age_s = 0.0F;  ///< Since when, as far as was seen.

    bool exists() const { return distance_m >= 0.0F; }
};

/// What route, map, signals and other reports tell about a vehicle that was not heard just now. Displacements
/// count along its route from where it was last seen.
struct MotionContext {
    std::uint32_t row = 0;      ///< Of the scene's tracks.
    float reach_m = 0.0F;       ///< It cannot have come further. > 0.
    float route_left_m = 0.0F;  ///< To the end of its route; at most `route_horizon_m` beyond the reach.
    Path path;

    LineOnWay line, next_line;        ///< The first two within the reach and `route_horizon_m`.
    VehicleOnWay leader;              ///< The vehicle ahead in its lane when it was last heard.
    VehicleOnWay follower;            ///< The vehicle behind it then.
    float smoothed_speed_mps = 0.0F;  ///< Of its reports, newest weighted by 0.3.

    float travelled_m = 0.0F;     ///< Reported speed x age, at most `reach_m`.
    float free_flow_m = 0.0F;     ///< At the speed limits of the lanes on its way, at most `reach_m`.
    float sigma_m = 0.0F;         ///< Standard deviation of the place where it was last seen, filtered.
    bool has_left = false;        ///< Past the end of its route, where no detector tells of exits.
    float displacement_m = 0.0F;  ///< By the rule: see `MotionContextBuilder`.
    bool held_by_signal = false;
    float held_at_m = 0.0F;  ///< The line that holds it, where one does.
    bool held_by_leader = false;
    std::uint32_t detections = 0;  ///< Neighbours with known places that still detect it.
    bool drives = false;           ///< The scene has a twin of it; then `twin_m` is its displacement.
    float twin_m = 0.0F;           ///< At most `reach_m`; by detections, as the rule's.

    /// Where it is believed to be before a net corrects it: by its twin, or by the rule.
    float believed_m() const { return drives ? twin_m : displacement_m; }

    roads::Point place_at(float displacement) const { return path.place_at(displacement, reach_m); }
    roads::Point direction_at(float displacement) const { return path.direction_at(displacement, reach_m); }
};

inline constexpr float route_horizon_m = 200.0F;

/// How vehicles that were seen standing start again. The default is what trained nets know: they never do.
struct StartAtGreen {
    float acceleration_mps2 = 0.0F;  ///< 0: a vehicle that was seen standing stays.
    float wave_mps = 5.0F;           ///< Speed at which the start runs back through a queue. > 0.
};

/// Finds the `MotionContext` of all vehicles that are not known, and says where the rule puts them:
///
///   1. it went on at its reported speed along its route (dead reckoning) from where it was last seen; noisy
///      places are filtered first (motion_filter.hpp),
///   2. not beyond the first stop line that shows red or yellow,
///   3. not into the vehicle that was ahead of it in its lane (its rear, less the minimum gap),
///      as far as that one is believed to have come,
///   4. and, of the places within reach, rather where the neighbours that still detect it can do so: the
///      displacement s that makes ((s - s3) / (1 m + 2.5 m/s age))^2 + sum (miss / 5 m)^2 least, where a miss
///      is the distance beyond the link radius, or the error of a measured range.
///
/// With a `StartAtGreen`, a vehicle that was seen (nearly) standing before a line that is green now has
/// started since: when the light turned green and the start had run back to it, it accelerated up to the
/// speed limit. Step 2 then regards the second line ahead, too.
///
/// Keeps what reports do not repeat: which vehicle followed which, mean speeds, and how long a signal has
/// shown its state. Call it with every observation, in order. One builder, one thread; no allocation once
/// buffers have grown.
class MotionContextBuilder {
  public:
    /// `network` outlives the builder.
    MotionContextBuilder(const roads::Network& network, const graph::LinkRules& rules,
                         StartAtGreen start = {});

    /// `scene` was built from `observation`. `ahead` gets one entry per row that is not known, by row.
    void build(const traffic::Observation& observation, const Scene& scene,
               std::vector<MotionContext>& ahead);

    /// Mean speed of the known vehicles in the lane of each row's last report, m/s; negative without any.
    const std::vector<float>& lane_speed_mps() const { return lane_speed_mps_; }
    /// Smoothed reported speed of each row, m/s.
    float smoothed_speed_mps(std::uint32_t row) const { return memories_[row].smoothed_speed_mps; }
    /// The lanes on the way of an entry of `ahead`, from where it was last seen; empty without a route.
    std::span<const roads::RouteStep> way_of(std::size_t entry) const {
        return std::span(steps_).subspan(steps_of_[entry].first, steps_of_[entry].count);
    }
    /// Of the last scene in which a vehicle was not known.
    const detail::Detections& detections() const { return detections_; }

  private:
    struct Memory {
        core::VehicleKey key;
        double report_s = std::numeric_limits<double>::lowest();
        float smoothed_speed_mps = 0.0F;
        MotionFilter seen;                  ///< When it was last heard.
        core::VehicleKey leader, follower;  ///< When it was last heard; value 0: none.
        bool neighbours_noted = false;
    };
    /// Steps of one entry of `ahead` in `steps_`.
    struct Steps {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };

    void remember(const traffic::Observation& observation, const Tracks& tracks);
    static void filter_report(const traffic::MotionState& seen, float sigma_m, double report_s, bool is_new,
                              Memory& memory);
    void find_lines(const traffic::Observation& observation, MotionContext& ahead) const;
    void watch_signals(const traffic::Observation& observation);
    void look_ahead(const traffic::Observation& observation, const Tracks& tracks, MotionContext& ahead);
    float started_m(const Tracks& tracks, const MotionContext& ahead, float desired_mps) const;
    void hold_at_red(MotionContext& ahead) const;
    void lay_path(const Tracks& tracks, MotionContext& ahead) const;
    void list_places(const Tracks& tracks, const std::vector<MotionContext>& ahead);
    void sort_places();
    void note_neighbours(const traffic::Observation& observation, const Tracks& tracks);
    core::VehicleKey leader_before(const traffic::Observation& observation, const Tracks& tracks,
                                   const detail::VehicleOnLane& place);
    void find_neighbours(const Tracks& tracks, std::vector<MotionContext>& ahead);
    void hold_behind_leaders(std::vector<MotionContext>& ahead) const;
    void follow_twins(const Scene& scene, std::vector<MotionContext>& ahead) const;
    void follow_detections(const Scene& scene, std::vector<MotionContext>& ahead);
    void measure_lane_speeds(const Tracks& tracks);
    VehicleOnWay on_way(const Tracks& tracks, const std::vector<MotionContext>& ahead, core::VehicleKey key,
                        std::span<const roads::RouteStep> steps) const;

    const roads::Network& network_;
    graph::LinkRules rules_;
    StartAtGreen start_;
    std::vector<Memory> memories_, old_memories_;  ///< One per row, by key.
    std::vector<std::string> signal_states_;
    std::vector<std::vector<double>> signal_state_since_s_;
    std::vector<roads::RouteStep> steps_, walked_;
    std::vector<Steps> steps_of_;
    std::vector<std::uint32_t> ahead_of_row_;           ///< Entry of `ahead`, or the number of rows.
    std::vector<detail::VehicleOnLane> place_of_row_;   ///< Where each vehicle is believed to be.
    std::vector<detail::VehicleOnLane> lane_places_;    ///< The same on lanes, sorted.
    std::vector<detail::VehicleOnLane> places_before_;  ///< Of the previous call; sorted on first use.
    bool places_before_sorted_ = false;
    detail::Detections detections_;
    std::vector<float> lane_speed_mps_;
};

namespace detail {

/// The state of a vehicle after a displacement: on its lane along its route, at the place of the path.
traffic::MotionState state_after(const roads::Network& network, const traffic::Observation& observation,
                                 const Tracks& tracks, const MotionContext& ahead, float displacement_m);

}  // namespace detail

}  // namespace clearway::prediction
