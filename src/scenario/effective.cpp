#include <string_view>
#include <type_traits>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/folder_name.hpp"
#include "core/leftovers.hpp"
#include "core/part_folder.hpp"
#include "core/strict_table.hpp"
#include "scenario/config.hpp"
#include "scenario/detail/library.hpp"
#include "scenario/detail/tables.hpp"

namespace clearway::scenario {

namespace {

template <class Member>
std::string value_text(const Member& value) {
    if constexpr (std::is_same_v<Member, std::string>) {
        return detail::quoted(value);
    } else if constexpr (std::is_enum_v<Member>) {
        return detail::quoted(std::string(core::name(value)));
    } else if constexpr (core::OptionalMember<Member>::value) {
        return value_text(*value);
    } else if constexpr (std::is_floating_point_v<Member>) {
        return fmt::format("{}", value + 0.0);  // a negative zero is "-0", which is read as a whole number
    } else {
        return fmt::format("{}", value);
    }
}

/// Empty texts and empty optionals count as absent. So does `connected`, the default of trips.ends: older
/// configurations keep their `configuration_hash`.
template <class Member>
bool is_absent(const Member& value) {
    if constexpr (std::is_same_v<Member, std::string>) return value.empty();
    if constexpr (core::OptionalMember<Member>::value) return !value.has_value();
    if constexpr (std::is_same_v<Member, TripEnds>) return value == TripEnds::connected;
    return false;
}

/// Members of a struct as lines `key = value`, without the absent ones.
template <class Struct>
std::string members(const Struct& values) {
    std::string text;
    core::for_each_field<Struct>([&](const auto& field) {
        const auto& value = values.*field.member;
        if (is_absent(value)) return;
        text += fmt::format("{} = {}\n", field.name, value_text(value));
    });
    return text;
}

std::string text_array(const std::vector<std::string>& values) {
    std::string text = "[";
    for (const std::string& value : values)
        text += (text.size() > 1 ? ", " : "") + detail::quoted(value);
    return text + "]";
}

/// What the table has beside plain keys.
template <class Struct>
std::string lists(const Struct&) {
    return "";
}

std::string lists(const NetworkSource& network) {
    return network.additional.empty() ? "" : fmt::format("additional = {}\n", text_array(network.additional));
}

std::string lists(const Measured& measured) {
    std::string text = fmt::format("routes = {}\nadditional = {}\n", text_array(measured.routes),
                                   text_array(measured.additional));
    // Only if there are any, so that older configurations keep their `configuration_hash`.
    if (!measured.persons.empty()) text += fmt::format("persons = {}\n", text_array(measured.persons));
    if (!measured.options.empty()) text += fmt::format("options = {}\n", text_array(measured.options));
    if (measured.own_types) text += "\n[measured.own_types]\n" + members(*measured.own_types);
    for (const MeasuredType& type : measured.types)
        text += "\n[[measured.type]]\n" + members(type);
    return text;
}

std::string lists(const RoadCondition& road) {
    std::string text;
    for (const Stretch& stretch : road.stretches)
        text += fmt::format("\n[road.stretch.{}]\n{}edges = {}\n", detail::quoted(stretch.name),
                            members(stretch), text_array(stretch.edges));
    return text;
}

/// Tables without effect are left out, so that older configurations keep their `configuration_hash`.
template <class Struct>
bool has_effect(const Struct& table) {
    if constexpr (std::is_same_v<Struct, Following>) return table != Following{};
    if constexpr (std::is_same_v<Struct, traffic::SirenConfig>) return table.compliance > 0.0;
    if constexpr (std::is_same_v<Struct, Slow>) return table.share > 0.0;
    if constexpr (std::is_same_v<Struct, Privilege>) return !table.none();
    if constexpr (std::is_same_v<Struct, RoadCondition>) return !table.is_dry();
    if constexpr (std::is_same_v<Struct, Pedestrians>) return table.walk();
    return true;
}

template <class Member>
std::string table_text(const char* key, const Member& member) {
    std::string text;
    if constexpr (detail::IsList<Member>::value) {
        for (const auto& row : member)
            text += fmt::format("\n[[{}]]\n{}", key, members(row));
    } else if constexpr (core::OptionalMember<Member>::value) {
        if (member) text = table_text(key, *member);
    } else if (has_effect(member)) {
        text = fmt::format("\n[{}]\n{}{}", key, members(member), lists(member));
    }
    return text;
}

/// The files that a configuration names relative to its folder.
std::vector<std::string> own_files(const ScenarioConfig& config) {
    const NetworkSource& network = config.network;
    std::vector<std::string> files = {network.nodes,      network.edges,       network.connections,
                                      network.signals,    network.file,        network.preemption,
                                      network.mean_times, config.demand.counts};
    files.insert(files.end(), network.additional.begin(), network.additional.end());
    if (config.measured) {
        files.insert(files.end(), config.measured->routes.begin(), config.measured->routes.end());
        files.insert(files.end(), config.measured->additional.begin(), config.measured->additional.end());
        files.insert(files.end(), config.measured->persons.begin(), config.measured->persons.end());
        if (config.measured->own_types) files.push_back(config.measured->own_types->file);
    }
    std::erase_if(files, [](const std::string& file) {
        return file.empty() || file.front() == '$' || std::filesystem::path(file).is_absolute();
    });
    return files;
}

void copy_files(const ScenarioConfig& config, const std::filesystem::path& folder) {
    for (const std::string& file : own_files(config)) {
        const std::filesystem::path target = folder / file;
        core::make_folder(target.parent_path());
        core::write_atomically(target, core::read_file(config.folder / file));
    }
}

/// The text with the line of its key `name` replaced; everything else stays, comments included.
std::string renamed(const std::string& text, const std::string& name) {
    const toml::table table = core::parse_toml(text, "scenario.toml");
    const auto line = table.get("name")->source().begin.line;
    std::size_t start = 0;
    for (toml::source_index number = 1; number < line; ++number)
        start = text.find('\n', start) + 1;
    const std::size_t end = text.find('\n', start);
    return text.substr(0, start) + "name = " + detail::quoted(name) +
           (end == std::string::npos ? "\n" : text.substr(end));
}

/// Whether the file stands for itself; one with a `base` is a list of changes.
bool is_whole(const std::string& text) {
    return !core::parse_toml(text, "scenario.toml").contains("base");
}

/// The text with the usual remedy against locks in its table [time], unless it has a value of its own.
std::string unlocked(const std::string& text) {
    const toml::table table = core::parse_toml(text, "scenario.toml");
    if (table["time"]["ignore_junction_blocker_s"]) return text;
    const std::string line =
        fmt::format("ignore_junction_blocker_s = {:.1f}\n", usual_ignore_junction_blocker_s);
    if (!table.contains("time")) return text + "\n[time]\n" + line;
    constexpr std::string_view header = "\n[time]\n";
    const std::size_t at = ("\n" + text).find(header);
    if (at == std::string::npos)
        throw core::InputError({"time", "the line `[time]` of the scenario holds something else, too",
                                "`[time]`",
                                "Write it so, or set time.ignore_junction_blocker_s in the scenario"});
    const std::size_t end = at + header.size() - 1;
    return text.substr(0, end) + line + text.substr(end);
}

}  // namespace

std::string to_toml(const ScenarioConfig& config) {
    std::string text =
        fmt::format("name = {}\nversion = {}\n", detail::quoted(config.name), detail::quoted(config.version));
    if (!config.title.empty()) text += fmt::format("title = {}\n", detail::quoted(config.title));
    detail::for_each_table([&](const auto& table) { text += table_text(table.key, config.*table.member); });
    return text;
}

std::string configuration_hash(const ScenarioConfig& config) {
    return core::content_hash(to_toml(config));
}

std::string scenario_hash(const ScenarioConfig& config) {
    std::string bytes = to_toml(config);
    for (const std::string& file : own_files(config)) {
        const std::filesystem::path path = resolve(config, file);
        if (std::filesystem::exists(path)) bytes += core::content_hash(core::read_file(path)) + "\n";
    }
    return core::content_hash(bytes);
}

void store(const ScenarioConfig& config, const std::filesystem::path& folder) {
    core::make_folder(folder);
    copy_files(config, folder);
    core::write_atomically(folder / "scenario.toml", to_toml(config));
}

void init(const std::filesystem::path& folder, const std::string& from) {
    if (std::filesystem::exists(folder) &&
        (!std::filesystem::is_directory(folder) || !std::filesystem::is_empty(folder)))
        throw core::InputError(core::Problem{folder.string(), "exists and is not an empty folder",
                                             "a new or an empty folder", "choose another name"});
    const std::filesystem::path named = folder.has_filename() ? folder : folder.parent_path();
    std::vector<core::Problem> problems;
    core::check_folder_name(folder.string(), named.filename().string(), problems);
    if (!problems.empty()) throw core::InputError(std::move(problems));
    const std::filesystem::path source = detail::scenario_file(from);
    const ScenarioConfig config = load(from);
    const std::string text = core::read_file(source);
    const std::string copy =
        unlocked(renamed(is_whole(text) ? text : to_toml(config), named.filename().string()));
    core::remove_leftovers_of(named);
    core::PartFolder part(named);
    copy_files(config, part.path());
    core::write_atomically(part.path() / "scenario.toml", copy);
    part.replace();
}

}  // namespace clearway::scenario
