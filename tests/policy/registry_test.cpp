#include <gtest/gtest.h>

#include "core/error.hpp"
#include "policy/policy.hpp"
#include "support/crossing_scene.hpp"

namespace clearway::testing {
namespace {

TEST(PartRegistry, names_the_nearest_part_for_one_it_does_not_know) {
    try {
        policy::make_policy("disertation", policy::PolicyContext{two_crossings()});
        FAIL() << "no error";
    } catch (const core::InputError& error) {
        ASSERT_EQ(error.problems().size(), 1U);
        EXPECT_NE(error.problems()[0].cure.find("dissertation"), std::string::npos);
        EXPECT_NE(error.problems()[0].allowed.find("listing_5_5"), std::string::npos);
    }
}

TEST(PartRegistry, has_unique_names_and_a_summary_of_one_line_each) {
    std::vector<std::string> names;
    for (const policy::PolicyEntry& entry : policy::policies()) {
        EXPECT_EQ(entry.summary.find('\n'), std::string::npos);
        EXPECT_FALSE(entry.summary.empty());
        names.push_back(entry.name);
    }
    std::ranges::sort(names);
    EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

}  // namespace
}  // namespace clearway::testing
