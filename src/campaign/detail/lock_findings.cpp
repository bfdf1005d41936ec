#include "campaign/detail/lock_findings.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "campaign/detail/way_findings.hpp"
#include "core/counted.hpp"
#include "report/locks.hpp"

namespace clearway::campaign::detail {
namespace {

constexpr std::size_t most_places = 3;

std::string place_of(const metrics::LockRow& lock, const roads::Network& network) {
    const std::string junction = ", junction " + lock.junction;
    const auto edge = network.find_edge(lock.edge);
    return edge ? road_words(network.edge(*edge), junction) : "edge " + lock.edge + junction;
}

/// `3 at Avenue X (edge 12, junction 34)`, where most are first.
std::string places_of(const std::vector<metrics::LockRow>& locks, const roads::Network& network) {
    std::map<std::string, std::size_t> counts;
    for (const metrics::LockRow& lock : locks)
        ++counts[place_of(lock, network)];
    std::vector<std::pair<std::string, std::size_t>> places(counts.begin(), counts.end());
    std::ranges::stable_sort(places, std::ranges::greater{}, &std::pair<std::string, std::size_t>::second);
    const std::size_t shown = std::min(places.size(), most_places);
    std::vector<std::string> texts;
    for (std::size_t row = 0; row < shown; ++row)
        texts.push_back(fmt::format("{} at {}", places[row].second, places[row].first));
    const std::string more =
        shown < places.size() ? fmt::format(", and at {} more", places.size() - shown) : "";
    return core::listed(texts) + more;
}

}  // namespace

Finding locks_finding(const results::RunRecord& record, const std::vector<metrics::LockRow>& locks,
                      const Checked& checked, const std::string& less) {
    constexpr std::uint64_t many = 100;  // one vehicle in so many
    const metrics::RunMetrics& run = record.metrics;
    if (run.locks == 0)
        return {"locks", Grade::ok,
                fmt::format("none in this run of seed {}, {:.0f} s; other seeds may lock: --lock-trials 6 "
                            "looks, with 12 more runs",
                            record.provenance.study_seed, run.simulated_s)};
    const std::string emergency = run.locked_emergency_vehicles == 0
                                      ? ""
                                      : fmt::format(", {} of them EV", run.locked_emergency_vehicles);
    const bool ignored = checked.config.time.ignore_junction_blocker_s.value_or(-1.0) >= 0.0;
    const bool is_short = run.locked_emergency_vehicles > 0 || many * run.locked_vehicles > run.vehicle_count;
    return {"locks", is_short ? Grade::falls_short : Grade::note,
            fmt::format("{} in this run of seed {}, the longest {:.0f} s; {} stood in them{}: {}",
                        core::counted(run.locks, "lock"), record.provenance.study_seed, run.longest_lock_s,
                        core::counted(run.locked_vehicles, "vehicle"), emergency,
                        places_of(locks, checked.network)),
            report::lock_remedy(ignored ? report::Blockers::ignored : report::Blockers::respected, less) +
                "; --lock-trials 6 counts the runs that lock"};
}

}  // namespace clearway::campaign::detail
