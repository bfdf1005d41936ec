#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "metrics/recorder.hpp"
#include "metrics/road_layout.hpp"
#include "metrics/run_metrics.hpp"
#include "metrics/traffic_tables.hpp"
#include "traffic/vehicle.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// Counts locks. A vehicle is locked when it has stood for over 60 s and all that time nothing explained it:
/// no red or yellow for its way, no stop, no pedestrian on a crossing, no moving vehicle ahead or across, and
/// no queue that ends at one of these. What a vehicle waits for is followed from vehicle to vehicle: the one
/// ahead on its route, through junctions, else one that stands inside the junction across its way, else one
/// with the right of way at its line. A lock is where this ends: at a vehicle that waits for nothing, or in a
/// ring. Looks once a second, in time linear in the vehicles on the road (but for sorting).
class LockWatch {
  public:
    /// The layout outlives the watch.
    LockWatch(const RoadLayout& layout, StandingReasons reasons);

    /// One step. The roster lists every vehicle of the snapshot; a vehicle that it lacks drives on by the
    /// first way of its lane.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster);
    void describe(RunMetrics& metrics) const;
    std::vector<LockRow> rows() const;

  private:
    static constexpr double not_standing = -1.0;

    /// A vehicle at the look before.
    struct Standing {
        double since_s = not_standing;  ///< Without a reason.
        bool locked = false;
        core::LaneIndex lane;
        float position_m = 0.0F;
    };
    struct Look;

    bool stands(const Look& look, std::uint32_t row) const;
    void sort_by_lane(const truth::Snapshot& snapshot);
    /// The nearest vehicle ahead, `nothing`, or `excused` where something explains that the vehicle stands.
    std::uint32_t ahead_of(const Look& look, std::uint32_t row) const;
    std::uint32_t ahead_on(const Look& look, std::uint32_t row, const LaneWay* way) const;
    /// What keeps the first of a queue from `inside`, a lane in a junction.
    std::uint32_t across(const Look& look, core::LaneIndex inside, std::uint32_t row) const;
    /// From `lane`, which lies `later` edges ahead on the vehicle's route; null where its route does not lead
    /// on.
    const LaneWay* way_of(const Look& look, std::uint32_t row, core::LaneIndex lane, std::size_t later) const;
    bool is_inside(core::LaneIndex lane) const;
    /// Who holds the lanes beside one from which a vehicle has to change, or `nothing`.
    std::uint32_t beside(const Look& look, std::uint32_t row, core::LaneIndex lane) const;
    /// Who fills the lanes behind the junction that lead on, where that of its own way does not, or
    /// `nothing`.
    std::uint32_t beyond(const Look& look, std::uint32_t row, const LaneWay& way,
                         const std::vector<core::EdgeIndex>& route) const;
    /// Whether the lane behind a way onto edge `next` of a route leads to the edge after it.
    bool leads_on(const LaneWay& way, const std::vector<core::EdgeIndex>& route, std::size_t next) const;
    /// The lane behind the junction that a way leads across.
    core::LaneIndex lane_beyond(const LaneWay& way) const;
    /// From the lane's beginning to the rear of the last vehicle on it; without end if it is empty.
    float room_on_m(const Look& look, core::LaneIndex lane) const;
    /// From the junction that a way leads across to the rear of the first vehicle behind its line; below 0
    /// when that vehicle reaches back over the line.
    float room_beyond_m(const Look& look, const LaneWay& way) const;
    bool is_red(const Look& look, const LaneWay& way) const;
    float length_m(const Look& look, std::uint32_t row) const;
    bool is_held(const Look& look, std::uint32_t row) const;
    /// The row where the queue ahead ends, or `excused`.
    std::uint32_t end_of_queue(const Look& look, std::uint32_t row);
    void count(const Look& look, std::uint32_t row, Standing& now);
    LockRow& lock_at(core::EdgeIndex edge, double since_s, double now_s);

    const RoadLayout& layout_;
    StandingReasons reasons_;
    double last_s_ = -1.0;
    std::vector<core::VehicleKey> keys_;  ///< At the look before, with the next two.
    std::vector<Standing> before_;
    std::vector<Standing> now_;
    std::vector<std::uint32_t> row_before_;
    std::vector<std::uint32_t> order_;          ///< Rows by lane, the first on a lane in front.
    std::vector<std::uint32_t> place_of_row_;   ///< In `order_`.
    std::vector<std::uint32_t> last_on_lane_;   ///< Place in `order_` of the last vehicle of each lane.
    std::vector<std::uint32_t> first_on_lane_;  ///< Likewise of the first.
    std::vector<std::uint32_t> end_;            ///< By row; what `end_of_queue` found.
    std::vector<std::uint32_t> path_;
    std::vector<LockRow> locks_;
    std::set<core::VehicleKey> locked_;
    std::set<core::VehicleKey> locked_emergency_;
    double locked_vehicle_s_ = 0.0;
};

}  // namespace clearway::metrics::detail
