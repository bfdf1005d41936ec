#pragma once

#include <string>

#include "sumo_line.hpp"

namespace clearway::scenario_import {

/// What an import makes of the demand of files of SUMO.
class SumoDemand : public SumoScenario {
  protected:
    std::string traffic_file() const { return core::read_file(out() / "town" / "traffic.rou.xml"); }
    std::string types_file() const { return core::read_file(out() / "town" / "types.add.xml"); }
    std::string additional_file() const { return core::read_file(out() / "town" / "additional.add.xml"); }
    std::size_t vehicles() const { return count(traffic_file(), "<vehicle "); }

    static std::size_t count(const std::string& text, const std::string& part) {
        std::size_t number = 0;
        for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
            ++number;
        return number;
    }
    /// A configuration over the straight road with `routes`, and its further elements.
    ImportRequest configured(const std::string& routes, const std::string& options,
                             const std::string& additional = "") const {
        line_network();
        write("line.rou.xml", "<routes>" + routes + "</routes>");
        write("line.add.xml", "<additional>\n" + additional + "</additional>");
        return request({write("run.sumocfg",
                              "<configuration><net-file value='line.net.xml'/><route-files "
                              "value='line.rou.xml'/><additional-files value='line.add.xml'/>" +
                                  options + "</configuration>")});
    }
    static std::string flow(const std::string& attributes, const std::string& content = "") {
        return "<flow id='f' " + attributes + "><route edges='first second'/>" + content + "</flow>";
    }
};

}  // namespace clearway::scenario_import
