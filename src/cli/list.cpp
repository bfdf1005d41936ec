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
#include "experiment/settings_page.hpp"
#include "policy/policy.hpp"
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
                                    {"policy", condition.policies},
                                    {"traffic_model", experiment::name(condition.traffic_model)},
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

Section policies() {
    Section section{"policies", "Policies (run --policy NAME ...)", {}};
    for (const policy::PolicyEntry& entry : policy::policies()) {
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
            fmt::print("  {:28} {}\n", entry.name, entry.summary);
        }
        gap = "\n";
    }
}

struct Arguments {
    std::vector<std::string> words;
    Printing printing = Printing::text;
    bool as_markdown = false;
};

core::ExitCode list_settings(const Arguments& arguments) {
    constexpr const char* settings = "settings";
    if (arguments.words.empty() || arguments.words.front() != settings)
        throw core::InputError({"list",
                                arguments.words.empty()
                                    ? "--markdown goes with settings"
                                    : fmt::format("`{}` cannot be listed alone", arguments.words.front()),
                                settings, "Say `clearway list`, or `clearway list settings`"});
    const std::vector<experiment::Component> components =
        experiment::components_named(arguments.words.size() > 1 ? arguments.words.back() : "");
    if (arguments.as_markdown) {
        fmt::print("{}", experiment::settings_markdown(components));
    } else if (arguments.printing == Printing::json) {
        fmt::print("{}", experiment::settings_json(components));
    } else {
        fmt::print("{}", experiment::settings_console(components));
    }
    return core::ExitCode::ok;
}

}  // namespace

Action configure_list(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    app.footer(app.get_footer() + "\n  clearway list settings preempt_signals");
    app.add_option("what", arguments->words,
                   "`settings`: every number that a condition may set, or those of NAME")
        ->expected(0, 2)
        ->option_text("settings [NAME] [the names alone]");
    add_json_option(app, arguments->printing, "the lists");
    app.add_flag("--markdown", arguments->as_markdown,
                 "Print the settings as docs/reference/settings.md has them");
    return [arguments](const Invocation&) {
        if (!arguments->words.empty() || arguments->as_markdown) return list_settings(*arguments);
        const std::vector<Section> sections = {scenarios(), conditions(), failures(), predictors(),
                                               policies()};
        arguments->printing == Printing::json ? print_json(sections) : print_text(sections);
        return core::ExitCode::ok;
    };
}

}  // namespace clearway::cli
