#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/common_options.hpp"
#include "cli/verb.hpp"
#include "experiment/conditions.hpp"
#include "policy/part.hpp"
#include "prediction/predictor.hpp"
#include "scenario/config.hpp"
#include "sensing/failure_config.hpp"

namespace clearway::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Something that can be asked for by name.
struct Entry {
    std::string name;
    std::string summary;
    Json details = Json::object();  ///< Further fields for machines.
};

struct Section {
    const char* key;  ///< Name of the field in JSON.
    const char* title;
    std::vector<Entry> entries;
};

Section scenarios() {
    Section section{"scenarios", "Scenarios (run SCENARIO, dataset SCENARIO, init --from SCENARIO)", {}};
    for (const std::string& name : scenario::list()) {
        const scenario::ScenarioConfig config = scenario::load(name);
        section.entries.push_back({name,
                                   fmt::format("{} ({})", config.title, config.version),
                                   {{"title", config.title},
                                    {"version", config.version},
                                    {"dense_variant", config.dense.has_value()},
                                    {"step_length_s", config.time.step_length_s},
                                    {"attribution", config.network.attribution}}});
    }
    return section;
}

Section conditions() {
    Section section{"conditions", "Conditions (run --condition NAME, or in a study file)", {}};
    for (const experiment::BuiltInCondition& known : experiment::built_in_conditions()) {
        const experiment::ConditionSpec& condition = known.condition;
        const bool checked = condition.safety_checks == traffic::SafetyChecks::on;
        section.entries.push_back({condition.name,
                                   known.summary,
                                   {{"summary", known.summary},
                                    {"failure", condition.failure},
                                    {"predictor", condition.predictor},
                                    {"policy", condition.parts},
                                    {"engine", experiment::name(condition.engine)},
                                    {"safety_checks", checked ? "on" : "off"}}});
    }
    return section;
}

/// Every parameter of a failure model; its name carries its unit.
Json parameters_of(const sensing::FailureConfig& config) {
    Json parameters = Json::object();
    core::for_each_field<sensing::FailureConfig>([&](const auto& field) {
        const auto& value = config.*field.member;
        using Member = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_enum_v<Member>) {
            const auto known = sensing::spellings(Member{});
            parameters[field.name] =
                std::ranges::find(known, value, [](const auto& spelling) { return spelling.first; })->second;
        } else {
            parameters[field.name] = value;
        }
    });
    return parameters;
}

Section failures() {
    Section section{"failures",
                    "Sensor failures (run --failure NAME, NAME,FIELD=VALUE,... or FIELD=VALUE,...; "
                    "docs/reference/sensing.md)",
                    {}};
    for (const sensing::FailurePreset& preset : sensing::failure_presets()) {
        section.entries.push_back(
            {preset.name,
             preset.summary,
             {{"summary", preset.summary}, {"parameters", parameters_of(preset.config)}}});
    }
    return section;
}

Section predictors() {
    Section section{"predictors", "Predictors (run --predictor NAME)", {}};
    for (const prediction::PredictorEntry& entry : prediction::predictors()) {
        section.entries.push_back({entry.name, entry.summary, {{"summary", entry.summary}}});
    }
    return section;
}

Section policy_parts() {
    Section section{"policy_parts", "Policy parts (run --policy NAME ...)", {}};
    for (const policy::PartEntry& entry : policy::parts()) {
        section.entries.push_back({entry.name, entry.summary, {{"summary", entry.summary}}});
    }
    return section;
}

void print_json(const std::vector<Section>& sections) {
    Json all = Json::object();
    for (const Section& section : sections) {
        Json& list = all[section.key] = Json::array();
        for (const Entry& entry : section.entries) {
            Json item = {{"name", entry.name}};
            item.update(entry.details);
            list.push_back(std::move(item));
        }
    }
    fmt::print("{}\n", all.dump(2));
}

void print_text(const std::vector<Section>& sections) {
    const char* gap = "";
    for (const Section& section : sections) {
        fmt::print("{}{}\n", gap, section.title);
        for (const Entry& entry : section.entries) {
            fmt::print("  {:22} {}\n", entry.name, entry.summary);
        }
        gap = "\n";
    }
}

}  // namespace

Action configure_list(CLI::App& app) {
    const auto printing = std::make_shared<Printing>(Printing::text);
    add_json_option(app, *printing, "the lists");
    return [printing](const Invocation&) {
        const std::vector<Section> sections = {scenarios(), conditions(), failures(), predictors(),
                                               policy_parts()};
        *printing == Printing::json ? print_json(sections) : print_text(sections);
        return core::ExitCode::ok;
    };
}

}  // namespace clearway::cli
