#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "trace/detail/enumerations.hpp"
#include "trace/detail/tables.hpp"
#include "truth/events.hpp"

namespace clearway::trace::detail {

/// What happened in a step.
template <class File>
class EventTables {
  public:
    EventTables(File& file, Names& names)
        : names_(names),
          time_s_(file, file.steps(), "steps", {"events_time_s", "s", "Time of the step's events"}),
          rows_(file, "events", "What happened, ordered by kind") {}

    template <class Events>
    void code(Events& events) {
        code_value(time_s_, events.time);
        std::size_t left = 0;
        if constexpr (File::reading) {
            rows_.count(left);
            events.clear();
        }
        code_keys(EventKind::departed, events.departed, left);
        code_keys(EventKind::arrived, events.arrived, left);
        code_keys(EventKind::teleported, events.teleported, left);
        code_keys(EventKind::removed, events.removed, left);
        each(EventKind::collision, events.collisions, left, [](auto& collision, auto& row) {
            exchange(collision.collider, row.vehicle);
            exchange(collision.victim, row.other);
            exchange(collision.place, row.place);
            exchange(collision.lane, row.lane);
            exchange(collision.with_emergency_vehicle, row.with_emergency_vehicle);
        });
        each(EventKind::emergency_braking, events.emergency_brakings, left, [](auto& braking, auto& row) {
            exchange(braking.vehicle, row.vehicle);
            exchange(braking.deceleration_mps2, row.deceleration_mps2);
        });
        if (left != 0) throw std::runtime_error("events are not ordered by kind");
    }

  private:
    template <class Value>
    using Column = ColumnOf<File, Value>;

    /// The members of all kinds of event.
    struct Row {
        EventKind kind{};
        core::VehicleKey vehicle, other;
        truth::CollisionPlace place{};
        core::LaneIndex lane;
        bool with_emergency_vehicle = false;
        float deceleration_mps2 = 0.0F;
    };

    template <class Member>
    static void exchange(Member& member, std::remove_const_t<Member>& cell) {
        if constexpr (File::reading) {
            member = cell;
        } else {
            cell = member;
        }
    }

    template <class Keys>
    void code_keys(EventKind kind, Keys& keys, std::size_t& left) {
        each(kind, keys, left, [](auto& key, auto& row) { exchange(key, row.vehicle); });
    }

    /// Codes all events of a kind; `exchange_members(event, row)` copies members from or to the row.
    template <class List, class ExchangeMembers>
    void each(EventKind kind, List& events, std::size_t& left, const ExchangeMembers& exchange_members) {
        if constexpr (File::reading) {
            for (; left > 0 && next_kind(left) == kind; --left) {
                code_row(ahead_);
                has_ahead_ = false;
                exchange_members(events.emplace_back(), ahead_);
            }
        } else {
            std::size_t count = events.size();
            rows_.count(count);
            for (const auto& event : events) {
                Row row;
                row.kind = kind;
                exchange_members(event, row);
                kind_(row.kind);
                code_row(row);
            }
        }
    }

    EventKind next_kind(std::size_t) {
        if (!has_ahead_) {
            ahead_ = {};
            kind_(ahead_.kind);
            has_ahead_ = true;
        }
        return ahead_.kind;
    }

    void code_row(Row& row) {
        names_.code(vehicle_, row.vehicle);
        names_.code(other_, row.other);
        place_(row.place);
        code_value(lane_, row.lane);
        with_emergency_vehicle_(row.with_emergency_vehicle);
        deceleration_mps2_(row.deceleration_mps2);
    }

    Names& names_;
    typename File::template Column<double> time_s_;
    typename File::Rows rows_;
    Column<EventKind> kind_{rows_, {"kind", "", "What happened"}, event_names};
    Column<std::uint32_t> vehicle_{rows_, vehicle_column};
    Column<std::uint32_t> other_{
        rows_, {"other", "", "Row in /vehicles: the other vehicle of a collision; 4294967295: none"}};
    Column<truth::CollisionPlace> place_{rows_, {"place", "", "Where a collision happened"}, place_names};
    Column<std::uint32_t> lane_{rows_,
                                {"lane", "", "Lane of a collision: index in the network; 4294967295: none"}};
    Column<bool> with_emergency_vehicle_{
        rows_, {"with_emergency_vehicle", "", "An emergency vehicle is in the collision"}};
    Column<float> deceleration_mps2_{rows_,
                                     {"deceleration_mps2", "m/s^2", "Deceleration of an emergency braking"}};
    Row ahead_;
    bool has_ahead_ = false;  ///< The kind of the next row has been read.
};

}  // namespace clearway::trace::detail
