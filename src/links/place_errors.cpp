#include "links/place_errors.hpp"

#include <algorithm>
#include <tuple>

#include "links/detail/sparse_bins.hpp"

namespace clearway::links {
namespace {

constexpr double fine_end_m = 200.0;
constexpr double fine_bins_per_m = 10.0;
constexpr std::uint32_t fine_bins = 2000;
constexpr std::uint32_t last_bin = PlaceGrid::size - 1;

}  // namespace

void LaneOrder::add(core::VehicleIndex row, core::LaneIndex lane, float lane_position_m) {
    if (lane.exists()) places_.push_back({lane, lane_position_m, row});
}

void LaneOrder::sort() {
    std::ranges::sort(places_, {}, [](const Place& place) {
        return std::make_tuple(place.lane, place.position_m, place.row);
    });
}

core::VehicleIndex LaneOrder::next_ahead(core::LaneIndex lane, float lane_position_m) const {
    if (!lane.exists()) return core::no_row;
    const auto next = std::ranges::upper_bound(
        places_, std::make_pair(lane, lane_position_m), {},
        [](const Place& place) { return std::make_pair(place.lane, place.position_m); });
    if (next == places_.end() || next->lane != lane) return core::no_row;
    return next->position_m - lane_position_m <= next_ahead_horizon_m ? next->row : core::no_row;
}

std::uint32_t PlaceGrid::bin_of(double error_m) {
    if (error_m < fine_end_m) {
        // Rounding may carry a value just below the end of the fine bins over it.
        return std::min(static_cast<std::uint32_t>(error_m * fine_bins_per_m), fine_bins - 1);
    }
    const double above = std::min(error_m - fine_end_m, static_cast<double>(last_bin - fine_bins));
    return fine_bins + static_cast<std::uint32_t>(above);
}

double PlaceGrid::lower_edge_m(std::uint32_t bin) {
    if (bin < fine_bins) return static_cast<double>(bin) / fine_bins_per_m;
    return fine_end_m + static_cast<double>(std::min(bin, last_bin) - fine_bins);
}

std::uint64_t PlaceErrors::vehicles() const {
    std::uint64_t count = 0;
    for (const Bin& bin : bins)
        count += bin.vehicles;
    return count;
}

void PlaceErrors::add(const PlaceErrors& other) {
    detail::add_bins(bins, other.bins, [](Bin& sum, const Bin& bin) { sum.vehicles += bin.vehicles; });
}

void PlaceHistogram::add(double error_m) {
    if (counts_.empty()) counts_.resize(PlaceGrid::size);
    ++counts_[PlaceGrid::bin_of(error_m)];
}

PlaceErrors PlaceHistogram::errors() const {
    PlaceErrors errors;
    for (std::uint32_t bin = 0; bin < counts_.size(); ++bin) {
        if (counts_[bin] > 0) errors.bins.push_back({bin, counts_[bin]});
    }
    return errors;
}

std::optional<double> quantile_m(const PlaceErrors& errors, double share) {
    const double wanted = share * static_cast<double>(errors.vehicles());
    double passed = 0.0;
    for (const PlaceErrors::Bin& bin : errors.bins) {
        const auto vehicles = static_cast<double>(bin.vehicles);
        if (passed + vehicles >= wanted) {
            const double low = PlaceGrid::lower_edge_m(bin.bin);
            return low + (PlaceGrid::lower_edge_m(bin.bin + 1) - low) * (wanted - passed) / vehicles;
        }
        passed += vehicles;
    }
    return std::nullopt;
}

}  // namespace clearway::links
