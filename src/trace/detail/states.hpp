#pragma once

#include <bit>
#include <cassert>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "trace/detail/tables.hpp"
#include "traffic/observation.hpp"
#include "truth/snapshot.hpp"

namespace clearway::trace::detail {

/// Stands for no row of /snapshot.
inline constexpr std::int64_t no_snapshot_row = -1;

/// The rows of /snapshot that a report or belief may name in place of a state: for each vehicle the present
/// row and that of its last report. Most reports and beliefs equal the truth of some moment, and so take
/// almost no space.
class KnownStates {
  public:
    /// Begins a step: `vehicles` are the rows in /vehicles of the vehicles of `now`, `first_row` is the first
    /// row of the step in /snapshot.
    void start_step(const truth::Snapshot& now, const std::vector<std::uint32_t>& vehicles,
                    std::uint64_t first_row) {
        assert(vehicles.size() == now.size());
        ++step_;
        for (std::uint32_t row = 0; row < vehicles.size(); ++row) {
            if (vehicles[row] == none) continue;
            Known& known = of(vehicles[row]);
            known.present = {static_cast<std::int64_t>(first_row + row), now.motion(row)};
            known.step = step_;
        }
    }
    /// Row with exactly this state; `no_snapshot_row` when none is known.
    std::int64_t row_of(std::uint32_t vehicle, const traffic::MotionState& state) const {
        if (vehicle >= known_.size()) return no_snapshot_row;
        const Known& known = known_[vehicle];
        if (known.step == step_ && same(known.present.state, state)) return known.present.row;
        if (known.reported.row != no_snapshot_row && same(known.reported.state, state))
            return known.reported.row;
        return no_snapshot_row;
    }
    /// Throws std::runtime_error for a row that `row_of` cannot have returned.
    const traffic::MotionState& state_at(std::uint32_t vehicle, std::int64_t row) const {
        if (vehicle < known_.size()) {
            const Known& known = known_[vehicle];
            if (known.step == step_ && known.present.row == row) return known.present.state;
            if (known.reported.row == row) return known.reported.state;
        }
        throw std::runtime_error("a state is named that does not exist");
    }
    void remember_report(std::uint32_t vehicle, std::int64_t row, const traffic::MotionState& state) {
        if (vehicle != none && row != no_snapshot_row) of(vehicle).reported = {row, state};
    }

  private:
    struct Place {
        std::int64_t row = no_snapshot_row;
        traffic::MotionState state;
    };
    struct Known {
        Place present, reported;
        std::uint64_t step = 0;  ///< Of `present`.
    };

    Known& of(std::uint32_t vehicle) {
        if (vehicle >= known_.size()) known_.resize(vehicle + 1);
        return known_[vehicle];
    }
    static bool same(const traffic::MotionState& one, const traffic::MotionState& other) {
        using State = traffic::MotionState;
        const auto same_real = [&](float State::*member) {
            return std::bit_cast<std::uint32_t>(one.*member) == std::bit_cast<std::uint32_t>(other.*member);
        };
        return same_real(&State::x_m) && same_real(&State::y_m) && same_real(&State::heading_rad) &&
               same_real(&State::speed_mps) && one.lane == other.lane && same_real(&State::lane_position_m) &&
               one.route_edge == other.route_edge;
    }

    std::vector<Known> known_;
    std::uint64_t step_ = 0;
};

/// Columns of a state of motion, or the row of /snapshot that it equals.
template <class File>
class StateColumns {
  public:
    explicit StateColumns(typename File::Rows& rows) : rows_(rows) {}

    /// Returns the row of /snapshot.
    template <class State>
    std::int64_t code(State& state, std::uint32_t vehicle, const KnownStates& known) {
        std::int64_t row = no_snapshot_row;
        if constexpr (!File::reading) row = known.row_of(vehicle, state);
        snapshot_row_(row);
        traffic::MotionState own = row == no_snapshot_row ? state : blank();
        code_members(own);
        if constexpr (File::reading) state = row == no_snapshot_row ? own : known.state_at(vehicle, row);
        return row;
    }

  private:
    template <class Value>
    using Column = ColumnOf<File, Value>;

    static traffic::MotionState blank() {
        constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
        return {nothing, nothing, nothing, nothing, core::LaneIndex::none(), nothing, 0};
    }
    void code_members(traffic::MotionState& state) {
        x_m_(state.x_m);
        y_m_(state.y_m);
        heading_rad_(state.heading_rad);
        speed_mps_(state.speed_mps);
        code_value(lane_, state.lane);
        lane_position_m_(state.lane_position_m);
        route_edge_(state.route_edge);
    }

    typename File::Rows& rows_;
    Column<std::int64_t> snapshot_row_{
        rows_,
        {"snapshot_row", "", "Row of /snapshot with the same state, which is then omitted here; else -1"}};
    Column<float> x_m_{rows_, {"x_m", "m", "Front bumper; NaN: see snapshot_row"}};
    Column<float> y_m_{rows_, {"y_m", "m", "Front bumper; NaN: see snapshot_row"}};
    Column<float> heading_rad_{rows_, {"heading_rad", "rad", "From the x axis; NaN: see snapshot_row"}};
    Column<float> speed_mps_{rows_, {"speed_mps", "m/s", "NaN: see snapshot_row"}};
    Column<std::uint32_t> lane_{rows_, {"lane", "", "Index in the network; 4294967295: none"}};
    Column<float> lane_position_m_{rows_, {"lane_position_m", "m", "NaN: see snapshot_row"}};
    Column<std::uint32_t> route_edge_{rows_, {"route_edge", "1", "Edge of the route, counted from 0"}};
};

/// Rows must be ordered by key. Throws std::invalid_argument when writing, std::runtime_error when reading.
template <class File>
void require_order(core::VehicleKey before, core::VehicleKey key) {
    if (before < key) return;
    if constexpr (File::reading) {
        throw std::runtime_error("vehicles are not ordered");
    } else {
        throw std::invalid_argument("rows are not ordered by key");
    }
}

}  // namespace clearway::trace::detail
