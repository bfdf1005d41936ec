#include <algorithm>

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "policy/policy.hpp"
#include "support/crossing_scene.hpp"

namespace clearway::testing {
namespace {

TEST(PolicyRegistry, names_the_nearest_policy_for_one_it_does_not_know) {
    try {
        policy::make_policy("disertation", policy::PolicyContext{two_crossings()});
        FAIL() << "no error";
    } catch (const core::InputError& error) {
        ASSERT_EQ(error.problems().size(), 1U);
        EXPECT_NE(error.problems()[0].cure.find("dissertation"), std::string::npos);
        EXPECT_NE(error.problems()[0].allowed.find("listing_5_5"), std::string::npos);
    }
}

TEST(PolicyRegistry, has_unique_names_and_a_summary_of_one_line_each) {
    std::vector<std::string> names;
    for (const policy::PolicyEntry& entry : policy::policies()) {
        EXPECT_EQ(entry.summary.find('\n'), std::string::npos)
            << entry.name << ": clearway list shows one line: shorten its summary (src/policy/registry.cpp)";
        EXPECT_FALSE(entry.summary.empty())
            << entry.name << ": say what it does in its entry of src/policy/registry.cpp";
        names.push_back(entry.name);
    }
    std::ranges::sort(names);
    const auto twice = std::ranges::adjacent_find(names);
    EXPECT_EQ(twice, names.end()) << *twice << " has two entries in src/policy/registry.cpp: rename one";
}

TEST(PolicyRegistry, says_of_every_policy_that_may_ask_drivers_that_it_renews_its_requests) {
    for (const policy::PolicyEntry& entry : policy::policies()) {
        const auto has = [&](const char* field) {
            return std::ranges::find(entry.table.rows, field, &core::SettingInfo::name) !=
                   entry.table.rows.end();
        };
        const bool renews = entry.is(traffic::Trait::renews_requests);
        if (has("ask_humans") && !renews)
            ADD_FAILURE() << entry.name << " may ask drivers (AskSettings), whose answer takes longer than a "
                          << "decision: add Trait::renews_requests to its entry in src/policy/registry.cpp";
        if (renews && !has("lease_s"))
            ADD_FAILURE()
                << entry.name << " has Trait::renews_requests: add a setting lease_s to its config by "
                << "detail::lifetime_field (policy/detail/cooperation.hpp), and pass it to LeaseWriter";
    }
}

/// Signals asked for at 130 m, 7.8 s before arrival at the allowed speed.
std::size_t asked_at_130_m(const std::string& policy, const core::Settings& settings) {
    CrossingScene scene;
    scene.add({"e", traffic::VehicleClass::emergency, {"west_A", "A_B", "B_east"}, 1, 489.6 - 130.0, 16.0});
    traffic::BelievedGraph& belief = scene.belief(std::nullopt);
    belief.time = core::Seconds(100.0);
    std::vector<traffic::Lease> leases;
    policy::make_policy(policy, policy::PolicyContext{two_crossings()}, settings)->act(belief, leases);
    return static_cast<std::size_t>(std::ranges::count_if(leases, [](const traffic::Lease& lease) {
        return std::holds_alternative<traffic::HoldGreen>(lease.action);
    }));
}

TEST(PolicyRegistry, passes_settings_to_the_policy_and_through_a_combination) {
    for (const char* const policy : {"preempt_signals", "corridor"}) {
        EXPECT_EQ(asked_at_130_m(policy, {}), 0U) << policy;
        EXPECT_EQ(asked_at_130_m(policy, {{"preempt_signals.lead_s", "12"}}), 1U) << policy;
        EXPECT_EQ(asked_at_130_m(policy, {{"green_wave.before_s", "60"}}), 0U) << policy;
    }
}

TEST(PolicyRegistry, refuses_settings_that_a_policy_does_not_have) {
    for (const char* const policy : {"preempt_signals", "corridor"}) {
        EXPECT_THROW(asked_at_130_m(policy, {{"preempt_signals.leed_s", "12"}}), core::InputError);
        EXPECT_THROW(asked_at_130_m(policy, {{"preempt_signals.lead_s", "61"}}), core::InputError);
    }
}

}  // namespace
}  // namespace clearway::testing
