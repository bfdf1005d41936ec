#include "campaign/detail/site_findings.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clearway::campaign::detail {

using scenario::SiteKind;

Finding sites_finding(const scenario::ScenarioConfig& config) {
    constexpr const char* cure =
        "add [[emergency_site]] with kind, and longitude and latitude or edge, to scenario.toml";
    if (!config.emergency_trips.empty()) return {"sites", Grade::ok, "trips of EVs stand in the scenario"};
    if (config.demand_kind() == scenario::DemandKind::flows)
        return {"sites", Grade::ok, "EVs drive the ways of the scenario's flows"};
    std::map<SiteKind, std::size_t> counts;
    for (const scenario::EmergencySite& site : config.emergency_sites)
        ++counts[site.kind];
    if (counts.empty()) return {"sites", Grade::note, "none: EVs start and arrive at random places", cure};
    std::vector<std::string> words;
    for (const auto& [kind, name] : scenario::spellings(SiteKind{}))
        if (counts.contains(kind)) words.push_back(fmt::format("{} {}", counts.at(kind), name));
    const bool has_stations =
        counts.contains(SiteKind::ambulance_station) || counts.contains(SiteKind::fire_station);
    const char* const others = has_stations ? "other stations" : "hospitals";
    std::vector<std::string> missing;
    if (config.emergency_kinds.ambulance > 0.0 && !counts.contains(SiteKind::ambulance_station))
        missing.push_back(fmt::format("no ambulance_station, so that ambulances start at {}", others));
    if (config.emergency_kinds.fire_engine > 0.0 && !counts.contains(SiteKind::fire_station))
        missing.push_back(fmt::format("no fire_station, so that fire engines start at {}", others));
    const std::string text = fmt::format("{}", fmt::join(words, ", "));
    if (missing.empty()) return {"sites", Grade::ok, text};
    return {"sites", Grade::note, fmt::format("{}; {}", text, fmt::join(missing, "; ")), cure};
}

}  // namespace clearway::campaign::detail
