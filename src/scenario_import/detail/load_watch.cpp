#include "scenario_import/detail/load_watch.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/open_file.hpp"
#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

namespace {

constexpr double measured_from_s = demand_window_s - judged_s;
/// Of the free speed: below it, vehicles take twice their time.
constexpr double least_speed_share = 0.5;
constexpr double most_waiting_share = 0.05;
constexpr double most_teleported_share = 0.01;
/// Limits before the last minutes of the departures: roads only fill until then, so a load that is beyond
/// these earlier is beyond the others later. Stricter by a third, because an early jam may be one of chance.
constexpr double hopeless_speed_share = 1.0 / 3.0;
constexpr double hopeless_waiting_share = 0.075;
constexpr double room_speed_share = 0.75;
constexpr double room_waiting_share = 0.01;

/// A number of a row `<step time="10.00" running="3" .../>`; 0 where it has none.
double value_of(const std::string& row, const std::string& name) {
    const std::string mark = " " + name + "=\"";
    const std::size_t at = row.find(mark);
    if (at == std::string::npos) return 0.0;
    const std::size_t begin = at + mark.size();
    return number(row.substr(begin, row.find('"', begin) - begin)).value_or(0.0);
}

}  // namespace

LoadWatch::LoadWatch(std::filesystem::path summary, LoadMeasure measure)
    : summary_(std::move(summary)), measure_(measure) {}

bool LoadWatch::is_decided() {
    const auto is_open = [&] { return fault_ == LoadFault::none && !is_empty(); };
    if (!std::filesystem::exists(summary_)) return !is_open();  // SUMO has not begun
    core::OpenFile file(summary_);
    file.skip(read_);
    std::string rest;
    file.read([&](std::string_view piece) { rest += piece; });
    std::size_t begin = 0;
    for (std::size_t end = 0; is_open() && (end = rest.find('\n', begin)) != std::string::npos;
         begin = end + 1) {
        const std::string row = rest.substr(begin, end - begin);
        read_ += row.size() + 1;
        if (row.find("<step ") != std::string::npos) take(row);
    }
    return !is_open();
}

LoadFault LoadWatch::fault() {
    if (is_decided()) return fault_;
    if (!window_is_over_) end_window();
    if (fault_ == LoadFault::none && load_.left > 0.0) fault_ = LoadFault::stays;
    return fault_;
}

/// SUMO gives no speed (-1) when no vehicle is on the road, so speeds are weighted by the number of vehicles.
void LoadWatch::take(const std::string& row) {
    const double time_s = value_of(row, "time");
    const double running = value_of(row, "running");
    const double speeds = running * std::max(0.0, value_of(row, "meanSpeedRelative"));
    if (time_s >= demand_window_s && !window_is_over_) end_window();
    load_.teleports = value_of(row, "teleports");
    load_.left = running + value_of(row, "waiting");
    if (load_.left > 0.0) load_.end_s = time_s;
    running_of_all_time_ += running;
    if (running_of_all_time_ > 0.0)
        load_.speed_of_all_time += (speeds - running * load_.speed_of_all_time) / running_of_all_time_;
    if (load_.teleports > most_teleported_share * measure_.cars) fault_ = LoadFault::teleports;
    if (window_is_over_) return;
    const double waiting = value_of(row, "waiting");
    if (time_s >= early_.end_s) end_early();
    if (time_s < measured_from_s) {
        ++early_.rows;
        early_.running += running;
        early_.speeds += speeds;
        early_.waiting += waiting;
        return;
    }
    ++rows_;
    load_.running += running;
    load_.relative_speed += speeds;
    load_.halting += value_of(row, "halting");
    load_.waiting += waiting;
}

void LoadWatch::end_early() {
    if (early_.speeds < hopeless_speed_share * measure_.free_speed * early_.running) fault_ = LoadFault::slow;
    if (early_.waiting > hopeless_waiting_share * measure_.cars * early_.rows) fault_ = LoadFault::queues;
    early_ = {early_.end_s + judged_s};
}

void LoadWatch::end_window() {
    window_is_over_ = true;
    if (load_.running > 0.0) load_.relative_speed /= load_.running;
    for (double* const mean : {&load_.running, &load_.halting, &load_.waiting})
        *mean /= std::max(1.0, rows_);
    if (load_.running < 1.0) return;
    if (load_.relative_speed < least_speed_share * measure_.free_speed) fault_ = LoadFault::slow;
    if (load_.waiting > most_waiting_share * measure_.cars) fault_ = LoadFault::queues;
}

bool LoadWatch::has_room() const {
    return load_.teleports == 0.0 && load_.waiting <= room_waiting_share * measure_.cars &&
           load_.relative_speed >= room_speed_share * measure_.free_speed;
}

}  // namespace clearway::scenario_import::detail
