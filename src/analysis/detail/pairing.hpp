#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "results/store.hpp"

namespace clearway::analysis::detail {

/// Complete runs of one condition in one scenario, by replication; nullptr if there is none.
using Runs = std::vector<const results::RunRecord*>;

/// Values of a condition and of what it is compared with, one of each for every complete pair.
struct Pairs {
    std::vector<double> condition;
    std::vector<double> baseline;

    void add(const std::optional<double>& with, const std::optional<double>& without) {
        if (!with || !without) return;
        condition.push_back(*with);
        baseline.push_back(*without);
    }
};
/// Of the replications in which both have a value.
Pairs pairs_of(std::span<const std::optional<double>> condition,
               std::span<const std::optional<double>> baseline);

/// A metric of an emergency vehicle that arrived.
using VehicleNumber = std::optional<double> metrics::VehicleRow::*;

/// Means of one replication over the emergency vehicles that arrived in each of its runs.
struct CommonMeans {
    std::vector<double> means;  ///< One per run.
    std::size_t left_out = 0;   ///< Emergency vehicles that did not arrive in every run.
};
/// Nothing when a run is missing or no emergency vehicle arrived in all runs.
std::optional<CommonMeans> common_means(std::span<const results::RunRecord* const> runs,
                                        VehicleNumber number);

}  // namespace clearway::analysis::detail
