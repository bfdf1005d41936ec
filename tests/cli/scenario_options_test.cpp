#include "cli/detail/scenario_options.hpp"

#include <algorithm>

#include <CLI/App.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "cli/detail/app.hpp"
#include "core/error.hpp"
#include "scenario/overrides.hpp"

namespace clearway::cli {
namespace {

/// What `app --friction 0.5` sets.
scenario::Options parsed(void (*declare)(App&, scenario::Options&), const std::vector<std::string>& words) {
    CLI::App parser;
    App app(parser);
    scenario::Options options;
    declare(app, options);
    parser.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    return options;
}

std::string valid_text(const scenario::Override& override) {
    if (!override.value.words.empty()) return override.value.words.back();
    return override.is_number() ? fmt::format("{}", override.value.minimum) : "car=1";
}

TEST(ScenarioOptions, are_one_for_every_override_of_a_scenario) {
    for (const scenario::Override& override : scenario::overrides()) {
        const std::string text = valid_text(override);
        std::vector<std::string> words = {override.option};
        if (!override.is_flag) words.push_back(text);
        const scenario::Options options = parsed(add_scenario_options, words);
        ASSERT_EQ(options.overrides.size(), 1U) << override.option;
        EXPECT_EQ(options.overrides.at(override.value.name).text, text);
        EXPECT_EQ(options.overrides.at(override.value.name).where, override.option);
        const scenario::Options named =
            parsed(add_override_option, {"--override", override.value.name + "=" + text});
        EXPECT_EQ(named.overrides.at(override.value.name).text, text);
    }
}

TEST(ScenarioOptions, refuse_what_is_not_a_number_or_not_a_word_at_once) {
    for (const scenario::Override& override : scenario::overrides()) {
        if (!override.is_number() && override.value.words.empty()) continue;
        if (override.is_flag) continue;
        EXPECT_THROW(parsed(add_scenario_options, {override.option, "much"}), CLI::ValidationError)
            << override.option;
    }
}

TEST(ScenarioOptions, show_unit_and_range_in_the_help) {
    CLI::App parser;
    App app(parser);
    scenario::Options options;
    add_scenario_options(app, options);
    EXPECT_THAT(parser.help(), testing::HasSubstr("--friction NUMBER, 0.1 to 1 [by scenario]"));
    EXPECT_THAT(parser.help(), testing::HasSubstr("--warm-up NUMBER, 0 to 86400 s [by scenario]"));
    EXPECT_THAT(parser.help(), testing::HasSubstr("--density NUMBER, 0 to 20 [1]")) << "a factor";
}

TEST(EverydayOptions, stand_first_and_apart_from_the_others) {
    CLI::App parser;
    App app(parser);
    bool flag = false;
    app.add_flag("--rare", flag, "Seldom");
    {
        const OptionGroup group(app, "Scenario");
        app.add_flag("--usual", flag, "Often");
        app.add_flag("--third", flag, "Third");
    }
    app.set_everyday({"--usual"});
    const std::string help = parser.help();
    std::vector<std::size_t> places;
    for (const char* const words :
         {"Everyday options", "--usual", "Further options", "--rare", "Scenario:", "--third"})
        places.push_back(help.find(words));
    EXPECT_TRUE(std::ranges::is_sorted(places)) << help;
    EXPECT_NE(places.back(), std::string::npos) << help;
}

}  // namespace
}  // namespace clearway::cli
