#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/dataset_order.hpp"

namespace clearway::samples {

/// The replications of a data set: `first` to `first + count - 1`.
struct DatasetSeeds {
    std::uint32_t first = 0;
    std::uint32_t count = 1;
};

/// One order for each replication of a scenario. `shared` says what and where to; scenario and network are
/// kept below `origin/` of the data set.
std::vector<experiment::DatasetOrder> dataset_orders(const experiment::DatasetOrder& shared,
                                                     const std::string& scenario, const DatasetSeeds& seeds);

/// Where the order of a recording is kept beside the data set.
std::filesystem::path order_file(const experiment::DatasetOrder& order);

/// What an order will write.
std::vector<std::filesystem::path> files_of(const experiment::DatasetOrder& order);

/// Refuses a folder in which recordings of others would be lost: throws core::InputError. The same orders may
/// be given again. `scenario` is the text of the effective configuration.
void check_folder(const std::vector<experiment::DatasetOrder>& orders, const std::string& scenario);

}  // namespace clearway::samples
