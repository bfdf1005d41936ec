#include "policy/conformance.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <utility>

namespace clearway::testing {
namespace {

using traffic::VehicleClass;

/// Filled before main, by constants of other files: made when the first of them needs it.
std::vector<PolicyScenes>& entered() {
    static std::vector<PolicyScenes> all;
    return all;
}

std::string describe(const traffic::Lease& lease) {
    std::ostringstream text;
    if (const auto* vehicle = std::get_if<core::VehicleKey>(&lease.target)) text << "v" << vehicle->value;
    if (const auto* signal = std::get_if<core::SignalIndex>(&lease.target)) text << "s" << signal->value;
    text << ' ' << traffic::name(lease.action) << ' ' << lease.expiry.value << ' ' << lease.priority << ' '
         << lease.policy << ' ' << lease.reason << ' ' << lease.beneficiary.value;
    if (const auto* drive = std::get_if<traffic::DriveAt>(&lease.action)) text << ' ' << drive->speed.value;
    if (const auto* lane = std::get_if<traffic::ChangeLane>(&lease.action)) text << ' ' << lane->lane_number;
    if (const auto* hold = std::get_if<traffic::HoldGreen>(&lease.action)) {
        for (const auto* links : {&hold->links, &hold->own_links}) {
            text << " |";
            for (const std::uint16_t link : *links)
                text << ' ' << link;
        }
    }
    if (const auto* adjustment = std::get_if<traffic::AdjustGreen>(&lease.action)) {
        for (const std::uint16_t link : adjustment->links)
            text << ' ' << link;
    }
    return text.str();
}

void expect_legal_links(core::SignalIndex signal, const std::vector<std::uint16_t>& links) {
    EXPECT_FALSE(links.empty()) << "name the links of the signal that are to be green";
    EXPECT_TRUE(std::ranges::is_sorted(links)) << "sort them";
    EXPECT_EQ(std::ranges::adjacent_find(links), links.end()) << "a link twice: name each once";
    for (const std::uint16_t link : links)
        EXPECT_LT(link, two_crossings().signal(signal).links.size())
            << "the signal has no such link: count from 0, as the network does";
}

/// Of the test that runs.
int failure_count() {
    return ::testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
}

}  // namespace

OwnScenes::OwnScenes(PolicyScenes scenes) {
    entered().push_back(std::move(scenes));
}

const std::vector<PolicyScenes>& all_own_scenes() {
    return entered();
}

PolicyScenes scenes_of(const std::string& policy) {
    const auto found = std::ranges::find(entered(), policy, &PolicyScenes::policy);
    return found == entered().end() ? PolicyScenes{} : *found;
}

core::VehicleKey emergency_key() {
    return core::vehicle_key("e");
}

void add_helpful_scene(ActuationBench& bench, const PolicyScenes& scenes) {
    const auto add = [&](const std::string& id, VehicleClass kind, std::vector<std::string> route,
                         std::uint32_t lane, double position_m, double speed_mps) {
        bench.add({id, kind, std::move(route), lane, position_m, speed_mps});
    };
    add("e", VehicleClass::emergency, eastbound, 1, 490.0 - scenes.to_line_m, scenes.speed_mps);
    add("a1", VehicleClass::automated, eastbound, 1, 400.0, 10.0);
    add("a2", VehicleClass::automated, eastbound, 0, 366.0, 12.0);
    add("h1", VehicleClass::human, eastbound, 1, 480.0, 0.0);
    add("h2", VehicleClass::human, {"north_a_A", "A_south_a"}, 0, 285.0, 0.0);
    add("h3", VehicleClass::human, {"north_a_A", "A_south_a"}, 0, 277.0, 0.0);
    add("a4", VehicleClass::automated, {"north_a_A", "A_south_a"}, 0, 255.0, 6.0);
    for (const SceneVehicle& vehicle : scenes.vehicles)
        bench.add(vehicle);
}

void add_needless_scene(ActuationBench& bench) {
    bench.add({"e", VehicleClass::emergency, {"B_east"}, 0, 150.0, 14.0});
    bench.add({"a1", VehicleClass::automated, eastbound, 1, 400.0, 10.0});
    bench.add({"a2", VehicleClass::automated, {"south_a_A", "A_north_a"}, 0, 100.0, 12.0});
    bench.add({"h1", VehicleClass::human, eastbound, 1, 480.0, 0.0});
}

void PolicyRun::act() {
    traffic::BelievedGraph& belief = bench_.scene.belief();
    belief.time = bench_.now;
    belief.signals.state = bench_.shown;
    std::vector<traffic::Lease> leases;
    policy_->act(belief, leases);
    for (const traffic::Lease& lease : leases)
        note_request(lease);
    leases = delivered(leases);
    constexpr int most_told = 3;
    for (const traffic::Lease& lease : leases) {
        const int failures = failure_count();
        if (illegal_ < most_told) expect_legal(lease);
        illegal_ += failure_count() > failures ? 1 : 0;
        leases_.push_back(describe(lease));
    }
    bench_.actuator.accept(leases, bench_.now);
}

void PolicyRun::note_request(const traffic::Lease& lease) {
    if (lease.beneficiary == core::VehicleKey{} || std::holds_alternative<core::SignalIndex>(lease.target))
        return;
    const auto* const vehicle = std::get_if<core::VehicleKey>(&lease.target);
    if (vehicle != nullptr && *vehicle == lease.beneficiary) return;
    const double lives_s = lease.expiry.value - bench_.now.value;
    shortest_request_s_ = std::min(lives_s, shortest_request_s_.value_or(lives_s));
}

std::vector<traffic::Lease> PolicyRun::delivered(const std::vector<traffic::Lease>& leases) const {
    std::vector<traffic::Lease> all;
    for (const traffic::Lease& lease : leases) {
        const auto* const stretch = std::get_if<traffic::Stretch>(&lease.target);
        if (stretch == nullptr) {
            all.push_back(lease);
            continue;
        }
        EXPECT_LT(stretch->lane.value, two_crossings().lanes().size()) << "take a lane of the belief";
        EXPECT_LT(stretch->from_m, stretch->to_m) << "leave out a stretch without length";
        EXPECT_GE(stretch->from_m, 0.0F) << "begin where the lane does";
        EXPECT_LE(stretch->to_m, two_crossings().lane(stretch->lane).length_m) << "end where the lane does";
        for (const auto& [key, state] : bench_.on_road) {
            if (!stretch->has(bench_.scene.roster().find(key)->vehicle_class, state)) continue;
            all.push_back(lease);
            all.back().target = key;
        }
    }
    return all;
}

void PolicyRun::run_for(double duration_s) {
    const double end_s = bench_.now.value + duration_s;
    while (bench_.now.value < end_s - 1e-9) {
        act();
        const double next_s = std::min(end_s, bench_.now.value + 0.5);
        const std::vector<traffic::Command> commands = bench_.run_until(next_s);
        commands_.insert(commands_.end(), commands.begin(), commands.end());
    }
}

void PolicyRun::remove(core::VehicleKey vehicle) {
    bench_.scene.remove(vehicle);
    bench_.on_road.erase(vehicle);
}

void PolicyRun::expect_own_name(const std::string& name) const {
    const std::string own(policy_->name());
    const policy::PolicyEntry* const entry = policy::policies().find(own);
    EXPECT_TRUE(name == own ||
                (entry != nullptr && std::ranges::find(entry->components, name) != entry->components.end()))
        << "'" << name
        << "' stands in the lease, and counts of what a policy did go by that: give LeaseWriter '" << own
        << "', its name()";
}

void PolicyRun::expect_legal(const traffic::Lease& lease) {
    SCOPED_TRACE(describe(lease));
    EXPECT_GT(lease.expiry, bench_.now) << "it ends before it begins: add a lifetime to the belief's time";
    EXPECT_LE(lease.expiry.value, bench_.now.value + 60.0) << "renew a shorter one instead";
    EXPECT_STRNE(lease.reason, "") << "say why in a few words";
    expect_own_name(lease.policy);
    if (const auto* signal = std::get_if<core::SignalIndex>(&lease.target)) {
        ASSERT_LT(signal->value, two_crossings().signals().size()) << "take a signal of the EV's approaches";
        if (const auto* hold = std::get_if<traffic::HoldGreen>(&lease.action)) {
            expect_legal_links(*signal, hold->links);
            EXPECT_TRUE(std::ranges::includes(hold->links, hold->own_links))
                << "own_links are those of `links` that the EV takes";
        } else
            expect_legal_links(*signal, std::get<traffic::AdjustGreen>(lease.action).links);
        return;
    }
    const core::VehicleKey vehicle = std::get<core::VehicleKey>(lease.target);
    ASSERT_TRUE(bench_.on_road.contains(vehicle)) << "ask only vehicles of the belief";
    EXPECT_NE(bench_.scene.roster().find(vehicle)->vehicle_class, VehicleClass::human)
        << "human drivers are asked only with ask_humans=1";
    const roads::Lane& lane = two_crossings().lane(bench_.on_road.at(vehicle).lane);
    if (const auto* drive = std::get_if<traffic::DriveAt>(&lease.action)) {
        EXPECT_TRUE(std::isfinite(drive->speed.value)) << "look for a division by 0";
        EXPECT_GE(drive->speed.value, 0.0) << "0 stops a vehicle; none drives backwards";
        EXPECT_LE(drive->speed.value, lane.speed_limit_mps + 1e-6)
            << "above the limit of its lane: View::allowed_speed is the most that it may be asked";
    }
    if (const auto* change = std::get_if<traffic::ChangeLane>(&lease.action)) {
        EXPECT_LT(change->lane_number, two_crossings().edge(lane.edge).lane_count)
            << "its edge has no such lane: 0 is the outermost";
    }
}

void expect_all_given_back(const std::vector<traffic::Command>& commands) {
    std::set<core::VehicleKey> speeds;
    std::map<core::VehicleKey, int> odd;
    std::set<std::uint32_t> signals;
    std::set<core::VehicleKey> aside;
    for (const traffic::Command& command : commands) {
        if (const auto* set = std::get_if<traffic::SetSpeed>(&command)) speeds.insert(set->vehicle);
        if (const auto* release = std::get_if<traffic::ReleaseSpeed>(&command)) {
            EXPECT_EQ(speeds.erase(release->vehicle), 1U)
                << "released what was not set: leave releases to actuation";
        }
        if (const auto* stop = std::get_if<traffic::StopOnLane>(&command)) aside.insert(stop->vehicle);
        if (const auto* resume = std::get_if<traffic::ResumeFromStop>(&command)) {
            EXPECT_EQ(aside.erase(resume->vehicle), 1U) << "resumed what did not stop: leave it to actuation";
        }
        if (const auto* freedom = std::get_if<traffic::SetLaneChangeFreedom>(&command))
            odd[freedom->vehicle] = freedom->freedom != traffic::LaneChangeFreedom::normal;
        if (const auto* privilege = std::get_if<traffic::SetJunctionPrivilege>(&command))
            odd[privilege->vehicle] = privilege->privilege != traffic::JunctionPrivilege::none;
        if (const auto* state = std::get_if<traffic::SetSignalState>(&command))
            signals.insert(state->signal.value);
        if (const auto* restore = std::get_if<traffic::RestoreProgram>(&command)) {
            EXPECT_EQ(signals.erase(restore->signal.value), 1U)
                << "restored what was not held: leave it to actuation";
        }
    }
    EXPECT_TRUE(speeds.empty()) << "a set speed was left behind: give the lease a shorter life";
    EXPECT_TRUE(aside.empty()) << "a vehicle was left beside the road: give the lease a shorter life";
    EXPECT_TRUE(signals.empty()) << "a signal was left behind: give the lease a shorter life";
    for (const auto& [vehicle, is_odd] : odd)
        EXPECT_FALSE(is_odd) << "a freedom was left behind: give the lease a shorter life";
}

}  // namespace clearway::testing
