#include "analysis/detail/pairing.hpp"

#include <algorithm>

namespace clearway::analysis::detail {

Pairs pairs_of(std::span<const std::optional<double>> condition,
               std::span<const std::optional<double>> baseline) {
    Pairs pairs;
    for (std::size_t row = 0; row < std::min(condition.size(), baseline.size()); ++row)
        pairs.add(condition[row], baseline[row]);
    return pairs;
}

std::optional<CommonMeans> common_means(std::span<const results::RunRecord* const> runs,
                                        VehicleNumber number) {
    std::map<std::string, std::size_t> arrivals;  // Emergency vehicle -> runs in which it arrived.
    for (const results::RunRecord* run : runs) {
        if (run == nullptr) return std::nullopt;
        for (const metrics::VehicleRow& vehicle : run->vehicles) {
            if (vehicle.vehicle_class != traffic::VehicleClass::emergency) continue;
            std::size_t& count = arrivals[vehicle.id];
            if (vehicle.outcome == metrics::VehicleOutcome::arrived) ++count;
        }
    }
    const auto common = static_cast<std::size_t>(
        std::ranges::count(arrivals, runs.size(), &std::pair<const std::string, std::size_t>::second));
    if (common == 0) return std::nullopt;
    CommonMeans result;
    result.left_out = arrivals.size() - common;
    for (const results::RunRecord* run : runs) {
        double sum = 0.0;
        for (const metrics::VehicleRow& vehicle : run->vehicles) {
            const auto found = arrivals.find(vehicle.id);
            if (found != arrivals.end() && found->second == runs.size()) sum += (vehicle.*number).value();
        }
        result.means.push_back(sum / static_cast<double>(common));
    }
    return result;
}

}  // namespace clearway::analysis::detail
