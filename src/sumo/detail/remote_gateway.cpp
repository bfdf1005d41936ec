#include <csignal>
#include <future>
#include <memory>
#include <thread>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>
#include <libsumo/libtraci.h>
#include <unistd.h>

#include "sumo/detail/api_gateway.hpp"

namespace clearway::sumo::detail::gateway {
namespace {

namespace api = ::libtraci;
namespace key = ::libsumo;

constexpr const char* view = "View #0";  // sumo-gui's first view

using Results = ::libsumo::TraCIResults;

const std::vector<int>& read_variables() {
    static const std::vector<int> variables = {
        key::VAR_POSITION,     key::VAR_LANE_ID,      key::VAR_ANGLE,       key::VAR_SPEED,
        key::VAR_ACCELERATION, key::VAR_LANEPOSITION, key::VAR_ROUTE_INDEX, key::VAR_ROUTE_ID};
    return variables;
}

template <class Result>
const Result& result(const Results& results, int variable) {
    const auto found = results.find(variable);
    const auto* const typed =
        found == results.end() ? nullptr : dynamic_cast<const Result*>(found->second.get());
    if (typed == nullptr)
        throw core::SimulatorError(fmt::format("SUMO does not report the variable 0x{:02x}", variable));
    return *typed;
}

double number(const Results& results, int variable) {
    return result<::libsumo::TraCIDouble>(results, variable).value;
}

const std::string& text(const Results& results, int variable) {
    return result<::libsumo::TraCIString>(results, variable).value;
}

/// Variables that are read in every step are subscribed to: SUMO sends them with its answer to the step.
class RemoteGateway : public libtraci::ApiGateway {
  public:
    RemoteGateway() = default;
    RemoteGateway(const RemoteGateway&) = delete;
    RemoteGateway& operator=(const RemoteGateway&) = delete;
    ~RemoteGateway() override {
        try {
            close();
        } catch (const core::SimulatorError&) {
            // Callers that want to know about errors call close().
        }
    }

    void close() override {
        if (!std::exchange(is_open_, false)) return;
        ApiGateway::close();
    }

    std::vector<std::string> departed() override {
        std::vector<std::string> ids = ApiGateway::departed();
        for (const std::string& id : ids)
            follow(id);
        return ids;
    }

    std::vector<std::string> vehicle_ids() override {
        std::vector<std::string> ids = ApiGateway::vehicle_ids();
        for (const std::string& id : ids)
            follow(id);
        return ids;
    }

    Presence read(const std::string& vehicle, VehicleReading& reading) override {
        return libtraci::call([&] {
            const Results results = api::Vehicle::getSubscriptionResults(vehicle);
            if (results.empty()) return Presence::off_road;
            const auto& position = result<::libsumo::TraCIPosition>(results, key::VAR_POSITION);
            if (position.x == key::INVALID_DOUBLE_VALUE) return Presence::off_road;
            reading.lane = text(results, key::VAR_LANE_ID);
            if (reading.lane.empty()) return Presence::parked;
            reading.x_m = position.x;
            reading.y_m = position.y;
            reading.angle_deg = number(results, key::VAR_ANGLE);
            reading.speed_mps = number(results, key::VAR_SPEED);
            reading.acceleration_mps2 = number(results, key::VAR_ACCELERATION);
            reading.lane_position_m = number(results, key::VAR_LANEPOSITION);
            return Presence::on_road;
        });
    }

    std::uint32_t route_index(const std::string& vehicle) override {
        return libtraci::call([&] {
            const Results results = api::Vehicle::getSubscriptionResults(vehicle);
            const int index = result<::libsumo::TraCIInt>(results, key::VAR_ROUTE_INDEX).value;
            return static_cast<std::uint32_t>(std::max(0, index));
        });
    }

    std::string route_id(const std::string& vehicle) override {
        return libtraci::call(
            [&] { return text(api::Vehicle::getSubscriptionResults(vehicle), key::VAR_ROUTE_ID); });
    }

    std::string signal_state(const std::string& signal) override {
        return libtraci::call([&] {
            if (signals_.insert(signal).second)
                api::TrafficLight::subscribe(signal, {key::TL_RED_YELLOW_GREEN_STATE});
            return text(api::TrafficLight::getSubscriptionResults(signal), key::TL_RED_YELLOW_GREEN_STATE);
        });
    }

    bool has_view() override {
        try {
            return api::GUI::hasView(view);
        } catch (const std::exception&) {
            return false;  // a SUMO without windows does not know the question
        }
    }

    void show_around(const std::string& vehicle, double metres) override {
        libtraci::call([&] {
            const auto at = api::Vehicle::getPosition(vehicle);
            api::GUI::setBoundary(view, at.x - metres, at.y - metres, at.x + metres, at.y + metres);
        });
    }

    void track(const std::string& vehicle) override {
        libtraci::call([&] { api::GUI::trackVehicle(view, vehicle); });
    }

  private:
    static void follow(const std::string& vehicle) {
        libtraci::call([&] { api::Vehicle::subscribe(vehicle, read_variables()); });
    }

    bool is_open_ = true;                      ///< libtraci crashes on requests after the end.
    std::unordered_set<std::string> signals_;  ///< Subscribed.
};

std::string words_at_abort;  // a signal handler has no other way to them

extern "C" void tell_and_end(int) {
    const ssize_t told = ::write(STDERR_FILENO, words_at_abort.data(), words_at_abort.size());
    ::_exit(static_cast<int>(told < 0 ? core::ExitCode::runs_failed : core::ExitCode::environment));
}

/// SUMO's client asserts that the first answer is one of SUMO. As long as this object lives, a process that
/// aborts says so last and ends with the exit code of an EnvironmentError.
class AbortIsTold {
  public:
    explicit AbortIsTold(const std::string& words) {
        words_at_abort = words + "\n";
        std::signal(SIGABRT, tell_and_end);
    }
    ~AbortIsTold() { std::signal(SIGABRT, SIG_DFL); }
    AbortIsTold(const AbortIsTold&) = delete;
    AbortIsTold& operator=(const AbortIsTold&) = delete;
};

std::string no_sumo(const std::string& host, int port, const std::string& reason) {
    return fmt::format(
        "no SUMO answers at {}:{}: {}. Start it with --remote-port {}, and give its host and port", host,
        port, reason, port);
}

/// The version that the SUMO at this address reports. libtraci waits for ever for an answer, so this runs in
/// its own thread, which is abandoned when `patience` is over; the process ends then, too.
std::string greet(const std::string& host, int port, core::Seconds patience) {
    auto promise = std::make_shared<std::promise<std::string>>();
    std::future<std::string> answer = promise->get_future();
    const AbortIsTold told(no_sumo(host, port, "what answers there is another program"));
    std::thread([promise, host, port] {
        try {
            promise->set_value(api::Simulation::init(port, 0, host).second);
        } catch (...) {
            promise->set_exception(std::current_exception());
        }
    }).detach();
    if (answer.wait_for(std::chrono::duration<double>(patience.value)) != std::future_status::ready)
        throw core::EnvironmentError(
            fmt::format("{}:{} does not answer like SUMO within {} s. Start SUMO with --remote-port {}, "
                        "and give the port of SUMO",
                        host, port, patience.value, port));
    try {
        return answer.get();
    } catch (const std::exception& fault) {
        throw core::EnvironmentError(no_sumo(host, port, fault.what()));
    }
}

/// `1.15` from `SUMO 1.15.0`.
std::string release(const std::string& version) {
    const std::size_t from = version.find_first_of("0123456789");
    if (from == std::string::npos) return version;
    return version.substr(from, version.find('.', version.find('.', from) + 1) - from);
}

}  // namespace

std::unique_ptr<Sumo> at(const std::string& host, int port, core::Seconds patience) {
    // A broken connection must be an error of the call, not the end of the process.
    std::signal(SIGPIPE, SIG_IGN);
    const std::string there = greet(host, port, patience);
    auto sumo = std::make_unique<RemoteGateway>();
    const std::string here = in_this_process()->version();
    if (release(there) != release(here))
        throw core::EnvironmentError(fmt::format(
            "{}:{} is {}, but this Clearway is built with {}, whose variables differ. Start a SUMO {} there",
            host, port, there, here, release(here)));
    return sumo;
}

}  // namespace clearway::sumo::detail::gateway
