#include "python/part_process.hpp"

#include <csignal>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "roads/exits.hpp"

namespace clearway::python {
namespace {

using Json = nlohmann::ordered_json;

Json lanes_of(const roads::Network& network) {
    Json edge = Json::array(), number = Json::array(), length = Json::array(), limit = Json::array();
    for (const roads::Lane& lane : network.lanes()) {
        edge.push_back(lane.edge.value);
        number.push_back(lane.number);
        length.push_back(lane.length_m);
        limit.push_back(lane.speed_limit_mps);
    }
    return {{"edge", edge}, {"number", number}, {"length_m", length}, {"speed_limit_mps", limit}};
}

/// By edge, the edges that an emergency vehicle may turn into.
Json onward_of(const roads::Network& network) {
    Json onward = Json::array();
    for (std::uint32_t row = 0; row < network.edges().size(); ++row) {
        Json& next = onward.emplace_back(Json::array());
        if (network.edge(core::EdgeIndex{row}).internal) continue;
        for (const core::EdgeIndex to : roads::exits(network, core::EdgeIndex{row}, roads::Driver::emergency))
            next.push_back(to.value);
    }
    return onward;
}

Json network_json(const roads::Network& network) {
    Json edges = Json::array(), lanes = Json::array(), signals = Json::array();
    for (const roads::Edge& edge : network.edges())
        edges.push_back({edge.id, edge.lane_count, edge.internal});
    for (const roads::Lane& lane : network.lanes())
        lanes.push_back(lane.id);
    for (const roads::Signal& signal : network.signals()) {
        Json phases = Json::array();
        for (const roads::Phase& phase : signal.program)
            phases.push_back(phase.state);
        signals.push_back({signal.id, phases});
    }
    return {{"edges", edges},
            {"lane_ids", lanes},
            {"lanes", lanes_of(network)},
            {"onward", onward_of(network)},
            {"signals", signals}};
}

}  // namespace

std::string to_json(const PartName& name, const Greeting& greeting) {
    const Json object = {
        {"file", name.file.string()},
        {"object", name.object},
        {"settings", greeting.settings},
        {"kind", greeting.kind == PartKind::policy ? "policy" : "predictor"},
        {"question", Json::parse(to_json(greeting.question))},
        {"answer", Json::parse(to_json(greeting.answer))},
        {"period_s", greeting.period_s},
        {"link_radius_m", greeting.link_radius_m},
        {"network", greeting.network == nullptr ? Json(nullptr) : network_json(*greeting.network)}};
    return object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

PartProcess::PartProcess(const PartName& name, const Greeting& greeting)
    : label_(fmt::format("{} of {}", name.object.empty() ? "module" : name.object, name.file.string())),
      question_(channel_.outgoing(), greeting.question),
      answer_(channel_.incoming(), greeting.answer),
      host_(channel_.theirs()) {
    channel_.close_theirs();
    channel_.write_text(to_json(name, greeting));
    if (!channel_.ring(Bell::hello)) report_end();
    wait_for_answer();
}

void PartProcess::ask() {
    if (!channel_.ring(Bell::decide)) report_end();
    wait_for_answer();
}

void PartProcess::wait_for_answer() {
    Bell bell{};
    if (!channel_.wait(bell)) report_end();
    if (bell == Bell::lost)
        throw PartLost(fmt::format("{}: the machine failed it, so give the same command again: {}", label_,
                                   channel_.read_text()),
                       0);
    if (bell == Bell::failed) throw PartError(fmt::format("{}: {}", label_, channel_.read_text()));
    if (bell != Bell::answer)
        throw PartError(fmt::format("{}: it answered with byte {}, which no part does", label_,
                                    static_cast<unsigned>(static_cast<unsigned char>(bell))));
}

void PartProcess::report_end() {
    const std::optional<core::Exit> end = host_.wait();
    if (!end)
        throw PartLost(
            fmt::format("{}: its process was killed with the one that all parts come from", label_), SIGKILL);
    if (end->signal == SIGKILL)
        throw PartLost(fmt::format("{}: its process was {}, as the system does where memory is short: give "
                                   "the same command again; what it printed is in the log",
                                   label_, end->describe()),
                       SIGKILL);
    throw PartError(
        fmt::format("{}: its process ended ({}) instead of answering; what it printed is in the log", label_,
                    end->describe()));
}

void check_part(const PartName& name, PartKind kind, const core::Settings& settings,
                const std::string& where) {
    try {
        const PartProcess process(name, {.kind = kind, .settings = settings});
    } catch (const PartError& error) {
        throw core::InputError({where, error.what(), "", "Correct the file or the settings"});
    } catch (const PartLost& error) {
        throw core::EnvironmentError(fmt::format("{}: {}", where, error.what()));
    }
}

}  // namespace clearway::python
