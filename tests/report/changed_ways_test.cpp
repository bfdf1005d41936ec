#include "report/detail/changed_ways.hpp"

#include <gmock/gmock.h>

namespace clearway::report::detail {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// a -> b -> c -> d -> e, and a -> x -> y -> e.
RoadMap two_ways() {
    RoadMap roads;
    const auto add = [&](const char* id, std::vector<std::size_t> to) {
        MapEdge edge;
        edge.id = id;
        edge.to = std::move(to);
        roads.edges.push_back(edge);
    };
    add("a", {1, 5});
    add("b", {2});
    add("c", {3});
    add("d", {4});
    add("e", {});
    add("x", {6});
    add("y", {4});
    return roads;
}

class ChangedWays : public testing::Test {
  protected:
    std::map<std::string, DrivenWay> ways(const std::vector<std::string>& edges,
                                          const std::string& vehicle = "ev") const {
        EdgePlaces places;
        for (std::size_t edge = 0; edge < roads_.edges.size(); ++edge)
            places[roads_.edges[edge].id] = edge;
        metrics::TrafficTables tables;
        for (const std::string& edge : edges)
            tables.edge_times.push_back({vehicle, edge, 10.0 * static_cast<double>(++at_), 4.0});
        return driven_ways(tables, places, roads_);
    }
    std::vector<ChangedWay> changed(const std::vector<std::string>& without,
                                    const std::vector<std::string>& with) const {
        ScenarioMap map;
        add_changed_ways(ways(without), ways(with), 3, map);
        EXPECT_EQ(map.trips, 1U);
        return map.changed_ways;
    }

    const RoadMap roads_ = two_ways();
    mutable int at_ = 0;
};

TEST_F(ChangedWays, are_those_of_vehicles_that_drove_other_edges) {
    const std::vector<ChangedWay> found = changed({"a", "b", "c", "d", "e"}, {"a", "x", "y", "e"});
    ASSERT_THAT(found, SizeIs(1));
    EXPECT_EQ(found[0].vehicle, "ev");
    EXPECT_EQ(found[0].replication, 3U);
    EXPECT_THAT(found[0].baseline, ElementsAre(0, 1, 2, 3, 4));
    EXPECT_THAT(found[0].condition, ElementsAre(0, 5, 6, 4));
    EXPECT_DOUBLE_EQ(found[0].baseline_s, 44.0) << "entered every ten seconds, the last one for four";
    EXPECT_DOUBLE_EQ(found[0].gain_s(), 10.0);
}

TEST_F(ChangedWays, are_not_those_that_lack_times_of_edges) {
    EXPECT_THAT(changed({"a", "b", "c", "d", "e"}, {"a", "e"}), SizeIs(1))
        << "the way with fewest edges between them is the other one";
    EXPECT_THAT(changed({"a", "b", "c", "d", "e"}, {"a", "b", "e"}), IsEmpty());
    EXPECT_THAT(changed({"b", "e"}, {"b", "c", "d", "e"}), IsEmpty());
}

TEST_F(ChangedWays, are_not_those_that_end_on_the_same_way) {
    EXPECT_THAT(changed({"a", "b", "c"}, {"a", "b", "c", "d", "e"}), IsEmpty());
    EXPECT_THAT(changed({"a", "b", "c"}, {"a", "x"}), SizeIs(1));
}

TEST_F(ChangedWays, need_both_runs_and_edges_of_the_map) {
    ScenarioMap map;
    add_changed_ways(ways({"a", "b"}, "one"), ways({"a", "x"}, "other"), 0, map);
    EXPECT_EQ(map.trips, 0U);
    EXPECT_THAT(ways({"a", "elsewhere"}), IsEmpty());
}

}  // namespace
}  // namespace clearway::report::detail
