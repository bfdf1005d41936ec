#include "scenario/config.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/strict_table.hpp"
#include "scenario/detail/checks.hpp"
#include "scenario/detail/library.hpp"
#include "scenario/detail/tables.hpp"

namespace clearway::scenario {

namespace {

using core::StrictTable;

template <class Struct>
void read_table(StrictTable& reader, Struct& target);

/// Reads the table or the tables called `key`: a struct, an optional one, or a list.
template <class Target>
void read_below(StrictTable& parent, const std::string& key, Target& target) {
    if constexpr (detail::IsList<Target>::value) {
        for (StrictTable& reader : parent.rows(key))
            read_table(reader, target.emplace_back());
    } else if (auto reader = parent.below(key)) {
        if constexpr (core::OptionalMember<Target>::value) {
            read_table(*reader, target.emplace());
        } else {
            read_table(*reader, target);
        }
    }
}

void read_stretches(StrictTable& reader, RoadCondition& road) {
    auto named = reader.below("stretch");
    if (!named) return;
    for (const auto& [key, node] : *reader.table("stretch")) {
        const std::string name(key.str());
        if (auto members = named->below(name)) {
            Stretch& stretch = road.stretches.emplace_back();
            stretch.name = name;
            members->texts("edges", stretch.edges);
            read_table(*members, stretch);
        }
    }
}

void read_lists(StrictTable& reader, Measured& measured) {
    reader.texts("routes", measured.routes);
    reader.texts("additional", measured.additional);
    reader.texts("persons", measured.persons);
    reader.texts("options", measured.options);
    read_below(reader, "type", measured.types);
    read_below(reader, "own_types", measured.own_types);
}

template <class Struct>
void read_table(StrictTable& reader, Struct& target) {
    reader.read(target);
    if constexpr (std::is_same_v<Struct, RoadCondition>) read_stretches(reader, target);
    if constexpr (std::is_same_v<Struct, NetworkSource>) reader.texts("additional", target.additional);
    if constexpr (std::is_same_v<Struct, Measured>) read_lists(reader, target);
    reader.finish();
}

void read_root(const toml::table& table, core::TomlReading& reading, ScenarioConfig& config) {
    StrictTable root(table, "", reading);
    root.text_or_empty("name", config.name);
    root.text_or_empty("version", config.version);
    root.text_or_empty("title", config.title);
    auto kinds = root.below("kinds");
    detail::for_each_table([&](const auto& listed) {
        const std::string key = listed.key;
        const std::size_t dot = key.find('.');
        if (dot == std::string::npos) {
            read_below(root, key, config.*listed.member);
        } else if (kinds) {
            read_below(*kinds, key.substr(dot + 1), config.*listed.member);
        }
    });
    if (kinds) kinds->finish();
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

/// Puts the keys of `over` over those of `base`; tables are merged, anything else is replaced.
void merge_into(toml::table& base, const toml::table& over) {
    for (const auto& [key, node] : over) {
        toml::table* const below = base[key].as_table();
        if (below != nullptr && node.is_table())
            merge_into(*below, *node.as_table());
        else
            base.insert_or_assign(key, node);
    }
}

/// The table of a scenario file. One that names a `base` has the keys of the scenario in the folder of that
/// name beside its own, changed by its own keys; relative paths then start where those of the base do.
toml::table read_scenario(const std::filesystem::path& file, std::filesystem::path& folder) {
    toml::table table = core::parse_toml(core::read_file(file), file.string());
    folder = file.parent_path().empty() ? "." : file.parent_path();
    if (table.contains("conditions") || table.contains("condition"))
        throw core::InputError({file.string(), "is a study file, not a scenario",
                                "a folder with a scenario.toml, or a TOML file of a scenario",
                                fmt::format("`clearway study {}` runs it", file.string())});
    if (!table.contains("base")) return table;
    const std::string base = table["base"].value<std::string>().value_or("");
    const std::filesystem::path base_file =
        (std::filesystem::absolute(folder) / ".." / base / "scenario.toml").lexically_normal();
    const std::string where = file.string() + ": base";
    if (base.empty() || base == ".." || std::filesystem::path(base).filename() != base)
        throw core::InputError(
            {where, "is no name of a folder", "a scenario in a folder beside this one", ""});
    if (!std::filesystem::is_regular_file(base_file))
        throw core::InputError({where, fmt::format("there is no {}", base_file.string()),
                                "a scenario in a folder beside this one", ""});
    toml::table whole = core::parse_toml(core::read_file(base_file), base_file.string());
    if (whole.contains("base"))
        throw core::InputError({where, fmt::format("scenario {} has a base of its own", base),
                                "a scenario without the key `base`", "Name that one"});
    folder = base_file.parent_path();
    table.erase("base");
    merge_into(whole, table);
    return whole;
}

/// `time` of `a.toml:9: time.window_s`.
std::string table_of(const core::Problem& problem) {
    const std::size_t key = problem.where.rfind(' ') + 1;
    return problem.where.substr(key, std::max(problem.where.rfind('.'), key) - key);
}

/// Checks what the tables say together. A key that could not be read has its default then, and so has one
/// that is misspelt: of the key, or of all of the table, that would tell the same fault twice.
void check_rest(const ScenarioConfig& config, core::TomlReading& reading) {
    std::set<std::string> unread;
    for (const core::Problem& problem : reading.problems)
        unread.insert(problem.where);
    std::vector<core::Problem> more;
    detail::check(config, more);
    for (core::Problem& problem : more)
        if (!unread.contains(problem.where) && !reading.misspelt.contains(table_of(problem)))
            reading.problems.push_back(std::move(problem));
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
    if (name.empty()) return folder.empty() ? key : fmt::format("scenario in {}: {}", folder.string(), key);
    return fmt::format("scenario {}: {}", name, key);
}

ScenarioConfig load(const std::string& name_or_path, const Options& options) {
    const std::filesystem::path file = detail::scenario_file(name_or_path);
    ScenarioConfig config;
    core::TomlReading reading{file.string(), {}, {}};
    toml::table table = read_scenario(file, config.folder);
    for (const auto& [key, value] : options.settings)
        set_key(table, key, value);
    read_root(table, reading, config);
    config.origins = reading.origins;
    detail::apply(options, config, reading.problems);
    check_rest(config, reading);
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
    for (const std::string& path : config.network.additional)
        files.push_back(resolve(config, path));
    if (!config.measured) return files;
    for (const std::string& path : config.measured->additional)
        files.push_back(resolve(config, path));
    return files;
}

}  // namespace clearway::scenario
