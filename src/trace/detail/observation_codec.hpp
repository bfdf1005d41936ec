#pragma once

#include <cstdint>
#include <vector>

#include "trace/detail/roster_codec.hpp"
#include "trace/detail/snapshot_codec.hpp"

namespace clearway::trace::detail {

/// Columns of the motion of rows: `state(row)` is it and `foreseen(row)` what is expected.
template <class Stream, class State, class Foreseen>
void code_motion(Stream& stream, std::size_t rows, const State& state, const Foreseen& foreseen) {
    using traffic::MotionState;
    for (float MotionState::*const member : {&MotionState::x_m, &MotionState::y_m, &MotionState::heading_rad,
                                             &MotionState::speed_mps, &MotionState::lane_position_m}) {
        column(stream, rows,
               [&](std::uint32_t row) { stream.real(state(row).*member, foreseen(row).*member); });
    }
    column(stream, rows, [&](std::uint32_t row) { stream.number(state(row).lane, foreseen(row).lane); });
    column(stream, rows,
           [&](std::uint32_t row) { stream.number(state(row).route_edge, foreseen(row).route_edge); });
}

/// Reports, expected to say what the snapshot says, or what they said before.
class ReportsCodec {
  public:
    template <class Stream, class Reports>
    void code(Stream& stream, Reports& now, const truth::Snapshot& snapshot, double elapsed_s) {
        keys_.code_rows(stream, now);
        core::match_rows(keys_.now(), snapshot.key, true_row_);
        code_columns(stream, now, snapshot, elapsed_s);
        last_ = now;
    }
    const std::vector<core::VehicleKey>& keys() const { return keys_.now(); }

  private:
    const traffic::ObservedVehicle* before(std::uint32_t row) const {
        return keys_.before()[row] == no_row ? nullptr : &last_[keys_.before()[row]];
    }

    template <class Stream, class Reports>
    void code_columns(Stream& stream, Reports& now, const truth::Snapshot& snapshot, double elapsed_s) {
        const std::size_t rows = now.size();
        column(stream, rows, [&](std::uint32_t row) {
            const bool is_there = true_row_[row] != no_row;
            const auto* const old = before(row);
            stream.choice(now[row].vehicle_class,
                          is_there ? snapshot.vehicle_class[true_row_[row]]
                          : old    ? old->vehicle_class
                                   : traffic::VehicleClass::human,
                          traffic::vehicle_classes.size());
        });
        column(stream, rows, [&](std::uint32_t row) {
            const auto* const old = before(row);
            stream.choice(now[row].freshness, old ? old->freshness : traffic::Freshness::fresh, 2);
        });
        column(stream, rows, [&](std::uint32_t row) {
            const auto* const old = before(row);
            const float aged_s = old ? static_cast<float>(double{old->age_s} + elapsed_s) : 0.0F;
            stream.real(now[row].age_s,
                        now[row].freshness == traffic::Freshness::fresh ? fresh_age_s_ : aged_s);
            if (now[row].freshness == traffic::Freshness::fresh) fresh_age_s_ = now[row].age_s;
        });
        column(stream, rows, [&](std::uint32_t row) {
            stream.real(now[row].position_sigma_m, row == 0 ? 0.0F : now[row - 1].position_sigma_m);
        });
        code_motion(
            stream, rows, [&](std::uint32_t row) -> auto& { return now[row].state; },
            [&](std::uint32_t row) {
                const auto* const old = before(row);
                const bool is_there = true_row_[row] != no_row;
                if (old && (now[row].age_s != 0.0F || !is_there)) return old->state;
                return is_there ? snapshot.motion(true_row_[row]) : traffic::MotionState{};
            });
    }

    KeyList keys_;
    std::vector<traffic::ObservedVehicle> last_;
    std::vector<std::uint32_t> true_row_;
    float fresh_age_s_ = 0.0F;  ///< Of the last fresh report.
};

class ObservationCodec {
  public:
    /// `roster` is the true one, `own_roster` that of the sensor.
    template <class Stream, class Observation, class Roster>
    void code(Stream& stream, Observation& now, const truth::Snapshot& snapshot, Roster& roster,
              Roster& own_roster) {
        stream.number(now.is_report);
        stream.number(now.exits_known, true);
        stream.real(now.time.value, snapshot.time.value);
        stream.real(now.report_time.value, now.is_report ? now.time.value : last_report_s_);
        const double elapsed_s = now.time.value - last_s_;
        last_s_ = now.time.value;
        last_report_s_ = now.report_time.value;

        bool is_own = now.roster != &roster;
        stream.number(is_own);
        if constexpr (Stream::reading) now.roster = is_own ? &own_roster : &roster;
        if (is_own) own_roster_.code(stream, own_roster);
        reports_.code(stream, now.vehicles, snapshot, elapsed_s);
        own_states_.code(stream, now.own_states, snapshot, elapsed_s);
        list(stream, now.detected_links, [&](auto& link) {
            stream.key(link.from);
            stream.key(link.to);
            stream.real(link.range_m, -1.0F);
            stream.real(link.range_sigma_m);
        });
        code_signals(stream, now.signals, snapshot.signals);
    }
    const std::vector<core::VehicleKey>& keys() const { return reports_.keys(); }
    const std::vector<core::VehicleKey>& own_keys() const { return own_states_.keys(); }

  private:
    RosterCodec own_roster_{RosterCodec::Keys::known};
    ReportsCodec reports_, own_states_;
    double last_s_ = 0.0;
    double last_report_s_ = 0.0;
};

}  // namespace clearway::trace::detail
