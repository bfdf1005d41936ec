#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/random.hpp"
#include "core/units.hpp"
#include "drivers/config.hpp"
#include "drivers/detail/drawn_reaction.hpp"
#include "truth/snapshot.hpp"

namespace clearway::drivers {

/// Human drivers who do what a policy asks of them. Whether one complies and how fast is drawn by driver, so
/// it is the same in every condition. Part of the environment: it sees the truth, as ears do. One per run;
/// single-threaded.
class Listeners {
  public:
    Listeners(const core::KeyedRandom& random, const RequestConfig& config);

    /// Drivers who take requests from this step on, ordered by key. Valid until the next call. None if
    /// compliance is 0.
    std::span<const core::VehicleKey> step(const truth::Snapshot& snapshot);

  private:
    struct Hearing {
        core::Seconds since;
        core::Seconds last;
    };

    RequestConfig config_;
    detail::DrawnReaction reactions_;
    std::map<core::VehicleKey, Hearing> heard_;
    std::vector<core::VehicleKey> ready_;
};

}  // namespace clearway::drivers
