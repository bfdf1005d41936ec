#include "scenario/map_age.hpp"

#include <fmt/format.h>

#include "core/number.hpp"

namespace clearway::scenario {
namespace {

/// The day with which a text begins; one that is not `ok` where it begins with none.
std::chrono::year_month_day day_of(std::string_view text) {
    constexpr std::size_t letters = 10;
    const std::string_view day = text.substr(0, letters);
    if (day.size() < letters || day[4] != '-' || day[7] != '-') return {};
    const auto year = core::number_from<int>(day.substr(0, 4));
    const auto month = core::number_from<unsigned>(day.substr(5, 2));
    const auto in_month = core::number_from<unsigned>(day.substr(8, 2));
    if (!year || !month || !in_month) return {};
    return {std::chrono::year(*year), std::chrono::month(*month), std::chrono::day(*in_month)};
}

}  // namespace

bool begins_with_map_date(std::string_view text) {
    constexpr std::chrono::year first{2004};  // of OpenStreetMap; editors write 1970 for what has no date
    const std::chrono::year_month_day day = day_of(text);
    return day.ok() && day.year() >= first;
}

std::string map_age_warning(std::string_view map_date, std::chrono::sys_days on_day) {
    constexpr int old_years = 5;  // Assumed: within it, a town rebuilds few junctions.
    if (!begins_with_map_date(map_date)) return "";
    const auto age = std::chrono::floor<std::chrono::years>(on_day - std::chrono::sys_days(day_of(map_date)));
    if (age.count() < old_years) return "";
    return fmt::format("{} years old, in which roads, lanes, limits, signals and hospitals may have changed",
                       age.count());
}

std::chrono::sys_days today() {
    return std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
}

}  // namespace clearway::scenario
