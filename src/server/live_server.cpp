#include "server/live_server.hpp"

#include <chrono>
#include <optional>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/read_failure.hpp"
#include "server/access.hpp"
#include "server/detail/client.hpp"
#include "server/detail/feed.hpp"
#include "server/detail/hub.hpp"
#include "server/pacer.hpp"
#include "view/player.hpp"

namespace clearway::server {
namespace {

namespace asio = boost::asio;
using detail::Client;
using detail::Feed;
using Clock = std::chrono::steady_clock;

constexpr std::size_t most_clients = 8;
/// Those that watch, and those that only ask for the page or have not yet said what they want.
constexpr std::size_t most_connections = 64;
constexpr std::chrono::seconds last_patience{10};
constexpr std::chrono::milliseconds beat{20};
/// After a connection that could not be taken, because the system has no descriptor left. It still waits, so
/// that taking it again at once would only fill a core.
constexpr std::chrono::milliseconds accept_pause{200};
constexpr std::chrono::milliseconds status_period{500};
constexpr double fastest = 1000.0;

using RunAcceptor = asio::local::stream_protocol::acceptor;

std::vector<RunAcceptor> listen_for_runs(asio::io_context& loop, std::size_t runs,
                                         const std::filesystem::path& sockets) {
    std::vector<RunAcceptor> all;
    for (std::size_t run = 0; run < runs; ++run)
        all.emplace_back(loop, asio::local::stream_protocol::endpoint(socket_of(sockets, run).string()));
    return all;
}

asio::ip::tcp::acceptor listen_at(asio::io_context& loop, const LiveConfig& config) {
    try {
        const std::string address = addresses_of(config.host, "--host").front();
        const asio::ip::tcp::endpoint place(asio::ip::make_address(address), config.port);
        return {loop, place, true};
    } catch (const boost::system::system_error& error) {
        if (core::is_of_machine(error.code().value())) throw;
        const bool is_elsewhere = error.code() == boost::system::errc::address_not_available;
        throw core::EnvironmentError(fmt::format(
            "cannot serve at {} port {}: {}. {}", config.host, config.port, error.code().message(),
            is_elsewhere ? "--host takes an address or a name of this machine, or 0.0.0.0 for all of them"
                         : "Choose another with --port, or 0 for any that is free"));
    }
}

}  // namespace

std::filesystem::path socket_of(const std::filesystem::path& folder, std::size_t run) {
    return folder / fmt::format("run-{}", run);
}

struct LiveServer::State {
    State(LiveConfig wanted, const std::filesystem::path& sockets)
        : config(std::move(wanted)),
          hub(config.runs),
          pacer(config.runs, config.speed),
          browsers(listen_at(loop, config)),
          runs(listen_for_runs(loop, config.runs, sockets)),
          feeds(config.runs),
          timer(loop),
          rules{config.host, browsers.local_endpoint().port(), config.token, own_names()},
          host{.rules = rules,
               .page = view::live_page(config.title),
               .allow_control = config.allow_control,
               .counts = counts,
               .connections = connections,
               .joined = [this](const std::shared_ptr<Client>& client) { return join(client); },
               .control = [this](const std::string& words) { control(words); }} {}

    void accept_runs() {
        for (std::size_t run = 0; run < runs.size(); ++run)
            accept_run(run);
    }

    void accept_run(std::size_t run) {
        runs[run].async_accept([this, run](const boost::system::error_code& error, Feed::Socket socket) {
            if (error == asio::error::operation_aborted) return;
            if (error) return later([this, run] { accept_run(run); });
            add_run(run, std::move(socket));
        });
    }

    /// Calls `action` after a pause.
    template <class Action>
    void later(const Action& action) {
        const auto pause = std::make_shared<asio::steady_timer>(loop, accept_pause);
        pause->async_wait([pause, action](const boost::system::error_code& error) {
            if (!error) action();
        });
    }

    void add_run(std::size_t run, Feed::Socket socket) {
        feeds[run] = std::make_shared<Feed>(
            std::move(socket),
            Feed::Events{.block = [this, run](std::uint8_t kind,
                                              std::string_view content) { take(run, kind, content); },
                         .closed = [this, run] { pacer.ended(run), ++ended; }});
        feeds[run]->start();
    }

    void take(std::size_t run, std::uint8_t kind, std::string_view content) {
        const detail::Hub::Taken taken = hub.take(run, kind, content);
        if (taken.time_s >= 0.0) pacer.reached(run, taken.time_s);
        if (taken.ended) pacer.ended(run);
        if (taken.message) {
            for (const auto& client : clients)
                client->send(taken.message);
        } else if (hub.has_begun()) {
            greet_waiting();
        }
    }

    void accept_browsers() {
        browsers.async_accept([this](const boost::system::error_code& error, Client::Socket socket) {
            if (error == asio::error::operation_aborted) return;
            if (!error && connections < most_connections) {
                std::make_shared<Client>(std::move(socket), host)->start();
            } else {
                ++counts.refused;  // One too many for this server, or for the system.
            }
            if (error) return later([this] { accept_browsers(); });
            accept_browsers();
        });
    }

    bool join(const std::shared_ptr<Client>& client) {
        forget_closed();
        if (clients.size() + waiting.size() >= most_clients) return false;
        ++counts.clients;
        waiting.push_back(client);
        return true;
    }

    /// Clients that came before the runs said who they are, or just now, are told.
    void greet_waiting() {
        for (const auto& client : waiting) {
            client->say(hub.welcome(config.allow_control));
            for (const detail::SharedMessage& message : hub.beginning())
                client->send(message);
            client->say(status_of(*client));
            clients.push_back(client);
        }
        waiting.clear();
    }

    std::string status_of(const Client& client) const {
        const core::Json words = {{"paused", pacer.paused()},
                                  {"speed", pacer.speed()},
                                  {"dropped", client.dropped()},
                                  {"ended", is_over()}};
        return core::Json{{"status", words}}.dump();
    }

    /// Throws std::exception for words that are not known.
    void control(const std::string& words) {
        const core::Json json = core::Json::parse(words);
        const std::string what = json.at("do").get<std::string>();
        if (what == "pause") {
            pacer.pause();
        } else if (what == "go") {
            pacer.go();
        } else if (what == "step") {
            pacer.step();
        } else {
            const double times = what == "speed" ? json.at("times").get<double>() : -1.0;
            if (!(times >= 0.0 && times <= fastest)) throw std::invalid_argument("no such control");
            pacer.set_speed(times);
        }
        say_status();
    }

    void say_status() {
        last_status = Clock::now();
        for (const auto& client : clients)
            client->say(status_of(*client));
    }

    bool is_over() const { return ended >= config.runs; }

    void forget_closed() {
        std::erase_if(clients, [](const auto& client) { return !client->is_open(); });
        std::erase_if(waiting, [](const auto& client) { return !client->is_open(); });
    }

    void tick() {
        const auto now = Clock::now();
        const double passed_s = std::chrono::duration<double>(now - last_tick).count();
        last_tick = now;
        const double allowed_s = pacer.allow(passed_s);
        if (allowed_s > Pacer::waiting) {
            for (const auto& feed : feeds) {
                if (feed) feed->allow(allowed_s);
            }
        }
        if (hub.has_begun()) greet_waiting();
        forget_closed();
        if (now - last_status >= status_period) say_status();
        if (stop() || (is_over() && said_good_bye(now))) return loop.stop();
        timer.expires_after(beat);
        timer.async_wait([this](const boost::system::error_code& error) {
            if (!error) tick();
        });
    }

    /// Whether everybody has what was queued, or had time enough.
    bool said_good_bye(Clock::time_point now) {
        if (!over_since) {
            over_since = now;
            say_status();
        }
        for (const auto& client : clients)
            client->finish();
        forget_closed();
        return clients.empty() || now - *over_since > last_patience;
    }

    LiveConfig config;
    LiveCounts counts;
    std::size_t connections = 0;
    asio::io_context loop{1};
    detail::Hub hub;
    Pacer pacer;
    asio::ip::tcp::acceptor browsers;
    std::vector<RunAcceptor> runs;
    std::vector<std::shared_ptr<Feed>> feeds;  ///< Null until the run is there.
    asio::steady_timer timer;
    AccessRules rules;
    Client::Host host;
    std::vector<std::shared_ptr<Client>> clients, waiting;
    std::size_t ended = 0;
    std::function<bool()> stop;
    Clock::time_point last_tick = Clock::now(), last_status{};
    std::optional<Clock::time_point> over_since;
};

LiveServer::LiveServer(const LiveConfig& config, const std::filesystem::path& sockets) {
    check_token(config.token, "--token");
    if (!is_loopback(config.host, "--host") && config.token.empty())
        throw core::InputError(
            {"--host", config.host + " can be reached from other machines", "an address with a token", ""});
    try {
        state_ = std::make_unique<State>(config, sockets);
        state_->accept_runs();
        state_->accept_browsers();
    } catch (const boost::system::system_error& error) {
        throw core::EnvironmentError(fmt::format("the live page cannot be served: {}. {}",
                                                 error.code().message(),
                                                 core::cure_of(error.code().value())));
    }
}
LiveServer::~LiveServer() = default;

std::uint16_t LiveServer::port() const {
    return state_->rules.port;
}

void LiveServer::run(const std::function<bool()>& stop) {
    state_->stop = stop;
    state_->tick();
    state_->loop.run();
}

LiveCounts LiveServer::counts() const {
    return state_->counts;
}

}  // namespace clearway::server
