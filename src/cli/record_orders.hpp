#pragma once

#include <vector>

#include "cli/worker_orders.hpp"
#include "experiment/dataset_order.hpp"

namespace clearway::cli {

/// Records data sets with worker processes (`clearway-run --dataset FILE`) as `work_on` says; the lines are
/// what the workers said about their files, by replication. Order files and logs stand beside each order's
/// scenario file.
WorkerResult record_orders(const std::vector<experiment::DatasetOrder>& orders, unsigned jobs);

}  // namespace clearway::cli
