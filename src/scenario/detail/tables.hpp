#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/settings.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario::detail {

/// A table of scenario.toml and the member that holds its keys: a struct with a field table, an optional one,
/// or a list of them for `[[key]]`.
template <class Member>
struct Table {
    const char* key;
    Member ScenarioConfig::*member;
    const char* summary;  ///< For the reference page, without a full stop.
};
template <class Member>
Table(const char*, Member ScenarioConfig::*, const char*) -> Table<Member>;

/// Every table, in the order of an effective scenario.toml: readers, writers, overrides and the reference
/// page come from this list.
constexpr void tables(const auto& list) {
    using S = ScenarioConfig;
    list(Table{"network", &S::network,
               "Where the roads come from; paths are relative to the folder, and the list `additional` names "
               "SUMO's additional files"},
         Table{"time", &S::time, "The clock of a run"},
         Table{"demand", &S::demand, "How many vehicles drive"},
         Table{"dense", &S::dense, "What the dense variant changes; optional"},
         Table{"limits", &S::limits, "Speed limits of classes"},
         Table{"drivers", &S::drivers, "Car-following model and desired speeds"},
         Table{"car_following", &S::following, "Drivers that differ from the default; optional"},
         Table{"siren", &S::siren, "Human drivers who yield to a siren; optional"},
         Table{"slow", &S::slow, "Vehicles slower than the rest; optional"},
         Table{"privilege", &S::privilege, "What the law allows EVs, in every condition; optional"},
         Table{"road", &S::road, "Weather and works; optional"},
         Table{"pedestrians", &S::pedestrians, "People at crossings; optional"},
         Table{"kinds.traffic", &S::traffic_kinds, "Frequencies of kinds among traffic"},
         Table{"kinds.emergency", &S::emergency_kinds, "The same among EVs"},
         Table{"trips", &S::trips, "Origins and destinations drawn over the network"},
         Table{"flow", &S::flows, "A share of all vehicles from an edge to another"},
         Table{"emergency_trip", &S::emergency_trips, "An EV with a trip of its own"},
         Table{"emergency_site", &S::emergency_sites, "Where EVs start or arrive"},
         Table{"incident", &S::incidents, "A road that is blocked for a while"},
         Table{"call", &S::calls, "EVs are sent from stations; `dispatch` of a condition says which"},
         Table{"measured", &S::measured,
               "Measured demand; its lists `routes`, `additional` and `persons` name files"});
}

/// Calls `visit(table)` for every table.
template <class Visitor>
constexpr void for_each_table(Visitor&& visit) {
    tables([&](const auto&... table) { (visit(table), ...); });
}

template <class Value>
struct IsList : std::false_type {};
template <class Value>
struct IsList<std::vector<Value>> : std::true_type {};

/// The row of the key `time.window_s`; empty for a key that there is not.
core::SettingInfo key_info(const std::string& key);

/// Sets the key of a plain table from text; later messages about it then name `where`. Returns what is wrong,
/// if anything.
std::optional<core::Problem> set_key(ScenarioConfig& config, const std::string& key, const std::string& text,
                                     const std::string& where);

}  // namespace clearway::scenario::detail
