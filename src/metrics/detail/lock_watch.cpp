#include "metrics/detail/lock_watch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.hpp"
#include "core/match_rows.hpp"
#include "metrics/detail/standing.hpp"
#include "traffic/signal.hpp"

namespace clearway::metrics::detail {
namespace {

constexpr double look_period_s = 1.0;
/// Half of the time after which one of SUMO's own vehicles may be given up, and longer than most red times.
constexpr double lock_after_s = 60.0;
/// Looks without a locked vehicle for less than this do not end a lock: its queue moved up.
constexpr double same_lock_s = 60.0;
/// A vehicle with the right of way is met if it drives this near to its line, or stands as near as the
/// second.
constexpr float approaching_m = 100.0F;
constexpr float at_line_m = 5.0F;
/// A vehicle stands because of the one ahead if the gap is at most this: twice a usual gap in a queue.
constexpr float queue_gap_m = 10.0F;

constexpr std::uint32_t nothing = core::no_row;
constexpr std::uint32_t excused = core::no_row - 1;
constexpr std::uint32_t unknown = core::no_row - 2;
constexpr std::uint32_t on_path = core::no_row - 3;

}  // namespace

struct LockWatch::Look {
    const truth::Snapshot& snapshot;
    const traffic::Roster& roster;
};

LockWatch::LockWatch(const RoadLayout& layout, StandingReasons reasons)
    : layout_(layout), reasons_(std::move(reasons)) {}

void LockWatch::step(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    const double now_s = snapshot.time.value;
    if (layout_.chain.ways.empty()) return;
    if (last_s_ >= 0.0 && now_s + core::clock_tolerance_s < last_s_ + look_period_s) return;
    const Look look{snapshot, roster};
    core::match_rows(snapshot.key, keys_, row_before_);
    keys_ = snapshot.key;
    sort_by_lane(snapshot);
    end_.assign(snapshot.size(), unknown);
    now_.assign(snapshot.size(), {});
    for (std::uint32_t row = 0; row < snapshot.size(); ++row) {
        Standing& now = now_[row];
        now.lane = snapshot.lane[row];
        now.position_m = snapshot.lane_position_m[row];
        if (!stands(look, row) || end_of_queue(look, row) == excused) continue;
        now.since_s = now_s;
        if (row_before_[row] == core::no_row) continue;
        const Standing& before = before_[row_before_[row]];
        const bool moved = before.lane != now.lane || std::abs(before.position_m - now.position_m) >
                                                          standing_mps * static_cast<float>(look_period_s);
        if (before.since_s == not_standing || moved) continue;
        now.since_s = before.since_s;
        now.locked = before.locked;
        if (now_s - now.since_s > lock_after_s) count(look, row, now);
    }
    before_.swap(now_);
    last_s_ = now_s;
}

bool LockWatch::stands(const Look& look, std::uint32_t row) const {
    return look.snapshot.speed_mps[row] < standing_mps &&
           look.snapshot.lane[row].value < layout_.chain.ways.size();
}

void LockWatch::sort_by_lane(const truth::Snapshot& snapshot) {
    order_.clear();
    for (std::uint32_t row = 0; row < snapshot.size(); ++row)
        if (snapshot.lane[row].value < layout_.chain.ways.size()) order_.push_back(row);
    std::ranges::sort(order_, [&](std::uint32_t left, std::uint32_t right) {
        if (snapshot.lane[left] != snapshot.lane[right])
            return snapshot.lane[left].value < snapshot.lane[right].value;
        if (snapshot.lane_position_m[left] != snapshot.lane_position_m[right])
            return snapshot.lane_position_m[left] > snapshot.lane_position_m[right];
        return left < right;
    });
    first_on_lane_.assign(layout_.chain.ways.size(), nothing);
    last_on_lane_.assign(layout_.chain.ways.size(), nothing);
    place_of_row_.assign(snapshot.size(), nothing);
    for (std::uint32_t place = 0; place < order_.size(); ++place) {
        const std::uint32_t lane = snapshot.lane[order_[place]].value;
        if (first_on_lane_[lane] == nothing) first_on_lane_[lane] = place;
        last_on_lane_[lane] = place;
        place_of_row_[order_[place]] = place;
    }
}

float LockWatch::length_m(const Look& look, std::uint32_t row) const {
    const traffic::VehicleInfo* const info = look.roster.find(look.snapshot.key[row]);
    return info == nullptr ? traffic::VehicleInfo{}.length_m : info->length_m;
}

const LaneWay* LockWatch::way_of(const Look& look, std::uint32_t row, core::LaneIndex lane,
                                 std::size_t later) const {
    const std::vector<LaneWay>& ways = layout_.chain.ways[lane.value];
    const traffic::VehicleInfo* const info = look.roster.find(look.snapshot.key[row]);
    if (is_inside(lane) || info == nullptr) return ways.empty() ? nullptr : &ways.front();
    const std::vector<core::EdgeIndex>& route = look.roster.route(info->route);
    const std::size_t next = look.snapshot.route_edge[row] + 1 + later;
    if (next >= route.size()) return nullptr;
    // Of several lanes of the next edge, it goes to one that leads on, and waits for the fullest.
    const LaneWay* found = nullptr;
    for (const LaneWay& way : ways) {
        if (way.next != route[next]) continue;
        const bool is_better =
            found == nullptr ||
            (leads_on(way, route, next) != leads_on(*found, route, next)
                 ? leads_on(way, route, next)
                 : room_on_m(look, lane_beyond(way)) < room_on_m(look, lane_beyond(*found)));
        if (is_better) found = &way;
    }
    return found;
}

bool LockWatch::leads_on(const LaneWay& way, const std::vector<core::EdgeIndex>& route,
                         std::size_t next) const {
    const std::vector<LaneWay>& beyond = layout_.chain.ways[lane_beyond(way).value];
    return next + 1 >= route.size() || core::contains(beyond, route[next + 1], &LaneWay::next);
}

core::LaneIndex LockWatch::lane_beyond(const LaneWay& way) const {
    core::LaneIndex lane = way.onto;
    while (is_inside(lane) && !layout_.chain.ways[lane.value].empty())
        lane = layout_.chain.ways[lane.value].front().onto;
    return lane;
}

float LockWatch::room_on_m(const Look& look, core::LaneIndex lane) const {
    const std::uint32_t last = last_on_lane_[lane.value];
    if (last == nothing) return std::numeric_limits<float>::max();
    return look.snapshot.lane_position_m[order_[last]] - length_m(look, order_[last]);
}

float LockWatch::room_beyond_m(const Look& look, const LaneWay& way) const {
    float inside_m = 0.0F;
    core::LaneIndex lane = way.onto;
    while (is_inside(lane) && last_on_lane_[lane.value] == nothing &&
           !layout_.chain.ways[lane.value].empty()) {
        inside_m += layout_.chain.length_m[lane.value];
        lane = layout_.chain.ways[lane.value].front().onto;
    }
    return inside_m + room_on_m(look, lane);
}

bool LockWatch::is_inside(core::LaneIndex lane) const {
    return layout_.chain.approach[lane.value] != layout_.chain.edge[lane.value];
}

bool LockWatch::is_red(const Look& look, const LaneWay& way) const {
    if (!way.signal.exists() || way.signal.value >= look.snapshot.signals.state.size()) return false;
    const std::string& state = look.snapshot.signals.state[way.signal.value];
    return way.link < state.size() && !traffic::is_green(state[way.link]);
}

std::uint32_t LockWatch::ahead_on(const Look& look, std::uint32_t row, const LaneWay* way) const {
    // A vehicle keeps a junction clear: it stands before it until there is room for all of it behind.
    float room_m = length_m(look, row) + queue_gap_m;
    for (std::size_t later = 0; way != nullptr && room_m > 0.0F;) {
        if (is_red(look, *way)) return excused;
        const core::LaneIndex lane = way->onto;
        const std::uint32_t last = last_on_lane_[lane.value];
        if (last != nothing) {
            const std::uint32_t ahead = order_[last];
            return is_inside(lane) || room_on_m(look, lane) <= room_m ? ahead : nothing;
        }
        if (!is_inside(lane)) {
            room_m -= layout_.chain.length_m[lane.value];
            ++later;
        }
        way = way_of(look, row, lane, later);
    }
    return nothing;
}

std::uint32_t LockWatch::ahead_of(const Look& look, std::uint32_t row) const {
    const core::LaneIndex lane = look.snapshot.lane[row];
    const float position_m = look.snapshot.lane_position_m[row];
    const std::uint32_t place = place_of_row_[row];
    if (place != first_on_lane_[lane.value]) {
        const std::uint32_t leader = order_[place - 1];
        const float gap_m = look.snapshot.lane_position_m[leader] - length_m(look, leader) - position_m;
        if (gap_m <= queue_gap_m) return leader;
    }
    const LaneWay* const way = way_of(look, row, lane, 0);
    if (way == nullptr) return beside(look, row, lane);
    if (is_red(look, *way)) return excused;
    const float left_m = layout_.chain.length_m[lane.value] - position_m;
    const bool at_end = std::min(left_m, left_m + room_beyond_m(look, *way)) <= queue_gap_m;
    const std::uint32_t ahead = at_end ? ahead_on(look, row, way) : nothing;
    if (ahead != nothing) return ahead;
    const std::uint32_t crossing = across(look, is_inside(lane) ? lane : way->onto, row);
    const traffic::VehicleInfo* const info = look.roster.find(look.snapshot.key[row]);
    if (crossing != nothing || info == nullptr) return crossing;
    const std::vector<core::EdgeIndex>& route = look.roster.route(info->route);
    if (leads_on(*way, route, look.snapshot.route_edge[row] + std::size_t{1})) return nothing;
    const std::uint32_t neighbour = is_inside(lane) ? nothing : beside(look, row, lane);
    return neighbour != nothing ? neighbour : beyond(look, row, *way, route);
}

std::uint32_t LockWatch::beyond(const Look& look, std::uint32_t row, const LaneWay& way,
                                const std::vector<core::EdgeIndex>& route) const {
    const std::size_t after = look.snapshot.route_edge[row] + std::size_t{2};
    const auto& edge = layout_.chain.edge;
    for (std::uint32_t lane = 0; lane < edge.size(); ++lane) {
        if (edge[lane] != way.next || last_on_lane_[lane] == nothing) continue;
        const bool leads =
            after >= route.size() || core::contains(layout_.chain.ways[lane], route[after], &LaneWay::next);
        if (leads && room_on_m(look, core::LaneIndex{lane}) <= length_m(look, row) + queue_gap_m)
            return order_[last_on_lane_[lane]];
    }
    return nothing;
}

std::uint32_t LockWatch::beside(const Look& look, std::uint32_t row, core::LaneIndex lane) const {
    const auto& edge = layout_.chain.edge;
    const auto holds = [&](std::uint32_t other) {
        return first_on_lane_[other] != nothing && way_of(look, row, core::LaneIndex{other}, 0) != nullptr;
    };
    for (std::uint32_t other = lane.value; other-- > 0 && edge[other] == edge[lane.value];)
        if (holds(other)) return order_[first_on_lane_[other]];
    for (std::uint32_t other = lane.value + 1; other < edge.size() && edge[other] == edge[lane.value];
         ++other)
        if (holds(other)) return order_[first_on_lane_[other]];
    return nothing;
}

std::uint32_t LockWatch::across(const Look& look, core::LaneIndex inside, std::uint32_t row) const {
    if (inside.value >= layout_.chain.foes.size()) return nothing;
    std::uint32_t blocker = nothing;
    for (const core::LaneIndex lane : layout_.chain.foes[inside.value]) {
        const std::uint32_t first = first_on_lane_[lane.value];
        for (std::uint32_t place = first; first != nothing && place <= last_on_lane_[lane.value]; ++place) {
            if (!stands(look, order_[place])) return excused;
            if (order_[place] != row) blocker = std::min(blocker, order_[place]);
        }
    }
    if (blocker != nothing) return blocker;
    for (const core::LaneIndex lane : layout_.chain.prior[inside.value]) {
        const std::uint32_t first = first_on_lane_[lane.value];
        if (first == nothing || order_[first] == row) continue;
        const float left_m =
            layout_.chain.length_m[lane.value] - look.snapshot.lane_position_m[order_[first]];
        const bool waits = stands(look, order_[first]);
        if (!waits && left_m <= approaching_m) return excused;
        if (waits && left_m <= at_line_m) blocker = std::min(blocker, order_[first]);
    }
    return blocker;
}

bool LockWatch::is_held(const Look& look, std::uint32_t row) const {
    if (reasons_.at_stop && reasons_.at_stop(look.snapshot.key[row])) return true;
    if (!reasons_.pedestrian_on) return false;
    const core::EdgeIndex approach = layout_.chain.approach[look.snapshot.lane[row].value];
    return std::ranges::any_of(layout_.chain.crossings[approach.value], reasons_.pedestrian_on);
}

std::uint32_t LockWatch::end_of_queue(const Look& look, std::uint32_t row) {
    path_.clear();
    std::uint32_t found = unknown;
    for (std::uint32_t at = row; found == unknown;) {
        if (end_[at] ==
            on_path) {  // A ring; rows are ordered by key, so its name does not depend on the start.
            found = *std::min_element(std::ranges::find(path_, at), path_.end());
        } else if (end_[at] != unknown) {
            found = end_[at];
        } else if (!stands(look, at)) {
            found = excused;
        } else {
            end_[at] = on_path;
            path_.push_back(at);
            const std::uint32_t ahead = ahead_of(look, at);
            if (ahead == nothing)
                found = is_held(look, at) ? excused : at;
            else if (ahead == excused)
                found = excused;
            else
                at = ahead;
        }
    }
    for (const std::uint32_t passed : path_)
        end_[passed] = found;
    return found;
}

LockRow& LockWatch::lock_at(core::EdgeIndex edge, double since_s, double now_s) {
    const std::string& junction = layout_.chain.junctions[edge.value];
    for (LockRow& lock : locks_) {
        if (lock.junction != junction || now_s > lock.from_s + lock.lasted_s + same_lock_s) continue;
        lock.from_s = std::min(lock.from_s, since_s);
        return lock;
    }
    return locks_.emplace_back(LockRow{layout_.chain.edge_ids[edge.value], junction, since_s, 0.0, 0, 0});
}

void LockWatch::count(const Look& look, std::uint32_t row, Standing& now) {
    const core::VehicleKey vehicle = look.snapshot.key[row];
    // A bus at its stop has a reason of its own in a queue that has none.
    if (reasons_.at_stop && reasons_.at_stop(vehicle)) {
        now.since_s = not_standing;
        now.locked = false;
        return;
    }
    const double now_s = look.snapshot.time.value;
    const std::uint32_t end = end_[row];
    assert(end < look.snapshot.size());
    LockRow& lock = lock_at(layout_.chain.approach[look.snapshot.lane[end].value], now.since_s, now_s);
    lock.lasted_s = now_s - lock.from_s;
    locked_vehicle_s_ += now_s - (now.locked ? last_s_ : now.since_s);
    if (now.locked) return;
    now.locked = true;
    const bool emergency = look.snapshot.vehicle_class[row] == traffic::VehicleClass::emergency;
    ++lock.vehicles;
    if (emergency) ++lock.emergency_vehicles;
    locked_.insert(vehicle);
    if (emergency) locked_emergency_.insert(vehicle);
}

std::vector<LockRow> LockWatch::rows() const {
    std::vector<LockRow> rows = locks_;
    std::ranges::stable_sort(rows, {}, &LockRow::from_s);
    return rows;
}

void LockWatch::describe(RunMetrics& metrics) const {
    metrics.locks = locks_.size();
    metrics.locked_vehicles = locked_.size();
    metrics.locked_emergency_vehicles = locked_emergency_.size();
    metrics.locked_vehicle_s = locked_vehicle_s_;
    for (const LockRow& lock : locks_)
        metrics.longest_lock_s = std::max(metrics.longest_lock_s, lock.lasted_s);
}

}  // namespace clearway::metrics::detail
