#include "report/configuration.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "core/strict_table.hpp"
#include "report/text.hpp"
#include "roads/limits.hpp"

namespace clearway::report {
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

bool passes_red(const toml::table& scenario, const experiment::ConditionSpec& baseline) {
    const auto own = baseline.settings.find("privilege.pass_red");
    if (own != baseline.settings.end()) return own->second != "0";
    return scenario["privilege"]["pass_red"].value_or(0.0) > 0.0;
}

/// Where ambulances start, if the scenario has sites and no station for them; else empty.
std::string stand_in_words(const toml::table& scenario) {
    const toml::array* const sites = scenario["emergency_site"].as_array();
    const bool has_drawn_ambulances = scenario["demand"]["emergency"].value_or(1.0) > 0.0 &&
                                      scenario["kinds"]["emergency"]["ambulance"].value_or(1.0) > 0.0 &&
                                      !scenario["emergency_trip"].is_array();
    if (sites == nullptr || sites->empty() || !has_drawn_ambulances) return "";
    bool has_fire_station = false;
    for (const toml::node& site : *sites) {
        const toml::table* const row = site.as_table();
        const std::string kind = row == nullptr ? "" : (*row)["kind"].value_or(std::string());
        if (kind == "ambulance_station") return "";
        has_fire_station = has_fire_station || kind == "fire_station";
    }
    return fmt::format("no ambulance station, so that ambulances start at {}",
                       has_fire_station ? "fire stations" : "hospitals");
}

std::string sentence_of(const toml::table& table, bool has_signals, const std::string& roads,
                        const experiment::ConditionSpec* baseline) {
    if (!table["demand"].is_table()) return "";
    std::vector<std::string> words = {demand_words(table)};
    if (!roads.empty()) words.push_back(roads);
    if (const double density = table["demand"]["density"].value_or(1.0); density != 1.0)
        words.push_back(fmt::format("density {:g}", density));
    if (const double share = automated_share(table); share >= 0.0)
        words.push_back(fmt::format("automated share {:.2g}", share));
    if (const std::string stand_in = stand_in_words(table); !stand_in.empty()) words.push_back(stand_in);
    const std::string programs = programs_words(table["network"]["attribution"].value_or(std::string()));
    if (has_signals && !programs.empty()) words.push_back(programs);
    if (has_signals && baseline != nullptr)
        words.emplace_back(passes_red(table, *baseline) ? "EVs of the baseline may pass red"
                                                        : "EVs of the baseline stop at red (where yours may "
                                                          "pass it: --set privilege.pass_red=1)");
    return fmt::format("Simulated: {}.", fmt::join(words, ", "));
}

std::string road_words(const std::optional<RoadMap>& map) {
    roads::Limits limits;
    if (map)
        for (const MapEdge& edge : map->edges)
            limits.add(edge.limit_mps, edge.length_m);
    return limits.words();
}

}  // namespace

void add_configuration(const std::string& configuration, ScenarioFacts& scenario) {
    const toml::table table = core::parse_toml(configuration, "manifest.json");
    const auto time = table["time"];
    scenario.step_length_s = time["step_length_s"].value_or(0.0);
    scenario.horizon_s = time["horizon_s"].value_or(0.0);
    if (time["ignore_junction_blocker_s"].value_or(-1.0) >= 0.0) scenario.blockers = Blockers::ignored;
    scenario.assumptions =
        sentence_of(table, scenario.roads && !scenario.roads->signals.empty(), road_words(scenario.roads),
                    scenario.conditions.empty() ? nullptr : &scenario.conditions.front().condition);
}

std::string simulated_sentence(const std::string& configuration, const roads::Network& network,
                               const experiment::ConditionSpec& baseline) {
    return sentence_of(core::parse_toml(configuration, "scenario.toml"), !network.signals().empty(),
                       roads::limits_of(network).words(), &baseline);
}

}  // namespace clearway::report
