#include <cstdlib>

#include <gtest/gtest.h>

#include "policy/recover_signals.hpp"
#include "roads/short_loops.hpp"
#include "scenario/config.hpp"
#include "scenario/network.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::testing {
namespace {

/// Every published figure but those of docs/findings/short-blocks.md is from a network without loops of short
/// blocks, so no signal stands back in any of them. In the city the two carriageways of a street with a
/// signal each would be one, if they did not count as one place.
TEST(ShippedScenarios, have_short_loops_only_where_they_are_made_for_it) {
    setenv("SUMO_HOME", "/usr/share/sumo", 0);
    setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1);
    for (const std::string& name : scenario::list()) {
        const support::TemporaryFolder folder;
        const scenario::BuiltNetwork built =
            scenario::build_network(scenario::load(name), folder.path() / "network");
        EXPECT_EQ(roads::on_short_loops(built.network, policy::RecoverSignalsConfig{}.short_block_m).empty(),
                  !name.starts_with("short_"))
            << name;
    }
}

}  // namespace
}  // namespace clearway::testing
