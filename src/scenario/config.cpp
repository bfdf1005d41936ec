#include "scenario/config.hpp"

#include <cstdlib>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/strict_table.hpp"
#include "scenario/detail/checks.hpp"
#include "scenario/detail/library.hpp"

namespace clearway::scenario {

namespace {

using core::StrictTable;

template <class Struct>
void read_subtable(StrictTable& parent, const std::string& key, Struct& target) {
    if (auto reader = parent.below(key)) {
        reader->read(target);
        reader->finish();
    }
}

template <class Struct>
void read_subtable(StrictTable& parent, const std::string& key, std::optional<Struct>& target) {
    if (parent.table(key) != nullptr) read_subtable(parent, key, target.emplace());
}

template <class Struct>
void read_list(StrictTable& parent, const std::string& key, std::vector<Struct>& target) {
    for (StrictTable& reader : parent.rows(key)) {
        reader.read(target.emplace_back());
        reader.finish();
    }
}

void read_kinds(StrictTable& root, ScenarioConfig& config) {
    auto kinds = root.below("kinds");
    if (!kinds) return;
    read_subtable(*kinds, "traffic", config.traffic_kinds);
    read_subtable(*kinds, "emergency", config.emergency_kinds);
    kinds->finish();
}

void read_road(StrictTable& root, RoadCondition& road) {
    auto reader = root.below("road");
    if (!reader) return;
    reader->read(road);
    if (auto named = reader->below("stretch")) {
        for (const auto& [key, node] : *reader->table("stretch")) {
            const std::string name(key.str());
            auto members = named->below(name);
            if (!members) continue;
            road.stretches.emplace_back().name = name;
            members->read(road.stretches.back());
            members->texts("edges", road.stretches.back().edges);
            members->finish();
        }
    }
    reader->finish();
}

void read_measured(StrictTable& root, ScenarioConfig& config) {
    auto reader = root.below("measured");
    if (!reader) return;
    Measured& measured = config.measured.emplace();
    reader->read(measured);
    reader->texts("routes", measured.routes);
    reader->texts("additional", measured.additional);
    reader->texts("persons", measured.persons);
    read_list(*reader, "type", measured.types);
    read_subtable(*reader, "own_types", measured.own_types);
    reader->finish();
}

void read_root(const toml::table& table, core::TomlReading& reading, ScenarioConfig& config) {
    StrictTable root(table, "", reading);
    root.text_or_empty("name", config.name);
    root.text_or_empty("version", config.version);
    root.text_or_empty("title", config.title);
    read_subtable(root, "network", config.network);
    read_subtable(root, "time", config.time);
    read_subtable(root, "demand", config.demand);
    read_subtable(root, "dense", config.dense);
    read_subtable(root, "limits", config.limits);
    read_subtable(root, "drivers", config.drivers);
    read_subtable(root, "car_following", config.following);
    read_subtable(root, "siren", config.siren);
    read_subtable(root, "slow", config.slow);
    read_subtable(root, "privilege", config.privilege);
    read_road(root, config.road);
    read_subtable(root, "pedestrians", config.pedestrians);
    read_kinds(root, config);
    read_subtable(root, "trips", config.trips);
    read_list(root, "flow", config.flows);
    read_list(root, "emergency_trip", config.emergency_trips);
    read_list(root, "emergency_site", config.emergency_sites);
    read_measured(root, config);
    root.finish();
}

/// Sets a dotted key to `value`, which is TOML text.
void set_key(toml::table& root, const std::string& dotted, const std::string& value) {
    toml::table* table = &root;
    std::size_t begin = 0;
    for (std::size_t dot = dotted.find('.'); dot != std::string::npos; dot = dotted.find('.', begin)) {
        const std::string key = dotted.substr(begin, dot - begin);
        table->insert(key, toml::table{});
        toml::table* const next = table->get(key)->as_table();
        if (next == nullptr)
            throw core::InputError(
                {fmt::format("factor scenario.{}", dotted), fmt::format("{} is not a table", key), "", ""});
        table = next;
        begin = dot + 1;
    }
    core::set_value(*table, dotted.substr(begin), value);
}

}  // namespace

DemandKind ScenarioConfig::demand_kind() const {
    if (measured) return DemandKind::measured;
    return flows.empty() ? DemandKind::trips : DemandKind::flows;
}

bool ScenarioConfig::has_pedestrians() const {
    return pedestrians.walk() || (measured && !measured->persons.empty());
}

std::string ScenarioConfig::where(const std::string& key) const {
    const auto found = origins.find(key);
    if (found != origins.end()) return found->second;
    return name.empty() ? key : fmt::format("scenario {}: {}", name, key);
}

ScenarioConfig load(const std::string& name_or_path, const Options& options) {
    const std::filesystem::path file = detail::scenario_file(name_or_path);
    ScenarioConfig config;
    config.folder = file.parent_path().empty() ? "." : file.parent_path();
    core::TomlReading reading{file.string(), {}, {}};
    toml::table table = core::parse_toml(core::read_file(file), reading.file);
    for (const auto& [key, value] : options.settings)
        set_key(table, key, value);
    read_root(table, reading, config);
    config.origins = reading.origins;
    detail::apply(options, config, reading.problems);
    detail::check(config, reading.problems);
    if (!reading.problems.empty()) throw core::InputError(reading.problems);
    return config;
}

std::filesystem::path resolve(const ScenarioConfig& config, const std::string& path) {
    static const std::string prefix = "$SUMO_HOME";
    if (path.rfind(prefix, 0) != 0) return config.folder / path;
    const char* home = std::getenv("SUMO_HOME");
    if (home == nullptr || *home == '\0')
        throw core::EnvironmentError(fmt::format(
            "SUMO_HOME is not set, and {} refers to it. Set it to SUMO's folder (Debian: /usr/share/sumo)",
            path));
    return home + path.substr(prefix.size());
}

std::vector<std::filesystem::path> additional_files(const ScenarioConfig& config) {
    std::vector<std::filesystem::path> files;
    if (!config.measured) return files;
    for (const std::string& path : config.measured->additional)
        files.push_back(resolve(config, path));
    return files;
}

}  // namespace clearway::scenario
