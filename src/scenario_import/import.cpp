#include "scenario_import/import.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <unistd.h>

#include "core/atomic_file.hpp"
#include "core/counted.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/folder_name.hpp"
#include "core/leftovers.hpp"
#include "core/temporary_folder.hpp"
#include "roads/crossings.hpp"
#include "scenario/network_document.hpp"
#include "scenario/picture.hpp"
#include "scenario/preemption.hpp"
#include "scenario/written_files.hpp"
#include "scenario_import/detail/context.hpp"
#include "scenario_import/detail/own_words.hpp"
#include "scenario_import/detail/source.hpp"
#include "scenario_import/detail/sumo_trial.hpp"
#include "scenario_import/detail/survey.hpp"
#include "scenario_import/detail/synthetic_demand.hpp"
#include "scenario_import/osm/driving_side.hpp"
#include "scenario_import/osm/map.hpp"
#include "scenario_import/osm/map_signals.hpp"
#include "scenario_import/osm/sites.hpp"
#include "scenario_import/sumo/configuration.hpp"
#include "scenario_import/sumo/demand.hpp"
#include "traffic/emergency_ends.hpp"
#include "traffic/step_length.hpp"

namespace clearway::scenario_import {

namespace {

using detail::Import;
using detail::SourceKind;
using detail::SumoFiles;

constexpr const char* network_name = "network.net.xml";
constexpr const char* preemption_name = "preemption.csv";

/// The files of a request by kind.
struct Sources {
    std::vector<std::filesystem::path> maps;
    std::optional<std::filesystem::path> network;
    SumoFiles demand;
    double step_length_s = 1.0;  ///< Of the SUMO scenario; SUMO's default.
    std::optional<double> time_to_teleport_s;
    std::optional<double> ignore_junction_blocker_s;
    std::vector<std::string> options;
};

void check_folder(const std::filesystem::path& folder) {
    std::vector<core::Problem> problems;
    core::check_folder_name("--name", folder.filename().string(), problems);
    if (!problems.empty()) throw core::InputError(std::move(problems));
    if (folder.string().find(',') != std::string::npos)
        throw core::InputError(
            core::Problem{folder.string(),
                          "would lie in a folder with a comma in its path, which SUMO takes as a separator",
                          "a path without commas", "import it in another folder"});
    if (std::filesystem::exists(folder))
        throw core::InputError(core::Problem{folder.string(), "exists already", "a new folder",
                                             "choose another name, or remove it"});
}

/// Another import of the same name may have been quicker.
void move_to(const std::filesystem::path& made, const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::rename(made, folder, error);
    if (!error) return;
    if (std::filesystem::exists(folder))
        throw core::InputError(core::Problem{folder.string(), "was made by another program in the meantime",
                                             "a new folder", "choose another name, or remove it"});
    throw core::write_error(folder, error.value());
}

void add_configuration(const std::filesystem::path& file, Import& import, Sources& sources) {
    const detail::Configuration configuration = detail::read_configuration(file);
    sources.network = configuration.network;
    sources.demand = {configuration.routes, configuration.additional, configuration.begin_s,
                      configuration.end_s,  configuration.scale,      configuration.rerouting};
    sources.step_length_s = configuration.step_length_s;
    sources.time_to_teleport_s = configuration.time_to_teleport_s;
    sources.ignore_junction_blocker_s = configuration.ignore_junction_blocker_s;
    sources.options = configuration.kept_options;
    if (configuration.sublane_width_m > 0.0)
        import.findings.changes.push_back(fmt::format(
            "vehicles of the scenario share lanes (lateral-resolution {:g} m); here they do so only "
            "in the sublane model: --traffic-model sublane of every verb",
            configuration.sublane_width_m));
    if (configuration.scale != 1.0)
        import.findings.changes.push_back(fmt::format(
            "option scale of the configuration: each vehicle occurs {:g} times", configuration.scale));
    for (const std::string& option : configuration.other_options)
        import.left_out.add("options of the configuration that are not taken over", option,
                            detail::LeftOut::all);
}

Sources sort_files(Import& import, bool& leaves_out_bad_vehicles) {
    Sources sources;
    std::vector<std::filesystem::path> configurations;
    for (const std::filesystem::path& file : import.request.files) {
        const SourceKind kind = detail::kind_of(file);
        detail::refuse_bomb(file);
        if (kind == SourceKind::map) sources.maps.push_back(file);
        if (kind == SourceKind::routes) sources.demand.routes.push_back(file);
        if (kind == SourceKind::additional) sources.demand.additional.push_back(file);
        if (kind == SourceKind::configuration) configurations.push_back(file);
        if (kind != SourceKind::network) continue;
        if (sources.network)
            throw core::InputError(core::Problem{file.string(), "is a second network", "one network", ""});
        sources.network = file;
    }
    const bool has_demand = !sources.demand.routes.empty() || !sources.demand.additional.empty();
    const auto fundamentals = static_cast<int>(!sources.maps.empty()) +
                              static_cast<int>(sources.network.has_value()) +
                              static_cast<int>(!configurations.empty());
    if (fundamentals != 1 || configurations.size() > 1 || (has_demand && !sources.network))
        throw core::InputError(
            core::Problem{import.request.files.front().string(), "cannot be imported with the other files",
                          "maps, or one network with route and additional files, or one configuration",
                          "import them one by one"});
    if (configurations.empty()) return sources;
    add_configuration(configurations.front(), import, sources);
    leaves_out_bad_vehicles = detail::read_configuration(configurations.front()).ignores_route_errors;
    for (const auto* list : {&sources.demand.routes, &sources.demand.additional})
        for (const std::filesystem::path& file : *list)
            detail::refuse_bomb(file);
    detail::refuse_bomb(*sources.network);
    return sources;
}

/// SUMO networks have version 0.x or 1.x.
void check_version(const scenario::NetworkDocument& document, const std::filesystem::path& file) {
    const std::string version = document.attribute("version");
    const auto number = detail::number(version);
    if (number && *number < 2.0) return;
    throw core::InputError(core::Problem{
        file.string(), fmt::format("is a network of the unknown version \"{}\"", version), "0.x or 1.x",
        "write it again with netconvert: netconvert --sumo-net-file OLD --output-file NEW"});
}

[[noreturn]] void refuse_without_roads(const Import& import) {
    throw core::InputError(core::Problem{import.request.files.front().string(), "has no road for cars",
                                         "a map or network with roads for cars", "choose another file"});
}

/// Reads the copy of `given` that the import made. Problems name the lines of the given file.
roads::Network read_copy(const std::filesystem::path& copy, const std::filesystem::path& given) {
    try {
        scenario::refuse_written_files(copy, {});
        return roads::Network::read(copy);
    } catch (const core::InputError& error) {
        roads::Network::read(given);
        std::vector<core::Problem> problems = error.problems();
        for (core::Problem& problem : problems)
            problem.where = given.string();
        throw core::InputError(std::move(problems));
    }
}

roads::Network take_network(Import& import, const std::filesystem::path& file) {
    scenario::NetworkDocument document(file);
    check_version(document, file);
    if (!document.has_edges()) refuse_without_roads(import);
    document.without_newer_classes();
    if (document.repaired_lists() > 0)
        import.findings.changes.push_back(
            fmt::format("{} lists of vehicle classes name classes of a newer netconvert that SUMO 1.15 "
                        "rejects; those classes are removed",
                        document.repaired_lists()));
    if (const int parted = document.part_two_way_edges(); parted > 0)
        import.findings.changes.push_back(fmt::format(
            "{} multi-lane edges with traffic in both directions (bidirectional rails) are separated, "
            "because SUMO 1.15 aborts on them; trains that meet there pass through each other",
            parted));
    const int admitted = document.admit_emergency();
    if (admitted > 0)
        import.findings.changes.push_back(
            fmt::format("{} lanes or connections open to cars are opened to emergency vehicles", admitted));
    import.findings.left_hand = document.attribute("lefthand") == "true";
    core::write_atomically(import.scenario / network_name, document.text());
    roads::Network network = read_copy(import.scenario / network_name, file);
    detail::survey(network, import.findings);
    if (import.findings.car_edges == 0) refuse_without_roads(import);
    return network;
}

/// Throws `without_crossings` when there are no crossings.
void add_pedestrians(Import& import, const roads::Network& network, scenario::ScenarioConfig& config,
                     const core::Problem& without_crossings) {
    const double per_hour = import.request.pedestrians_per_hour;
    if (per_hour <= 0.0) return;
    const std::vector<roads::Crossing> crossings = roads::crossings(network);
    if (crossings.empty()) throw core::InputError(without_crossings);
    const auto signalled = std::ranges::count_if(crossings, &roads::Crossing::has_signal);
    config.pedestrians.per_hour = per_hour;
    if (signalled == 0) config.pedestrians.crossings = scenario::Crossings::all;
    import.findings.changes.push_back(
        fmt::format("{:g} pedestrians per hour at each of {} crossings{}", per_hour,
                    signalled == 0 ? crossings.size() : static_cast<std::size_t>(signalled),
                    signalled == 0 ? ", none of which has a signal"
                                   : fmt::format(" with a signal, of {} in all", crossings.size())));
}

/// `10 km/h in living streets, 50 km/h on other roads`: what netconvert's types for towns give these classes.
std::string limits_of(const std::set<std::string>& classes) {
    std::vector<std::string> words;
    for (const auto& [name, limit] : {std::pair{"motorway", "100 km/h on motorways"},
                                      {"motorway_link", "60 km/h on their ramps"},
                                      {"living_street", "10 km/h in living streets"}})
        if (classes.contains(name)) words.emplace_back(limit);
    if (words.empty()) return "50 km/h";
    if (words.size() < classes.size()) words.emplace_back("50 km/h on other roads");
    return core::listed(words);
}

/// The day of the maps' data: the oldest that they state, else that of the newest object; or empty.
std::string map_date(const std::vector<std::filesystem::path>& maps, const std::string& newest) {
    std::vector<std::string> stated;
    for (const std::filesystem::path& map : maps)
        stated.push_back(detail::stated_map_date(map));
    std::string oldest = *std::ranges::min_element(stated);
    return !oldest.empty() || newest.empty() ? oldest : newest + " (newest object)";
}

/// Reports unfinished maps and missing speed limits.
void report_gaps(Import& import, const std::vector<std::filesystem::path>& maps,
                 const detail::MapContents& map) {
    for (const std::filesystem::path& file : maps)
        if (const std::string remark = detail::overpass_remark(file); !remark.empty())
            import.left_out.add("maps that Overpass did not finish",
                                fmt::format("{}: {}", file.filename().string(), remark));
    constexpr double least_km = 0.05;
    if (map.unlimited_km >= least_km)
        import.findings.changes.push_back(
            fmt::format("{:.1f} km of the map's {:.1f} km of road, both directions together, have no speed "
                        "limit: they get those of SUMO's types for towns, {}",
                        map.unlimited_km, map.car_roads_km, limits_of(map.unlimited_classes)));
}

void import_maps(Import& import, const std::vector<std::filesystem::path>& maps,
                 scenario::ScenarioConfig& config) {
    const auto [extract, map] = detail::extract_roads(maps, import.work, import.on_progress);
    report_gaps(import, maps, map);
    import.on_progress("building the network", 0.0);
    const auto footways =
        import.request.pedestrians_per_hour > 0.0 ? detail::Footways::build : detail::Footways::none;
    const detail::DrivingSideChoice choice = detail::choose_driving_side(import.request.side, map);
    const std::filesystem::path built =
        detail::build_roads(maps.front(), extract, {choice.side, footways}, import.work, import.on_progress);
    const roads::Network network = take_network(import, built);
    import.findings.side_reason = choice.reason;
    std::filesystem::remove(built);
    add_pedestrians(import, network, config,
                    {"--pedestrians",
                     "netconvert finds no place for a crossing: the map has none, and netconvert guesses "
                     "them only at roads of at most 50 km/h",
                     "a map with crossings or with such roads", "leave it out"});
    config.network.attribution = "Map data (c) OpenStreetMap contributors, ODbL 1.0";
    config.network.map_date = map_date(maps, map.newest);
    import.findings.map_date = config.network.map_date;
    detail::choose_trips(import, config, network);
    import.findings.map_signals = detail::account_for_signals(map.signals, network, import.left_out);
    if (!network.signals().empty())
        import.findings.changes.push_back(
            fmt::format("programs of {} are netconvert's, of a fixed cycle: the map has none. netedit enters "
                        "those of your town in network.net.xml",
                        core::counted(network.signals().size(), "signal")));
    config.emergency_sites = detail::place_sites(map.sites, network, config.trips, import.left_out);
    for (const scenario::EmergencySite& site : config.emergency_sites) {
        for (const auto& [kind, name] : scenario::spellings(scenario::SiteKind{}))
            if (kind == site.kind) ++import.findings.sites[name];
        if (!site.name.empty()) import.findings.site_names.push_back(site.name);
    }
    detail::add_synthetic_demand(import, config, network);
}

/// Calls `work`; problems that it throws get the user's own words.
template <class Work>
void told_in_own_words(const Import& import, const Work& work) {
    try {
        work();
    } catch (const core::InputError& error) {
        std::vector<core::Problem> problems = error.problems();
        for (core::Problem& problem : problems) {
            problem.where = detail::in_own_words(problem.where, import);
            problem.what = detail::in_own_words(problem.what, import);
        }
        throw core::InputError(std::move(problems));
    }
}

void try_out_demand(Import& import, const Sources& sources, scenario::ScenarioConfig& config) {
    import.on_progress("preparing a run", 0.0);
    const detail::Tried tried = detail::make_demand(import, config);
    detail::require_load(import, tried.demand);
    detail::compare_steps(import, tried.demand, sources.step_length_s);
    std::string& failure = import.findings.trial_failure;
    failure = detail::in_own_words(failure, import);
    if (const auto place = detail::place_of_complaint(failure, import))
        failure = fmt::format("{}: {}", *place, failure);
}

/// Steps that are too coarse are not taken over; `compare_steps` says what that changes.
void take_over_times(const Sources& sources, scenario::ScenarioConfig& config) {
    constexpr double finest_s = 0.1;
    if (sources.step_length_s >= finest_s && sources.step_length_s <= traffic::coarsest_trusted_step_s)
        config.time.step_length_s = sources.step_length_s;
    config.time.time_to_teleport_s = sources.time_to_teleport_s;
    if (sources.ignore_junction_blocker_s)
        config.time.ignore_junction_blocker_s = sources.ignore_junction_blocker_s;
}

void import_sumo(Import& import, const Sources& sources, scenario::ScenarioConfig& config) {
    import.on_progress("reading the network", 0.0);
    const roads::Network network = take_network(import, *sources.network);
    import.findings.side_reason = "as the network says";
    add_pedestrians(
        import, network, config,
        {"--pedestrians", "the network has no crossing for pedestrians",
         "a network with sidewalks and crossings", "leave it out, or let netconvert guess crossings"});
    config.network.attribution = fmt::format("from {}", sources.network->filename().string());
    const bool has_files = !sources.demand.routes.empty() || !sources.demand.additional.empty();
    import.on_progress("reading the demand", 0.0);
    if (has_files &&
        detail::add_sumo_demand(import, sources.demand, network, import.scenario / network_name, config)) {
        take_over_times(sources, config);
        config.measured->options = sources.options;
        return told_in_own_words(import, [&] { try_out_demand(import, sources, config); });
    }
    if (has_files)
        import.findings.changes.emplace_back("the files have no road vehicles: the demand is synthetic");
    detail::choose_trips(import, config, network);
    told_in_own_words(import, [&] { detail::add_synthetic_demand(import, config, network); });
}

scenario::ScenarioConfig start_config(const Import& import) {
    scenario::ScenarioConfig config;
    config.name = import.request.folder.filename().string();
    config.version = "imported";
    config.title =
        fmt::format("{}, imported from {}", config.name, import.request.files.front().filename().string());
    config.network.file = network_name;
    config.limits.automated_kmh = config.limits.human_kmh;
    config.time.ignore_junction_blocker_s = scenario::usual_ignore_junction_blocker_s;
    config.folder = import.scenario;
    return config;
}

/// A program can also run for ever: SUMO draws speed factors until one is possible.
[[noreturn]] void refuse_slow(const ImportRequest& request, const std::string& stage) {
    throw core::InputError(core::Problem{
        request.files.front().string(),
        fmt::format("{} does not end within {:g} s", stage, request.program_limit_s),
        "files that its program works through in that time",
        "Look for values that are not possible, such as a speedDev of 1000, or raise --program-limit"});
}

}  // namespace

Findings import(const ImportRequest& request, const OnProgress& on_progress) {
    if (request.files.empty())
        throw core::InputError(
            core::Problem{"FILE", "is missing", "a map, a network or a configuration", ""});
    const std::filesystem::path folder = std::filesystem::absolute(request.folder).lexically_normal();
    check_folder(folder);
    core::make_folder(folder.parent_path());
    core::remove_leftovers_of(folder);
    const std::filesystem::path beside =
        folder.parent_path() / fmt::format(".{}.clearway-import-{}", folder.filename().string(), ::getpid());
    std::filesystem::remove_all(beside);
    const core::TemporaryFolder aside(beside);
    ImportRequest settled = request;
    settled.folder = folder;
    const OnProgress limited = [&](const std::string& stage, double elapsed_s) {
        if (elapsed_s > request.program_limit_s) refuse_slow(request, stage);
        on_progress(stage, elapsed_s);
    };
    Import import{settled, limited, aside.path() / "scenario", aside.path() / "work"};
    core::make_folder(import.scenario);
    core::make_folder(import.work);

    bool leaves_out_bad_vehicles = false;
    const Sources sources = sort_files(import, leaves_out_bad_vehicles);
    if (leaves_out_bad_vehicles) settled.bad_vehicles = BadVehicles::leave_out;
    scenario::ScenarioConfig config = start_config(import);
    if (sources.maps.empty())
        import_sumo(import, sources, config);
    else
        import_maps(import, sources.maps, config);

    on_progress("writing the scenario", 0.0);
    Findings& findings = import.findings;
    findings.name = config.name;
    findings.left_out = import.left_out.lines();
    if (config.emergency_trips.empty())
        findings.emergency_trips = traffic::words(scenario::emergency_ends(config));
    const roads::Network network =
        roads::Network::read(import.scenario / network_name, scenario::additional_files(config));
    if (!network.signals().empty()) {
        config.network.preemption = preemption_name;
        core::write_atomically(import.scenario / preemption_name,
                               scenario::preemption_csv(network, scenario::preemption_in(network)));
    }
    core::write_atomically(import.scenario / "scenario.toml", scenario::to_toml(config));
    core::write_atomically(import.scenario / "import.json", to_json(findings));
    core::write_atomically(import.scenario / "network.svg",
                           scenario::network_picture(network, config.title, config.network.attribution));
    scenario::load((import.scenario / "scenario.toml").string());
    on_progress("done", 0.0);
    move_to(import.scenario, folder);
    core::flush_folder(folder.parent_path());
    return findings;
}

}  // namespace clearway::scenario_import
