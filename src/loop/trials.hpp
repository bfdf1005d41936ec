#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "metrics/tried_choices.hpp"
#include "truth/events.hpp"

namespace clearway::loop {

/// Moments at which other choices for an emergency vehicle were driven to their ends in copies of the run.
class Trials {
  public:
    /// After each step of the run.
    void note(const truth::Events& events);
    /// The fastest of `tried` others arrives at `best`.
    void add(core::VehicleKey vehicle, core::Seconds best, std::uint64_t tried);
    /// Once the run is over; a vehicle that did not arrive counts with `horizon`.
    metrics::TriedChoices result(core::Seconds horizon) const;

  private:
    struct Trial {
        core::VehicleKey vehicle;
        double best_s = 0.0;
        std::uint64_t tried = 0;
    };
    std::map<core::VehicleKey, double> arrived_s_;
    std::vector<Trial> trials_;
};

}  // namespace clearway::loop
