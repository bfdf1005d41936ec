#include "view/recorded_run.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/json.hpp"
#include "roads/closure.hpp"
#include "view/drawing.hpp"
#include "view/run_stream.hpp"

namespace clearway::view {

namespace {

/// Where and when a road is blocked; lanes and places as in the drawing.
core::Json json_of(const traffic::Incident& incident, const roads::Network& network) {
    const Origin origin = origin_of(network);
    const roads::Point place = roads::place_of(network, incident);
    core::Json lanes = core::Json::array();
    for (const std::uint32_t number : incident.lanes)
        lanes.push_back(network.lane_of(incident.edge, number).value);
    return {{"edge", incident.edge.value},
            {"lanes", std::move(lanes)},
            {"place", {origin.x(place.x_m), origin.y(place.y_m)}},
            {"from_s", incident.from.value},
            {"to_s", incident.to.value}};
}

}  // namespace

std::string about(const experiment::RunKey& key, const experiment::ConditionSpec& condition,
                  const roads::Network& network, std::span<const traffic::Incident> incidents,
                  const std::string& title) {
    core::Json blocks = core::Json::array();
    for (const traffic::Incident& incident : incidents)
        blocks.push_back(json_of(incident, network));
    const core::Json words = {
        {"run", experiment::to_text(key)}, {"scenario", key.scenario},
        {"condition", key.condition},      {"title", title.empty() ? key.condition : title},
        {"replication", key.replication},  {"policies", condition.policies},
        {"failure", condition.failure},    {"predictor", condition.predictor},
        {"incidents", std::move(blocks)}};
    return words.dump(-1, ' ', false, core::Json::error_handler_t::replace);
}

RunView view_of(trace::RecordingReader& recording, const roads::Network& network, const Window& window,
                StreamConfig config, const std::string& title) {
    const trace::RecordingInfo& info = recording.info();
    RunView view;
    view.about = about(info.key, info.condition, network,
                       trace::incidents_from(info.incidents, experiment::to_text(info.key)), title);
    RunStream stream(origin_of(network), trace::loop_of(info).rules(), std::move(config));
    std::optional<double> first_s;
    double last_s = 0.0;
    while (const auto step = recording.next()) {
        last_s = step->time().value;
        if (!first_s) first_s = last_s;
        const bool is_before = window.from_s && last_s < *window.from_s - core::clock_tolerance_s;
        if (is_before) {
            stream.skip(*step);
        } else if (!window.to_s || last_s <= *window.to_s + core::clock_tolerance_s) {
            if (stream.frames() == 0) view.begin_s = last_s;
            stream.step(*step, view.stream);
            view.end_s = last_s;
        }
    }
    if (stream.frames() == 0)
        throw core::InputError({experiment::to_text(info.key), "no recorded step lies in the window",
                                first_s ? fmt::format("{} to {} s", *first_s, last_s) : "a step", ""});
    return view;
}

}  // namespace clearway::view
