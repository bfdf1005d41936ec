#pragma once

#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "core/ids.hpp"
#include "core/random.hpp"
#include "core/units.hpp"
#include "drivers/detail/drawn_reaction.hpp"
#include "truth/snapshot.hpp"

namespace clearway::drivers {

/// Which human drivers do what a policy asks of them.
struct RequestConfig {
    double compliance = 0.0;
    double hearing_m = 150.0;
    double reaction_mean_s = 1.5;
    double reaction_deviation_s = 0.5;
    double fastest_reaction_s = 0.3;
    double memory_s = 3.0;

    static constexpr auto fields() {
        using C = RequestConfig;
        using core::Field;
        return std::make_tuple(
            Field{"compliance", "1", &C::compliance, 0.0, 1.0,
                  "Share of human drivers who do what a policy asks for an emergency vehicle",
                  "0: only automated vehicles take requests"},
            Field{"hearing_m", "m", &C::hearing_m, 1.0, 2000.0,
                  "They hear the emergency vehicle, or its request on their display, within this distance",
                  "assumed: a siren outside towns"},
            Field{"reaction_mean_s", "s", &C::reaction_mean_s, 0.0, 10.0,
                  "Mean time between hearing it and doing what is asked",
                  "assumed: surprise reaction, 1.5 s"},
            Field{"reaction_deviation_s", "s", &C::reaction_deviation_s, 0.0, 5.0,
                  "Standard deviation of that time between drivers", "assumed: a third of the mean"},
            Field{"fastest_reaction_s", "s", &C::fastest_reaction_s, 0.0, 10.0,
                  "Shortest reaction time of any driver", "assumed: simple reaction time"},
            Field{"memory_s", "s", &C::memory_s, 0.1, 60.0,
                  "An emergency vehicle that was not heard for this long is forgotten", "assumed"});
    }
};

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
