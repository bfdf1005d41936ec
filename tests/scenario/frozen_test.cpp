#include <map>

#include <gtest/gtest.h>

#include "scenario/prepare.hpp"
#include "scratch.hpp"

namespace clearway::scenario {
namespace {

/// What `v1` means: the hash of everything that a network is built from, and of the demand of replication 0
/// of study seed 1. Every figure of the project is measured on these. A change here makes all of them void:
/// then call it v2.
struct Frozen {
    const char* name;
    const char* network_inputs;
    const char* demand;
    const char* dense_demand;
};
constexpr Frozen frozen_v1[] = {
    {"merge", "7a158d461dbdbce5bc57112292ffc447", "5220ccb5c8eccd93eaa8cd6f802a811f",
     "d364f7eeac262c0467bf11b628d3dc7e"},
    {"intersection", "71f0d66ff033bc7367b314dc07062d79", "cea804307aea0b4848be18d530650772",
     "5bbdf613771519db07aaa5d7ccf96500"},
    {"city", "1e31a5c19d70c22f8250244e990db51d", "6081285ce5a4189090f22571e304b7b6",
     "7e0c7579412720ce20e4e72150ac9ccc"},
    {"grid_signals", "dc8c7fbea2ec34e4120ca4455fcc74e7", "698882c5aff1246af6e76fcde1da29d8",
     "6f83775eff0ab6a94aa9669f6440da9f"},
    {"spider", "351e843dccb67f808e7949e2b1165f2d", "5cfe602d3ad2dc291ec5827e20dabd0a",
     "60eeb22866b11a437b19f1449b547834"},
    {"random_town", "b49ef19a637bbc1524bea3e752151e6c", "f391b453afdd5aaf8b379b4ad8210149",
     "65425a95a88b702b25b929fb50c312c1"},
    {"short_grid", "e608d108bcd3d28871ef007ceca20b72", "7d66ceeef0e7acb14eff43e42461d8c5", ""},
    {"short_ring", "7776cf8e1f0aa00bb19f83fcdfd14d03", "62912f26ffaf56c6118b2a837e219ca7", ""},
    {"short_town", "988206843d17c5cc69b3ae278179d9b7", "8fb3facc7562e7119ee4358a6266a1da", ""},
    {"bologna", "e45a580d8534cd552226c0993a8c9460", "714c3e0b25043cbdf0ed2bca5cc4aec7", ""},
    {"bologna_stretch", "e45a580d8534cd552226c0993a8c9460", "ba249a667b36c2779ff16fcf4df6d91f", ""},
};

std::ostream& operator<<(std::ostream& out, const Frozen& frozen) {
    return out << frozen.name;
}

class FrozenScenario : public ScratchTest, public ::testing::WithParamInterface<Frozen> {};

TEST_P(FrozenScenario, is_still_v1) {
    const Frozen& frozen = GetParam();
    const ScenarioConfig config = load(frozen.name);
    EXPECT_EQ(config.version, "v1");
    const BuiltNetwork network = build_network(config, folder() / "network");
    EXPECT_EQ(network.inputs_hash, frozen.network_inputs);
    const Prepared prepared =
        prepare(config, network, core::StudySeed{1}, core::Replication{0}, folder() / "standard");
    EXPECT_EQ(prepared.demand_hash, frozen.demand);
    if (!config.dense) return;
    Options options;
    options.set("variant", "dense");
    const Prepared dense = prepare(load(frozen.name, options), network, core::StudySeed{1},
                                   core::Replication{0}, folder() / "dense");
    EXPECT_EQ(dense.demand_hash, frozen.dense_demand);
}

INSTANTIATE_TEST_SUITE_P(v1, FrozenScenario, ::testing::ValuesIn(frozen_v1),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace clearway::scenario
