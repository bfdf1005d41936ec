#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/settings.hpp"
#include "core/spellings.hpp"
#include "experiment/loop_config.hpp"
#include "experiment/simulation.hpp"
#include "failures/failure_config.hpp"

namespace clearway::experiment {

/// What a data set is for.
enum class DatasetKind : std::uint8_t {
    published,  ///< One snapshot as chapter 5.4 of the dissertation stores it: three CSV files.
    samples,    ///< Inputs of predictors at many moments, with labels: one file per failure model.
    repair,     ///< The same for the improved net, `graphsage`.
    /// The features of every candidate pair, for the logistic pair model; also per failure model.
    pair_samples,
    edge_times,  ///< Vehicles, time and distance on each edge: samples/edge_times.hpp.
};
constexpr core::Spellings<DatasetKind, 5> spellings(DatasetKind) {
    return {{{DatasetKind::published, "published"},
             {DatasetKind::samples, "samples"},
             {DatasetKind::repair, "repair"},
             {DatasetKind::pair_samples, "pair_samples"},
             {DatasetKind::edge_times, "edge_times"}}};
}

/// Which pairs a published data set lists; the dissertation does not say.
enum class ListedPairs : std::uint8_t {
    true_links,  ///< Only pairs that are linked: every label is 1.
    candidates,  ///< All allowed pairs within the candidate radius, linked or not.
};
constexpr core::Spellings<ListedPairs, 2> spellings(ListedPairs) {
    return {{{ListedPairs::true_links, "true_links"}, {ListedPairs::candidates, "candidates"}}};
}

/// A data set: one simulation, recorded; without a policy or under some.
struct DatasetJob : Simulation, LinkSettings {
    std::filesystem::path output;
    DatasetKind dataset = DatasetKind::published;
    ListedPairs pairs = ListedPairs::candidates;
    std::uint32_t feature_count = 5;
    std::vector<std::string> failures;
    double interval_s = 5.0;
    failures::Exits exits = failures::Exits::known;
    /// Of samples: what acts on the traffic, in this order, knowing everything; empty: nothing does.
    std::vector<std::string> policies = {};
    core::Settings settings = {};  ///< Settings of the policies that differ from their defaults.

    /// All members but the policies and their settings, which stand in a job only when there are any.
    static constexpr void fields(const auto& table) {
        using Self = DatasetJob;
        LinkSettings::fields(table);
        table(core::Field{"output", "", &Self::output, 0, 0, "Folder of the data set", "given"},
              core::Field{"dataset", "", &Self::dataset, 0, 0, "What is recorded", "given"},
              core::Field{"pairs", "", &Self::pairs, 0, 0, "Of published: which pairs are listed",
                          "the dissertation does not say"},
              core::Field{"feature_count", "1", &Self::feature_count, 2, 5,
                          "Of published: 2, position alone, or 5", "dissertation 5.4"},
              core::Field{"failures", "", &Self::failures, 0, 0, "Of samples: presets of sensing", "given"},
              core::Field{"interval_s", "s", &Self::interval_s, 0.1, 3600,
                          "Of samples: simulation time between two of them",
                          "assumed: neighbouring samples differ"},
              core::Field{"exits", "", &Self::exits, 0, 0,
                          "Of samples: whether it is known which vehicles left", "known"});
    }
    bool operator==(const DatasetJob&) const = default;
};

/// `corridor+red_privilege`; empty without a policy.
std::string joined_policies(const DatasetJob& job);

/// The same in names of files: `-under-corridor`; of one in Python, class and hash, `-under-Yield-3f2a9c01`.
std::string under_policies(const DatasetJob& job);

/// The file for the job's samples of one failure. `ending` tells the kind of samples; see
/// samples::sample_ending.
std::filesystem::path sample_file(const DatasetJob& job, const std::string& failure, std::string_view ending);

}  // namespace clearway::experiment
