// What leases of a user's code may name.
#include "policy/detail/known_targets.hpp"

#include <gmock/gmock.h>

#include "python/channel.hpp"
#include "roads/crossing_network.hpp"
#include "support/message_of.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::policy::detail {
namespace {

using ::testing::HasSubstr;

roads::Network drawn(const std::string& text) {
    const support::TemporaryFolder folder;
    return roads::Network::read(folder.write("a.net.xml", text));
}

/// What a lease of a way over these edges is told; empty if nothing is wrong.
std::string told(const roads::Network& network, std::initializer_list<const char*> ids) {
    const core::VehicleKey vehicle{7};
    traffic::BelievedGraph belief;
    belief.own_states.emplace_back().key = vehicle;
    KnownTargets targets(network);
    targets.see(belief);
    traffic::Lease lease;
    lease.target = vehicle;
    traffic::TakeRoute way;
    for (const char* id : ids)
        way.edges.push_back(network.find_edge(id).value());
    lease.action = way;
    return support::message_of<python::PartError>([&] { targets.check(lease); });
}

TEST(KnownTargets, a_way_with_a_gap_is_told_with_its_two_edges_and_what_may_follow) {
    const roads::Network network = drawn(roads::crossing_network());
    EXPECT_EQ(told(network, {"back", "west", "east", "back"}), "");
    EXPECT_EQ(told(network, {"south", "north"}), "");
    EXPECT_THAT(
        told(network, {"back", "west", "north"}),
        HasSubstr("no emergency vehicle gets from edge \"west\" to edge \"north\" (allowed next: east; "
                  "belief.network.onward"));
    EXPECT_THAT(told(network, {"north", "path"}),
                HasSubstr("\"north\" to edge \"path\" (allowed next: none;"));
}

TEST(KnownTargets, a_way_over_an_edge_that_is_closed_to_emergency_vehicles_has_a_gap) {
    const std::string closed = R"(<lane id="north_0" disallow="emergency")";
    const roads::Network network =
        drawn(std::regex_replace(roads::crossing_network(), std::regex(R"(<lane id="north_0")"), closed));
    EXPECT_THAT(told(network, {"south", "north"}),
                HasSubstr("from edge \"south\" to edge \"north\" (allowed next: east;"));
    EXPECT_EQ(told(network, {"south", "east"}), "");
}

}  // namespace
}  // namespace clearway::policy::detail
