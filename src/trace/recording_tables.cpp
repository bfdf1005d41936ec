#include "trace/recording_tables.hpp"

#include <array>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "truth/events.hpp"
#include "truth/snapshot.hpp"

namespace clearway::trace {
namespace {

struct TableEntry {
    RecordingTable table;
    const char* name;
    const char* header;
};

constexpr const char* motion_header = "x_m,y_m,heading_rad,speed_mps,lane,lane_position_m,route_edge";

constexpr std::array tables = {
    TableEntry{RecordingTable::snapshot, "snapshot", "time_s,vehicle,class,acceleration_mps2,{}"},
    TableEntry{RecordingTable::signals, "signals", "time_s,signal,state"},
    TableEntry{RecordingTable::events, "events", "time_s,event,vehicle,other_vehicle,lane,deceleration_mps2"},
    TableEntry{RecordingTable::observation, "observation",
               "time_s,is_report,vehicle,class,freshness,age_s,position_sigma_m,{}"},
    TableEntry{RecordingTable::detections, "detections", "time_s,from,to,range_m,range_sigma_m"},
    TableEntry{RecordingTable::belief, "belief", "time_s,vehicle,class,age_s,sigma_m,{}"},
    TableEntry{RecordingTable::links, "links", "time_s,left,right,distance_m,probability"},
    TableEntry{RecordingTable::leases, "leases",
               "time_s,vehicle,signal,action,speed_mps,lane_number,side,links,own_links,expiry_s,priority,"
               "policy,reason,beneficiary,stretch_lane,stretch_from_m,stretch_to_m,stretch_below_mps,"
               "stretch_addressed"},
};

/// Writes the lines of one step.
class StepLines {
  public:
    StepLines(const RecordedStep& step, const RoadNames& names) : step_(step), names_(names) {}

    std::string write(RecordingTable table) {
        constexpr std::array writers = {&StepLines::snapshot,    &StepLines::signals,    &StepLines::events,
                                        &StepLines::observation, &StepLines::detections, &StepLines::belief,
                                        &StepLines::links,       &StepLines::leases};
        static_assert(writers.size() == tables.size());
        (this->*writers[static_cast<std::size_t>(table)])();
        return std::move(text_);
    }

  private:
    template <class... Cells>
    void line(const Cells&... cells) {
        text_ += fmt::format("{}", step_.snapshot->time.value);
        ((text_ += "," + fmt::format("{}", cells)), ...);
        text_ += "\n";
    }
    std::string vehicle(core::VehicleKey key) const { return vehicle_cell(*step_.roster, key); }
    static std::string name_in(const std::vector<std::string>& names, std::uint32_t index, bool exists) {
        if (!exists) return "";
        return index < names.size() ? core::csv_text(names[index]) : fmt::format("#{}", index);
    }
    std::string lane(core::LaneIndex index) const {
        return name_in(names_.lanes, index.value, index.exists());
    }
    std::string signal(std::uint32_t index) const { return name_in(names_.signals, index, true); }
    std::string motion(const traffic::MotionState& state) const {
        return fmt::format("{},{},{},{},{},{},{}", state.x_m, state.y_m, state.heading_rad, state.speed_mps,
                           lane(state.lane), state.lane_position_m, state.route_edge);
    }

    void snapshot() {
        const truth::Snapshot& now = *step_.snapshot;
        for (core::VehicleIndex row = 0; row < now.size(); ++row)
            line(vehicle(now.key[row]), traffic::name(now.vehicle_class[row]), now.acceleration_mps2[row],
                 motion(now.motion(row)));
    }
    void signals() {
        const std::vector<std::string>& states = step_.snapshot->signals.state;
        for (std::uint32_t i = 0; i < states.size(); ++i)
            line(signal(i), core::csv_text(states[i]));
    }
    void events() {
        const truth::Events& now = *step_.events;
        const auto each = [&](const char* event, const std::vector<core::VehicleKey>& keys) {
            for (const core::VehicleKey key : keys)
                line(event, vehicle(key), "", "", "");
        };
        each("departed", now.departed);
        each("arrived", now.arrived);
        each("teleported", now.teleported);
        each("removed", now.removed);
        for (const truth::Collision& collision : now.collisions) {
            const bool on_junction = collision.place == truth::CollisionPlace::junction;
            line(on_junction ? "collision_on_junction" : "collision_on_lane", vehicle(collision.collider),
                 vehicle(collision.victim), lane(collision.lane), "");
        }
        for (const truth::EmergencyBraking& braking : now.emergency_brakings)
            line("emergency_braking", vehicle(braking.vehicle), "", "", braking.deceleration_mps2);
    }
    void observation() {
        if (step_.observation == nullptr) return;
        for (const traffic::ObservedVehicle& each : step_.observation->vehicles)
            line(step_.observation->is_report ? 1 : 0, vehicle(each.key), traffic::name(each.vehicle_class),
                 each.freshness == traffic::Freshness::fresh ? "fresh" : "stale", each.age_s,
                 each.position_sigma_m, motion(each.state));
    }
    void detections() {
        if (step_.observation == nullptr) return;
        for (const traffic::DetectedLink& link : step_.observation->detected_links)
            line(vehicle(link.from), vehicle(link.to),
                 link.range_m < 0.0F ? "" : fmt::format("{}", link.range_m), link.range_sigma_m);
    }
    void belief() {
        if (step_.belief == nullptr) return;
        for (const traffic::BelievedVehicle& each : step_.belief->vehicles)
            line(vehicle(each.key), traffic::name(each.vehicle_class), each.age_s, each.sigma_m,
                 motion(each.state));
    }
    void links() {
        if (step_.belief == nullptr) return;
        const traffic::BelievedGraph& now = *step_.belief;
        for (core::VehicleIndex left = 0; left < now.vehicles.size(); ++left) {
            for (const traffic::BelievedLink& link : now.links_of(left)) {
                if (link.neighbour > left)
                    line(vehicle(now.vehicles[left].key), vehicle(now.vehicles[link.neighbour].key),
                         link.distance_m, link.probability);
            }
        }
    }

    /// `speed_mps,lane_number,side,links,own_links`.
    struct ActionCells {
        std::string operator()(const traffic::DriveAt& action) const {
            return fmt::format("{},,,,", action.speed.value);
        }
        std::string operator()(const traffic::ChangeLane& action) const {
            return fmt::format(",{},,,", action.lane_number);
        }
        std::string operator()(const traffic::PullAside& action) const {
            return action.side == traffic::Side::right ? ",,right,," : ",,left,,";
        }
        std::string operator()(const traffic::HoldGreen& action) const {
            return fmt::format(",,,{},{}", fmt::join(action.links, " "), fmt::join(action.own_links, " "));
        }
        std::string operator()(const traffic::AdjustGreen& action) const {
            return fmt::format(",,,{},", fmt::join(action.links, " "));
        }
        std::string operator()(const traffic::TakeRoute& action) const { return way(action.edges); }
        std::string operator()(const traffic::StandBack& action) const { return way(action.way); }
        static std::string way(const std::vector<core::EdgeIndex>& edges) {
            std::string numbers;
            for (const core::EdgeIndex edge : edges)
                numbers += (numbers.empty() ? "" : " ") + std::to_string(edge.value);
            return fmt::format(",,,{},", numbers);
        }
        template <class Plain>
        std::string operator()(const Plain&) const {
            return ",,,,";
        }
    };
    std::string stretch(const traffic::Stretch& place) const {
        return fmt::format("{},{},{},{},{}", lane(place.lane), place.from_m, place.to_m, place.below_mps,
                           place.addressed == traffic::Addressed::automated ? "automated" : "drivers");
    }
    void leases() {
        for (const traffic::Lease& each : step_.leases)
            lease(each);
    }
    void lease(const traffic::Lease& lease) {
        const auto* const key = std::get_if<core::VehicleKey>(&lease.target);
        const auto* const index = std::get_if<core::SignalIndex>(&lease.target);
        const auto* const place = std::get_if<traffic::Stretch>(&lease.target);
        line(key != nullptr ? vehicle(*key) : "", index != nullptr ? signal(index->value) : "",
             traffic::name(lease.action), std::visit(ActionCells{}, lease.action), lease.expiry.value,
             lease.priority, core::csv_text(lease.policy), core::csv_text(lease.reason),
             vehicle(lease.beneficiary), place != nullptr ? stretch(*place) : ",,,,");
    }

    const RecordedStep& step_;
    const RoadNames& names_;
    std::string text_;
};

}  // namespace

std::string_view name(RecordingTable table) {
    return tables[static_cast<std::size_t>(table)].name;
}

std::vector<std::string> recording_table_names() {
    return core::texts_of(tables, &TableEntry::name);
}

std::optional<RecordingTable> recording_table_from(std::string_view word) {
    for (const TableEntry& entry : tables) {
        if (word == entry.name) return entry.table;
    }
    return std::nullopt;
}

std::string vehicle_cell(const traffic::Roster& roster, core::VehicleKey key) {
    const traffic::VehicleInfo* const info = roster.find(key);
    if (info != nullptr) return core::csv_text(info->id);
    return key.value == 0 ? "" : fmt::format("#{:016x}", key.value);
}

std::string csv_header(RecordingTable table) {
    return fmt::format(fmt::runtime(tables[static_cast<std::size_t>(table)].header), motion_header) + "\n";
}

std::string csv_lines(RecordingTable table, const RecordedStep& step, const RoadNames& names) {
    return StepLines(step, names).write(table);
}

}  // namespace clearway::trace
