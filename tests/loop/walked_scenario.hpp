#pragma once

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "core/process.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::test {

/// A scenario as an import makes it of one of SUMO with persons: a crossing with a signal, sidewalks and
/// crossings, 60 cars that go straight on, three EVs, and slow people who cross the roads. Removed at the
/// end.
class WalkedScenario {
  public:
    static constexpr int persons = 60;

    WalkedScenario() {
        std::filesystem::create_directories(folder());
        const core::Exit made =
            core::run({.program = "netgenerate",
                       .arguments = {"--grid", "--grid.number", "1", "--grid.attach-length", "250",
                                     "--default-junction-type", "traffic_light", "--default.lanenumber", "2",
                                     "--sidewalks.guess", "--crossings.guess", "--output-file",
                                     (folder() / "network.net.xml").string()},
                       .environment = {},
                       .output = parent_.path() / "netgenerate.log"});
        if (!made.ok()) throw std::runtime_error("netgenerate fails");
        parent_.write("walked/traffic.rou.xml", traffic());
        parent_.write("walked/persons.rou.xml", walkers());
        parent_.write("walked/scenario.toml",
                      "name = \"walked\"\nversion = \"test\"\n[network]\nfile = \"network.net.xml\"\n"
                      "[time]\nwarm_up_s = 60.0\nwindow_s = 180.0\nhorizon_s = 900.0\n"
                      "[demand]\nemergency = 3\n"
                      "[measured]\nemergency_minimum_length_m = 400.0\nroutes = [\"traffic.rou.xml\"]\n"
                      "persons = [\"persons.rou.xml\"]\n[[measured.type]]\nid = \"car\"\n");
    }

    std::filesystem::path folder() const { return parent_.path() / "walked"; }

  private:
    static std::string traffic() {
        std::string xml = "<routes>\n";
        for (int number = 0; number < 60; ++number)
            xml +=
                fmt::format("<vehicle id=\"{}\" type=\"car\" depart=\"{}\"><route edges=\"{}\"/></vehicle>\n",
                            number, 3 * number, number % 2 == 0 ? "left0A0 A0right0" : "bottom0A0 A0top0");
        return xml + "</routes>\n";
    }
    static std::string walkers() {
        constexpr std::array walks = {"left0A0 A0left0", "bottom0A0 A0bottom0", "A0right0 right0A0"};
        std::string xml =
            "<routes>\n<vType id=\"slow\" vClass=\"pedestrian\" maxSpeed=\"0.7\" speedDev=\"0.1\"/>\n";
        for (int number = 0; number < persons; ++number)
            xml += fmt::format(
                "<person id=\"{0}\" type=\"slow\" depart=\"{1}\" departPos=\"{2}\"><walk "
                "edges=\"{3}\" arrivalPos=\"{2}\"/></person>\n",
                number, 3 * number, number % 3 == 2 ? 15 : 225, walks[number % 3]);
        return xml + "</routes>\n";
    }

    support::TemporaryFolder parent_;
};

}  // namespace clearway::test
