#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "failures/failure_config.hpp"
#include "graph/proximity.hpp"
#include "roads/network.hpp"
#include "sensing/line_of_sight.hpp"
#include "truth/snapshot.hpp"

namespace clearway::sensing {

/// The middle of a signal's stop lines; nothing for a signal without lanes.
std::optional<Place> place_of(const roads::Network& network, const roads::Signal& signal);

/// Finds vehicles that do not report but are seen by others: by units at signals, by automated and emergency
/// vehicles that report, and by the sensors of emergency vehicles, which need no report. Keeps buffers;
/// single-threaded.
///
/// A roadside unit stands in the middle of the stop lines of its signal, above the traffic, so nothing hides
/// a vehicle from it. A vehicle looks from its centre to the centres of others; with occlusion, a third
/// vehicle whose box meets that line hides them; from the sensors of emergency vehicles it always does.
/// Vehicles that are seen are identified: trackers keep their
/// identity.
class Observers {
  public:
    Observers(const failures::FailureConfig& config, const roads::Network& network);
    bool none() const { return units_.empty() && onboard_range_m_ == 0.0 && emergency_range_m_ == 0.0; }
    bool considers_occlusion() const { return occlusion_ == failures::Occlusion::considered; }

    /// Stores the boxes of a snapshot, for `hidden` and `look`.
    void take(const truth::Snapshot& snapshot, const traffic::Roster& roster);
    /// Standard error of the seen position of each row, m; negative if nothing sees it, 0 for rows that
    /// report (`reports`). The better of two sensors counts.
    void look(const truth::Snapshot& snapshot, std::span<const std::uint8_t> reports,
              std::vector<float>& sigma_m);
    /// Whether another vehicle stands between two rows of the snapshot. `near` must have all vehicles that
    /// are no farther from the first than the second is.
    bool hidden(core::VehicleIndex from, core::VehicleIndex to,
                std::span<const core::VehicleIndex> near) const;

  private:
    void look_from_roadside(const truth::Snapshot& snapshot, std::span<const std::uint8_t> reports,
                            std::vector<float>& sigma_m) const;
    void look_from_vehicles(const truth::Snapshot& snapshot, std::span<const std::uint8_t> reports,
                            std::vector<float>& sigma_m);

    void look_from_emergency_vehicles(const truth::Snapshot& snapshot, std::span<const std::uint8_t> reports,
                                      std::vector<float>& sigma_m);

    double onboard_range_m_;
    float onboard_sigma_m_;
    double emergency_range_m_;
    float emergency_sigma_m_;
    float roadside_range_m_;
    float roadside_sigma_m_;
    failures::Occlusion occlusion_;
    std::vector<Place> units_;
    std::vector<Box> boxes_;  ///< By row.
    std::vector<float> centre_x_m_, centre_y_m_;
    graph::ProximityBuilder builder_;
    graph::ProximityGraph near_;
};

}  // namespace clearway::sensing
