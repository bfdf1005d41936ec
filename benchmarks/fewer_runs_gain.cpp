// What runs of the baseline beside pairs are worth: `fewer_runs_gain FOLDER`, of studies/fewer_runs.toml.
// Prints for each scenario a line: pairs; unpaired runs that are as good as one paired run; what share of the
// differences' variance is explained, %, by what the baseline lost and by what the same EVs gain alone on the
// road (`SCENARIO_alone`); and of 200 repetitions, drawn with replacement, the mean half width, s, and the
// coverage, %, of 20 pairs, of 30, and of 10 pairs with 40 runs of the baseline. benchmarks/fewer_runs.py
// runs it.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "analysis/summary.hpp"
#include "core/random.hpp"

namespace {

using namespace clearway;

constexpr std::uint64_t repetitions = 200;
constexpr std::size_t adjusted_pairs = 10;
constexpr std::size_t baselines = 40;

/// Of one scenario, by replication.
struct Pool {
    std::vector<double> baseline_s, condition_s, difference_s, lost_s;
};

double variance(const std::vector<double>& values) {
    const double deviation = analysis::estimate_mean(values)->deviation;
    return deviation * deviation;
}

/// R^2 of a straight line, %.
double explained(const std::vector<double>& values, const std::vector<double>& covariate) {
    const auto adjusted = analysis::estimate_adjusted(values, covariate, covariate);
    if (!adjusted) return 0.0;
    const auto n = static_cast<double>(values.size());
    return 100.0 -
           100.0 * adjusted->deviation * adjusted->deviation * (n - 2.0) / (variance(values) * (n - 1.0));
}

Pool pool_of(const analysis::ScenarioSummary& scenario) {
    const auto values = [&](const char* condition, const char* metric) {
        std::vector<double> all;
        for (const std::optional<double>& value : scenario.find(condition)->metric(metric).values)
            all.push_back(value.value());
        return all;
    };
    Pool pool{values("baseline", analysis::primary_metric),
              values("corridor", analysis::primary_metric),
              {},
              values("baseline", "emergency_time_loss_s")};
    std::ranges::transform(pool.condition_s, pool.baseline_s, std::back_inserter(pool.difference_s),
                           std::minus<>());
    return pool;
}

/// Intervals of repeated studies.
struct Intervals {
    double half_width_s = 0.0;
    double held = 0.0;

    void add(const analysis::MaybeEstimate& estimate, double truth_s) {
        half_width_s += estimate->interval->half_width() / repetitions;
        held += estimate->interval->contains(truth_s) ? 100.0 / repetitions : 0.0;
    }
};

void print_gain(const std::string& name, const Pool& pool, const Pool& alone) {
    const double truth_s = analysis::estimate_mean(pool.difference_s)->mean;
    const core::KeyedRandom draws(core::StudySeed{1}, core::Replication{0});
    Intervals of_20;
    Intervals of_30;
    Intervals adjusted;
    for (std::uint64_t repetition = 0; repetition < repetitions; ++repetition) {
        std::vector<double> differences_s, lost_s;
        for (std::uint64_t row = 0; row < baselines; ++row) {
            const std::size_t drawn =
                draws.below(pool.lost_s.size(), core::Purpose::demand, repetition * baselines + row);
            lost_s.push_back(pool.lost_s[drawn]);
            differences_s.push_back(pool.difference_s[drawn]);
        }
        const std::span<const double> differences(differences_s);
        const std::span<const double> lost(lost_s);
        of_20.add(analysis::estimate_mean(differences.first(20)), truth_s);
        of_30.add(analysis::estimate_mean(differences.first(30)), truth_s);
        adjusted.add(
            analysis::estimate_adjusted(differences.first(adjusted_pairs), lost.first(adjusted_pairs), lost),
            truth_s);
    }
    std::printf("%s %zu %.1f %.0f %.0f", name.c_str(), pool.lost_s.size(),
                (variance(pool.baseline_s) + variance(pool.condition_s)) / variance(pool.difference_s),
                explained(pool.difference_s, pool.lost_s), explained(pool.difference_s, alone.difference_s));
    for (const Intervals& one : {of_20, of_30, adjusted})
        std::printf(" %.1f %.1f", one.half_width_s, one.held);
    std::printf("\n");
}

}  // namespace

int main(int count, char** arguments) try {
    if (count != 2) {
        std::fprintf(stderr, "usage: fewer_runs_gain FOLDER\n");
        return 2;
    }
    const analysis::Summary summary = analysis::summarise(
        results::read_results(results::Store::open(arguments[1]), results::VehicleRows::emergency));
    std::map<std::string, Pool> pools;
    for (const analysis::ScenarioSummary& scenario : summary.scenarios)
        pools.emplace(scenario.scenario, pool_of(scenario));
    for (const auto& [name, pool] : pools)
        if (const auto alone = pools.find(name + "_alone"); alone != pools.end())
            print_gain(name, pool, alone->second);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "fewer_runs_gain: %s\n", error.what());
    return 1;
}
