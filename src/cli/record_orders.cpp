#include "cli/record_orders.hpp"

#include <fmt/format.h>

namespace clearway::cli {

WorkerResult record_orders(const std::vector<results::DatasetOrder>& orders, unsigned jobs) {
    std::vector<WorkerOrder> work;
    for (const results::DatasetOrder& order : orders) {
        const std::filesystem::path folder = order.scenario_file.parent_path() / "orders";
        work.push_back({.label = fmt::format("{} replication {}", order.scenario, order.replication),
                        .option = "--dataset",
                        .file = folder / fmt::format("{:04}.json", order.replication),
                        .text = results::to_json(order),
                        .log = folder / fmt::format("{:04}.log", order.replication),
                        .work = order.output / fmt::format("work-{}-{}", order.scenario, order.replication)});
    }
    return work_on(work, jobs, "recordings");
}

}  // namespace clearway::cli
