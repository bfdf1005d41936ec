#include "study/side_files.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/files.hpp"
#include "core/json.hpp"
#include "metrics/counts.hpp"
#include "scenario/network.hpp"
#include "scenario/outlook.hpp"
#include "scenario/picture.hpp"
#include "scenario/prepare.hpp"
#include "study/detail/road_map.hpp"

namespace clearway::study {
namespace {

/// The edges with more lanes for cars than the dissertation's networks have, as read_facts expects them.
std::string wide_edges_json(const roads::Network& network) {
    core::Json rows = core::Json::array();
    for (const scenario::WideEdge& edge : scenario::wide_edges(network))
        rows.push_back({{"edge", edge.id}, {"street", edge.name}, {"car_lanes", edge.car_lanes}});
    return core::to_text(rows);
}

/// Street names of edges outside junctions, as read_facts expects them.
std::string streets_json(const roads::Network& network) {
    core::Json names = core::Json::object();
    for (const roads::Edge& edge : network.edges()) {
        if (!edge.internal && !edge.name.empty()) names[edge.id] = edge.name;
    }
    return names.dump(1, ' ', false, core::Json::error_handler_t::replace) + "\n";
}

/// Writes the counted flows of a scenario, if it has any, as read_facts expects them. Throws as check_counts
/// does.
void write_counts(const scenario::ScenarioConfig& config, const roads::Network& network,
                  const std::filesystem::path& file) {
    if (config.demand.counts.empty()) return;
    check_counts(config, network);
    core::write_atomically(file, core::read_file(scenario::resolve(config, config.demand.counts)));
}

/// Without a text there is no such file.
void keep_text(const std::filesystem::path& file, const std::string& text) {
    if (text.empty())
        std::filesystem::remove(file);
    else
        core::write_atomically(file, text);
}

void keep_texts(const std::filesystem::path& file, const core::Settings& texts) {
    keep_text(file, texts.empty() ? "" : core::to_text(core::Json(texts)));
}

core::Json outlook_of(const roads::Network& network, const scenario::Prepared& prepared) {
    std::vector<std::vector<std::string>> ways;
    for (const traffic::EmergencyDeparture& departure : prepared.emergency)
        ways.push_back(departure.edges);
    return scenario::outlook_json(
        scenario::outlook(network, ways, scenario::planned_routes(prepared.route_files.front(), network),
                          prepared.time.window_s));
}

/// Makes what a scenario needs besides its network: a first demand, which finds unknown edges and unreachable
/// destinations before any worker starts, its wide edges, street names, a map and a picture for the report.
void complete_scenario(const scenario::ScenarioConfig& config, const experiment::RunJob& unit,
                       const std::filesystem::path& folder) {
    const std::filesystem::path picture = folder / "network.svg";
    if (std::filesystem::exists(picture)) return;
    const scenario::BuiltNetwork built = scenario::open_network(config, unit.network_folder);
    const std::filesystem::path demand = folder / "demand" / std::to_string(unit.replication);
    core::make_folder(demand);
    const scenario::Prepared prepared = scenario::prepare(config, built, core::StudySeed{unit.study_seed},
                                                          core::Replication{unit.replication}, demand);
    core::write_atomically(folder / "outlook.json", core::to_text(outlook_of(built.network, prepared)));
    const std::string title = config.title.empty() ? config.name : config.title;
    core::write_atomically(folder / "wide_edges.json", wide_edges_json(built.network));
    write_counts(config, built.network, folder / "counts.csv");
    core::write_atomically(folder / "streets.json", streets_json(built.network));
    core::write_atomically(folder / "roads.json", detail::road_map_json(built.network, config));
    core::write_atomically(picture,
                           scenario::network_picture(built.network, title, config.network.attribution));
}

}  // namespace

void check_counts(const scenario::ScenarioConfig& config, const roads::Network& network) {
    if (config.demand.counts.empty()) return;
    const std::filesystem::path source = scenario::resolve(config, config.demand.counts);
    std::vector<core::Problem> problems;
    for (const metrics::EdgeCount& count : metrics::read_counts(source)) {
        if (network.find_edge(count.edge)) continue;
        problems.push_back({source.string(), fmt::format("the network has no edge {}", count.edge),
                            "edges of the scenario's network", ""});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

void complete_scenarios(const Plan& plan, const results::Store& store) {
    std::vector<core::Problem> problems;
    for (const scenario::ScenarioConfig& config : plan.scenarios) {
        const auto planned = std::ranges::find_if(
            plan.units, [&](const PlannedUnit& each) { return each.unit.scenario == config.name; });
        if (planned == plan.units.end()) continue;
        try {
            complete_scenario(config, planned->unit, store.scenario_folder(config.name));
        } catch (const core::InputError& error) {
            problems.insert(problems.end(), error.problems().begin(), error.problems().end());
        }
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

void keep_command(const results::Store& store, const std::string& command, Growth growth) {
    const std::filesystem::path file = store.folder() / "command.txt";
    if (growth == Growth::none && std::filesystem::exists(file)) return;
    core::write_atomically(file, command + "\n");
}

void keep_titles(const results::Store& store, const core::Settings& titles) {
    keep_texts(store.folder() / "titles.json", titles);
}

void keep_controls(const results::Store& store, const core::Settings& controls) {
    keep_texts(store.folder() / "controls.json", controls);
}

void keep_study_file(const results::Store& store, const std::string& text) {
    keep_text(store.folder() / "study.toml", text);
}

void copy_trainings(const std::filesystem::path& source, const results::Store& store) {
    for (const auto& training : std::filesystem::directory_iterator(source)) {
        std::error_code unknown;
        if (!std::filesystem::exists(training.path() / "losses.csv", unknown)) continue;
        const std::filesystem::path target = store.folder() / "training" / training.path().filename();
        core::make_folder(target);
        for (const char* const name : {"losses.csv", "summary.json"}) {
            const std::filesystem::path file = training.path() / name;
            if (std::filesystem::exists(file)) core::write_atomically(target / name, core::read_file(file));
        }
    }
}

}  // namespace clearway::study
