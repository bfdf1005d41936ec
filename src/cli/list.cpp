#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/reference_pages.hpp"
#include "cli/verb.hpp"
#include "core/terminal.hpp"
#include "experiment/conditions.hpp"
#include "experiment/settings_page.hpp"
#include "failures/failure_config.hpp"
#include "policy/policy.hpp"
#include "prediction/predictor.hpp"
#include "scenario/config.hpp"
#include "scenario/road_limits.hpp"

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
        const std::string newest = scenario::newest(name);
        const std::string roads = scenario::road_limits(config).words();
        section.entries.push_back(
            {name,
             fmt::format("{}{} ({}{})", config.title, roads.empty() ? "" : "; " + roads, config.version,
                         newest == name ? "" : "; for new studies " + newest),
             {{"title", config.title},
              {"version", config.version},
              {"newest", newest},
              {"roads", roads},
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
Json parameters_of(const failures::FailureConfig& config) {
    Json parameters = Json::object();
    core::for_each_field<failures::FailureConfig>([&](const auto& field) {
        const auto& value = config.*field.member;
        using Member = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_enum_v<Member>) {
            parameters[field.name] = core::name(value);
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
    for (const failures::FailurePreset& preset : failures::failure_presets()) {
        section.entries.push_back(
            {preset.name,
             preset.summary,
             {{"summary", preset.summary}, {"parameters", parameters_of(preset.config)}}});
    }
    return section;
}

/// The parts of a registry, with what they do for machines.
template <class Entry>
Section parts(const char* key, const char* title, const traffic::Registry<Entry>& registry) {
    Section section{key, title, {}};
    for (const Entry& entry : registry) {
        Json traits = Json::array();
        for (const traffic::Trait trait : entry.traits)
            traits.push_back(core::name(trait));
        section.entries.push_back(
            {entry.name, entry.summary, {{"summary", entry.summary}, {"traits", traits}}});
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
        fmt::print("{}{}\n", gap, core::wrapped(section.title, 2));
        for (const Entry& entry : section.entries) {
            fmt::print("{}\n", core::wrapped(fmt::format("  {:28} {}", entry.name, entry.summary), 31));
        }
        gap = "\n";
    }
}

struct ListArguments {
    std::vector<std::string> words;
    Printing printing = Printing::text;
    bool as_markdown = false;
    bool with_reasons = false;
};

std::vector<Section> all_sections() {
    return {scenarios(), conditions(), failures(),
            parts("predictors", "Predictors (run --predictor NAME)", prediction::predictors()),
            parts("policies", "Policies (run --policy NAME ...)", policy::policies())};
}

void print_sections(const std::vector<Section>& sections, Printing printing) {
    printing == Printing::json ? print_json(sections) : print_text(sections);
}

/// Whether a word means a section: `policies`, or `policy` as the option has it.
bool is_meant(const Section& section, const std::string& word) {
    const std::string key = section.key;
    const bool ends_in_ies = key.ends_with("ies");
    return word == key ||
           word == key.substr(0, key.size() - (ends_in_ies ? 3 : 1)) + (ends_in_ies ? "y" : "");
}

/// What is wrong with `clearway list WORD`.
core::InputError unknown_list(const std::string& word, const std::vector<ReferencePage>& pages,
                              const std::vector<Section>& sections) {
    std::vector<std::string> known = {"settings"};
    for (const ReferencePage& page : pages)
        known.emplace_back(page.name);
    for (const Section& section : sections)
        known.emplace_back(section.key);
    const std::string allowed = core::listed(known);
    if (word.empty()) return core::InputError({"list", "--markdown needs the name of a page", allowed, ""});
    return core::InputError({"list", fmt::format("`{}` cannot be listed alone", word), allowed,
                             word == "metrics" ? "Did you mean 'columns'?"
                                               : core::did_you_mean(word, known, "Say `clearway list`")});
}

void list_settings(const ListArguments& arguments) {
    const std::string part = arguments.words.size() > 1 ? arguments.words.back() : "";
    const std::vector<experiment::Component> components = experiment::components_named(part);
    if (arguments.as_markdown) {
        fmt::print("{}", experiment::settings_markdown(components));
    } else if (arguments.printing == Printing::json) {
        fmt::print("{}", experiment::settings_json(components));
    } else if (arguments.with_reasons) {
        fmt::print("{}", experiment::settings_console(components));
    } else if (!part.empty() && components.size() > 1) {
        fmt::print("{}", experiment::settings_of_parts(part, components));
    } else {
        fmt::print("{}\nWhat each is and why it has its default: --reasons\n",
                   experiment::settings_lines(components));
    }
}

void refuse_second_word(const ListArguments& arguments, const char* name) {
    if (arguments.words.size() > 1)
        throw core::InputError({"list", fmt::format("`{}` is one word too many", arguments.words.back()),
                                fmt::format("list {}", name), ""});
}

void list_section(const Section& section, const ListArguments& arguments) {
    refuse_second_word(arguments, section.key);
    if (arguments.as_markdown)
        throw core::InputError({"--markdown", fmt::format("has no page of {}", section.key),
                                "list settings, columns or scenario-keys", "Leave it out"});
    print_sections({section}, arguments.printing);
}

void list_page(const ReferencePage& page, const ListArguments& arguments) {
    refuse_second_word(arguments, page.name);
    if (arguments.as_markdown) {
        fmt::print("{}", to_markdown(page));
    } else if (arguments.printing == Printing::json) {
        fmt::print("{}", core::fields_json(page.tables));
    } else {
        fmt::print("{}", core::fields_console(page.tables, page.use));
    }
}

void list_alone(const ListArguments& arguments) {
    const std::string word = arguments.words.empty() ? "" : arguments.words.front();
    if (arguments.with_reasons && word != "settings")
        throw core::InputError({"--reasons", "is for settings", "list settings", "Leave it out"});
    if (word == "settings") return list_settings(arguments);
    const std::vector<ReferencePage> pages = reference_pages();
    const auto found = std::ranges::find(pages, word, &ReferencePage::name);
    if (found != pages.end()) return list_page(*found, arguments);
    const std::vector<Section> sections = all_sections();
    const auto section = std::ranges::find_if(sections, [&](const auto& one) { return is_meant(one, word); });
    if (section == sections.end()) throw unknown_list(word, pages, sections);
    list_section(*section, arguments);
}

}  // namespace

Action configure_list(App& app) {
    const auto arguments = std::make_shared<ListArguments>();
    app.footer(app.get_footer() + "\n  clearway list settings preempt_signals");
    app.add_option(
           "what", arguments->words,
           "Names of one kind, such as policies; or settings of conditions, columns of tables, or keys "
           "of scenario.toml, in full")
        .expected(0, 2)
        .option_text("KIND|settings [NAME]|columns|scenario-keys [the names alone]");
    add_json_option(app, arguments->printing, "the lists");
    app.add_flag("--markdown", arguments->as_markdown,
                 "Print them as the page of docs/reference has them [off]")
        .excludes("--json");
    app.add_flag("--reasons", arguments->with_reasons,
                 "With settings: what each is, and why it has its default [a line for each]")
        .excludes("--json")
        .excludes("--markdown");
    return [arguments](const Invocation&) {
        if (!arguments->words.empty() || arguments->as_markdown || arguments->with_reasons) {
            list_alone(*arguments);
            return core::ExitCode::ok;
        }
        print_sections(all_sections(), arguments->printing);
        return core::ExitCode::ok;
    };
}

}  // namespace clearway::cli
