#include "roads/route_search.hpp"

#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "roads/crossing_network.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::roads {
namespace {

class Search : public ::testing::Test {
  protected:
    static Network read(const std::string& text = crossing_network()) {
        const support::TemporaryFolder folder;
        return Network::read(folder.write("a.net.xml", text));
    }
    /// The crossing, whose lane to the north has these permissions, and who finds a way there.
    static bool leads_north(const char* permissions, Driver driver) {
        const std::string lane = R"(<lane id="north_0" )";
        const Network network =
            read(std::regex_replace(crossing_network(), std::regex(lane), lane + permissions));
        const auto edge = [&](const char* id) { return network.find_edge(id).value(); };
        RouteSearch search(network, driver);
        std::vector<core::EdgeIndex> way;
        const auto free_s = [&](core::EdgeIndex at, double) { return search.free_s(at); };
        const bool found = search.search({edge("south"), edge("north")}, free_s, way) != no_way_s;
        EXPECT_EQ(way.empty(), !found);
        EXPECT_EQ(search.time_of(std::vector{edge("south"), edge("north")}, 0.0, free_s) != no_way_s, found);
        return found;
    }
    core::EdgeIndex edge(const char* id) const { return network_.find_edge(id).value(); }
    auto free() {
        return [this](core::EdgeIndex at, double) { return search_.free_s(at); };
    }

    Network network_ = read();
    RouteSearch search_{network_, Driver::car};
    std::vector<core::EdgeIndex> way_;
};

TEST_F(Search, CountsEdgesAndJunctions) {
    // east 200 m at 10 m/s, across the junction 10 m at 10 m/s.
    EXPECT_DOUBLE_EQ(search_.search({edge("south"), edge("east"), 2.0}, free(), way_), 2.0 + 1.0 + 20.0);
    EXPECT_EQ(way_, (std::vector{edge("south"), edge("east")}));
    EXPECT_DOUBLE_EQ(search_.time_of(way_, 2.0, free()), 23.0);
}

TEST_F(Search, FindsNothingWhereTurnsOrPermissionsForbid) {
    EXPECT_EQ(search_.search({edge("west"), edge("north"), 0.0}, free(), way_), no_way_s);
    EXPECT_TRUE(way_.empty());
    EXPECT_EQ(search_.free_s(edge("path")), no_way_s) << "for pedestrians";
    EXPECT_EQ(search_.search({edge("west"), edge("path"), 0.0}, free(), way_), no_way_s);
    const std::vector gap{edge("west"), edge("north")};
    EXPECT_EQ(search_.time_of(gap, 0.0, free()), no_way_s);
}

TEST_F(Search, HasThePermissionsOfWhoDrives) {
    EXPECT_TRUE(leads_north("", Driver::car));
    EXPECT_TRUE(leads_north("", Driver::emergency));
    EXPECT_FALSE(leads_north(R"(allow="emergency" )", Driver::car));
    EXPECT_TRUE(leads_north(R"(allow="emergency" )", Driver::emergency));
    EXPECT_TRUE(leads_north(R"(disallow="emergency" )", Driver::car));
    EXPECT_FALSE(leads_north(R"(disallow="emergency" )", Driver::emergency));
}

TEST_F(Search, TakesTheLaneThatIsOpenToTheDriver) {
    // The faster lane of west is closed to cars.
    const std::string slow =
        std::regex_replace(crossing_network(), std::regex(R"re((<lane id="west_0".*speed=")20)re"), "$0110");
    const Network network = read(slow);
    const core::EdgeIndex west = network.find_edge("west").value();
    EXPECT_DOUBLE_EQ(RouteSearch(network, Driver::car).free_s(west), 10.0);
    EXPECT_DOUBLE_EQ(RouteSearch(network, Driver::emergency).free_s(west), 5.0);
}

TEST_F(Search, TheDestinationIsReachedWhereOneStands) {
    EXPECT_DOUBLE_EQ(search_.search({edge("east"), edge("east"), 3.0}, free(), way_), 3.0);
    EXPECT_EQ(way_, std::vector{edge("east")});
}

TEST_F(Search, TimesFollowTheMomentOfEntry) {
    const auto slow_later = [&](core::EdgeIndex at, double entered_s) {
        return search_.free_s(at) * (entered_s < 10.0 ? 1.0 : 2.0);
    };
    EXPECT_DOUBLE_EQ(search_.search({edge("south"), edge("east"), 2.0}, slow_later, way_), 23.0);
    EXPECT_DOUBLE_EQ(search_.search({edge("south"), edge("east"), 9.5}, slow_later, way_), 10.5 + 40.0);
}

TEST_F(Search, KnowsAWayThatPassesItsEnd) {
    EXPECT_FALSE(passes_its_end(std::vector{edge("south"), edge("east")}));
    EXPECT_TRUE(passes_its_end(std::vector{edge("east"), edge("back"), edge("west"), edge("east")}));
}

TEST_F(Search, AClosedEdgeIsNoWay) {
    const auto closed = [&](core::EdgeIndex at, double) {
        return at == edge("east") ? no_way_s : search_.free_s(at);
    };
    EXPECT_EQ(search_.search({edge("south"), edge("east"), 0.0}, closed, way_), no_way_s);
}

}  // namespace
}  // namespace clearway::roads
