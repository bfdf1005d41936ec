#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "prediction/candidates.hpp"

namespace clearway::prediction {

struct MotionContext;

namespace detail {

/// A neighbour detects a vehicle that is not known. Rows of the scene's tracks.
struct Detection {
    std::uint32_t row = 0;   ///< The vehicle that is not known.
    std::uint32_t from = 0;  ///< The neighbour, known or not.
    float range_m = -1.0F;   ///< Measured distance; negative: presence alone.
    auto operator<=>(const Detection&) const = default;
};

/// The detections of a scene by the vehicle that is detected. No allocation once it has grown.
class Detections {
  public:
    void list(const Scene& scene);
    /// By neighbour. O(log detections).
    std::span<const Detection> of(std::uint32_t row) const;

  private:
    std::vector<Detection> all_;  ///< Sorted.
};

/// The displacement of a vehicle in which what is believed of it and what neighbours with known places detect
/// agree best (step 4 of MotionContextBuilder).
float agreed_displacement_m(const MotionContext& entry, std::span<const Detection> detections,
                            const Tracks& tracks, double link_radius_m, float believed_m);

}  // namespace detail
}  // namespace clearway::prediction
