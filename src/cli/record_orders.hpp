#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "results/dataset_order.hpp"

namespace clearway::cli {

/// How recording ended.
struct RecordResult {
    core::ExitCode exit_code = core::ExitCode::ok;
    std::vector<std::string> lines;  ///< What the workers said about their files, by replication.
};

/// Records data sets with worker processes (`clearway-run --dataset FILE`), `jobs` at one time (0: one per
/// core), with progress on standard error. Order files and logs stand beside each order's scenario file. A
/// worker that fails is reported on standard error and the others go on; the first failure decides the exit
/// code. SIGINT and SIGTERM end the workers. Throws core::EnvironmentError when none can be started.
RecordResult record_orders(const std::vector<results::DatasetOrder>& orders, unsigned jobs);

}  // namespace clearway::cli
