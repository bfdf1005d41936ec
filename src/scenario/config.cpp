#include "scenario/config.hpp"

#include <cmath>
#include <cstdlib>

#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "scenario/detail/checks.hpp"
#include "scenario/detail/library.hpp"
#include "scenario/detail/toml_reader.hpp"

namespace clearway::scenario {

namespace {

using detail::Reading;
using detail::TableReader;

template <class Struct>
void read_subtable(TableReader& parent, const std::string& key, Reading& reading, Struct& target) {
    const toml::table* table = parent.table(key);
    if (table == nullptr) return;
    TableReader reader(*table, parent.full(key), reading);
    reader.read(target);
    reader.finish();
}

template <class Struct>
void read_subtable(TableReader& parent, const std::string& key, Reading& reading,
                   std::optional<Struct>& target) {
    if (parent.table(key) != nullptr) read_subtable(parent, key, reading, target.emplace());
}

template <class Struct>
void read_list(TableReader& parent, const std::string& key, Reading& reading, std::vector<Struct>& target) {
    std::size_t number = 0;
    for (const toml::table* table : parent.tables(key)) {
        const std::string name = fmt::format("{}[{}]", parent.full(key), number++);
        reading.origins[name] = reading.place(table->source(), name);
        TableReader reader(*table, name, reading);
        reader.read(target.emplace_back());
        reader.finish();
    }
}

void read_kinds(TableReader& root, Reading& reading, ScenarioConfig& config) {
    const toml::table* table = root.table("kinds");
    if (table == nullptr) return;
    TableReader kinds(*table, "kinds", reading);
    read_subtable(kinds, "traffic", reading, config.traffic_kinds);
    read_subtable(kinds, "emergency", reading, config.emergency_kinds);
    kinds.finish();
}

void read_road(TableReader& root, Reading& reading, RoadCondition& road) {
    const toml::table* table = root.table("road");
    if (table == nullptr) return;
    TableReader reader(*table, "road", reading);
    reader.read(road);
    if (const toml::table* stretches = reader.table("stretch")) {
        TableReader named(*stretches, "road.stretch", reading);
        for (const auto& [key, node] : *stretches) {
            const std::string name(key.str());
            const toml::table* stretch = named.table(name);
            if (stretch == nullptr) continue;
            TableReader members(*stretch, named.full(name), reading);
            road.stretches.emplace_back().name = name;
            members.read(road.stretches.back());
            members.texts("edges", road.stretches.back().edges);
            members.finish();
        }
    }
    reader.finish();
}

void read_measured(TableReader& root, Reading& reading, ScenarioConfig& config) {
    const toml::table* table = root.table("measured");
    if (table == nullptr) return;
    Measured& measured = config.measured.emplace();
    TableReader reader(*table, "measured", reading);
    reader.read(measured);
    reader.texts("routes", measured.routes);
    reader.texts("additional", measured.additional);
    reader.texts("persons", measured.persons);
    read_list(reader, "type", reading, measured.types);
    read_subtable(reader, "own_types", reading, measured.own_types);
    reader.finish();
}

void read_root(const toml::table& table, Reading& reading, ScenarioConfig& config) {
    TableReader root(table, "", reading);
    root.text("name", config.name);
    root.text("version", config.version);
    root.text("title", config.title);
    read_subtable(root, "network", reading, config.network);
    read_subtable(root, "time", reading, config.time);
    read_subtable(root, "demand", reading, config.demand);
    read_subtable(root, "dense", reading, config.dense);
    read_subtable(root, "limits", reading, config.limits);
    read_subtable(root, "drivers", reading, config.drivers);
    read_subtable(root, "siren", reading, config.siren);
    read_road(root, reading, config.road);
    read_subtable(root, "pedestrians", reading, config.pedestrians);
    read_kinds(root, reading, config);
    read_subtable(root, "trips", reading, config.trips);
    read_list(root, "flow", reading, config.flows);
    read_list(root, "emergency_trip", reading, config.emergency_trips);
    read_list(root, "emergency_site", reading, config.emergency_sites);
    read_measured(root, reading, config);
    root.finish();
}

toml::table parse(const std::filesystem::path& file, const std::string& shown) {
    const std::string text = core::read_file(file);
    try {
        return toml::parse(text, shown);
    } catch (const toml::parse_error& error) {
        throw core::InputError(core::Problem{
            fmt::format("{}:{}:{}", shown, error.source().begin.line, error.source().begin.column),
            std::string(error.description()), "a TOML file", "correct this line"});
    }
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
    const toml::table parsed = toml::parse("value = " + value);
    const std::string last = dotted.substr(begin);
    table->erase(last);  // also forgets its place in the file
    parsed.get("value")->visit([&](const auto& node) { table->insert(last, node); });
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
    Reading reading;
    reading.file = file.string();
    toml::table table = parse(file, reading.file);
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
