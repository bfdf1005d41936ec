#include "core/error.hpp"
#include "core/json.hpp"
#include "trace/recording.hpp"

namespace clearway::trace {

std::string incidents_text(std::span<const traffic::Incident> incidents) {
    if (incidents.empty()) return "";
    core::Json list = core::Json::array();
    for (const traffic::Incident& incident : incidents) {
        core::Json row = {{"edge", incident.edge.value},
                          {"lanes", incident.lanes},
                          {"position_m", incident.position_m},
                          {"from_s", incident.from.value},
                          {"to_s", incident.to.value},
                          {"speed_past_mps", incident.speed_past_mps},
                          {"emergency_passes", incident.emergency_passes}};
        if (incident.known_after) row["known_after_s"] = incident.known_after->value;
        list.push_back(std::move(row));
    }
    return list.dump();
}

std::vector<traffic::Incident> incidents_from(const std::string& text, const std::string& where) {
    std::vector<traffic::Incident> incidents;
    if (text.empty()) return incidents;
    try {
        for (const core::Json& row : core::Json::parse(text)) {
            traffic::Incident& incident = incidents.emplace_back();
            incident.edge = core::EdgeIndex{row.at("edge").get<std::uint32_t>()};
            row.at("lanes").get_to(incident.lanes);
            row.at("position_m").get_to(incident.position_m);
            incident.from = core::Seconds(row.at("from_s").get<double>());
            incident.to = core::Seconds(row.at("to_s").get<double>());
            row.at("speed_past_mps").get_to(incident.speed_past_mps);
            row.at("emergency_passes").get_to(incident.emergency_passes);
            if (row.contains("known_after_s"))
                incident.known_after = core::Seconds(row.at("known_after_s").get<double>());
        }
    } catch (const core::Json::exception& error) {
        throw core::InputError({where, std::string("incidents cannot be read: ") + error.what(),
                                "what a recording has", "Record the run again"});
    }
    return incidents;
}

}  // namespace clearway::trace
