#include "scenario/sumo_files.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/files.hpp"
#include "core/markup.hpp"

namespace clearway::scenario {

namespace {

std::string emergency_xml(const std::vector<traffic::EmergencyDeparture>& departures, const SumoRun& run) {
    std::string device;
    const auto add = [&](const char* key, const std::string& value) {
        device += fmt::format("        <param key=\"{}\" value=\"{}\"/>\n", key, value);
    };
    if (run.bluelight == traffic::BlueLight::on) add("has.bluelight.device", "true");
    if (run.rerouting_s > 0.0) {
        add("has.rerouting.device", "true");
        add("device.rerouting.period", fmt::format("{}", run.rerouting_s));
    }
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<routes>\n";
    for (const traffic::EmergencyDeparture& departure : departures)
        xml += fmt::format(
            "    <vehicle id=\"{}\" type=\"{}\" depart=\"{:.2f}\" departLane=\"{}\" departSpeed=\"{}\"{}>\n  "
            "  "
            "    <route edges=\"{}\"/>\n{}    </vehicle>\n",
            core::escaped(departure.id), core::escaped(departure.type), departure.depart.value,
            departure.depart_lane, departure.depart_speed,
            departure.arrival ? fmt::format(" arrivalPos=\"{:.2f}\"", departure.arrival->value) : "",
            core::escaped(fmt::format("{}", fmt::join(departure.edges, " "))), device);
    return xml + "</routes>\n";
}

/// Copies the additional files next to the others and returns their names.
std::string copied(const std::vector<std::filesystem::path>& files, const std::filesystem::path& folder) {
    std::string names;
    std::size_t number = 0;
    for (const std::filesystem::path& file : files) {
        const std::string name =
            number == 0 ? "vehicle_types.add.xml" : fmt::format("additional{}.add.xml", number);
        const std::string content = core::read_file(file);
        core::write_atomically(folder / name, content);
        names += (number++ == 0 ? "" : ",") + name;
    }
    return names;
}

}  // namespace

void write_sumo_files(const ScenarioConfig& config, const BuiltNetwork& network, const SumoRun& run,
                      const std::filesystem::path& folder) {
    const Prepared prepared = prepare(config, network, run.seed, run.replication, folder);
    core::write_atomically(folder / "network.net.xml", core::read_file(prepared.network_file));
    core::write_atomically(folder / "emergency.rou.xml", emergency_xml(prepared.emergency, run));
    std::string routes = "traffic.rou.xml,emergency.rou.xml";
    for (std::size_t row = 1; row < prepared.route_files.size(); ++row)  // after traffic.rou.xml
        routes += "," + prepared.route_files[row].filename().string();
    const std::string lateral =
        run.lateral_model == traffic::LateralModel::sublane
            ? fmt::format("    <lateral-resolution value=\"{}\"/>\n", sublane_resolution_m)
            : "";
    const std::string blockers = prepared.time.ignore_junction_blocker_s
                                     ? fmt::format("    <ignore-junction-blocker value=\"{}\"/>\n",
                                                   *prepared.time.ignore_junction_blocker_s)
                                     : "";
    std::string options;
    for (const std::string& option : prepared.options) {
        const std::size_t equals = option.find('=');
        options +=
            fmt::format("    <{} value=\"{}\"/>\n", option.substr(0, equals), option.substr(equals + 1));
    }
    const std::string additional = copied(prepared.additional_files, folder);
    core::write_atomically(
        folder / "run.sumocfg",
        fmt::format(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<configuration>\n"
            "    <net-file value=\"network.net.xml\"/>\n"
            "    <route-files value=\"{}\"/>\n"
            "    <additional-files value=\"{}\"/>\n    <begin value=\"0\"/>\n    <end value=\"{}\"/>\n"
            "    <step-length value=\"{}\"/>\n    <seed value=\"{}\"/>\n"
            "    <time-to-teleport value=\"{}\"/>\n{}{}{}    <xml-validation value=\"never\"/>\n"
            "    <collision.action value=\"warn\"/>\n</configuration>\n",
            routes, additional, prepared.time.horizon_s, prepared.time.step_length_s, prepared.simulator_seed,
            prepared.time.time_to_teleport_s.value_or(300.0), blockers, lateral, options));
}

}  // namespace clearway::scenario
