// The example as its page tells to add it: this program has the registry and the scenes of follow_guide.py.

#include <gtest/gtest.h>

#include "actuation/fakes.hpp"
#include "core/error.hpp"
#include "policy/policy.hpp"

namespace clearway::testing {
namespace {

TEST(OwnPolicyGuide, the_policy_is_there_with_its_setting_and_renews_requests) {
    ASSERT_TRUE(policy::policies().is("keep_distance", traffic::Trait::renews_requests));
    const policy::PolicyContext context{two_crossings()};
    EXPECT_EQ(policy::make_policy("keep_distance", context, {{"keep_distance.reach_m", "30"}})->name(),
              "keep_distance");
    EXPECT_THROW(policy::make_policy("keep_distance", context, {{"keep_distance.reach_m", "0"}}),
                 core::InputError);
}

}  // namespace
}  // namespace clearway::testing
