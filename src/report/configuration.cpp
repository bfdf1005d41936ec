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
#include "traffic/emergency_ends.hpp"

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

/// How trips of EVs are drawn; empty where none is, or along the ways of flows.
std::string emergency_words(const toml::table& scenario) {
    const bool are_drawn = scenario["demand"]["emergency"].value_or(0.0) > 0.0 &&
                           !scenario["emergency_trip"].is_array() && !scenario["flow"].is_array();
    if (!are_drawn) return "";
    const auto kinds = scenario["kinds"]["emergency"];
    traffic::EmergencyEnds ends{.ambulances = kinds["ambulance"].value_or(1.0) > 0.0,
                                .fire_engines = kinds["fire_engine"].value_or(0.0) > 0.0,
                                .police_cars = kinds["police_car"].value_or(0.0) > 0.0,
                                .least_m = scenario["trips"]["emergency_minimum_length_m"].value_or(0.0)};
    if (const toml::array* const sites = scenario["emergency_site"].as_array())
        for (const toml::node& site : *sites) {
            const toml::table* const row = site.as_table();
            const std::string kind = row == nullptr ? "" : (*row)["kind"].value_or(std::string());
            ends.hospitals |= kind == "hospital";
            ends.ambulance_stations |= kind == "ambulance_station";
            ends.fire_stations |= kind == "fire_station";
        }
    return traffic::words(ends);
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
    if (const std::string emergency = emergency_words(table); !emergency.empty()) words.push_back(emergency);
    if (const std::string date = table["network"]["map_date"].value_or(std::string()); !date.empty())
        words.push_back("map data of " + date);
    const std::string programs = programs_words(table["network"]["attribution"].value_or(std::string()));
    if (has_signals && !programs.empty()) words.push_back(programs);
    if (has_signals && baseline != nullptr)
        words.emplace_back(passes_red(table, *baseline) ? "EVs of the baseline may pass red"
                                                        : "EVs of the baseline stop at red (where yours may "
                                                          "pass it: --set privilege.pass_red=1)");
    return fmt::format("Simulated: {}.", fmt::join(words, "; "));
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
