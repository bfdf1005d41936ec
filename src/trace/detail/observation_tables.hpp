#pragma once

#include <cstdint>

#include "trace/detail/roster_tables.hpp"
#include "trace/detail/snapshot_tables.hpp"

namespace clearway::trace::detail {

/// What the sensors reported.
template <class File>
class ObservationTables {
  public:
    ObservationTables(File& file, Names& names)
        : names_(names),
          rows_(file, "observation", "What the sensors reported: a row per step with a report or a decision"),
          vehicles_(
              file, "observation/vehicles",
              "What was last reported of each vehicle, ordered by key; then what emergency vehicles know "
              "of themselves"),
          detections_(file, "observation/detections", "Dark vehicles that a neighbour detected"),
          incidents_(file, "observation/incidents", "Incidents that last and are known"),
          signals_(file, "observation/signals",
                   "What signals were seen to show, where it differs from /signals", names),
          roster_(file, "observation/", names) {}

    /// Whether the step has an observation.
    bool is_there() {
        std::size_t count = 0;
        rows_.count(count);
        return count == 1;
    }
    /// `roster` is the true one, `own_roster` that of the sensor.
    template <class Observation, class Roster>
    void code(Observation& now, const truth::Snapshot& snapshot, Roster& roster, Roster& own_roster,
              KnownStates& known) {
        std::size_t one = 1;
        rows_.count(one);
        code_value(time_s_, now.time);
        code_value(report_time_s_, now.report_time);
        is_report_(now.is_report);
        exits_known_(now.exits_known);
        bool is_own = now.roster != &roster;
        has_roster_(is_own);
        if constexpr (File::reading) now.roster = is_own ? &own_roster : &roster;
        if (is_own) roster_.code(own_roster);
        code_vehicles(now, known);
        list<File>(detections_, now.detected_links, [&](auto& link) {
            names_.code(from_, link.from);
            names_.code(to_, link.to);
            range_m_(link.range_m);
            range_sigma_m_(link.range_sigma_m);
        });
        list<File>(incidents_, now.incidents, [&](auto& incident) {
            code_value(edge_, incident.edge);
            closed_to_emergency_(incident.closed_to_emergency);
            speed_past_mps_(incident.speed_past_mps);
        });
        signals_.code(now.signals, snapshot.signals, has_signals_);
    }

  private:
    template <class Value>
    using Column = ColumnOf<File, Value>;

    template <class Observation>
    void code_vehicles(Observation& now, KnownStates& known) {
        code_lengths<File>(vehicles_, own_states_, now);
        code_reports(now.vehicles, known, [&](std::uint32_t vehicle, std::int64_t row, const auto& state) {
            known.remember_report(vehicle, row, state);
        });
        code_reports(now.own_states, known, [](std::uint32_t, std::int64_t, const auto&) {});
    }

    template <class Reports, class Remember>
    void code_reports(Reports& reports, const KnownStates& known, const Remember& remember) {
        core::VehicleKey before;
        for (auto& report : reports) {
            const std::uint32_t vehicle = names_.code(vehicle_, report.key);
            if (&report != &reports.front()) require_order<File>(before, report.key);
            before = report.key;
            vehicle_class_(report.vehicle_class);
            freshness_(report.freshness);
            age_s_(report.age_s);
            position_sigma_m_(report.position_sigma_m);
            remember(vehicle, state_.code(report.state, vehicle, known), report.state);
        }
    }

    Names& names_;
    typename File::Rows rows_, vehicles_, detections_, incidents_;
    Column<double> time_s_{rows_, {"time_s", "s", "Reports up to this time"}};
    Column<double> report_time_s_{rows_, {"report_time_s", "s", "Time of the latest report round"}};
    Column<bool> is_report_{rows_, {"is_report", "", "A report round took place in this step"}};
    Column<bool> exits_known_{rows_, {"exits_known", "", "Vehicles that left the network are absent"}};
    Column<bool> has_roster_{rows_, {"has_roster", "", "The sensor keeps a roster of its own"}};
    Column<std::uint32_t> own_states_{
        rows_,
        {"own_states", "1",
         "How many of the vehicles, counted from the end, are emergency vehicles' own states"}};
    Column<bool> has_signals_{rows_, {"has_signals", "", "The observed signals differ from /signals"}};
    Column<std::uint32_t> vehicle_{vehicles_, vehicle_column};
    Column<traffic::VehicleClass> vehicle_class_{vehicles_, class_column, class_names};
    Column<traffic::Freshness> freshness_{
        vehicles_, {"freshness", "", "stale: its newest report was lost"}, freshness_names};
    Column<float> age_s_{vehicles_, {"age_s", "s", "Time since the state was measured"}};
    Column<float> position_sigma_m_{vehicles_,
                                    {"position_sigma_m", "m", "Standard deviation that the sensor states"}};
    StateColumns<File> state_{vehicles_};
    Column<std::uint32_t> from_{detections_, {"from", "", "Row in /vehicles: the vehicle that detects"}};
    Column<std::uint32_t> to_{detections_, {"to", "", "Row in /vehicles: the vehicle that is detected"}};
    Column<float> range_m_{detections_, {"range_m", "m", "Measured distance; negative: not measured"}};
    Column<float> range_sigma_m_{detections_, {"range_sigma_m", "m", "Standard deviation of the distance"}};
    Column<std::uint32_t> edge_{incidents_, {"edge", "", "Edge of the network"}};
    Column<bool> closed_to_emergency_{
        incidents_, {"closed_to_emergency", "", "No lane that an emergency vehicle may use is open"}};
    Column<float> speed_past_mps_{incidents_, {"speed_past_mps", "m/s", "Limit past it; 0: none"}};
    SignalTable<File> signals_;
    RosterTables<File> roster_;
};

}  // namespace clearway::trace::detail
