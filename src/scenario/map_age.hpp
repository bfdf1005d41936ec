#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace clearway::scenario {

/// Whether a text begins with a day on which OpenStreetMap had data, `2012-05-03`.
bool begins_with_map_date(std::string_view text);

/// `14 years old, in which ...`: what the age of map data on a day means for a study. Empty for data of the
/// last few years and where `network.map_date`, which begins with a day, is empty.
std::string map_age_warning(std::string_view map_date, std::chrono::sys_days on_day);

/// By the clock of this machine, in UTC.
std::chrono::sys_days today();

}  // namespace clearway::scenario
