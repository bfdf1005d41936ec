#include "samples/dataset_plan.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "samples/dataset_files.hpp"
#include "samples/recorders.hpp"

namespace clearway::samples {
namespace {

bool holds(const std::filesystem::path& file, const std::string& text) {
    return std::filesystem::exists(file) && core::read_file(file) == text;
}

}  // namespace

std::vector<experiment::DatasetOrder> dataset_orders(const experiment::DatasetOrder& shared,
                                                     const std::string& scenario, const DatasetSeeds& seeds) {
    experiment::DatasetOrder order = shared;
    order.scenario = scenario;
    const std::filesystem::path origin = order.output / "origin" / scenario;
    order.scenario_file = origin / "scenario.toml";
    order.network_folder = origin / "network";
    std::vector<experiment::DatasetOrder> orders;
    for (std::uint32_t i = 0; i < seeds.count; ++i) {
        order.replication = seeds.first + i;
        orders.push_back(order);
    }
    return orders;
}

std::filesystem::path order_file(const experiment::DatasetOrder& order) {
    return order.scenario_file.parent_path() / "orders" / fmt::format("{:04}.json", order.replication);
}

std::vector<std::filesystem::path> files_of(const experiment::DatasetOrder& order) {
    if (order.kind == experiment::DatasetKind::published) {
        return {order.output / edge_list_file, order.output / vehicle_features_file,
                order.output / target_file};
    }
    std::vector<std::filesystem::path> files;
    for (const std::string& failure : order.failures)
        files.push_back(experiment::sample_file(order, failure, sample_ending(order.kind)));
    return files;
}

void check_folder(const std::vector<experiment::DatasetOrder>& orders, const std::string& scenario) {
    const char* const cure = "Record into another --out, or remove what is there";
    const std::filesystem::path& scenario_file = orders.front().scenario_file;
    if (std::filesystem::exists(scenario_file) && !holds(scenario_file, scenario)) {
        throw core::InputError(
            {scenario_file.string(),
             fmt::format("another configuration of {} was recorded here", orders.front().scenario),
             "one for each scenario of a data set", cure});
    }
    std::vector<std::string> taken;
    for (const experiment::DatasetOrder& order : orders) {
        if (holds(order_file(order), experiment::to_json(order))) continue;
        for (const std::filesystem::path& file : files_of(order)) {
            if (std::filesystem::exists(file)) taken.push_back(file.string());
        }
    }
    if (taken.empty()) return;
    const std::string more = taken.size() == 1 ? "" : fmt::format(", and {} more", taken.size() - 1);
    throw core::InputError({taken.front(), "is there already, of another recording" + more, "", cure});
}

}  // namespace clearway::samples
