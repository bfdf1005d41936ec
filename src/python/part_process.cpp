#include "python/part_process.hpp"

#include <chrono>
#include <csignal>
#include <optional>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/process.hpp"
#include "python/interpreter.hpp"

namespace clearway::python {
namespace {

using Json = nlohmann::ordered_json;

/// Starts Python, which inherits the descriptors: this process has one thread, so nothing else can.
pid_t start(const Descriptors& theirs) {
    for (const int descriptor : {theirs.memory, theirs.read, theirs.write})
        ::fcntl(descriptor, F_SETFD, 0);
    return core::start(
               run_module("clearway._host", {std::to_string(theirs.memory), std::to_string(theirs.read),
                                             std::to_string(theirs.write)}))
        .pid;
}

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
    return {{"edges", edges}, {"lane_ids", lanes}, {"lanes", lanes_of(network)}, {"signals", signals}};
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

OwnedChild::~OwnedChild() {
    if (pid_ < 0) return;
    ::kill(pid_, SIGTERM);
    const core::Child child{pid_, std::chrono::steady_clock::now()};
    constexpr int patience_ms = 1000;
    for (int waited_ms = 0; waited_ms < patience_ms; ++waited_ms) {
        if (core::poll(child)) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ::kill(pid_, SIGKILL);
    core::wait(child);
}

std::string OwnedChild::wait() {
    const core::Child child{std::exchange(pid_, -1), std::chrono::steady_clock::now()};
    return core::wait(child).describe();
}

PartProcess::PartProcess(const PartName& name, const Greeting& greeting)
    : label_(fmt::format("{} of {}", name.object.empty() ? "module" : name.object, name.file.string())),
      question_(channel_.outgoing(), greeting.question),
      answer_(channel_.incoming(), greeting.answer),
      child_(start(channel_.theirs())) {
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
    if (bell == Bell::failed) throw PartError(fmt::format("{}: {}", label_, channel_.read_text()));
}

void PartProcess::report_end() {
    throw PartError(
        fmt::format("{}: its process ended ({}) instead of answering; what it printed is in the log", label_,
                    child_.wait()));
}

void check_part(const PartName& name, PartKind kind, const core::Settings& settings,
                const std::string& where) {
    try {
        const PartProcess process(name, {.kind = kind, .settings = settings});
    } catch (const PartError& error) {
        throw core::InputError(
            {where, error.what(), "", "Correct the file; CLEARWAY_PYTHON names another Python"});
    }
}

}  // namespace clearway::python
