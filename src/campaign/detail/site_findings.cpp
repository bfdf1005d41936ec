#include "campaign/detail/site_findings.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/error.hpp"
#include "scenario/map_age.hpp"
#include "traffic/emergency_ends.hpp"

namespace clearway::campaign::detail {

using scenario::SiteKind;

namespace {

/// `fire station`.
std::string spoken(std::string_view name) {
    std::string words(name);
    std::ranges::replace(words, '_', ' ');
    return words;
}

}  // namespace

Finding sites_finding(const scenario::ScenarioConfig& config) {
    constexpr const char* cure =
        "add [[emergency_site]] with kind, and longitude and latitude or edge, to scenario.toml";
    if (!config.emergency_trips.empty()) return {"sites", Grade::ok, "trips of EVs stand in the scenario"};
    if (config.demand_kind() == scenario::DemandKind::flows)
        return {"sites", Grade::ok, "EVs drive the ways of the scenario's flows"};
    std::map<SiteKind, std::size_t> counts;
    for (const scenario::EmergencySite& site : config.emergency_sites)
        ++counts[site.kind];
    if (counts.empty())
        return {"sites", Grade::note, "none: " + traffic::words(scenario::emergency_ends(config)), cure};
    std::vector<std::string> words;
    for (const auto& [kind, name] : scenario::spellings(SiteKind{}))
        if (counts.contains(kind)) words.push_back(core::counted(counts.at(kind), spoken(name)));
    const std::string text = core::listed(words);
    if (config.demand.emergency == 0) return {"sites", Grade::ok, text};
    const traffic::EmergencyEnds ends = scenario::emergency_ends(config);
    return {"sites", ends.has_stand_in() ? Grade::note : Grade::ok,
            fmt::format("{}; {}", text, traffic::words(ends)), ends.has_stand_in() ? cure : ""};
}

Finding map_finding(const std::string& map_date, std::chrono::sys_days on_day) {
    const std::string warning = scenario::map_age_warning(map_date, on_day);
    const std::string text = "data of " + map_date;
    if (warning.empty()) return {"map", Grade::ok, text};
    return {"map", Grade::note, fmt::format("{}, {}", text, warning),
            "an import of a new extract, for results of today"};
}

}  // namespace clearway::campaign::detail
