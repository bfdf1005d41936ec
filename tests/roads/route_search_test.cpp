#include "roads/route_search.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "roads/crossing_network.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::roads {
namespace {

class Search : public ::testing::Test {
  protected:
    static Network read() {
        const support::TemporaryFolder folder;
        const auto file = folder.path() / "a.net.xml";
        std::ofstream(file) << crossing_network();
        return Network::read(file);
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
