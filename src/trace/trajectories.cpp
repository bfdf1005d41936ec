#include "trace/trajectories.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.hpp"
#include "core/csv.hpp"
#include "roads/geography.hpp"
#include "truth/snapshot.hpp"

namespace clearway::trace {
namespace {

/// A stretch of a vehicle's journey without a gap in time.
struct Line {
    std::vector<double> time_s;
    std::vector<float> speed_mps;
    std::vector<roads::Coordinates> places;
};

struct Track {
    std::string id;
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    std::vector<Line> lines;
};

struct Nearest {
    std::uint32_t emergency = 0;  ///< Row of the snapshot.
    double metres = std::numeric_limits<double>::infinity();
};

class Writer {
  public:
    Writer(const roads::Network& network, const TrajectoryOptions& options,
           const std::filesystem::path& folder)
        : network_(network),
          options_(options),
          geography_(roads::Geography::of(network.location())),
          csv_(folder / "trajectories.csv") {
        csv_.write(
            "time_s,vehicle,class,near,distance_m,longitude_deg,latitude_deg,x_m,y_m,speed_mps,lane\n");
    }

    void take(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
        assert(options_.every.value > 0.0);
        if (snapshot.time.value < next_s_ - core::clock_tolerance_s) return;
        next_s_ = snapshot.time.value + options_.every.value;
        const auto count = static_cast<std::uint32_t>(snapshot.size());
        std::vector<std::uint32_t> emergency;
        for (std::uint32_t row = 0; row < count; ++row)
            if (snapshot.vehicle_class[row] == traffic::VehicleClass::emergency) emergency.push_back(row);
        for (std::uint32_t row = 0; row < count && !emergency.empty(); ++row) {
            if (snapshot.vehicle_class[row] == traffic::VehicleClass::emergency) {
                write(snapshot, roster, row, std::nullopt);
                continue;
            }
            const Nearest nearest = nearest_of(snapshot, emergency, row);
            if (nearest.metres < options_.reach.value) write(snapshot, roster, row, nearest);
        }
    }

    TrajectoryCounts finish(const std::filesystem::path& folder) {
        csv_.commit();
        for (const auto& [key, track] : tracks_)
            ++(track.vehicle_class == traffic::VehicleClass::emergency ? counts_.emergency_vehicles
                                                                       : counts_.neighbours);
        counts_.has_coordinates = geography_.has_value();
        if (geography_) write_geojson(folder / "trajectories.geojson");
        return counts_;
    }

  private:
    static Nearest nearest_of(const truth::Snapshot& snapshot, const std::vector<std::uint32_t>& emergency,
                              std::uint32_t row) {
        Nearest nearest;
        for (const std::uint32_t other : emergency) {
            const double metres =
                std::hypot(snapshot.x_m[row] - snapshot.x_m[other], snapshot.y_m[row] - snapshot.y_m[other]);
            if (metres < nearest.metres) nearest = {other, metres};
        }
        return nearest;
    }

    void write(const truth::Snapshot& snapshot, const traffic::Roster& roster, std::uint32_t row,
               const std::optional<Nearest>& nearest) {
        assert(roster.find(snapshot.key[row]) != nullptr);
        const traffic::VehicleInfo& info = *roster.find(snapshot.key[row]);
        std::string coordinates = ",";
        std::optional<roads::Coordinates> place;
        if (geography_) {
            place = geography_->coordinates(snapshot.x_m[row], snapshot.y_m[row]);
            coordinates = fmt::format("{:.7f},{:.7f}", place->longitude_deg, place->latitude_deg);
        }
        const std::string near =
            nearest ? core::csv_text(roster.find(snapshot.key[nearest->emergency])->id) : "";
        const core::LaneIndex lane = snapshot.lane[row];
        csv_.write(fmt::format("{:.2f},{},{},{},{},{},{:.2f},{:.2f},{:.2f},{}\n", snapshot.time.value,
                               core::csv_text(info.id), traffic::name(snapshot.vehicle_class[row]), near,
                               nearest ? fmt::format("{:.1f}", nearest->metres) : "", coordinates,
                               snapshot.x_m[row], snapshot.y_m[row], snapshot.speed_mps[row],
                               lane.exists() ? core::csv_text(network_.lane(lane).id) : ""));
        ++counts_.places;
        Track& track = tracks_[snapshot.key[row]];
        track.id = info.id;
        track.vehicle_class = snapshot.vehicle_class[row];
        if (!place) return;
        const double gap_s = 1.5 * options_.every.value;
        if (track.lines.empty() || snapshot.time.value - track.lines.back().time_s.back() > gap_s)
            track.lines.emplace_back();
        Line& line = track.lines.back();
        line.time_s.push_back(snapshot.time.value);
        line.speed_mps.push_back(snapshot.speed_mps[row]);
        line.places.push_back(*place);
        assert(line.places.size() == line.time_s.size());
    }

    void write_geojson(const std::filesystem::path& file) const {
        core::AtomicFile json(file);
        json.write("{\"type\": \"FeatureCollection\", \"features\": [");
        const char* separator = "\n";
        for (const auto& [key, track] : tracks_) {
            for (const Line& line : track.lines) {
                if (line.places.size() < 2) continue;
                json.write(separator + feature(track, line));
                separator = ",\n";
            }
        }
        json.write("\n]}\n");
        json.commit();
    }

    static std::string feature(const Track& track, const Line& line) {
        std::string points, times, speeds;
        for (std::size_t row = 0; row < line.places.size(); ++row) {
            const char* const comma = row == 0 ? "" : ", ";
            points += fmt::format("{}[{:.7f}, {:.7f}]", comma, line.places[row].longitude_deg,
                                  line.places[row].latitude_deg);
            times += fmt::format("{}{:.2f}", comma, line.time_s[row]);
            speeds += fmt::format("{}{:.2f}", comma, line.speed_mps[row]);
        }
        const std::string id =
            nlohmann::json(track.id).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        return fmt::format(
            "{{\"type\": \"Feature\", \"properties\": {{\"vehicle\": {}, \"class\": \"{}\", \"time_s\": "
            "[{}], "
            "\"speed_mps\": [{}]}}, \"geometry\": {{\"type\": \"LineString\", \"coordinates\": [{}]}}}}",
            id, traffic::name(track.vehicle_class), times, speeds, points);
    }

    const roads::Network& network_;
    TrajectoryOptions options_;
    std::optional<roads::Geography> geography_;
    core::AtomicFile csv_;
    std::map<core::VehicleKey, Track> tracks_;
    TrajectoryCounts counts_;
    double next_s_ = 0.0;
};

}  // namespace

TrajectoryCounts write_trajectories(RecordingReader& recording, const roads::Network& network,
                                    const TrajectoryOptions& options, const std::filesystem::path& folder) {
    Writer writer(network, options, folder);
    while (const auto step = recording.next())
        writer.take(*step->snapshot, *step->roster);
    return writer.finish(folder);
}

}  // namespace clearway::trace
