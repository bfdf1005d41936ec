#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/fields.hpp"
#include "policy/ask.hpp"
#include "policy/detail/view.hpp"

namespace clearway::policy::detail {

/// How an emergency vehicle's way through the lanes is chosen; members of the settings of parts that clear
/// it.
struct LanePlanConfig : AskSettings {
    /// Delay by a vehicle that stands ahead and is not asked. Assumed: a third of a red phase.
    static constexpr double blocked_s = 15.0;
    /// Delay by a vehicle that is not asked, times the share by which it is slower than the emergency
    /// vehicle may drive. Assumed.
    static constexpr double slow_s = 4.0;
    /// Delay by a vehicle that is asked to make room. Assumed: it is gone in time, mostly.
    static constexpr double clears_s = 0.5;
    double change_s = 1.0;
    /// A slower vehicle counts as standing. Assumed: walking pace is 1.4 m/s.
    static constexpr double halted_mps = 0.5;

    static constexpr void fields(const auto& table) {
        using C = LanePlanConfig;
        using core::Field;
        table(Field{"change_s", "s", &C::change_s, 0.0, 60.0, "Time that a lane change costs", "assumed"});
        AskSettings::fields(table);
    }
};

/// What a plan is made from; refers to all of it.
struct PlanScene {
    const View& view;
    const traffic::BelievedVehicle& emergency;
    const std::vector<VehicleAhead>& ahead;
    const Audience& audience;  ///< Who is asked to make room.
};

/// The way of an emergency vehicle through the lanes ahead, around vehicles that make no room: the cheapest
/// sequence of lanes over cells of 10 m, by dynamic programming. So one vehicle that does not cooperate costs
/// two lane changes and not the lane. Refers to the view; use it within one `act`.
class LanePlan {
  public:
    LanePlan(const PlanScene& scene, const LanePlanConfig& config, double horizon_m);

    /// Lane number on the present edge from whose way the plan is at this distance; nothing beyond the plan.
    std::optional<std::uint32_t> column_at(double distance_m) const;
    /// The column that a lane belongs to: the lane number on the present edge from which one gets there
    /// without a lane change. Nothing for lanes off the emergency vehicle's way.
    std::optional<std::uint32_t> column_of(core::LaneIndex lane) const;
    /// The neighbouring lane to change to now, if the plan changes within `distance_m`.
    std::optional<std::uint32_t> change_within(double distance_m) const;

  private:
    void find_columns(const View& view, const traffic::BelievedVehicle& emergency, double horizon_m);
    std::vector<double> costs(const PlanScene& scene, const LanePlanConfig& config) const;
    void choose(const std::vector<double>& cost, double change_s);
    /// Place in a table of all cells and columns.
    std::size_t at(std::size_t cell, std::size_t column) const { return cell * numbers_.size() + column; }
    /// Row of the column that a lane belongs to.
    std::optional<std::size_t> row_of(core::LaneIndex lane) const;

    std::size_t own_ = 0;                 ///< Row of the present lane in `numbers_`.
    std::vector<std::uint32_t> numbers_;  ///< Lane numbers of the columns, ascending.
    /// Of columns, by lane; the first of a lane counts.
    std::vector<std::pair<core::LaneIndex, std::size_t>> rows_;
    std::vector<std::size_t> plan_;  ///< Column by cell.
};

/// Asks the emergency vehicle to follow its plan: to change lanes where the plan does so within
/// `change_ahead_s`, or within two cells if it stands.
void follow(const LanePlan& plan, const traffic::BelievedVehicle& emergency, double change_ahead_s,
            LeaseWriter& write);

/// Length of a cell of a plan, m: a car and its gap, and a little.
inline constexpr double plan_cell_m = 10.0;

}  // namespace clearway::policy::detail
