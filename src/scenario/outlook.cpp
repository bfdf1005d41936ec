#include "scenario/outlook.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/xml_stream.hpp"
#include "roads/link_green.hpp"
#include "roads/program_times.hpp"
#include "roads/route_search.hpp"
#include "roads/short_loops.hpp"

namespace clearway::scenario {
namespace {

using Way = std::vector<core::EdgeIndex>;

Way way_of(const std::vector<std::string>& edges, const roads::Network& network) {
    Way way;
    for (const std::string& id : edges)
        if (const auto edge = network.find_edge(id)) way.push_back(*edge);
    return way;
}

class RouteReader : public core::XmlHandler {
  public:
    explicit RouteReader(const roads::Network& network) : network_(network) {}

    void start(std::string_view element, const core::XmlAttributes& attributes, unsigned long) override {
        const auto edges = attributes.find("edges");
        if (element != "route" || !edges) return;
        std::istringstream words{std::string(*edges)};
        std::vector<std::string> ids;
        for (std::string word; words >> word;)
            ids.push_back(word);
        ++routes_.vehicles;
        routes_.single += ids.size() == 1 ? 1 : 0;
        const Way way = way_of(ids, network_);
        for (std::size_t at = 1; at < way.size(); ++at)
            ++routes_.turns[{way[at - 1], way[at]}];
    }
    void end(std::string_view) override {}

    PlannedRoutes take() { return std::move(routes_); }

  private:
    const roads::Network& network_;
    PlannedRoutes routes_;
};

/// Calls `visit(connection)` for each way from an edge that a signal controls.
template <class Visit>
void for_each_link(const roads::Network& network, core::EdgeIndex edge, const Visit& visit) {
    for (std::uint32_t number = 0; number < network.edge(edge).lane_count; ++number)
        for (const roads::Connection& way : network.connections_from(network.lane_of(edge, number)))
            if (way.signal.exists()) visit(way);
}

/// The wait at red of a trip at each signal, s: by the lane with the shortest wait. A signal with several
/// stop lines on a way serves them together, so that the longest of their waits counts. Calls
/// `visit(connection)` for each way through a signal.
template <class Visit>
std::map<core::SignalIndex, double> waits_on(const roads::Network& network, const Way& way,
                                             const Visit& visit) {
    std::map<core::SignalIndex, double> waits_s;
    for (std::size_t at = 1; at < way.size(); ++at) {
        std::optional<std::pair<double, core::SignalIndex>> shortest;
        for_each_link(network, way[at - 1], [&](const roads::Connection& link) {
            if (network.lane(link.to).edge != way[at] || !link.allows_emergency) return;
            visit(link);
            const double wait_s = roads::link_green(network.signal(link.signal), link.signal_link).wait_s;
            if (!shortest || wait_s < shortest->first) shortest = {wait_s, link.signal};
        });
        if (!shortest) continue;
        double& longest_s = waits_s.try_emplace(shortest->second, 0.0).first->second;
        longest_s = std::max(longest_s, shortest->first);
    }
    return waits_s;
}

/// Links of a signal that emergency vehicles take.
using Links = std::set<std::uint16_t>;

/// The emergency vehicles' trips, one after the other.
class EmergencyWays {
  public:
    EmergencyWays(const roads::Network& network, Outlook& outlook)
        : network_(network), search_(network, roads::Driver::emergency), outlook_(outlook) {}

    void add(const Way& way) {
        const auto free_s = [&](core::EdgeIndex edge, double) { return search_.free_s(edge); };
        const double driven_s = search_.time_of(way, search_.free_s(way.front()), free_s);
        if (driven_s == roads::no_way_s) return;
        const auto waits_s = waits_on(network_, way, [&](const roads::Connection& link) {
            passed_[link.signal].insert(link.signal_link);
        });
        ++outlook_.trips;
        outlook_.trips_passing += waits_s.empty() ? 0 : 1;
        outlook_.signals_a_trip += static_cast<double>(waits_s.size());
        outlook_.trip_s += driven_s;
        for (const auto& [signal, wait_s] : waits_s)
            outlook_.red_s += wait_s;
    }
    const std::map<core::SignalIndex, Links>& passed() const { return passed_; }

  private:
    const roads::Network& network_;
    roads::RouteSearch search_;
    Outlook& outlook_;
    std::map<core::SignalIndex, Links> passed_;
};

/// The vehicles that turn at a signal from one edge to another.
struct TurnLoad {
    double degree = 0.0;  ///< Of saturation.
    Links links = {};
};

/// Degrees of saturation of the turns from an edge: of each the larger of that on the lanes that serve it and
/// that of all turns on all lanes. A lower bound, because turns that share a lane or yield have less.
std::vector<TurnLoad> loads_from(const roads::Network& network, core::EdgeIndex edge,
                                 const PlannedRoutes& others, double window_s) {
    constexpr double lane_per_h = 1800.0;  // usual saturation flow, 2 s between vehicles
    constexpr double hour_s = 3600.0;
    using Greens = std::map<core::LaneIndex, double>;
    Greens lanes;
    std::map<core::EdgeIndex, std::pair<Greens, Links>> turns;
    for_each_link(network, edge, [&](const roads::Connection& way) {
        if (!way.allows_cars) return;
        const double share = roads::link_green(network.signal(way.signal), way.signal_link).share;
        auto& [greens, links] = turns[network.lane(way.to).edge];
        links.insert(way.signal_link);
        for (Greens* const each : {&lanes, &greens})
            (*each)[way.from] = std::max((*each)[way.from], share);
    });
    const auto degree = [&](double vehicles, const Greens& greens) {
        double capacity_per_h = 0.0;
        for (const auto& [lane, share] : greens)
            capacity_per_h += lane_per_h * share;
        return capacity_per_h > 0.0 ? vehicles * hour_s / window_s / capacity_per_h : 0.0;
    };
    double all = 0.0;
    std::vector<TurnLoad> loads;
    for (auto& [to, turn] : turns) {
        const auto found = others.turns.find({edge, to});
        if (found == others.turns.end()) continue;
        all += found->second;
        loads.push_back({degree(found->second, turn.first), std::move(turn.second)});
    }
    for (TurnLoad& load : loads)
        load.degree = std::max(load.degree, degree(all, lanes));
    return loads;
}

/// The turns at a signal, the fullest first.
std::vector<TurnLoad> loads_at(const roads::Network& network, const roads::Signal& signal,
                               const PlannedRoutes& others, double window_s) {
    std::set<core::EdgeIndex> approaches;
    for (const auto& ways : signal.links)
        for (const roads::SignalLink& way : ways)
            approaches.insert(network.lane(way.from).edge);
    std::vector<TurnLoad> loads;
    for (const core::EdgeIndex edge : approaches)
        std::ranges::move(loads_from(network, edge, others, window_s), std::back_inserter(loads));
    std::ranges::stable_sort(loads, std::greater{}, &TurnLoad::degree);
    return loads;
}

/// Whether some links of two turns conflict and are never green together.
bool compete(const roads::Signal& signal, const TurnLoad& one, const TurnLoad& other) {
    for (const std::uint16_t left : one.links)
        for (const std::uint16_t right : other.links)
            if (signal.foes[left][right] && std::ranges::none_of(signal.program, [&](const auto& phase) {
                    return roads::gives_green(phase, left) && roads::gives_green(phase, right);
                }))
                return true;
    return false;
}

/// Whether two full turns compete for green, so that the program has none left to give back.
bool is_contested(const roads::Signal& signal, const std::vector<TurnLoad>& loads) {
    for (const TurnLoad& one : loads)
        for (const TurnLoad& other : loads)
            if (std::min(one.degree, other.degree) >= full_degree && compete(signal, one, other)) return true;
    return false;
}

/// Whether links wait for people on foot for long, who have begun to cross.
bool has_slow_walk(const roads::Signal& signal, const Links& links) {
    constexpr double long_s = 15.0;
    const roads::ProgramTimes times = roads::program_times(signal);
    for (std::size_t crossing = 0; crossing < signal.links.size(); ++crossing) {
        const double walk_s = times.green_s[crossing].value_or(0.0) + times.red_s[crossing].value_or(0.0);
        const bool is_slow = signal.crossings[crossing] && walk_s > long_s;
        if (is_slow && std::ranges::any_of(links, [&](auto link) { return signal.foes[crossing][link]; }))
            return true;
    }
    return false;
}

void judge_signals(const roads::Network& network, const std::map<core::SignalIndex, Links>& passed,
                   const PlannedRoutes& others, double window_s, Outlook& outlook) {
    const std::vector<bool> on_loop = roads::on_short_loops(network, roads::usual_short_block_m);
    outlook.passed = passed.size();
    std::pair<bool, double> fullest;
    for (const auto& [index, links] : passed) {
        const roads::Signal& signal = network.signal(index);
        const std::vector<TurnLoad> loads = loads_at(network, signal, others, window_s);
        const std::pair load{is_contested(signal, loads), loads.empty() ? 0.0 : loads.front().degree};
        outlook.full += load.second >= full_degree ? 1 : 0;
        outlook.contested += load.first ? 1 : 0;
        outlook.on_short_loops += !on_loop.empty() && on_loop[index.value] ? 1 : 0;
        outlook.slow_walks += has_slow_walk(signal, links) ? 1 : 0;
        if (load <= fullest) continue;
        fullest = load;
        outlook.fullest = signal.id;
    }
    outlook.fullest_degree = fullest.second;
}

std::string little_reason(const Outlook& outlook, const std::string& signals, const std::string& of_red) {
    if (outlook.signals == 0) return "the network has no signal";
    if (outlook.trips == 0) return "no trip of an EV is planned";
    if (outlook.trips_passing == 0)
        return fmt::format("none of {} of EVs passes a signal", core::counted(outlook.trips, "trip"));
    if (2 * outlook.trips_passing >= outlook.trips) return signals;
    return fmt::format("few EVs pass a signal ({} of {}), and {}", outlook.trips_passing, outlook.trips,
                       of_red);
}

/// What at least half of the signals have in common that makes them worth less.
std::string obstacles(const Outlook& outlook) {
    std::string words;
    const auto add = [&](std::size_t count, const char* one, const char* several) {
        if (count > 0 && 2 * count >= outlook.passed)
            words += fmt::format("; {} of the {} on their ways {}", count,
                                 core::counted(outlook.passed, "signal"), count == 1 ? one : several);
    };
    // docs/findings/cities.md: recovery, by which the others gain elsewhere, is off there.
    add(outlook.on_short_loops, "lies on a loop of short blocks, where the others hardly gain",
        "lie on loops of short blocks, where the others hardly gain");
    add(outlook.slow_walks, "first waits over 15 s for people on foot",
        "first wait over 15 s for people on foot");
    return words;
}

}  // namespace

PlannedRoutes planned_routes(const std::filesystem::path& file, const roads::Network& network) {
    RouteReader reader(network);
    core::stream_xml(file, reader);
    return reader.take();
}

std::map<core::SignalIndex, double> red_waits_s(const roads::Network& network,
                                                const std::vector<std::string>& edges) {
    return waits_on(network, way_of(edges, network), [](const roads::Connection&) {});
}

Outlook outlook(const roads::Network& network, const std::vector<std::vector<std::string>>& ways,
                const PlannedRoutes& others, double window_s) {
    Outlook outlook;
    outlook.signals = network.signals().size();
    EmergencyWays trips(network, outlook);
    for (const std::vector<std::string>& edges : ways)
        if (const Way way = way_of(edges, network); !way.empty()) trips.add(way);
    if (outlook.trips == 0) return outlook;
    const auto count = static_cast<double>(outlook.trips);
    outlook.trip_s += outlook.red_s;
    for (double* const sum : {&outlook.signals_a_trip, &outlook.red_s, &outlook.trip_s})
        *sum /= count;
    judge_signals(network, trips.passed(), others, window_s, outlook);
    return outlook;
}

Prospect Outlook::prospect() const {
    // Between the streets and cities of docs/findings/cities.md where no gain of `corridor` is shown, or one
    // barely (shares up to 0.05), and all others (from 0.10 on).
    constexpr double little_share = 0.07;
    if (red_share() < little_share) return Prospect::little;
    // Ibid.: where only one turn is full the others lose nothing, since recovery gives it the time of the
    // rest.
    return contested > 0 ? Prospect::costs_others : Prospect::helps;
}

std::string outlook_sentence(const Outlook& outlook) {
    const Prospect prospect = outlook.prospect();
    const std::string of_red =
        fmt::format("red without queues costs {:.0f} s of a trip of {:.0f} s", outlook.red_s, outlook.trip_s);
    const std::string signals =
        fmt::format("EVs pass {:.1f} signals a trip, and {}", outlook.signals_a_trip, of_red);
    if (prospect == Prospect::little)
        return fmt::format("By programs and trips alone, preemption has little to gain: {}{}.",
                           little_reason(outlook, signals, of_red),
                           outlook.full == 0
                               ? ""
                               : fmt::format(", but queues at full approaches (at {} of {}) may cost more",
                                             outlook.full, core::counted(outlook.passed, "signal")));
    if (prospect == Prospect::helps)
        return fmt::format("By programs and trips alone, preemption is likely to help: {}{}.", signals,
                           obstacles(outlook));
    return fmt::format(
        "By programs and trips alone, preemption is likely to help EVs and may cost the others: {}, and full "
        "approaches compete for green "
        "at {} of {} (the fullest, at {:.1f} times its capacity, is at {}){}.",
        signals, outlook.contested, core::counted(outlook.passed, "signal"), outlook.fullest_degree,
        outlook.fullest, obstacles(outlook));
}

core::Json outlook_json(const Outlook& outlook) {
    return {{"prospect", core::name(outlook.prospect())},
            {"signals", outlook.signals},
            {"trips", outlook.trips},
            {"trips_passing", outlook.trips_passing},
            {"signals_a_trip", outlook.signals_a_trip},
            {"red_s", outlook.red_s},
            {"trip_s", outlook.trip_s},
            {"red_share", outlook.red_share()},
            {"passed", outlook.passed},
            {"full", outlook.full},
            {"contested", outlook.contested},
            {"fullest_degree", outlook.fullest_degree},
            {"fullest", outlook.fullest},
            {"on_short_loops", outlook.on_short_loops},
            {"slow_walks", outlook.slow_walks},
            {"sentence", outlook_sentence(outlook)}};
}

}  // namespace clearway::scenario
