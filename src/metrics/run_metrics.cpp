#include "metrics/run_metrics.hpp"

namespace clearway::metrics {
namespace {

std::optional<double> share(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) return std::nullopt;
    return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::optional<double> LinkCounts::precision() const {
    return share(true_positive, true_positive + false_positive);
}

std::optional<double> LinkCounts::recall() const {
    return share(true_positive, true_positive + false_negative);
}

std::optional<double> LinkCounts::f1() const {
    return share(2 * true_positive, 2 * true_positive + false_positive + false_negative);
}

bool is_held_up(const RunMetrics& run) {
    constexpr std::uint64_t many = 100;  // one vehicle in so many
    return run.locked_emergency_vehicles > 0 || many * run.locked_vehicles > run.vehicle_count;
}

}  // namespace clearway::metrics
