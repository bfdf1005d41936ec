#include "links/detail/dark_draws.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace clearway::links::detail {
namespace {

using Column = std::vector<double>;

Column sum(const Column& one, const Column& other) {
    Column total(one.size());
    std::ranges::transform(one, other, total.begin(), std::plus{});
    return total;
}

/// AP over all failed links: those outside the candidates are never found, so each gain of recall is smaller
/// by the share of candidates, and the sum over the scores with it. Without a true candidate nothing is
/// found.
Drawn over_all_failed(const Drawn& ap, const Drawn& recall) {
    const auto product = [](double precision, double share) {
        return share == 0.0 ? 0.0 : precision * share;
    };
    Drawn drawn;
    if (recall.value && (ap.value || *recall.value == 0.0))
        drawn.value = product(ap.value.value_or(0.0), *recall.value);
    for (std::size_t i = 0; i < ap.draws.size(); ++i)
        drawn.draws.push_back(product(ap.draws[i], recall.draws[i]));
    return drawn;
}

/// Errors by run, on a grid as fine as the sample allows.
struct GroupedErrors {
    Column edges_m;              ///< Lower edge of each group.
    Column ends_m;               ///< Upper edge of each group.
    std::vector<Column> by_run;  ///< Vehicles by run and group.
};

GroupedErrors grouped(const std::vector<PlaceErrors>& runs, const PlaceErrors& all) {
    constexpr double groups = 500.0;
    const double least = static_cast<double>(all.vehicles()) / groups;
    GroupedErrors result;
    std::vector<std::size_t> group_of(PlaceGrid::size, 0);
    double held = 0.0;
    for (const PlaceErrors::Bin& bin : all.bins) {
        if (result.edges_m.empty() || held >= least) {
            result.edges_m.push_back(PlaceGrid::lower_edge_m(bin.bin));
            result.ends_m.push_back(0.0);
            held = 0.0;
        }
        result.ends_m.back() = PlaceGrid::lower_edge_m(bin.bin + 1);
        group_of[bin.bin] = result.edges_m.size() - 1;
        held += static_cast<double>(bin.vehicles);
    }
    for (const PlaceErrors& run : runs) {
        Column& counts = result.by_run.emplace_back(result.edges_m.size(), 0.0);
        for (const PlaceErrors::Bin& bin : run.bins)
            counts[group_of[bin.bin]] += static_cast<double>(bin.vehicles);
    }
    return result;
}

/// As quantile_m, on groups.
double quantile_of(const GroupedErrors& errors, const Column& counts, double share) {
    const double wanted = share * std::accumulate(counts.begin(), counts.end(), 0.0);
    double passed = 0.0;
    for (std::size_t group = 0; group < counts.size(); ++group) {
        if (counts[group] > 0.0 && passed + counts[group] >= wanted) {
            const double width = errors.ends_m[group] - errors.edges_m[group];
            return errors.edges_m[group] + width * (wanted - passed) / counts[group];
        }
        passed += counts[group];
    }
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

LinkFailed failed_measures(const std::vector<const LinkCase*>& cases,
                           const std::vector<LinkSummary>& candidates, const DrawnMeasures& drawn,
                           double threshold, const analysis::RunResampling& resampling) {
    const Column in_reach = column_of(candidates, [](const LinkSummary& run) { return run.true_links(); });
    const Column outside = column_of(cases, [](const LinkCase* one) { return one->truth.outside; });
    const Column never_seen = column_of(cases, [](const LinkCase* one) { return one->truth.never_seen; });
    const Column seen = sum(in_reach, outside);
    const Column failed = sum(seen, never_seen);
    const CountsAbove above = counts_above(candidates, threshold);
    const Drawn recall = draw_ratio(in_reach, failed, resampling);
    const Drawn f1 = draw_ratio(sum(above.found, above.found), sum(above.predicted, failed), resampling);
    LinkFailed result;
    result.links = static_cast<std::uint64_t>(std::accumulate(failed.begin(), failed.end(), 0.0));
    result.seen = static_cast<std::uint64_t>(std::accumulate(seen.begin(), seen.end(), 0.0));
    result.candidate_recall = recall.measured(resampling);
    result.candidate_recall_seen = draw_ratio(in_reach, seen, resampling).measured(resampling);
    result.ap = over_all_failed(drawn.ap, recall).measured(resampling);
    result.f1 = f1.measured(resampling);
    return result;
}

LinkDark dark_measures(const std::vector<const LinkCase*>& cases, const analysis::RunResampling& resampling) {
    LinkDark result;
    std::vector<PlaceErrors> places;
    for (const LinkCase* const one : cases) {
        result.vehicles += one->truth.dark_vehicles;
        result.never_seen += one->truth.unseen_vehicles;
        result.next_cases += one->belief.next_cases;
        places.push_back(one->places);
    }
    const auto share = [&](auto above, auto below) {
        return draw_ratio(column_of(cases, above), column_of(cases, below), resampling).measured(resampling);
    };
    result.believed = share([](const LinkCase* one) { return one->belief.dark_believed; },
                            [](const LinkCase* one) { return one->truth.dark_vehicles; });
    result.next_ahead = share([](const LinkCase* one) { return one->belief.next_right; },
                              [](const LinkCase* one) { return one->belief.next_cases; });
    constexpr std::array shares = {0.5, 0.95};
    const std::vector<Drawn> quantiles = draw_quantiles(places, shares, resampling);
    result.place_median_m = quantiles[0].measured(resampling);
    result.place_p95_m = quantiles[1].measured(resampling);
    return result;
}

std::vector<Drawn> draw_quantiles(const std::vector<PlaceErrors>& runs, std::span<const double> shares,
                                  const analysis::RunResampling& resampling) {
    PlaceErrors all;
    for (const PlaceErrors& run : runs)
        all.add(run);
    std::vector<Drawn> drawn(shares.size());
    if (all.bins.empty()) return drawn;
    const GroupedErrors errors = grouped(runs, all);
    Column counts;
    const auto weigh = [&](std::span<const double> weights) {
        counts.assign(errors.edges_m.size(), 0.0);
        for (std::size_t run = 0; run < runs.size(); ++run) {
            if (weights[run] == 0.0) continue;
            for (std::size_t group = 0; group < counts.size(); ++group)
                counts[group] += weights[run] * errors.by_run[run][group];
        }
    };
    weigh(Column(runs.size(), 1.0));
    Column shift;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        drawn[i].value = quantile_m(all, shares[i]);
        shift.push_back(*drawn[i].value - quantile_of(errors, counts, shares[i]));
    }
    for (std::size_t number = 0; number < resampling.resamples(); ++number) {
        weigh(resampling.weights(number));
        for (std::size_t i = 0; i < shares.size(); ++i)
            drawn[i].draws.push_back(quantile_of(errors, counts, shares[i]) + shift[i]);
    }
    return drawn;
}

}  // namespace clearway::links::detail
