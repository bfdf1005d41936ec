#include "server/live_server.hpp"

#include <chrono>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>

#include "core/error.hpp"
#include "core/json.hpp"
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
constexpr std::chrono::milliseconds beat{20};
constexpr std::chrono::milliseconds status_period{500};
constexpr double fastest = 1000.0;

asio::ip::tcp::acceptor listen_at(asio::io_context& loop, const LiveConfig& config) {
    try {
        const asio::ip::tcp::endpoint place(asio::ip::make_address(config.host), config.port);
        return {loop, place, true};
    } catch (const boost::system::system_error& error) {
        throw core::EnvironmentError(fmt::format(
            "cannot serve at {} port {}: {}. Choose another with --port, or 0 for any that is free",
            config.host, config.port, error.code().message()));
    }
}

}  // namespace

struct LiveServer::State {
    State(LiveConfig wanted, const std::filesystem::path& socket)
        : config(std::move(wanted)),
          hub(config.runs),
          pacer(config.runs, config.speed),
          browsers(listen_at(loop, config)),
          runs(loop, asio::local::stream_protocol::endpoint(socket.string())),
          timer(loop),
          rules{config.host, browsers.local_endpoint().port(), config.token},
          host{.rules = rules,
               .page = view::live_page(config.title),
               .allow_control = config.allow_control,
               .counts = counts,
               .joined = [this](const std::shared_ptr<Client>& client) { return join(client); },
               .control = [this](const std::string& words) { control(words); }} {}

    void accept_runs() {
        runs.async_accept([this](const boost::system::error_code& error, Feed::Socket socket) {
            if (error) return;
            if (feeds.size() < config.runs) add_run(std::move(socket));
            accept_runs();
        });
    }

    void add_run(Feed::Socket socket) {
        const std::size_t run = feeds.size();
        feeds.push_back(std::make_shared<Feed>(
            std::move(socket),
            Feed::Events{.block = [this, run](std::uint8_t kind,
                                              std::string_view content) { take(run, kind, content); },
                         .closed = [this, run] { pacer.ended(run), ++ended; }}));
        feeds.back()->start();
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
            if (error) return;
            std::make_shared<Client>(std::move(socket), host)->start();
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
        if (what == "pause") return pacer.pause();
        if (what == "go") return pacer.go();
        if (what == "step") return pacer.step();
        const double times = what == "speed" ? json.at("times").get<double>() : -1.0;
        if (!(times >= 0.0 && times <= fastest)) throw std::invalid_argument("no such control");
        pacer.set_speed(times);
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
            for (const auto& feed : feeds)
                feed->allow(allowed_s);
        }
        if (hub.has_begun()) greet_waiting();
        forget_closed();
        if (now - last_status >= status_period) {
            last_status = now;
            for (const auto& client : clients)
                client->say(status_of(*client));
        }
        if (stop() || (is_over() && clients.empty() && waiting.empty())) return loop.stop();
        timer.expires_after(beat);
        timer.async_wait([this](const boost::system::error_code& error) {
            if (!error) tick();
        });
    }

    LiveConfig config;
    asio::io_context loop{1};
    LiveCounts counts;
    detail::Hub hub;
    Pacer pacer;
    asio::ip::tcp::acceptor browsers;
    asio::local::stream_protocol::acceptor runs;
    asio::steady_timer timer;
    AccessRules rules;
    Client::Host host;
    std::vector<std::shared_ptr<Feed>> feeds;
    std::vector<std::shared_ptr<Client>> clients, waiting;
    std::size_t ended = 0;
    std::function<bool()> stop;
    Clock::time_point last_tick = Clock::now(), last_status{};
};

LiveServer::LiveServer(const LiveConfig& config, const std::filesystem::path& socket)
    : state_(std::make_unique<State>(config, socket)) {
    if (config.token.empty() && !is_loopback(config.host, "--host"))
        throw core::InputError(
            {"--host", config.host + " can be reached from other machines", "an address with a token", ""});
    state_->accept_runs();
    state_->accept_browsers();
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
