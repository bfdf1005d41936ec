#include "cli/detail/reference_pages.hpp"

#include <utility>

#include "metrics/lease_row.hpp"
#include "metrics/run_metrics.hpp"
#include "metrics/signal_event.hpp"
#include "metrics/signal_measures.hpp"
#include "metrics/traffic_tables.hpp"
#include "metrics/vehicle_row.hpp"
#include "scenario/keys.hpp"

namespace clearway::cli {
namespace {

template <class Struct>
core::FieldTable table_of(const char* title, const char* summary, const std::string& prefix = "") {
    return {title, summary, core::field_rows<Struct>(prefix)};
}

ReferencePage columns() {
    return {"columns",
            "Columns",
            "Every number of a run, as `runs.csv`, `vehicles.csv`, `results.sqlite` and `run.json` name it.\n"
            "Columns with `emergency` in their name are about the emergency vehicle (EV). How tables and "
            "verdicts\n"
            "use them stands in [metrics](metrics.md).",
            core::FieldUse::read,
            {table_of<metrics::RunMetrics>("Runs",
                                           "One row for each run, in `runs.csv` and table `runs`; "
                                           "`clearway compare --metric NAME` compares them"),
             table_of<metrics::VehicleRow>("Vehicles",
                                           "One row for each vehicle, in `vehicles.csv`, behind its id, "
                                           "class, kind and outcome"),
             table_of<metrics::LeaseRow>("Leases",
                                         "One row for each policy and action in `run.json`; `leases.csv` "
                                         "has a row for each outcome; the action `own_change_lane` is an EV "
                                         "that changes its lane itself, `consider_way` a faster way that "
                                         "gains too little"),
             table_of<metrics::ApproachRow>("Approaches", "Time lost by approach and class, in `run.json`"),
             table_of<metrics::RecoveryRow>("Recovery", "What a signal was like after an EV, in `run.json`"),
             table_of<metrics::JourneyRow>("Journeys",
                                           "Where an EV was, in `run.json` of the first three "
                                           "replications"),
             table_of<metrics::EdgeTimeRow>("Edge times", "How EVs drove their routes, in `run.json`"),
             table_of<metrics::ConsideredRow>("Ways considered",
                                              "Edges beside an EV's way that a policy considered and did "
                                              "not ask for, in `run.json`"),
             table_of<metrics::SignalHoldRow>("Signal holds", "Signals that policies held, in `run.json`"),
             table_of<metrics::SignalEvent>("Signal events",
                                            "Event logs of signals while they are asked for, in "
                                            "`signal_events.csv` of each run, behind them the event in "
                                            "words; `clearway export results DIR signal_events`"),
             table_of<metrics::SignalMeasures>("Signals",
                                               "How each signal served EVs, from its event log; "
                                               "`clearway export results DIR signals`")}};
}

ReferencePage scenario_keys() {
    std::vector<core::FieldTable> tables = scenario::key_tables();
    tables.push_back(scenario::override_table());
    return {"scenario-keys", "Keys of the scenario file",
            "Every key of `scenario.toml`. A study varies those of plain tables as factors: "
            "`scenario.demand.human =\n"
            "[40, 80]`. What they mean for emergency vehicles (EV) and traffic stands in [the scenario\n"
            "file](scenario-file.md). Beside them stand `name`, `version` and `title` of the scenario, and "
            "`base`: a\n"
            "scenario in a folder beside its own, whose keys the file changes. The last table lists the "
            "overrides, which change any scenario without editing its file.",
            core::FieldUse::set, std::move(tables)};
}

}  // namespace

std::vector<ReferencePage> reference_pages() {
    return {columns(), scenario_keys()};
}

std::string to_markdown(const ReferencePage& page) {
    return fmt::format(
        "# {0}\n\n{1}\n\nThis page is generated from the program's tables:\n"
        "`clearway list {2} --markdown > docs/reference/{2}.md`.\n{3}",
        page.title, page.intro, page.name, core::fields_markdown(page.tables, page.use));
}

}  // namespace clearway::cli
