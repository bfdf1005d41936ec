#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "results/recording.hpp"

namespace clearway::results::detail {

// One description of a recorded step for both ways: `Stream` is a NumberWriter, and the structs are const, or
// a NumberReader that fills them. What a reader can foresee comes from the step before: a vehicle moves on
// as it did, at the speed that it has now; a report says what the snapshot says; a belief says what was
// reported. All of it is arithmetic that IEEE 754 defines to the bit; functions of the mathematical library
// are not used, for their last bit differs between machines.

/// Does not compile when one of the structs gets or loses a member: it must be coded below, and
/// `recording_format` raised.
inline void every_member_is_coded(const traffic::Lease& lease, const truth::Events& events,
                                  const truth::Snapshot& snapshot, const traffic::Observation& observation,
                                  const traffic::BelievedGraph& belief) {
    [[maybe_unused]] const auto& [l1, l2, l3, l4, l5, l6, l7] = lease;
    [[maybe_unused]] const auto& [e1, e2, e3, e4, e5, e6, e7] = events;
    [[maybe_unused]] const auto& [c1, c2, c3, c4, c5] = truth::Collision{};
    [[maybe_unused]] const auto& [k1, k2] = truth::EmergencyBraking{};
    [[maybe_unused]] const auto& [s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11, s12] = snapshot;
    [[maybe_unused]] const auto& [o1, o2, o3, o4, o5, o6, o7, o8, o9] = observation;
    [[maybe_unused]] const auto& [v1, v2, v3, v4, v5, v6] = traffic::ObservedVehicle{};
    [[maybe_unused]] const auto& [d1, d2, d3, d4] = traffic::DetectedLink{};
    [[maybe_unused]] const auto& [m1, m2, m3, m4, m5, m6, m7] = traffic::MotionState{};
    [[maybe_unused]] const auto& [b1, b2, b3, b4, b5, b6, b7] = belief;
    [[maybe_unused]] const auto& [w1, w2, w3, w4, w5] = traffic::BelievedVehicle{};
    [[maybe_unused]] const auto& [n1, n2, n3] = traffic::BelievedLink{};
    [[maybe_unused]] const auto& [i1, i2, i3, i4, i5, i6, i7, i8, i9, i10, i11, i12] = traffic::VehicleInfo{};
}

inline constexpr std::uint32_t no_row = std::numeric_limits<std::uint32_t>::max();

/// Row in `sorted` of each of `keys`, both ascending; `no_row` where there is none.
inline void match(const std::vector<core::VehicleKey>& keys, const std::vector<core::VehicleKey>& sorted,
                  std::vector<std::uint32_t>& rows) {
    rows.clear();
    std::uint32_t at = 0;
    for (const core::VehicleKey key : keys) {
        while (at < sorted.size() && sorted[at] < key)
            ++at;
        rows.push_back(at < sorted.size() && sorted[at] == key ? at : no_row);
    }
}

/// A column of numbers: `code(row)` codes one.
template <class Stream, class Code>
void column(Stream& stream, std::size_t rows, const Code& code) {
    stream.begin_column();
    for (std::uint32_t row = 0; row < rows; ++row)
        code(row);
    stream.end_column();
}

/// A list whose length is coded, too.
template <class Stream, class List, class Code>
void list(Stream& stream, List& elements, const Code& code) {
    if constexpr (Stream::reading) {
        elements.clear();
        elements.resize(stream.size());
    } else {
        stream.size(elements.size());
    }
    for (auto& element : elements)
        code(element);
}

/// The keys of an ascending list, as what left it and what joined it since the step before.
class KeyList {
  public:
    /// Keys of the present list, and the row that each had in the step before, or `no_row`.
    const std::vector<core::VehicleKey>& now() const { return now_; }
    const std::vector<std::uint32_t>& before() const { return before_; }

    /// Reading, `keys` becomes the list.
    template <class Stream, class Keys>
    void code(Stream& stream, Keys& keys) {
        std::swap(now_, last_);
        if constexpr (!Stream::reading) {
            now_.assign(keys.begin(), keys.end());
            require_ascending();
            find_changes();
        }
        std::uint32_t expected = 0;
        list(stream, gone_, [&](auto& row) {
            stream.number(row, expected);
            expected = row + 1;
        });
        list(stream, joined_, [&](auto& key) { stream.key(key); });
        if constexpr (Stream::reading) {
            apply_changes();
            keys = now_;
        }
        match(now_, last_, before_);
    }

  private:
    void require_ascending() const {
        for (std::size_t i = 1; i < now_.size(); ++i) {
            if (!(now_[i - 1] < now_[i])) throw std::invalid_argument("rows are not ordered by key");
        }
    }
    void find_changes() {
        gone_.clear();
        joined_.clear();
        match(last_, now_, before_);
        for (std::uint32_t row = 0; row < last_.size(); ++row) {
            if (before_[row] == no_row) gone_.push_back(row);
        }
        match(now_, last_, before_);
        for (std::uint32_t row = 0; row < now_.size(); ++row) {
            if (before_[row] == no_row) joined_.push_back(now_[row]);
        }
    }
    void apply_changes() {
        now_.clear();
        auto gone = gone_.begin();
        auto joined = joined_.begin();
        for (std::uint32_t row = 0; row < last_.size(); ++row) {
            if (gone != gone_.end() && *gone == row) {
                ++gone;
                continue;
            }
            for (; joined != joined_.end() && *joined < last_[row]; ++joined)
                now_.push_back(*joined);
            now_.push_back(last_[row]);
        }
        now_.insert(now_.end(), joined, joined_.end());
        if (gone != gone_.end()) throw std::runtime_error("a vehicle left that was not there");
        for (std::size_t i = 1; i < now_.size(); ++i) {
            if (!(now_[i - 1] < now_[i])) throw std::runtime_error("vehicles are not ordered");
        }
    }

    std::vector<core::VehicleKey> now_, last_, joined_;
    std::vector<std::uint32_t> before_, gone_;
};

/// Vehicles and routes that a roster got, and routes that changed, since the step before.
class RosterCodec {
  public:
    /// `keys` tells whether vehicles are registered with the stream.
    enum class Keys : std::uint8_t { registered, known };
    explicit RosterCodec(Keys keys) : keys_(keys) {}

    template <class Stream, class Roster>
    void code(Stream& stream, Roster& roster) {
        code_routes(stream, roster);
        code_changes(stream, roster);
        code_new_vehicles(stream, roster);
    }

  private:
    static bool same(const traffic::VehicleInfo& one, const traffic::VehicleInfo& other) {
        using Info = traffic::VehicleInfo;
        const auto same_real = [&](float Info::*member) {
            return std::bit_cast<std::uint32_t>(one.*member) == std::bit_cast<std::uint32_t>(other.*member);
        };
        return one.route == other.route && one.vehicle_class == other.vehicle_class &&
               one.kind == other.kind && same_real(&Info::length_m) && same_real(&Info::width_m) &&
               same_real(&Info::minimum_gap_m) && same_real(&Info::maximum_speed_mps) &&
               same_real(&Info::acceleration_mps2) && same_real(&Info::deceleration_mps2) &&
               same_real(&Info::speed_factor);
    }

    template <class Stream, class Info>
    static void code_info(Stream& stream, Info& info, const traffic::VehicleInfo& foreseen) {
        stream.choice(info.vehicle_class, foreseen.vehicle_class, traffic::vehicle_classes.size());
        stream.choice(info.kind, foreseen.kind, static_cast<std::uint64_t>(traffic::VehicleKind::other) + 1);
        stream.real(info.length_m, foreseen.length_m);
        stream.real(info.width_m, foreseen.width_m);
        stream.real(info.minimum_gap_m, foreseen.minimum_gap_m);
        stream.real(info.maximum_speed_mps, foreseen.maximum_speed_mps);
        stream.real(info.acceleration_mps2, foreseen.acceleration_mps2);
        stream.real(info.deceleration_mps2, foreseen.deceleration_mps2);
        stream.real(info.speed_factor, foreseen.speed_factor);
        stream.number(info.route, foreseen.route);
    }

    template <class Stream, class Roster>
    void code_routes(Stream& stream, Roster& roster) {
        std::vector<core::EdgeIndex> edges;
        const auto code_edges = [&](auto& route) {
            core::EdgeIndex last{0};
            list(stream, route, [&](auto& edge) {
                stream.number(edge, last);
                last = edge;
            });
        };
        if constexpr (Stream::reading) {
            for (std::size_t count = stream.size(); count > 0; --count) {
                code_edges(edges);
                if (roster.add_route(edges).value != routes_++)
                    throw std::runtime_error("a route comes twice");
            }
        } else {
            stream.size(roster.route_count() - routes_);
            for (; routes_ < roster.route_count(); ++routes_)
                code_edges(roster.route(core::RouteIndex{static_cast<std::uint32_t>(routes_)}));
        }
    }

    template <class Stream, class Roster>
    void code_changes(Stream& stream, Roster& roster) {
        changed_.clear();
        if constexpr (!Stream::reading) {
            for (std::uint32_t row = 0; row < known_.size(); ++row) {
                if (!same(known_[row], roster.vehicles()[row])) changed_.push_back(row);
            }
        }
        list(stream, changed_, [&](auto& row) {
            stream.number(row);
            if (row >= known_.size()) throw std::runtime_error("a vehicle changed that is unknown");
            code_vehicle(stream, roster, row, known_[row]);
        });
    }

    template <class Stream, class Roster>
    void code_new_vehicles(Stream& stream, Roster& roster) {
        std::size_t count = 0;
        if constexpr (Stream::reading) {
            count = stream.size();
        } else {
            count = roster.vehicles().size() - known_.size();
            stream.size(count);
        }
        for (; count > 0; --count) {
            traffic::VehicleInfo base = known_.empty() ? traffic::VehicleInfo{} : known_.back();
            const auto row = static_cast<std::uint32_t>(known_.size());
            if constexpr (Stream::reading) {
                base.id = stream.characters();
                base.key = core::vehicle_key(base.id);
            } else {
                const traffic::VehicleInfo& added = roster.vehicles()[row];
                if (added.key != core::vehicle_key(added.id))
                    throw std::invalid_argument("the key of vehicle " + added.id + " is not that of its id");
                stream.characters(added.id);
            }
            known_.push_back(base);
            code_vehicle(stream, roster, row, base);
            if (keys_ == Keys::registered) stream.register_key(known_.back().key);
        }
    }

    template <class Stream, class Roster>
    void code_vehicle(Stream& stream, Roster& roster, std::uint32_t row, const traffic::VehicleInfo& base) {
        if constexpr (Stream::reading) {
            traffic::VehicleInfo info = base;
            code_info(stream, info, base);
            if (info.route.exists() && info.route.value >= roster.route_count())
                throw std::runtime_error("a route is unknown");
            known_[row] = info;
            roster.add(info);
            if (roster.vehicles().size() != known_.size()) throw std::runtime_error("a vehicle comes twice");
        } else {
            const traffic::VehicleInfo& info = roster.vehicles()[row];
            code_info(stream, info, base);
            known_[row] = info;
        }
    }

    Keys keys_;
    std::size_t routes_ = 0;
    std::vector<traffic::VehicleInfo> known_;
    std::vector<std::uint32_t> changed_;
};

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

template <class Stream, class Keys>
void code_keys(Stream& stream, Keys& keys) {
    list(stream, keys, [&](auto& key) { stream.key(key); });
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
        std::vector<core::VehicleKey> keys;
        for (const traffic::ObservedVehicle& vehicle : now)
            keys.push_back(vehicle.key);
        keys_.code(stream, keys);
        if constexpr (Stream::reading) {
            now.assign(keys.size(), {});
            for (std::uint32_t row = 0; row < keys.size(); ++row)
                now[row].key = keys[row];
        }
        match(keys_.now(), snapshot.key, true_row_);
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

/// Believed vehicles, expected to be where they reported to be, or where they are.
class BelievedVehiclesCodec {
  public:
    template <class Stream, class Vehicles>
    void code(Stream& stream, Vehicles& now, const std::vector<traffic::ObservedVehicle>& reports,
              const std::vector<core::VehicleKey>& report_keys, const truth::Snapshot& snapshot) {
        std::vector<core::VehicleKey> keys;
        for (const traffic::BelievedVehicle& vehicle : now)
            keys.push_back(vehicle.key);
        keys_.code(stream, keys);
        if constexpr (Stream::reading) {
            now.assign(keys.size(), {});
            for (std::uint32_t row = 0; row < keys.size(); ++row)
                now[row].key = keys[row];
        }
        match(keys_.now(), report_keys, report_row_);
        match(keys_.now(), snapshot.key, true_row_);
        code_columns(stream, now, reports, snapshot);
    }

  private:
    template <class Stream, class Vehicles>
    void code_columns(Stream& stream, Vehicles& now, const std::vector<traffic::ObservedVehicle>& reports,
                      const truth::Snapshot& snapshot) {
        const traffic::ObservedVehicle nobody;
        const auto report = [&](std::uint32_t row) -> const traffic::ObservedVehicle& {
            return report_row_[row] == no_row ? nobody : reports[report_row_[row]];
        };
        const std::size_t rows = now.size();
        column(stream, rows, [&](std::uint32_t row) {
            stream.choice(now[row].vehicle_class, report(row).vehicle_class, traffic::vehicle_classes.size());
        });
        column(stream, rows, [&](std::uint32_t row) { stream.real(now[row].age_s, report(row).age_s); });
        column(stream, rows, [&](std::uint32_t row) {
            const bool as_above = row > 0 && now[row].age_s == now[row - 1].age_s;
            stream.real(now[row].sigma_m, as_above ? now[row - 1].sigma_m : report(row).position_sigma_m);
        });
        code_motion(
            stream, rows, [&](std::uint32_t row) -> auto& { return now[row].state; },
            [&](std::uint32_t row) {
                traffic::MotionState state = report(row).state;
                if (now[row].age_s == 0.0F || true_row_[row] == no_row) return state;
                state.x_m = snapshot.x_m[true_row_[row]];
                state.y_m = snapshot.y_m[true_row_[row]];
                state.lane_position_m = snapshot.lane_position_m[true_row_[row]];
                return state;
            });
    }

    KeyList keys_;
    std::vector<std::uint32_t> report_row_, true_row_;
};

class BeliefCodec {
  public:
    template <class Stream, class Belief>
    void code(Stream& stream, Belief& now, const traffic::Observation& observation,
              const truth::Snapshot& snapshot, const ObservationCodec& reports) {
        stream.real(now.time.value, observation.time.value);
        if constexpr (Stream::reading) {
            now.roster = observation.roster;
        } else if (now.roster != observation.roster) {
            throw std::invalid_argument("a belief refers to another roster than its observation");
        }
        vehicles_.code(stream, now.vehicles, observation.vehicles, reports.keys(), snapshot);
        own_states_.code(stream, now.own_states, observation.own_states, reports.own_keys(), snapshot);
        code_signals(stream, now.signals, observation.signals);
        bool both_ways = true;
        if constexpr (!Stream::reading) both_ways = is_stored_both_ways(now);
        stream.number(both_ways, true);
        code_links(stream, now, both_ways);
    }

  private:
    static float distance_m(const traffic::BelievedVehicle& left, const traffic::BelievedVehicle& right) {
        const float across_m = left.state.x_m - right.state.x_m;
        const float along_m = left.state.y_m - right.state.y_m;
        return std::sqrt(across_m * across_m + along_m * along_m);
    }

    static std::uint32_t bits(float number) { return std::bit_cast<std::uint32_t>(number); }

    static bool is_stored_both_ways(const traffic::BelievedGraph& belief) {
        if (belief.first_link.size() != belief.vehicles.size() + 1) return false;
        std::vector<std::uint32_t> next(belief.first_link.begin(), belief.first_link.end() - 1);
        for (std::uint32_t row = 0; row < belief.vehicles.size(); ++row) {
            std::uint32_t above = 0;
            for (const traffic::BelievedLink& link : belief.links_of(row)) {
                if (link.neighbour == row || link.neighbour >= belief.vehicles.size()) return false;
                if (above > 0 && link.neighbour < above) return false;
                above = link.neighbour + 1;
                if (link.neighbour < row) continue;
                std::uint32_t& at = next[link.neighbour];
                if (at == belief.first_link[link.neighbour + 1]) return false;
                const traffic::BelievedLink& back = belief.links[at++];
                if (back.neighbour != row || bits(back.distance_m) != bits(link.distance_m) ||
                    bits(back.probability) != bits(link.probability))
                    return false;
            }
        }
        for (std::uint32_t row = 0; row < belief.vehicles.size(); ++row) {
            const auto links = belief.links_of(row);
            const auto higher =
                std::ranges::find_if(links, [&](const auto& link) { return link.neighbour > row; });
            if (next[row] != belief.first_link[row] + static_cast<std::uint32_t>(higher - links.begin()))
                return false;
        }
        return true;
    }

    /// The links of each row; where all are stored both ways, only those to higher rows.
    template <class Stream, class Belief>
    void code_links(Stream& stream, Belief& now, bool both_ways) {
        const auto rows = static_cast<std::uint32_t>(now.vehicles.size());
        if constexpr (!Stream::reading) collect(now, both_ways);
        auto first_links = static_cast<std::uint32_t>(now.first_link.size());
        stream.number(first_links, rows + 1);
        if (first_links != rows + 1) {
            if (first_links != 0 || rows != 0) throw std::runtime_error("links of no vehicle");
            if constexpr (Stream::reading) now.first_link.clear();
        }
        if constexpr (Stream::reading) count_.assign(rows, 0);
        column(stream, rows, [&](std::uint32_t row) { stream.number(count_[row], 0U); });
        std::size_t total = 0;
        for (const std::uint32_t count : count_)
            total += count;
        if constexpr (Stream::reading) {
            if (total > std::size_t{rows} * rows) throw std::runtime_error("there are too many links");
            links_.assign(total, {});
            left_.clear();
            for (std::uint32_t row = 0; row < rows; ++row)
                left_.insert(left_.end(), count_[row], row);
        }
        const auto links = static_cast<std::uint32_t>(total);
        column(stream, links, [&](std::uint32_t at) {
            const bool starts = at == 0 || left_[at - 1] != left_[at];
            const std::uint32_t above = starts ? (both_ways ? left_[at] : no_row) : links_[at - 1].neighbour;
            stream.number(links_[at].neighbour, above + 1);
            if (links_[at].neighbour >= rows) throw std::runtime_error("a neighbour is unknown");
        });
        column(stream, links, [&](std::uint32_t at) {
            stream.real(links_[at].distance_m,
                        distance_m(now.vehicles[left_[at]], now.vehicles[links_[at].neighbour]));
        });
        column(stream, links, [&](std::uint32_t at) { stream.real(links_[at].probability, 1.0F); });
        if constexpr (Stream::reading) {
            if (first_links != 0) restore(now, both_ways);
        }
    }

    void collect(const traffic::BelievedGraph& belief, bool both_ways) {
        count_.assign(belief.vehicles.size(), 0);
        links_.clear();
        left_.clear();
        for (std::uint32_t row = 0; row < belief.vehicles.size(); ++row) {
            for (const traffic::BelievedLink& link : belief.links_of(row)) {
                if (both_ways && link.neighbour < row) continue;
                links_.push_back(link);
                left_.push_back(row);
                ++count_[row];
            }
        }
    }

    void restore(traffic::BelievedGraph& belief, bool both_ways) const {
        const std::size_t rows = belief.vehicles.size();
        belief.first_link.assign(rows + 1, 0);
        for (std::size_t at = 0; at < links_.size(); ++at) {
            ++belief.first_link[left_[at] + 1];
            if (both_ways) ++belief.first_link[links_[at].neighbour + 1];
        }
        for (std::size_t row = 0; row < rows; ++row)
            belief.first_link[row + 1] += belief.first_link[row];
        std::vector<std::uint32_t> next(belief.first_link.begin(), belief.first_link.end() - 1);
        belief.links.assign(belief.first_link.back(), {});
        for (std::size_t at = 0; at < links_.size(); ++at) {
            const traffic::BelievedLink& link = links_[at];
            belief.links[next[left_[at]]++] = link;
            if (both_ways)
                belief.links[next[link.neighbour]++] = {left_[at], link.distance_m, link.probability};
        }
    }

    BelievedVehiclesCodec vehicles_, own_states_;
    std::vector<std::uint32_t> count_, left_;
    std::vector<traffic::BelievedLink> links_;
};

}  // namespace clearway::results::detail
