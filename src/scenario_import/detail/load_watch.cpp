#include "scenario_import/detail/load_watch.hpp"

#include <algorithm>
#include <utility>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

namespace {

constexpr double measured_from_s = demand_window_s - 180.0;
/// Of the free speed: below it, vehicles take twice their time.
constexpr double least_speed_share = 0.5;
constexpr double most_waiting_share = 0.05;
constexpr double most_teleported_share = 0.01;

/// A number of a row `<step time="10.00" running="3" .../>`; 0 where it has none.
double value_of(const std::string& row, const std::string& name) {
    const std::string mark = " " + name + "=\"";
    const std::size_t at = row.find(mark);
    if (at == std::string::npos) return 0.0;
    const std::size_t begin = at + mark.size();
    return number(row.substr(begin, row.find('"', begin) - begin)).value_or(0.0);
}

}  // namespace

LoadWatch::LoadWatch(std::filesystem::path summary, double free_speed)
    : summary_(std::move(summary)), free_speed_(free_speed) {}

bool LoadWatch::is_decided() {
    std::ifstream stream(summary_);
    stream.seekg(read_);
    const auto is_open = [&] { return fault_ == LoadFault::none && !is_empty(); };
    for (std::string row; is_open() && std::getline(stream, row) && !stream.eof();) {
        read_ += static_cast<std::streamoff>(row.size()) + 1;
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
    load_.loaded = value_of(row, "loaded");
    load_.teleports = value_of(row, "teleports");
    load_.left = running + value_of(row, "waiting");
    if (load_.left > 0.0) load_.end_s = time_s;
    running_of_all_time_ += running;
    if (running_of_all_time_ > 0.0)
        load_.speed_of_all_time += (speeds - running * load_.speed_of_all_time) / running_of_all_time_;
    if (load_.teleports > most_teleported_share * load_.loaded) fault_ = LoadFault::teleports;
    if (window_is_over_ || time_s < measured_from_s) return;
    ++rows_;
    load_.running += running;
    load_.relative_speed += speeds;
    load_.halting += value_of(row, "halting");
    load_.waiting += value_of(row, "waiting");
}

void LoadWatch::end_window() {
    window_is_over_ = true;
    if (load_.running > 0.0) load_.relative_speed /= load_.running;
    for (double* const mean : {&load_.running, &load_.halting, &load_.waiting})
        *mean /= std::max(1.0, rows_);
    if (load_.running < 1.0) return;
    if (load_.relative_speed < least_speed_share * free_speed_) fault_ = LoadFault::slow;
    if (load_.waiting > most_waiting_share * load_.loaded) fault_ = LoadFault::queues;
}

}  // namespace clearway::scenario_import::detail
