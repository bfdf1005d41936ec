#include "cli/detail/reference_pages.hpp"

#include "metrics/lease_row.hpp"
#include "metrics/run_metrics.hpp"
#include "metrics/signal_event.hpp"
#include "metrics/signal_measures.hpp"
#include "metrics/traffic_tables.hpp"
#include "metrics/vehicle_row.hpp"
#include "scenario/config.hpp"

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
                                         "that changes its lane itself"),
             table_of<metrics::ApproachRow>("Approaches", "Time lost by approach and class, in `run.json`"),
             table_of<metrics::RecoveryRow>("Recovery", "What a signal was like after an EV, in `run.json`"),
             table_of<metrics::JourneyRow>("Journeys",
                                           "Where an EV was, in `run.json` of the first three "
                                           "replications"),
             table_of<metrics::EdgeTimeRow>("Edge times", "How EVs drove their routes, in `run.json`"),
             table_of<metrics::SignalHoldRow>("Signal holds", "Signals that policies held, in `run.json`"),
             table_of<metrics::SignalEvent>("Signal events",
                                            "Event logs of signals while they are asked for, in "
                                            "`signal_events.csv` of each run, behind them the event in "
                                            "words; `clearway results DIR signal_events`"),
             table_of<metrics::SignalMeasures>("Signals",
                                               "How each signal served EVs, from its event log; "
                                               "`clearway results DIR signals`")}};
}

ReferencePage scenario_keys() {
    return {
        "scenario-keys",
        "Keys of the scenario file",
        "Every key of `scenario.toml`. A study varies those of plain tables as factors: "
        "`scenario.demand.human =\n"
        "[40, 80]`. What they mean for emergency vehicles (EV) and traffic stands in [the scenario\n"
        "file](scenario-file.md). Beside them stand `name`, `version` and `title` of the scenario.",
        core::FieldUse::set,
        {table_of<scenario::NetworkSource>(
             "network", "Where the roads come from; paths are relative to the folder", "network."),
         table_of<scenario::Times>("time", "The clock of a run", "time."),
         table_of<scenario::Demand>("demand", "How many vehicles drive", "demand."),
         table_of<scenario::Dense>("dense", "What the dense variant changes; optional", "dense."),
         table_of<scenario::SpeedLimits>("limits", "Speed limits of classes", "limits."),
         table_of<scenario::Drivers>("drivers", "Car-following model and desired speeds", "drivers."),
         table_of<scenario::Following>("car_following", "Other drivers than usual; optional",
                                       "car_following."),
         table_of<scenario::TrafficKinds>("kinds.traffic", "Frequencies of kinds among traffic",
                                          "kinds.traffic."),
         table_of<scenario::EmergencyKinds>("kinds.emergency", "The same among EVs", "kinds.emergency."),
         table_of<traffic::SirenConfig>("siren", "Human drivers who yield to a siren; optional", "siren."),
         table_of<scenario::Slow>("slow", "Vehicles slower than the rest; optional", "slow."),
         table_of<scenario::Privilege>("privilege", "What the law allows EVs, in every condition; optional",
                                       "privilege."),
         table_of<scenario::RoadCondition>("road", "Weather and works; optional", "road."),
         table_of<scenario::Stretch>("road.stretch.NAME",
                                     "Edges with a factor of their own, listed in `edges`",
                                     "road.stretch.NAME."),
         table_of<scenario::Pedestrians>("pedestrians", "People at crossings; optional", "pedestrians."),
         table_of<scenario::Trips>("trips", "Origins and destinations drawn over the network", "trips."),
         table_of<scenario::Flow>("[[flow]]", "A share of all vehicles from an edge to another", "flow."),
         table_of<scenario::EmergencyTrip>("[[emergency_trip]]", "An EV with a trip of its own",
                                           "emergency_trip."),
         table_of<scenario::EmergencySite>("[[emergency_site]]", "Where EVs start or arrive",
                                           "emergency_site."),
         table_of<scenario::Measured>(
             "measured", "Measured demand; its lists `routes`, `additional` and `persons` name files",
             "measured."),
         table_of<scenario::OwnTypes>("measured.own_types", "Vehicles keep their own types",
                                      "measured.own_types."),
         table_of<scenario::MeasuredType>("[[measured.type]]", "What a type of the measured demand becomes",
                                          "measured.type.")}};
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
