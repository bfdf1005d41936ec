// What every registered policy must do, whatever it is for, and one in Python as well.

#include "policy/conformance.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include <gmock/gmock.h>

#include "core/settings.hpp"
#include "core/units.hpp"
#include "python/part_name.hpp"

namespace clearway::testing {
namespace {

using traffic::VehicleClass;

const OwnScenes shipped[] = {
    OwnScenes{
        {.policy = "give_way", .reason = "no junction without a signal", .acts_in_helpful_scene = false}},
    OwnScenes{{.policy = "navigate", .reason = "no other way", .acts_in_helpful_scene = false}},
    OwnScenes{{.policy = "hold_cross", .reason = "acts only shortly before the arrival", .to_line_m = 50.0}},
    OwnScenes{{.policy = "geocast",
               .reason = "a message to a place goes out although nobody is there, and its sender goes there",
               .needless_lease = "the lane that is cleared"}},
    OwnScenes{{.policy = "listing_5_5",
               .reason = "releases no speed, as published",
               .ends_leases_within_60_s = false}},
    OwnScenes{{.policy = "pull_aside",
               .reason = "asks those that stand",
               .vehicles = {{"q1", VehicleClass::automated, eastbound, 1, 430.0, 0.0},
                            {"q2", VehicleClass::automated, eastbound, 0, 430.0, 0.0}}}},
    OwnScenes{
        {.policy = "rescue_lane", .reason = "is for fast roads without signals", .asks_vehicles = false}},
};
constexpr const char* enter_scenes =
    "; or say in the test of your policy what suits it: OwnScenes (tests/policy/conformance.hpp)";

class EveryPolicy : public ::testing::TestWithParam<std::string> {
  protected:
    static std::unique_ptr<policy::Policy> make() {
        return policy::make_policy(GetParam(), policy::PolicyContext{two_crossings()});
    }
    static PolicyScenes scenes() { return scenes_of(GetParam()); }
    /// Whether the crossings lack what the policy is for.
    static bool is_out_of_place() {
        return !scenes().acts_in_helpful_scene || policy::policies().is(GetParam(), traffic::Trait::shoulder);
    }
    /// Whether it acts for the emergency vehicle of the helpful scene.
    static bool acts_for_one() {
        ActuationBench bench;
        add_helpful_scene(bench, scenes());
        PolicyRun run(make(), bench);
        run.run_for(5.0);
        return !run.leases().empty();
    }
    static constexpr const char* scene_first =
        "it does not act for one EV either: mend acts_in_a_scene_made_for_it first";
};

TEST_P(EveryPolicy, knows_its_name) {
    EXPECT_EQ(make()->name(), python::short_name(GetParam())) << "name() returns the name of the registry";
}

TEST_P(EveryPolicy, acts_in_a_scene_made_for_it) {
    if (is_out_of_place()) {
        EXPECT_FALSE(acts_for_one()) << "it acts, so remove what OwnScenes says of it (" << scenes().reason
                                     << ") or Trait::shoulder";
    } else {
        EXPECT_TRUE(acts_for_one()) << "nothing of add_helpful_scene (tests/policy/conformance.cpp) moves "
                                       "it: add what it acts on, the "
                                       "speed of the EV or its place"
                                    << enter_scenes;
    }
}

/// Its reports are lost, as under --failure B10. A policy that reads links cannot serve it: the graph has
/// none of a vehicle that it lacks.
TEST_P(EveryPolicy, serves_an_emergency_vehicle_that_only_knows_itself) {
    if (policy::policies().is(GetParam(), traffic::Trait::reads_links)) GTEST_SKIP() << "it reads links";
    if (!is_out_of_place() && !acts_for_one()) GTEST_SKIP() << scene_first;
    ActuationBench bench;
    add_helpful_scene(bench, scenes());
    std::erase_if(bench.scene.belief().vehicles, [](const traffic::BelievedVehicle& vehicle) {
        return vehicle.vehicle_class == VehicleClass::emergency;
    });
    PolicyRun run(make(), bench);
    run.run_for(5.0);
    EXPECT_EQ(run.leases().empty(), is_out_of_place())
        << "find EVs by View::emergency_vehicles(), which reads belief.own_states; belief.vehicles lacks "
           "those "
           "whose reports are lost. A policy that needs links says so by Trait::reads_links";
}

TEST_P(EveryPolicy, does_nothing_in_a_scene_made_against_it) {
    ActuationBench bench;
    add_needless_scene(bench);
    PolicyRun run(make(), bench);
    run.run_for(5.0);
    if (scenes().needless_lease != nullptr) {
        EXPECT_THAT(run.leases(), ::testing::Each(::testing::HasSubstr(scenes().needless_lease)));
    } else {
        EXPECT_EQ(run.leases(), std::vector<std::string>{})
            << "nothing of add_needless_scene (tests/policy/conformance.cpp) is in an EV's way"
            << enter_scenes;
    }
}

/// The shortest `lease_s` of the parts of a policy that renew their requests, s; nothing if none does.
std::optional<double> promised_lease_s(const policy::PolicyEntry& entry) {
    std::optional<double> shortest_s;
    for (const std::string& name : entry.components) {
        const policy::PolicyEntry& part = policy::policies().at(name);
        if (!part.is(traffic::Trait::renews_requests)) continue;
        const auto row = std::ranges::find(part.table.rows, "lease_s", &core::SettingInfo::name);
        const double lease_s =
            row == part.table.rows.end() ? 0.0 : core::number_from(row->preset).value_or(0.0);
        shortest_s = std::min(lease_s, shortest_s.value_or(lease_s));
    }
    return shortest_s;
}

/// Checks of a run compare the latency of requests with what policies with the trait promise, and only these.
TEST_P(EveryPolicy, says_how_long_its_requests_to_vehicles_live) {
    const policy::PolicyEntry* const entry = policy::policies().find(GetParam());
    if (entry == nullptr) GTEST_SKIP() << "code in Python has no traits";
    ActuationBench bench;
    add_helpful_scene(bench, scenes());
    PolicyRun run(make(), bench);
    run.run_for(5.0);
    const std::optional<double> lives_s = run.shortest_request_s();
    const std::optional<double> promised_s = promised_lease_s(*entry);
    if (is_out_of_place() || !scenes().asks_vehicles) {
        EXPECT_FALSE(lives_s) << "it asks a vehicle: remove what OwnScenes says of it (" << scenes().reason
                              << ")";
        return;
    }
    if (!lives_s) {
        EXPECT_FALSE(promised_s) << "it has Trait::renews_requests and asks no vehicle here, so nothing "
                                    "judges its lease_s: let its scene have a vehicle that it asks"
                                 << enter_scenes;
        return;
    }
    ASSERT_TRUE(promised_s)
        << "its requests to vehicles live " << *lives_s
        << " s, so one that takes longer (request_latency_s) is lost, and no check of a "
           "run tells. Add Trait::renews_requests to its entry in "
           "src/policy/registry.cpp, `double lease_s = 2.0;` and its Field "
           "(`detail::lifetime_field<C>()`, policy/detail/cooperation.hpp) to its config, "
           "and pass config_.lease_s to LeaseWriter";
    EXPECT_GE(*lives_s, *promised_s - core::clock_tolerance_s)
        << "its requests end before lease_s: pass config_.lease_s to LeaseWriter";
}

TEST_P(EveryPolicy, gives_the_same_leases_for_the_same_belief) {
    std::vector<std::vector<std::string>> leases;
    for (int repeat = 0; repeat < 2; ++repeat) {
        ActuationBench bench;
        add_helpful_scene(bench, scenes());
        PolicyRun run(make(), bench);
        run.run_for(10.0);
        leases.push_back(run.leases());
    }
    EXPECT_EQ(leases[0], leases[1])
        << "no clock, address or chance of its own; state only from what it was shown";
}

TEST_P(EveryPolicy, does_nothing_on_an_empty_road) {
    ActuationBench bench;
    PolicyRun run(make(), bench);
    run.run_for(5.0);
    EXPECT_TRUE(run.leases().empty()) << "return before anything else where the belief has no EV";
}

TEST_P(EveryPolicy, does_nothing_for_one_vehicle_that_is_no_emergency_vehicle) {
    for (const VehicleClass kind : {VehicleClass::human, VehicleClass::automated}) {
        ActuationBench bench;
        bench.add({"only", kind, {"west_A", "A_B"}, 0, 400.0, 10.0});
        PolicyRun run(make(), bench);
        run.run_for(5.0);
        EXPECT_TRUE(run.leases().empty()) << "act for EVs only";
    }
}

TEST_P(EveryPolicy, gives_legal_leases_for_an_emergency_vehicle_alone_or_first_in_the_queue) {
    for (const double position_m : {0.5, 300.0, 488.0}) {
        ActuationBench bench;
        bench.add({"e", VehicleClass::emergency, {"west_A", "A_B", "B_east"}, 0, position_m, 0.0});
        PolicyRun run(make(), bench);
        run.run_for(10.0);
    }
}

TEST_P(EveryPolicy, gives_legal_leases_on_a_junction_and_for_an_unknown_lane) {
    ActuationBench bench;
    add_helpful_scene(bench, scenes());
    PolicyRun run(make(), bench);
    run.run_for(1.0);
    const core::LaneIndex inside = two_crossings().find_lane(":A_13_0").value();
    for (traffic::BelievedVehicle& own : bench.scene.belief().own_states)
        own.state.lane = inside;
    for (traffic::BelievedVehicle& vehicle : bench.scene.belief().vehicles) {
        vehicle.state.lane =
            vehicle.vehicle_class == VehicleClass::emergency ? inside : core::LaneIndex::none();
    }
    run.run_for(3.0);
}

TEST_P(EveryPolicy, serves_two_emergency_vehicles_that_cross) {
    ActuationBench bench;
    add_helpful_scene(bench, scenes());
    bench.add({"e2", VehicleClass::emergency, {"north_a_A", "A_south_a"}, 1, 220.0, 12.0});
    bench.add({"a3", VehicleClass::automated, {"north_a_A", "A_south_a"}, 1, 245.0, 8.0});
    PolicyRun run(make(), bench);
    run.run_for(20.0);
    if (is_out_of_place() || acts_for_one()) {
        EXPECT_EQ(run.leases().empty(), is_out_of_place())
            << "it acts for one EV, and not where another crosses: serve each EV of the belief";
    }
    run.remove(emergency_key());
    run.run_for(10.0);
    run.remove(core::vehicle_key("e2"));
    run.run_for(120.0);
    std::vector<traffic::Command> commands;
    bench.actuator.restore_all(commands);
    for (const traffic::Command& command : commands) {
        EXPECT_FALSE(std::holds_alternative<traffic::RestoreProgram>(command))
            << "a signal is held 120 s after the last EV has left: let the lease expire";
    }
}

TEST_P(EveryPolicy, leaves_nothing_behind_when_the_emergency_vehicle_vanishes) {
    ActuationBench bench;
    add_helpful_scene(bench, scenes());
    PolicyRun run(make(), bench);
    run.run_for(10.0);
    run.remove(emergency_key());
    run.run_for(60.0);
    std::vector<traffic::Command> commands = run.commands();
    const std::size_t before = commands.size();
    bench.actuator.restore_all(commands);
    if (scenes().ends_leases_within_60_s) {
        EXPECT_EQ(commands.size(), before) << "all leases had ended already: let them expire within seconds";
    }
    // The vehicle that vanished took its own settings with it.
    std::erase_if(commands, [](const traffic::Command& command) {
        return std::visit(
            [](const auto& kind) {
                if constexpr (requires { kind.vehicle; }) return kind.vehicle == emergency_key();
                return false;
            },
            command);
    });
    expect_all_given_back(commands);
    EXPECT_EQ(bench.actuator.active(), 0U);
}

TEST(OwnScenesOfPolicies, are_of_registered_policies_and_give_a_reason) {
    std::set<std::string> seen;
    for (const PolicyScenes& scenes : all_own_scenes()) {
        EXPECT_NE(policy::policies().find(scenes.policy), nullptr)
            << scenes.policy << ": no policy has this name (src/policy/registry.cpp)";
        EXPECT_FALSE(scenes.reason.empty()) << scenes.policy << ": say why the usual scenes do not suit it";
        EXPECT_TRUE(seen.insert(scenes.policy).second) << scenes.policy << ": entered twice";
    }
}

std::vector<std::string> policy_names() {
#ifdef CLEARWAY_ONE_POLICY
    return {CLEARWAY_ONE_POLICY};  // the scenes of others stand in tests that this program lacks
#else
    std::vector<std::string> names = policy::policies().names();
    names.emplace_back(CLEARWAY_SOURCE_DIR "/examples/python/yield_policy.py:Yield");
    return names;
#endif
}

INSTANTIATE_TEST_SUITE_P(Policies, EveryPolicy, ::testing::ValuesIn(policy_names()),
                         [](const auto& policy) { return python::short_name(policy.param); });

}  // namespace
}  // namespace clearway::testing
