#include "campaign/detail/run_cost.hpp"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <string_view>
#include <utility>

#include <sys/stat.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/progress.hpp"

namespace clearway::campaign {
namespace {

namespace fs = std::filesystem;

/// Wall time of a vehicle on the road for one step, SUMO and coupling. From the project's measurements: 3.1
/// to 11.9 us for the bare step on two shared cores, a tenth to a quarter more for the coupling.
constexpr double vehicle_step_s = 10e-6;
/// Mean time on the road, s. Assumed: between the merge (80 s) and the city (200 s).
constexpr double mean_trip_s = 120.0;
/// Loading, warm-up and forking of a run, s. Assumed: from runs of the sparse scenarios.
constexpr double overhead_s = 0.2;
/// A folder and two small files, each a block of 4 KiB.
constexpr double least_disk_bytes = 12.0 * 1024.0;
/// A line of vehicles.csv: 130 to 170 bytes in the four scenarios, more in those with measured demand.
constexpr double vehicle_disk_bytes = 160.0;
constexpr std::size_t sampled_runs = 10;

double disk_bytes(const fs::path& path) {
    struct stat status {};
    return ::lstat(path.c_str(), &status) == 0 ? 512.0 * static_cast<double>(status.st_blocks) : 0.0;
}

double folder_bytes(const fs::path& folder) {
    double total = disk_bytes(folder);
    for (const auto& entry : fs::directory_iterator(folder))
        total += disk_bytes(entry.path());
    return total;
}

/// Adds the runs of one condition to a sum of costs.
void sample(const results::Store& store, const std::string& scenario, const std::string& condition,
            RunCost& sum, std::size_t& count) {
    for (std::uint32_t i = 0; i < store.manifest().replications && count < sampled_runs; ++i) {
        const experiment::RunKey key{scenario, condition, i};
        const auto timing = store.complete(key) ? store.read_timing(key) : std::nullopt;
        if (!timing) continue;
        sum.wall_s = sum.wall_s.value_or(0.0) + timing->wall_s;
        sum.disk_bytes += folder_bytes(store.run_folder(key));
        ++count;
    }
}

/// Vehicles of a route file that depart within the window.
double departures(const std::string& routes, double window_s) {
    constexpr std::string_view depart = " depart=\"";
    double count = 0.0;
    for (std::size_t at = routes.find(depart); at != std::string::npos; at = routes.find(depart, at + 1)) {
        const std::size_t element = routes.rfind('<', at);
        const bool is_vehicle =
            routes.compare(element, 9, "<vehicle ") == 0 || routes.compare(element, 6, "<trip ") == 0;
        if (is_vehicle && std::strtod(routes.c_str() + at + depart.size(), nullptr) <= window_s) ++count;
    }
    return count;
}

/// Measured human and automated vehicles; nothing if their files cannot be read.
std::optional<double> measured_vehicles(const scenario::ScenarioConfig& config) {
    double count = 0.0;
    for (const std::string& file : config.measured->routes) {
        try {
            count += departures(core::read_file(scenario::resolve(config, file)), config.time.window_s);
        } catch (const core::Error&) {
            return std::nullopt;  // The run itself names the file.
        }
    }
    return count;
}

/// In the notes of a run folder: the time of processes, and that which the runs name.
constexpr const char* pace_key = "pace";

fs::path notes_in(const fs::path& runs) {
    return runs / "run-costs.json";
}

/// By the hash of a scenario; empty where there are none or where they cannot be read: they are a help alone.
core::Json read_notes(const fs::path& runs) {
    const fs::path file = notes_in(runs);
    try {
        if (fs::exists(file)) return core::parse_object(core::read_file(file), file.string());
    } catch (const std::exception&) {
    }
    return core::Json::object();
}

std::optional<std::pair<double, double>> noted_pair(const core::Json& notes, const std::string& key) {
    const auto found = notes.find(key);
    if (found == notes.end() || !found->is_array() || found->size() != 2 || !found->front().is_number() ||
        !found->back().is_number())
        return std::nullopt;
    return std::pair(found->front().get<double>(), found->back().get<double>());
}

/// Time of processes over that which the runs name; 1 where it was not noted.
double pace_of(const results::Store& store) {
    const core::Json notes = read_notes(store.folder());
    const auto noted = noted_pair(notes, pace_key);
    return noted && noted->second > 0.0 ? std::max(1.0, noted->first / noted->second) : 1.0;
}

/// Of runs of a scenario, by its hash; nothing where there are none.
std::optional<RunCost> measured_in(const results::Store& store, const std::string& hash,
                                   experiment::TrafficModel traffic_model) {
    RunCost sum;
    std::size_t count = 0;
    for (const results::ScenarioEntry& scenario : store.manifest().scenarios) {
        if (scenario.configuration_hash != hash) continue;
        for (const experiment::ConditionSpec& condition : store.manifest().conditions) {
            if (condition.traffic_model == traffic_model)
                sample(store, scenario.name, condition.name, sum, count);
        }
    }
    if (count == 0) return std::nullopt;
    const auto runs = static_cast<double>(count);
    return RunCost{.wall_s = *sum.wall_s / runs * pace_of(store),
                   .disk_bytes = sum.disk_bytes / runs,
                   .basis = CostBasis::measured};
}

/// Of the network file, for what was noted of its roads; empty where there is none or it cannot be read.
std::string roads_key(const scenario::ScenarioConfig& config) {
    if (config.network.plain()) return "";
    try {
        return "roads " + core::content_hash(core::read_file(scenario::resolve(config, config.network.file)));
    } catch (const core::Error&) {
        return "";
    }
}

/// Corrects a rough cost by what a run on the same roads took: noted are its time and its rough one.
void correct(RunCost& cost, const core::Json& notes, const scenario::ScenarioConfig& config) {
    if (notes.empty() || !cost.wall_s) return;
    const auto noted = noted_pair(notes, roads_key(config));
    if (!noted || noted->second <= 0.0) return;
    *cost.wall_s *= noted->first / noted->second;
    cost.basis = CostBasis::same_roads;
}

bool holds_runs(const fs::path& folder) {
    std::error_code unknown;  // such as a link that leads to itself
    return fs::exists(folder / "manifest.json", unknown) && fs::exists(folder / "runs", unknown);
}

}  // namespace

std::string clock_words(double seconds) {
    const std::string clock = core::clock_text(seconds);
    return clock + (std::ranges::count(clock, ':') > 1 ? " (h:m:s)" : " (m:s)");
}

RunCost rough_cost(const scenario::ScenarioConfig& config, experiment::TrafficModel traffic_model) {
    const scenario::Demand& demand = config.demand;
    std::optional<double> others = demand.human + demand.automated;
    if (traffic_model == experiment::TrafficModel::free_flow) {
        others = 0.0;
    } else if (config.demand_kind() == scenario::DemandKind::measured) {
        others = measured_vehicles(config);
    }
    const double vehicles = demand.density * others.value_or(0.0) + demand.emergency +
                            static_cast<double>(config.emergency_trips.size());
    RunCost cost;
    cost.disk_bytes = least_disk_bytes + vehicle_disk_bytes * vehicles;
    if (!others) return cost;
    cost.wall_s = overhead_s + vehicles * mean_trip_s / config.time.step_length_s * vehicle_step_s;
    return cost;
}

const char* words(CostBasis basis) {
    switch (basis) {
        case CostBasis::measured:
            return "from runs of these scenarios here";
        case CostBasis::same_roads:
            return "from a run on the same roads, by vehicles and steps";
        case CostBasis::rough:
            break;
    }
    return "rough: to a factor of three, or ten where traffic jams; clearway scenario check times a run";
}

void note_cost(const fs::path& runs, const scenario::ScenarioConfig& config, const std::string& hash,
               const RunCost& cost) {
    core::Json notes = read_notes(runs);
    notes[hash] = {cost.wall_s.value(), cost.disk_bytes};
    const std::string roads = roads_key(config);
    const auto rough_s = rough_cost(config, experiment::TrafficModel::standard).wall_s;
    if (!roads.empty() && rough_s) notes[roads] = {cost.wall_s.value(), *rough_s};
    core::write_atomically(notes_in(runs), core::to_text(notes));
}

void note_pace(const results::Store& store, double processes_s) {
    double named_s = 0.0;
    for (const experiment::RunKey& key : store.complete_runs()) {
        if (const auto timing = store.read_timing(key)) named_s += timing->wall_s;
    }
    if (named_s <= 0.0) return;
    core::Json notes = read_notes(store.folder());
    notes[pace_key] = {processes_s, named_s};
    core::write_atomically(notes_in(store.folder()), core::to_text(notes));
}

CostBook::CostBook(const fs::path& folder) : noted_(read_notes(fs::absolute(folder).parent_path())) {
    std::vector<fs::path> folders;
    std::error_code none;
    for (auto entry = fs::directory_iterator(fs::absolute(folder).parent_path(), none);
         !none && entry != fs::directory_iterator(); entry.increment(none)) {
        if (holds_runs(entry->path()) && entry->path() != fs::absolute(folder))
            folders.push_back(entry->path());
    }
    std::ranges::sort(folders);
    if (holds_runs(folder)) folders.insert(folders.begin(), folder);
    for (const fs::path& each : folders) {
        try {
            stores_.push_back(results::Store::open(each));
        } catch (const core::Error&) {
            // A folder of another version, or one that cannot be read.
        }
    }
}

RunCost CostBook::of(const scenario::ScenarioConfig& config, const std::string& hash,
                     experiment::TrafficModel traffic_model) const {
    for (const results::Store& store : stores_) {
        try {
            if (const auto cost = measured_in(store, hash, traffic_model)) return *cost;
        } catch (const std::exception&) {
            // Its runs are damaged, or are being removed: whom they belong to is told, and not a neighbour.
        }
    }
    const bool is_traffic = traffic_model != experiment::TrafficModel::free_flow;
    if (const auto noted = noted_pair(noted_, hash); is_traffic && noted)
        return {.wall_s = noted->first, .disk_bytes = noted->second, .basis = CostBasis::measured};
    RunCost cost = rough_cost(config, traffic_model);
    if (is_traffic) correct(cost, noted_, config);
    return cost;
}

}  // namespace clearway::campaign
