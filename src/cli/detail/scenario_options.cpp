#include "cli/detail/scenario_options.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "core/number.hpp"
#include "scenario/overrides.hpp"

namespace clearway::cli {
namespace {

const char* const group_name = "Scenario (the defaults are those of the scenario)";

/// `NUMBER, 0 to 86400 s [by scenario]`, or the words.
std::string value_text(const scenario::Override& override) {
    const core::SettingInfo& value = override.value;
    if (!value.words.empty()) return fmt::format("{} [{}]", fmt::join(value.words, "|"), value.preset);
    if (!override.is_number()) return fmt::format("NAME=VALUE,... [{}]", value.preset);
    return fmt::format("NUMBER, {} [{}]", core::range_text(value), value.preset);
}

void add_override(App& app, const scenario::Override& override, scenario::Options& options) {
    const core::SettingInfo& value = override.value;
    if (override.is_flag) {
        app.add_flag_callback(
            override.option, [&options, &value] { options.set(value.name, value.words.back()); },
            fmt::format("{} [{}]", value.doc, value.words.front()));
        return;
    }
    const auto set = [&options, &value](const std::string& text) { options.set(value.name, text); };
    const Option option = app.add_option_function<std::string>(override.option, set, value.doc)
                              .option_text(value_text(override));
    if (!value.words.empty()) option.one_of(value.words);
    if (!override.is_number()) return;
    option.check([&value](const std::string& text) {
        if (core::number_from(text)) return std::string();
        return fmt::format("\"{}\" is not a number (allowed: {})", text, core::range_text(value));
    });
}

}  // namespace

void add_scenario_options(App& app, scenario::Options& options) {
    const OptionGroup group(app, group_name);
    for (const scenario::Override& override : scenario::overrides())
        add_override(app, override, options);
}

void add_override_option(App& app, scenario::Options& options) {
    const OptionGroup group(app, group_name);
    app.add_option_function<std::vector<std::string>>(
           "--override",
           [&options](const std::vector<std::string>& assignments) {
               for (const std::string& words : assignments) {
                   const auto [name, value] = assignment("--override", words);
                   options.set(name, value, name);
               }
           },
           "A change to the scenario, as in [overrides] of a study file; can be repeated")
        .option_text("NAME=VALUE ...");
}

void add_scenario_argument(App& app, std::string& scenario) {
    app.add_option("scenario", scenario, "Name (clearway list), folder or TOML file")
        .required()
        .option_text("SCENARIO (required)");
}

}  // namespace clearway::cli
