#include "report/detail/configuration.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "core/strict_table.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

/// `random trips of 1,159 vehicles in 15 min`.
std::string demand_words(const toml::table& scenario) {
    const auto demand = scenario["demand"];
    if (scenario["measured"].is_table()) return "the trips of the scenario's files";
    const double density = demand["density"].value_or(1.0);
    const double vehicles = density * (demand["human"].value_or(0.0) + demand["automated"].value_or(0.0));
    const double minutes = scenario["time"]["window_s"].value_or(0.0) / 60.0;
    return fmt::format("{} of {} vehicles in {:.3g} min",
                       scenario["flow"].is_array() ? "drawn flows" : "random trips",
                       grouped(static_cast<std::uint64_t>(std::llround(vehicles))), minutes);
}

/// Of the human and automated vehicles; below 0 where it is not known.
double automated_share(const toml::table& scenario) {
    if (scenario["measured"].is_table()) return scenario["measured"]["automated_share"].value_or(-1.0);
    const double automated = scenario["demand"]["automated"].value_or(0.0);
    const double all = automated + scenario["demand"]["human"].value_or(0.0);
    return all > 0.0 ? automated / all : -1.0;
}

bool passes_red(const toml::table& scenario, const ConditionFacts& baseline) {
    const auto own = baseline.condition.settings.find("privilege.pass_red");
    if (own != baseline.condition.settings.end()) return own->second != "0";
    return scenario["privilege"]["pass_red"].value_or(0.0) > 0.0;
}

/// How demand came about, how much of it there is, and whether EVs of the baseline stop at red. Plain text.
std::string assumptions_sentence(const toml::table& table, const ScenarioFacts& scenario) {
    if (!table["demand"].is_table()) return "";
    std::vector<std::string> words = {demand_words(table)};
    if (const double density = table["demand"]["density"].value_or(1.0); density != 1.0)
        words.push_back(fmt::format("density {:g}", density));
    if (const double share = automated_share(table); share >= 0.0)
        words.push_back(fmt::format("automated share {:.2g}", share));
    const bool has_signals = scenario.roads && !scenario.roads->signals.empty();
    const std::string programs = programs_words(table["network"]["attribution"].value_or(std::string()));
    if (has_signals && !programs.empty()) words.push_back(programs);
    if (has_signals && !scenario.conditions.empty())
        words.emplace_back(passes_red(table, scenario.conditions.front())
                               ? "EVs of the baseline may pass red"
                               : "EVs of the baseline stop at red (policy red_privilege: they pass it)");
    return fmt::format("Simulated: {}.", fmt::join(words, ", "));
}

}  // namespace

void add_configuration(const std::string& configuration, ScenarioFacts& scenario) {
    const toml::table table = core::parse_toml(configuration, "manifest.json");
    const auto time = table["time"];
    scenario.step_length_s = time["step_length_s"].value_or(0.0);
    scenario.horizon_s = time["horizon_s"].value_or(0.0);
    if (time["ignore_junction_blocker_s"].value_or(-1.0) >= 0.0) scenario.blockers = Blockers::ignored;
    scenario.assumptions = assumptions_sentence(table, scenario);
}

}  // namespace clearway::report::detail
