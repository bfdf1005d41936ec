#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "trace/detail/enumerations.hpp"
#include "trace/detail/states.hpp"
#include "trace/detail/tables.hpp"
#include "truth/snapshot.hpp"

namespace clearway::trace::detail {

/// What every signal shows.
template <class File>
class SignalTable {
  public:
    SignalTable(File& file, const std::string& path, const char* doc, Names& names)
        : names_(names), rows_(file, path, doc) {}

    template <class Signals>
    void code(Signals& signals) {
        list<File>(rows_, signals.state, [&](auto& state) { names_.code_text(state_, state); });
    }
    /// Only signals that differ from `usual` are stored; `differ` says whether these do.
    template <class Signals>
    void code(Signals& signals, const traffic::SignalStates& usual, ColumnOf<File, bool>& differ) {
        bool is_stored = signals.state != usual.state;
        differ(is_stored);
        if (is_stored) {
            code(signals);
        } else if constexpr (File::reading) {
            signals = usual;
        }
    }

  private:
    Names& names_;
    typename File::Rows rows_;
    ColumnOf<File, std::uint32_t> state_{
        rows_,
        {"state", "",
         "Row in /texts: SUMO's letter of each link. One row per signal, in the order of the network"}};
};

/// Codes the lengths of the two lists that share `rows`: vehicles, then own states.
template <class File, class Lists>
void code_lengths(typename File::Rows& rows, ColumnOf<File, std::uint32_t>& own_states, Lists& now) {
    std::size_t all = now.vehicles.size() + now.own_states.size();
    rows.count(all);
    auto own = static_cast<std::uint32_t>(now.own_states.size());
    own_states(own);
    if constexpr (File::reading) {
        if (own > all) throw std::runtime_error("there are more own states than rows");
        now.vehicles.resize(all - own);
        now.own_states.resize(own);
    }
}

/// The true states of all vehicles on the road.
template <class File>
class SnapshotTables {
  public:
    SnapshotTables(File& file, Names& names)
        : names_(names),
          time_s_(file, file.steps(), "steps", {"time_s", "s", "Simulation time at the end of the step"}),
          rows_(file, "snapshot", "The true state of all vehicles on the road, ordered by key"),
          signals_(file, "signals", "What the signals show", names) {}

    template <class Snapshot>
    void code(Snapshot& now, KnownStates& known) {
        code_value(time_s_, now.time);
        std::size_t count = now.key.size();
        rows_.count(count);
        if constexpr (File::reading) {
            now.key.resize(count);
            now.resize(count);
        }
        vehicles_.resize(count);
        for (std::size_t row = 0; row < count; ++row) {
            vehicles_[row] = names_.code(vehicle_, now.key[row]);
            if (row > 0) require_order<File>(now.key[row - 1], now.key[row]);
            code_row(now, row);
        }
        signals_.code(now.signals);
        known.start_step(now, vehicles_, rows_.begin());
    }
    /// Number of steps; when reading.
    std::size_t steps() const { return time_s_.size(); }

  private:
    template <class Value>
    using Column = ColumnOf<File, Value>;

    template <class Snapshot>
    void code_row(Snapshot& now, std::size_t row) {
        vehicle_class_(now.vehicle_class[row]);
        x_m_(now.x_m[row]);
        y_m_(now.y_m[row]);
        heading_rad_(now.heading_rad[row]);
        speed_mps_(now.speed_mps[row]);
        acceleration_mps2_(now.acceleration_mps2[row]);
        code_value(lane_, now.lane[row]);
        lane_position_m_(now.lane_position_m[row]);
        route_edge_(now.route_edge[row]);
    }

    Names& names_;
    typename File::template Column<double> time_s_;
    typename File::Rows rows_;
    Column<std::uint32_t> vehicle_{rows_, vehicle_column};
    Column<traffic::VehicleClass> vehicle_class_{rows_, class_column, class_names};
    Column<float> x_m_{rows_, {"x_m", "m", "Front bumper"}};
    Column<float> y_m_{rows_, {"y_m", "m", "Front bumper"}};
    Column<float> heading_rad_{rows_, {"heading_rad", "rad", "Counter-clockwise from the x axis"}};
    Column<float> speed_mps_{rows_, {"speed_mps", "m/s", ""}};
    Column<float> acceleration_mps2_{rows_, {"acceleration_mps2", "m/s^2", ""}};
    Column<std::uint32_t> lane_{rows_, {"lane", "", "Index in the network; 4294967295: none"}};
    Column<float> lane_position_m_{rows_,
                                   {"lane_position_m", "m", "Front bumper from the start of the lane"}};
    Column<std::uint32_t> route_edge_{rows_,
                                      {"route_edge", "1", "Position in the route of the edge entered last"}};
    SignalTable<File> signals_;
    std::vector<std::uint32_t> vehicles_;
};

}  // namespace clearway::trace::detail
