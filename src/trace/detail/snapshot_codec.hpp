#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "trace/detail/codec_lists.hpp"
#include "trace/recording.hpp"

namespace clearway::trace::detail {

/// The signals that show something else than in `base`.
template <class Stream, class Signals>
void code_signals(Stream& stream, Signals& signals, const traffic::SignalStates& base) {
    std::vector<std::uint32_t> changed;
    if constexpr (!Stream::reading) {
        for (std::uint32_t i = 0; i < signals.state.size(); ++i) {
            if (i >= base.state.size() || signals.state[i] != base.state[i]) changed.push_back(i);
        }
    }
    auto count = static_cast<std::uint32_t>(signals.state.size());
    stream.number(count, static_cast<std::uint32_t>(base.state.size()));
    if constexpr (Stream::reading) {
        if (count > 1'000'000) throw std::runtime_error("there are too many signals");
        signals.state = base.state;
        signals.state.resize(count);
    }
    std::uint32_t expected = 0;
    list(stream, changed, [&](auto& index) {
        stream.number(index, expected);
        expected = index + 1;
        if (index >= count) throw std::runtime_error("a signal is unknown");
        if constexpr (Stream::reading) {
            signals.state[index] = stream.text();
        } else {
            stream.text(signals.state[index]);
        }
    });
}

template <class Stream, class Events>
void code_events(Stream& stream, Events& events, core::Seconds now) {
    stream.real(events.time.value, now.value);
    code_keys(stream, events.departed);
    code_keys(stream, events.arrived);
    code_keys(stream, events.teleported);
    code_keys(stream, events.removed);
    list(stream, events.collisions, [&](auto& collision) {
        stream.key(collision.collider);
        stream.key(collision.victim);
        stream.choice(collision.place, truth::CollisionPlace::lane, 2);
        stream.number(collision.lane);
        stream.number(collision.with_emergency_vehicle);
    });
    list(stream, events.emergency_brakings, [&](auto& braking) {
        stream.key(braking.vehicle);
        stream.real(braking.deceleration_mps2);
    });
}

class SnapshotCodec {
  public:
    template <class Stream, class Snapshot>
    void code(Stream& stream, Snapshot& now) {
        stream.real(now.time.value, last_.time.value + step_s_);
        step_s_ = now.time.value - last_.time.value;
        keys_.code(stream, now.key);
        if constexpr (Stream::reading) now.resize(now.key.size());
        code_columns(stream, now);
        code_signals(stream, now.signals, last_.signals);
        remember(now);
    }
    const std::vector<core::VehicleKey>& keys() const { return keys_.now(); }

  private:
    template <class Stream, class Snapshot>
    void code_columns(Stream& stream, Snapshot& now) {
        const auto before = [&](std::uint32_t row) { return keys_.before()[row]; };
        const auto of = [&](const auto& values, std::uint32_t row) {
            return before(row) == no_row ? std::decay_t<decltype(values[0])>{} : values[before(row)];
        };
        const std::size_t rows = now.key.size();
        column(stream, rows, [&](std::uint32_t row) {
            stream.choice(now.vehicle_class[row], of(last_.vehicle_class, row),
                          traffic::vehicle_classes.size());
        });
        column(stream, rows,
               [&](std::uint32_t row) { stream.number(now.route_edge[row], of(last_.route_edge, row)); });
        column(stream, rows, [&](std::uint32_t row) { stream.number(now.lane[row], of(last_.lane, row)); });
        column(stream, rows,
               [&](std::uint32_t row) { stream.real(now.speed_mps[row], of(last_.speed_mps, row)); });
        column(stream, rows, [&](std::uint32_t row) {
            const double gained_mps = double{now.speed_mps[row]} - double{of(last_.speed_mps, row)};
            const bool is_new = before(row) == no_row || step_s_ <= 0.0;
            stream.real(now.acceleration_mps2[row], is_new ? 0.0F : static_cast<float>(gained_mps / step_s_));
        });
        column(stream, rows,
               [&](std::uint32_t row) { stream.real(now.heading_rad[row], of(last_.heading_rad, row)); });
        column(stream, rows, [&](std::uint32_t row) {
            const double driven_m = double{now.speed_mps[row]} * step_s_;
            stream.real(now.lane_position_m[row],
                        static_cast<float>(double{of(last_.lane_position_m, row)} + driven_m));
        });
        column(stream, rows, [&](std::uint32_t row) {
            stream.real(now.x_m[row], moved_on(of(last_.x_m, row), of(moved_x_m_, row), row, now));
        });
        column(stream, rows, [&](std::uint32_t row) {
            stream.real(now.y_m[row], moved_on(of(last_.y_m, row), of(moved_y_m_, row), row, now));
        });
    }

    /// As far as in the step before, in proportion to the speeds.
    float moved_on(float last_m, double moved_m, std::uint32_t row, const truth::Snapshot& now) const {
        const std::uint32_t before = keys_.before()[row];
        const double speed_mps = before == no_row ? 0.0 : double{last_.speed_mps[before]};
        if (speed_mps <= 0.0) return last_m;
        return static_cast<float>(double{last_m} + moved_m * (double{now.speed_mps[row]} / speed_mps));
    }

    void remember(const truth::Snapshot& now) {
        const auto moved = [&](const std::vector<float>& to_m, const std::vector<float>& from_m,
                               std::vector<double>& moved_m) {
            moved_m.resize(to_m.size());
            for (std::uint32_t row = 0; row < to_m.size(); ++row) {
                const std::uint32_t before = keys_.before()[row];
                moved_m[row] = before == no_row ? 0.0 : double{to_m[row]} - double{from_m[before]};
            }
        };
        moved(now.x_m, last_.x_m, moved_x_m_);
        moved(now.y_m, last_.y_m, moved_y_m_);
        last_ = now;
    }

    KeyList keys_;
    truth::Snapshot last_;
    std::vector<double> moved_x_m_, moved_y_m_;
    double step_s_ = 0.0;
};

}  // namespace clearway::trace::detail
