#include "campaign/equip_candidates.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "campaign/detail/emergency_trips.hpp"
#include "core/temporary_folder.hpp"
#include "scenario/prepare.hpp"

namespace clearway::campaign {
namespace {

/// Pairs of neighbours that race with the candidates. Assumed: more would cost more than the race of signals.
constexpr std::size_t most_pairs = 6;

/// The candidates that follow each other on these ways, with how often.
std::vector<std::array<std::size_t, 2>> neighbours_of(
    const std::vector<core::SignalIndex>& candidates,
    const std::vector<std::vector<core::SignalIndex>>& ways) {
    std::map<std::array<std::size_t, 2>, std::size_t> counts;
    const auto number = [&](core::SignalIndex signal) {
        return static_cast<std::size_t>(std::ranges::find(candidates, signal) - candidates.begin());
    };
    for (const std::vector<core::SignalIndex>& way : ways) {
        for (std::size_t at = 1; at < way.size(); ++at) {
            const auto [first, second] = std::minmax({number(way[at - 1]), number(way[at])});
            if (second < candidates.size()) ++counts[{first, second}];
        }
    }
    std::vector<std::array<std::size_t, 2>> pairs;
    for (const auto& [pair, count] : counts)
        pairs.push_back(pair);
    std::ranges::stable_sort(pairs, std::greater{}, [&](const auto& pair) { return counts.at(pair); });
    pairs.resize(std::min(pairs.size(), most_pairs));
    return pairs;
}

/// Calls `visit(replication, prepared)` for each replication of the first scenario.
template <class Visit>
void for_each_demand(const study::StudyConfig& config, const scenario::BuiltNetwork& built,
                     const Visit& visit) {
    for (std::uint32_t replication = 0; replication < config.replications; ++replication) {
        const core::TemporaryFolder folder;
        visit(replication, scenario::prepare(config.scenarios.front(), built, core::StudySeed{config.seed},
                                             core::Replication{replication}, folder.path()));
    }
}

}  // namespace

EquipCandidates equip_candidates(const study::StudyConfig& config, const scenario::BuiltNetwork& built,
                                 const std::vector<bool>& today, std::size_t most) {
    const detail::Crossings crossings = detail::crossings_of(built.network);
    EquipCandidates candidates;
    std::map<core::SignalIndex, std::size_t> trips;  // of emergency vehicles that pass
    std::map<core::SignalIndex, double> red_s;       // of all of them
    std::vector<std::set<core::SignalIndex>> passed(config.replications);
    std::vector<std::vector<core::SignalIndex>> ways;
    std::vector<std::vector<std::string>> edges;
    scenario::PlannedRoutes others;  // of one run
    double window_s = 0.0;
    for_each_demand(config, built, [&](std::uint32_t replication, const scenario::Prepared& prepared) {
        for (const traffic::EmergencyDeparture& departure : prepared.emergency) {
            const std::vector<core::SignalIndex>& way =
                ways.emplace_back(detail::passed_by(departure.edges, crossings));
            edges.push_back(departure.edges);
            passed[replication].insert(way.begin(), way.end());
            candidates.met.add(way.size());
            for (const core::SignalIndex signal : way)
                ++trips[signal];
            for (const auto& [signal, wait_s] : scenario::red_waits_s(built.network, departure.edges))
                red_s[signal] += wait_s;
        }
        if (replication > 0) return;
        others = scenario::planned_routes(prepared.route_files.front(), built.network);
        window_s = prepared.time.window_s;
    });
    candidates.outlook = scenario::outlook(built.network, edges, others, window_s);
    candidates.not_passed = built.network.signals().size() - trips.size();
    candidates.switched_off = std::erase_if(trips, [&](const auto& one) {
        return !built.preemption.empty() && built.preemption[one.first.value].enabled.value_or(1) == 0;
    });
    candidates.equipped =
        std::erase_if(trips, [&](const auto& one) { return !today.empty() && today[one.first.value]; });
    for (const auto& [signal, count] : trips)
        candidates.signals.push_back(signal);
    if (candidates.signals.size() > most) {
        candidates.less_red = candidates.signals.size() - most;
        // Ranks what signals gain alone better than the number of trips does, in three networks of three.
        std::ranges::stable_sort(candidates.signals, std::greater{},
                                 [&](core::SignalIndex one) { return std::pair(red_s[one], trips.at(one)); });
        candidates.signals.resize(most);
        std::ranges::sort(candidates.signals);
    }
    candidates.neighbours = neighbours_of(candidates.signals, ways);
    candidates.passed.resize(config.replications);
    for (std::size_t candidate = 0; candidate < candidates.signals.size(); ++candidate) {
        const core::SignalIndex signal = candidates.signals[candidate];
        candidates.trips.push_back(static_cast<double>(trips.at(signal)) / static_cast<double>(ways.size()));
        for (std::size_t replication = 0; replication < passed.size(); ++replication)
            if (passed[replication].contains(signal)) candidates.passed[replication].push_back(candidate);
    }
    return candidates;
}

std::vector<std::set<std::string>> trips_past(const std::vector<core::SignalIndex>& signals,
                                              const study::StudyConfig& config,
                                              const scenario::BuiltNetwork& built) {
    const detail::Crossings crossings = detail::crossings_of(built.network);
    std::vector<std::set<std::string>> trips(config.replications);
    for_each_demand(config, built, [&](std::uint32_t replication, const scenario::Prepared& prepared) {
        for (const traffic::EmergencyDeparture& departure : prepared.emergency) {
            const std::vector<core::SignalIndex> way = detail::passed_by(departure.edges, crossings);
            if (std::ranges::find_first_of(way, signals) != way.end())
                trips[replication].insert(departure.id);
        }
    });
    return trips;
}

}  // namespace clearway::campaign
