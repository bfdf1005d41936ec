#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/counted.hpp"
#include "core/error.hpp"
#include "core/terminal.hpp"
#include "scenario/map_age.hpp"
#include "scenario_import/import.hpp"

namespace clearway::scenario_import {

namespace {

/// `45 car, 3 bus`.
std::string counts_text(const std::map<std::string, int>& counts) {
    std::string text;
    for (const auto& [name, count] : counts)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
    return text;
}

/// ` (St. Anna, unnamed, High Street)`, or empty where there are none of a map.
std::string names_text(const Findings& findings) {
    constexpr std::size_t most = 4;
    std::vector<std::string> words = findings.site_names;
    if (words.empty()) return "";
    if (words.size() > most) {
        words.resize(most);
        words.emplace_back("...");
    }
    return fmt::format(" ({})", fmt::join(words, "; "));
}

/// `1 fire station, 2 hospitals (St. Anna; ...)`.
std::string sites_text(const Findings& findings) {
    std::vector<std::string> words;
    for (const auto& [name, count] : findings.sites) {
        std::string kind = name;
        std::ranges::replace(kind, '_', ' ');
        words.push_back(core::counted(static_cast<std::uint64_t>(count), kind));
    }
    return core::listed(words) + names_text(findings) +
           "; take a wrong one out of scenario.toml ([[emergency_site]])";
}

/// `of 2012-05-03 (newest object): ...`.
std::string map_text(const std::string& date) {
    if (date.empty()) return "of unknown age: its objects have no timestamps";
    const std::string warning = scenario::map_age_warning(date, scenario::today());
    return fmt::format("of {}{}", date,
                       warning.empty() ? "" : fmt::format(": {}; take a new extract for today's", warning));
}

std::string emergency_text(const Findings& findings) {
    std::string text = findings.emergency_trips + "; random places are drawn by road length";
    if (!findings.sites.empty())
        text +=
            ". All EVs are ambulances: --emergency-kinds ambulance=1,fire_engine=1 asks for fire engines too";
    return text;
}

std::string list_text(const char* title, const std::vector<std::string>& lines) {
    if (lines.empty()) return {};
    std::string text = fmt::format("{}\n", title);
    for (const std::string& line : lines)
        text += core::wrapped("  - " + line, 4) + "\n";
    return text;
}

/// Lines `  label            text` with long texts going on below themselves.
std::string filled(const std::string& lines) {
    constexpr std::size_t text_column = 19;
    std::istringstream stream(lines);
    std::string text;
    for (std::string line; std::getline(stream, line);)
        text += core::wrapped(line, text_column) + "\n";
    return text;
}

/// What the signals come from, where a map has any.
std::string map_signals_text(const Findings& findings) {
    if (findings.map_signals == 0) return "";
    constexpr double usual_km_per_signal = 5.0;
    const bool are_few = findings.road_km > usual_km_per_signal * static_cast<double>(findings.signals);
    return fmt::format(" (from {} of the map: a junction may have several{}",
                       core::counted(findings.map_signals, "node"),
                       are_few ? "); few for these roads, and none is guessed: tag those that it lacks "
                                 "(highway=traffic_signals) and import again"
                               : ")");
}

}  // namespace

std::string to_text(const Findings& findings) {
    std::string text = fmt::format(
        "{}\n  edges            {} ({} open to cars)\n  lanes for cars   {}\n  roads for cars   {:.1f} km by "
        "direction, without junctions; {:.1f} km of lane\n  signals          {}{}\n  connected        {:.1f} "
        "% of "
        "the car edges reach each other\n  traffic drives   on the {}, {}\n",
        findings.name, findings.edges, findings.car_edges, findings.lanes, findings.road_km, findings.lane_km,
        findings.signals, map_signals_text(findings), 100.0 * findings.connected_share,
        findings.left_hand ? "left" : "right", findings.side_reason);
    if (findings.map_date) text += fmt::format("  map data         {}\n", map_text(*findings.map_date));
    if (!findings.sites.empty()) text += fmt::format("  EV sites         {}\n", sites_text(findings));
    if (!findings.emergency_trips.empty())
        text += fmt::format("  EV trips         {}\n", emergency_text(findings));
    int total = 0;
    for (const auto& [kind, count] : findings.vehicles)
        total += count;
    text += fmt::format("  demand           {} vehicles, {:.0f} an hour: {}\n                   {}\n", total,
                        findings.vehicles_per_hour, counts_text(findings.vehicles), findings.demand);
    if (findings.persons > 0) text += fmt::format("  persons          {} walk or ride\n", findings.persons);
    if (findings.bad_vehicles_share > most_bad_vehicles)
        text += fmt::format(
            "  short            {:.0f} % of the vehicles cannot drive their route and are left out: "
            "the traffic is not that of the files\n",
            100.0 * findings.bad_vehicles_share);
    if (!findings.trial_failure.empty())
        text += fmt::format("  short            SUMO fails in a trial run of the scenario: {}\n",
                            findings.trial_failure);
    text = filled(text);
    text += list_text("Changed:", findings.changes);
    text += list_text("Left out:", findings.left_out);
    return text;
}

std::string to_json(const Findings& findings) {
    nlohmann::ordered_json json = {{"name", findings.name},
                                   {"edges", findings.edges},
                                   {"car_edges", findings.car_edges},
                                   {"car_lanes", findings.lanes},
                                   {"car_roads_km", findings.road_km},
                                   {"car_lanes_km", findings.lane_km},
                                   {"signals", findings.signals},
                                   {"map_signals", findings.map_signals},
                                   {"connected_share", findings.connected_share},
                                   {"left_hand", findings.left_hand},
                                   {"left_hand_reason", findings.side_reason},
                                   {"emergency_sites", findings.sites},
                                   {"emergency_site_names", findings.site_names},
                                   {"emergency_trips", findings.emergency_trips},
                                   {"map_date", findings.map_date.value_or("")},
                                   {"vehicles_per_hour", findings.vehicles_per_hour},
                                   {"vehicles", findings.vehicles},
                                   {"routed_trips", findings.routed_trips},
                                   {"routed_at_departure", findings.routed_at_departure},
                                   {"bad_vehicles_share", findings.bad_vehicles_share},
                                   {"trial_failure", findings.trial_failure},
                                   {"persons", findings.persons},
                                   {"demand", findings.demand},
                                   {"changes", findings.changes},
                                   {"left_out", findings.left_out}};
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace clearway::scenario_import
