#include "view/frame_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "truth/events.hpp"
#include "truth/snapshot.hpp"
#include "view/dark_vehicles.hpp"

namespace clearway::view {
namespace {

std::uint32_t length_quanta(double metres) {
    return static_cast<std::uint32_t>(std::max(0L, std::lround(metres / quantum_m)));
}

std::int32_t speed_quanta(double speed_mps) {
    return static_cast<std::int32_t>(std::lround(speed_mps / speed_quantum_mps));
}

std::uint8_t heading_of(float radians) {
    const double turns = static_cast<double>(radians) / (2.0 * std::numbers::pi);
    return static_cast<std::uint8_t>(std::llround(turns * headings) & (headings - 1));
}

Link link_of(Slot one, Slot other) {
    return one < other ? Link{one, other} : Link{other, one};
}

/// Calls `visit` with both rows of each link of a graph, once.
template <class Visit>
void for_each_link(const graph::ProximityGraph& graph, const Visit& visit) {
    for (core::VehicleIndex row = 0; row < graph.vehicle_count(); ++row) {
        for (const core::VehicleIndex other : graph.neighbours_of(row)) {
            if (row < other) visit(row, other);
        }
    }
}

/// The number that says how much: see SeenLease.
struct Amount {
    std::int32_t operator()(const traffic::DriveAt& action) const { return speed_quanta(action.speed.value); }
    std::int32_t operator()(const traffic::ChangeLane& action) const {
        return static_cast<std::int32_t>(action.lane_number);
    }
    std::int32_t operator()(const traffic::PullAside& action) const {
        return static_cast<std::int32_t>(action.side);
    }
    std::int32_t operator()(const traffic::HoldGreen& action) const {
        return static_cast<std::int32_t>(action.links.size());
    }
    template <class Other>
    std::int32_t operator()(const Other&) const {
        return 0;
    }
};

}  // namespace

void FrameBuilder::look(const trace::RecordedStep& step) {
    assert(step.snapshot != nullptr && step.roster != nullptr && step.events != nullptr);
    const truth::Snapshot& snapshot = *step.snapshot;
    if (is_shown_) frame_.marks.clear();
    is_shown_ = false;
    if (step.observation != nullptr) {
        if (step.observation->is_report) dark_ = dark_vehicles(snapshot, *step.observation);
        take_links(step);
        take_known_blocks(*step.observation);
    }
    if (step.belief != nullptr) take_ghosts(step);
    mark_requests(step);
    mark_events(step);
}

const Frame& FrameBuilder::frame(const trace::RecordedStep& step) {
    is_shown_ = true;
    frame_.time_s = step.snapshot->time.value;
    frame_.signals = step.snapshot->signals.state;
    draw_vehicles(step);
    draw_ways(step);
    draw_leases(step);
    draw_links();
    return frame_;
}

Names FrameBuilder::take_names() {
    return std::exchange(new_names_, {});
}

Slot FrameBuilder::slot_of(core::VehicleKey key, const traffic::Roster& roster) {
    const auto [at, is_new] = slots_.try_emplace(key, static_cast<Slot>(slots_.size()));
    if (is_new) {
        NamedVehicle named;
        if (const traffic::VehicleInfo* const info = roster.find(key)) {
            named = {info->id, static_cast<std::uint8_t>(info->vehicle_class),
                     static_cast<std::uint8_t>(info->kind), length_quanta(info->length_m),
                     length_quanta(info->width_m)};
        }
        new_names_.vehicles.push_back(std::move(named));
    }
    return at->second;
}

std::uint32_t FrameBuilder::text_of(const std::string& text) {
    const auto [at, is_new] = texts_.try_emplace(text, static_cast<std::uint32_t>(texts_.size()));
    if (is_new) new_names_.texts.push_back(text);
    return at->second;
}

std::uint32_t FrameBuilder::way_of(core::RouteIndex route, const traffic::Roster& roster) {
    const auto [at, is_new] = ways_.try_emplace(route.value, way_count_);
    return is_new ? name_way(roster.route(route)) : at->second;
}

std::uint32_t FrameBuilder::considered_way_of(core::VehicleKey vehicle,
                                              const std::vector<core::EdgeIndex>& edges) {
    ConsideredWay& known = considered_[vehicle];
    // Further on, what is left of a way is the same way.
    const bool is_rest =
        edges.size() <= known.edges.size() && std::equal(edges.rbegin(), edges.rend(), known.edges.rbegin());
    if (!is_rest) known = {edges, name_way(edges)};
    return known.number;
}

std::uint32_t FrameBuilder::name_way(std::span<const core::EdgeIndex> edges) {
    std::vector<std::uint32_t>& way = new_names_.ways.emplace_back();
    for (const core::EdgeIndex edge : edges)
        way.push_back(edge.value);
    return way_count_++;
}

void FrameBuilder::take_known_blocks(const traffic::Observation& observation) {
    frame_.known_blocks.clear();
    for (const traffic::KnownIncident& incident : observation.incidents)
        frame_.known_blocks.push_back(incident.edge.value);
    std::ranges::sort(frame_.known_blocks);
}

void FrameBuilder::take_links(const trace::RecordedStep& step) {
    const truth::Snapshot& snapshot = *step.snapshot;
    true_links_.look(snapshot);
    std::vector<LinkedPair>& true_pairs = links(Layer::true_links);
    true_pairs.clear();
    for_each_link(true_links_.graph(), [&](core::VehicleIndex one, core::VehicleIndex other) {
        true_pairs.push_back({snapshot.key[one], snapshot.key[other]});
    });
    take_observed_links(*step.observation);
    if (step.belief != nullptr) take_believed_links(*step.belief);
}

/// Links between the places of the vehicles whose newest report arrived.
void FrameBuilder::take_observed_links(const traffic::Observation& observation) {
    std::vector<float> x_m;
    std::vector<float> y_m;
    std::vector<traffic::VehicleClass> vehicle_class;
    std::vector<core::VehicleKey> key;
    for (const traffic::ObservedVehicle& vehicle : observation.vehicles) {
        if (vehicle.freshness != traffic::Freshness::fresh) continue;
        x_m.push_back(vehicle.state.x_m);
        y_m.push_back(vehicle.state.y_m);
        vehicle_class.push_back(vehicle.vehicle_class);
        key.push_back(vehicle.key);
    }
    graph::ProximityGraph graph;
    proximity_.build({x_m, y_m, vehicle_class}, true_links_.rules(), graph);
    std::vector<LinkedPair>& observed = links(Layer::observed_links);
    observed.clear();
    for_each_link(graph, [&](core::VehicleIndex one, core::VehicleIndex other) {
        observed.push_back({key[one], key[other]});
    });
}

void FrameBuilder::take_believed_links(const traffic::BelievedGraph& belief) {
    std::vector<LinkedPair>& believed = links(Layer::believed_links);
    believed.clear();
    for (core::VehicleIndex row = 0; row < belief.vehicles.size(); ++row) {
        for (const traffic::BelievedLink& link : belief.links_of(row)) {
            if (row < link.neighbour)
                believed.push_back({belief.vehicles[row].key, belief.vehicles[link.neighbour].key});
        }
    }
}

void FrameBuilder::take_ghosts(const trace::RecordedStep& step) {
    frame_.ghosts.clear();
    for (const traffic::BelievedVehicle& vehicle : step.belief->vehicles) {
        const bool on_road = step.snapshot->row_of(vehicle.key).has_value();
        if (on_road && !std::ranges::binary_search(dark_, vehicle.key)) continue;
        if (!shows(vehicle.state.x_m, vehicle.state.y_m)) continue;
        frame_.ghosts.push_back({slot_of(vehicle.key, *step.roster), origin_.x(vehicle.state.x_m),
                                 origin_.y(vehicle.state.y_m), length_quanta(vehicle.sigma_m),
                                 static_cast<std::uint32_t>(std::lround(vehicle.age_s * 10.0F))});
    }
    std::ranges::sort(frame_.ghosts, {}, &Ghost::slot);
}

void FrameBuilder::mark(MarkKind kind, double time_s, std::uint32_t vehicle, std::uint32_t other) {
    frame_.marks.push_back({kind, time_s, vehicle, other});
}

void FrameBuilder::mark_requests(const trace::RecordedStep& step) {
    const double time_s = step.snapshot->time.value;
    const auto changes = leases_.step(time_s, step.leases, step.snapshot->signals);
    const auto number_of = [&](core::VehicleKey key) {
        return key.value == 0 ? 0 : slot_of(key, *step.roster) + 1;
    };
    for (const auto& hold : changes.requested)
        mark(MarkKind::request, time_s, number_of(hold.beneficiary), hold.signal.value + 1);
    for (const auto& hold : changes.granted)
        mark(MarkKind::grant, time_s, number_of(hold.beneficiary), hold.signal.value + 1);
}

/// Departures, arrivals and teleports of emergency vehicles; brakings and collisions of any, where shown.
void FrameBuilder::mark_events(const trace::RecordedStep& step) {
    const truth::Events& events = *step.events;
    const traffic::Roster& roster = *step.roster;
    const double time_s = step.snapshot->time.value;
    const auto mark_emergency = [&](MarkKind kind, const std::vector<core::VehicleKey>& keys) {
        for (const core::VehicleKey key : keys) {
            const traffic::VehicleInfo* const info = roster.find(key);
            if (info != nullptr && info->vehicle_class == traffic::VehicleClass::emergency)
                mark(kind, time_s, slot_of(key, roster) + 1);
        }
    };
    const auto is_shown = [&](core::VehicleKey key) {
        const auto row = step.snapshot->row_of(key);
        return !row || shows(step.snapshot->x_m[*row], step.snapshot->y_m[*row]);
    };
    mark_emergency(MarkKind::departure, events.departed);
    mark_emergency(MarkKind::arrival, events.arrived);
    mark_emergency(MarkKind::teleport, events.teleported);
    for (const truth::EmergencyBraking& braking : events.emergency_brakings) {
        if (is_shown(braking.vehicle)) mark(MarkKind::braking, time_s, slot_of(braking.vehicle, roster) + 1);
    }
    for (const truth::Collision& collision : events.collisions) {
        if (is_shown(collision.collider))
            mark(MarkKind::collision, time_s, slot_of(collision.collider, roster) + 1,
                 slot_of(collision.victim, roster) + 1);
    }
}

void FrameBuilder::draw_vehicles(const trace::RecordedStep& step) {
    const truth::Snapshot& snapshot = *step.snapshot;
    frame_.vehicles.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] != traffic::VehicleClass::emergency &&
            !shows(snapshot.x_m[row], snapshot.y_m[row]))
            continue;
        const core::VehicleKey key = snapshot.key[row];
        frame_.vehicles.push_back({slot_of(key, *step.roster), origin_.x(snapshot.x_m[row]),
                                   origin_.y(snapshot.y_m[row]), heading_of(snapshot.heading_rad[row]),
                                   speed_quanta(snapshot.speed_mps[row]),
                                   std::ranges::binary_search(dark_, key)});
    }
    std::ranges::sort(frame_.vehicles, {}, &SeenVehicle::slot);
    assert(std::ranges::adjacent_find(frame_.vehicles, {}, &SeenVehicle::slot) == frame_.vehicles.end());
}

void FrameBuilder::draw_ways(const trace::RecordedStep& step) {
    const truth::Snapshot& snapshot = *step.snapshot;
    frame_.ways.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] != traffic::VehicleClass::emergency) continue;
        const traffic::VehicleInfo* const info = step.roster->find(snapshot.key[row]);
        if (info == nullptr || !info->route.exists()) continue;
        frame_.ways.push_back({slot_of(snapshot.key[row], *step.roster), way_of(info->route, *step.roster),
                               snapshot.route_edge[row]});
    }
    std::ranges::sort(frame_.ways, {}, &SeenWay::slot);
}

void FrameBuilder::draw_leases(const trace::RecordedStep& step) {
    frame_.leases.clear();
    for (const auto& [key, lease] : leases_.all()) {
        SeenLease seen;
        seen.on_signal = std::holds_alternative<core::SignalIndex>(lease.target);
        for (const std::uint32_t target : targets_of(lease.target, step)) {
            seen.target = target;
            seen.action = static_cast<std::uint8_t>(lease.action.index());
            seen.amount = std::visit(Amount(), lease.action);
            if (const auto* const back = std::get_if<traffic::StandBack>(&lease.action);
                back != nullptr && !back->way.empty())
                seen.amount = static_cast<std::int32_t>(considered_way_of(lease.beneficiary, back->way)) + 1;
            seen.policy = text_of(lease.policy);
            seen.reason = text_of(lease.reason);
            if (lease.beneficiary.value != 0) seen.beneficiary = slot_of(lease.beneficiary, *step.roster) + 1;
            frame_.leases.push_back(seen);
        }
    }
    std::ranges::sort(frame_.leases);
    // Two messages in force may reach the same vehicle.
    frame_.leases.erase(std::unique(frame_.leases.begin(), frame_.leases.end()), frame_.leases.end());
}

/// Number of the signal, slot of the vehicle, or slots of the vehicles that are on the stretch now.
std::vector<std::uint32_t> FrameBuilder::targets_of(const traffic::Target& target,
                                                    const trace::RecordedStep& step) {
    if (const auto* const signal = std::get_if<core::SignalIndex>(&target)) return {signal->value};
    if (const auto* const vehicle = std::get_if<core::VehicleKey>(&target))
        return {slot_of(*vehicle, *step.roster)};
    const truth::Snapshot& snapshot = *step.snapshot;
    std::vector<std::uint32_t> slots;
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (std::get<traffic::Stretch>(target).has(snapshot.vehicle_class[row], snapshot.motion(row)))
            slots.push_back(slot_of(snapshot.key[row], *step.roster));
    }
    return slots;
}

void FrameBuilder::draw_links() {
    for (std::size_t layer = 0; layer < layers; ++layer) {
        frame_.links[layer].clear();
        for (const LinkedPair& pair : links_[layer]) {
            const auto one = drawn(pair.one);
            const auto other = drawn(pair.other);
            if (one && other) frame_.links[layer].push_back(link_of(*one, *other));
        }
        std::ranges::sort(frame_.links[layer]);
    }
}

std::optional<Slot> FrameBuilder::drawn(core::VehicleKey key) const {
    const auto at = slots_.find(key);
    if (at == slots_.end()) return std::nullopt;
    const bool is_there = std::ranges::binary_search(frame_.vehicles, at->second, {}, &SeenVehicle::slot) ||
                          std::ranges::binary_search(frame_.ghosts, at->second, {}, &Ghost::slot);
    return is_there ? std::optional(at->second) : std::nullopt;
}

}  // namespace clearway::view
