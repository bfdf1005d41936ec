#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clearway::experiment {

/// What a data set is for.
enum class DatasetKind : std::uint8_t {
    published,  ///< One snapshot as chapter 5.4 of the dissertation stores it: three CSV files.
    samples,    ///< What predictors were given at many moments, with the answers: one file per failure model.
    repair,     ///< The same for the improved net, `graphsage`.
    pair_samples,  ///< The features of every candidate pair, for the logistic pair model; likewise.
};
/// Which pairs a published data set lists; the dissertation does not say.
enum class ListedPairs : std::uint8_t {
    true_links,  ///< Only pairs that are linked: every label is 1.
    candidates,  ///< All allowed pairs within the candidate radius, linked or not.
};

std::string_view name(DatasetKind kind);
std::string_view name(ListedPairs pairs);
std::optional<DatasetKind> dataset_kind_from(std::string_view name);
std::optional<ListedPairs> listed_pairs_from(std::string_view name);

/// One simulation to record: a scenario and replication without a policy.
struct DatasetOrder {
    std::string scenario;
    std::filesystem::path scenario_file;   ///< The effective configuration, TOML.
    std::filesystem::path network_folder;  ///< Network built before.
    std::uint64_t study_seed = 1;
    std::uint32_t replication = 0;
    std::filesystem::path output;
    DatasetKind kind = DatasetKind::published;
    ListedPairs pairs = ListedPairs::candidates;  ///< Of kind published.
    std::uint32_t feature_count = 5;              ///< Of kind published: 2 or 5.
    std::vector<std::string> failures;            ///< Of samples: presets of sensing.
    double interval_s = 5.0;                      ///< Of samples: simulation time between two of them, > 0.
    std::string exits = "known";  ///< Of samples: whether it is known who left (sensing's spelling).

    bool operator==(const DatasetOrder&) const = default;
};

/// The file of the order's samples of one failure. `ending` tells what is in it; see prediction.
std::filesystem::path sample_file(const DatasetOrder& order, const std::string& failure,
                                  std::string_view ending);

/// JSON, for the worker's command line. `read_dataset_order` throws core::InputError.
std::string to_json(const DatasetOrder& order);
DatasetOrder read_dataset_order(const std::filesystem::path& file);

}  // namespace clearway::experiment
