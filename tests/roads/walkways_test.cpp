#include "roads/walkways.hpp"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace clearway::roads {
namespace {

/// The road with sidewalks and one crossing, at J: `in` W-J and `out` J-E on one side, `in2` E-J and `out2`
/// J-W on the other; the sides also meet at both ends of the road.
class WalkwaysTest : public ::testing::Test {
  protected:
    /// The network without the connections that name `mark`.
    Network without(const std::string& mark) const {
        std::istringstream lines(text());
        std::string kept;
        for (std::string line; std::getline(lines, line);)
            if (line.find("<connection") == std::string::npos || line.find(mark) == std::string::npos)
                kept += line + "\n";
        return read(kept);
    }
    Network read(const std::string& text) const { return Network::read(folder_.write("test.net.xml", text)); }
    static std::string text() {
        std::ifstream stream(CLEARWAY_SOURCE_DIR "/tests/support/data/footway.net.xml");
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    static std::optional<std::string> fault(const Network& network, const std::string& ids) {
        std::vector<core::EdgeIndex> edges;
        std::istringstream words(ids);
        for (std::string id; words >> id;)
            edges.push_back(network.find_edge(id).value());
        return Walkways(network).fault(edges);
    }
    static std::string gap(const std::string& from, const std::string& to) {
        return "its walk has a gap: nobody gets from edge \"" + from + "\" to \"" + to + "\" on foot";
    }

  private:
    support::TemporaryFolder folder_;
};

TEST_F(WalkwaysTest, LeadOverWalkingAreasAndCrossingsInEitherDirection) {
    const Network network = read(text());
    for (const char* const walk : {"in", "in out", "out in", "in out2", "out in2 out2", "out in2 in"})
        EXPECT_EQ(fault(network, walk), std::nullopt) << walk;
    EXPECT_EQ(fault(network, "in out out2"), gap("out", "out2"))
        << "it would turn round in the middle of the way";
    EXPECT_EQ(fault(network, "in in out2"), "its walk comes back to edge \"in\" at once");
    EXPECT_EQ(fault(network, "in out in"), "its walk comes back to edge \"in\" at once");
}

TEST_F(WalkwaysTest, EndWhereNoCrossingLeadsOver) {
    const Network network = without("_c0\"");
    EXPECT_EQ(fault(network, "in out in2"), std::nullopt) << "round the end of the road";
    EXPECT_EQ(fault(network, "out in2 in"), gap("in2", "in"));
}

TEST_F(WalkwaysTest, LeadStraightOverAJunctionWhereTheLaneEndsAtNoWalkingArea) {
    EXPECT_EQ(fault(without("_w"), "out in2 in"), std::nullopt);
    EXPECT_EQ(fault(without("_w"), "in out out2"), gap("out", "out2"));
    EXPECT_EQ(fault(without("from=\":J_w"), "in out"), gap("in", "out"))
        << "into an area that nothing leads out of";
    EXPECT_EQ(fault(without(":W_w"), "in out2"), std::nullopt) << "over the crossing";
    EXPECT_EQ(fault(without(":W_w"), "in2 out"), std::nullopt) << "over the crossing or by E";
}

TEST_F(WalkwaysTest, AreNotTrustedWhereSumoCouldSetOutTheWrongWay) {
    std::istringstream lines(text());
    std::string kept;
    for (std::string line; std::getline(lines, line);)
        if (line.find("<connection") == std::string::npos ||
            (line.find("_c0\"") == std::string::npos && line.find(":W_w") == std::string::npos))
            kept += line + "\n";
    EXPECT_EQ(fault(read(kept), "in out2"), gap("in", "out2")) << "no crossing at J, straight over at W";
}

TEST_F(WalkwaysTest, AreClosedWhereNoLaneIsOpenToPedestrians) {
    std::string closed = text();
    const std::string lane = "<lane id=\"out_0\" index=\"0\" allow=\"pedestrian\"";
    closed.replace(closed.find(lane), lane.size(), "<lane id=\"out_0\" index=\"0\" allow=\"bicycle\"");
    const Network network = read(closed);
    const Walkways walkways(network);
    EXPECT_TRUE(walkways.open(*network.find_edge("in")));
    EXPECT_FALSE(walkways.open(*network.find_edge("out")));
    EXPECT_EQ(fault(network, "in out"), "edge \"out\" is closed to pedestrians");
}

}  // namespace
}  // namespace clearway::roads
