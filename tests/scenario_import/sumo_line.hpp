#pragma once

#include <string>

#include "scenario/prepare.hpp"
#include "town.hpp"

namespace clearway::scenario_import {

/// Imports demand of SUMO on a straight road.
class SumoScenario : public ImportTest {
  protected:
    /// Imports the straight road with the content of a route file.
    ImportRequest line_with(const std::string& routes) const {
        return request({line_network(), write("line.rou.xml", "<routes>" + routes + "</routes>")});
    }
    static std::string car(const std::string& id, double depart_s,
                           const std::string& edges = "first second") {
        return fmt::format("<vehicle id='{}' depart='{}'><route edges='{}'/></vehicle>", id, depart_s, edges);
    }
    static std::string cars(int count) {
        std::string text;
        for (int number = 0; number < count; ++number)
            text += car(fmt::format("car{}", number), 2.0 * number);
        return text;
    }
    scenario::Prepared prepared(const std::string& name = "town") const {
        const scenario::ScenarioConfig config = scenario::load((out() / name).string());
        const scenario::BuiltNetwork network = scenario::build_network(config, folder() / "built");
        return scenario::prepare(config, network, core::StudySeed{1}, core::Replication{0},
                                 folder() / "demand");
    }
    std::string traffic() const { return core::read_file(folder() / "demand" / "traffic.rou.xml"); }
    std::string types() const { return core::read_file(folder() / "demand" / "vehicle_types.add.xml"); }
};

}  // namespace clearway::scenario_import
