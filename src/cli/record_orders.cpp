#include "cli/record_orders.hpp"

#include <fmt/format.h>

#include "samples/dataset_plan.hpp"

namespace clearway::cli {

WorkerResult record_orders(const std::vector<experiment::DatasetOrder>& orders, unsigned jobs) {
    std::vector<WorkerOrder> work;
    for (const experiment::DatasetOrder& order : orders) {
        const std::filesystem::path file = samples::order_file(order);
        work.push_back({.label = fmt::format("{} replication {}", order.scenario, order.replication),
                        .option = "--dataset",
                        .file = file,
                        .text = experiment::to_json(order),
                        .log = std::filesystem::path(file).replace_extension(".log"),
                        .work = order.output / fmt::format("work-{}-{}", order.scenario, order.replication)});
    }
    return work_on(work, jobs, "recordings");
}

}  // namespace clearway::cli
