// Trips without a route: SUMO chooses their way when they depart, by the traffic of the moment, in an import
// too.
#include <map>

#include <gmock/gmock.h>

#include "roads/network.hpp"
#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/sumo_trial.hpp"
#include "sumo_line.hpp"

namespace clearway::scenario_import {
namespace {

using testing::HasSubstr;

/// Trips through a grid of short blocks with signals, so many that free flow is not what they meet.
class SumoTrips : public SumoScenario {
  protected:
    void SetUp() override {
        SumoScenario::SetUp();
        run_tool("netgenerate",
                 {"--grid", "--grid.number", "5", "--grid.length", "120", "--default-junction-type",
                  "traffic_light", "--output-file", (folder() / "grid.net.xml").string()});
        std::vector<std::string> edges;
        const roads::Network network = roads::Network::read(folder() / "grid.net.xml");
        for (const roads::Edge& edge : network.edges())
            if (!edge.internal) edges.push_back(edge.id);
        std::string trips;
        for (std::size_t number = 0; number < 500; ++number)
            trips +=
                fmt::format("<trip id='v{}' depart='{:.1f}' from='{}' to='{}' departLane='best'/>\n", number,
                            1.2 * static_cast<double>(number), edges[(7 * number) % edges.size()],
                            edges[(31 * number + 11) % edges.size()]);
        write("grid.rou.xml", "<routes>" + trips + "</routes>");
    }

    ImportRequest request_with(const std::string& options) const {
        ImportRequest made = request({write("run.sumocfg",
                                            "<configuration><net-file value='grid.net.xml'/>"
                                            "<route-files value='grid.rou.xml'/>" +
                                                options + "</configuration>")});
        made.automated_share = 0.0;
        return made;
    }

    /// What plain SUMO says of each vehicle: arrival, length of the way, time loss.
    std::map<std::string, std::string> trips_of(std::vector<std::string> arguments) const {
        const std::filesystem::path out = folder() / "tripinfo.xml";
        arguments.insert(arguments.end(),
                         {"--end", "3600", "--no-warnings", "--tripinfo-output", out.string()});
        run_tool("sumo", arguments);
        std::map<std::string, std::string> trips;
        detail::for_each_element(out, [&](detail::Element&& trip) {
            trips[trip.text("id")] = fmt::format("{} {} {}", trip.text("arrival"), trip.text("routeLength"),
                                                 trip.text("timeLoss"));
        });
        return trips;
    }
    std::map<std::string, std::string> plain(std::vector<std::string> options = {}) const {
        options.insert(options.begin(), {"--net-file", (folder() / "grid.net.xml").string(), "--route-files",
                                         (folder() / "grid.rou.xml").string(), "--no-step-log"});
        return trips_of(std::move(options));
    }
};

TEST_F(SumoTrips, are_routed_at_departure_as_by_plain_sumo_to_the_vehicle) {
    const Findings findings = run(request_with(""));
    EXPECT_EQ(findings.routed_at_departure, 500U);
    EXPECT_THAT(findings.demand, HasSubstr("trips without a route routed by SUMO at departure"));
    const auto expected = plain();
    ASSERT_EQ(expected.size(), 500U);
    const scenario::Prepared made = prepared();
    EXPECT_EQ(trips_of(detail::sumo_arguments(made)), expected);

    std::string without = traffic();
    const std::string mark = " reroute=\"true\"";
    for (std::size_t at = without.find(mark); at != std::string::npos; at = without.find(mark))
        without.erase(at, mark.size());
    write("demand/traffic.rou.xml", without);
    EXPECT_NE(trips_of(detail::sumo_arguments(made)), expected)
        << "the ways at free flow, without SUMO's mark of trips";
}

TEST_F(SumoTrips, choose_again_on_their_way_where_the_configuration_says_so) {
    run(request_with("<device.rerouting.probability value='1'/><device.rerouting.period value='60'/>"));
    const auto expected = plain({"--device.rerouting.probability", "1", "--device.rerouting.period", "60"});
    EXPECT_EQ(trips_of(detail::sumo_arguments(prepared())), expected);
    EXPECT_NE(plain(), expected) << "the option matters here";
}

TEST_F(SumoTrips, get_the_routing_device_with_the_share_of_the_configuration) {
    write(
        "grid.rou.xml", "<routes>" + [] {
            std::string cars;
            for (int number = 0; number < 200; ++number)
                cars += fmt::format("<vehicle id='c{}' depart='{}'><route edges='A0A1 A1A2'/></vehicle>",
                                    number, number);
            return cars;
        }() + "</routes>");
    run(request_with("<device.rerouting.probability value='0.25'/>"));
    const std::string written = core::read_file(out() / "town" / "traffic.rou.xml");
    std::size_t equipped = 0;
    for (std::size_t at = written.find("has.rerouting"); at != std::string::npos;
         at = written.find("has.rerouting", at + 1))
        ++equipped;
    EXPECT_GT(equipped, 25U);
    EXPECT_LT(equipped, 75U);
}

}  // namespace
}  // namespace clearway::scenario_import
