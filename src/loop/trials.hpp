#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "metrics/tried_choices.hpp"
#include "truth/events.hpp"

namespace clearway::loop {

class ClosedLoop;

/// Tries other choices in copies of a run, after its steps.
class TriedAtSteps {
  public:
    TriedAtSteps() = default;
    TriedAtSteps(const TriedAtSteps&) = delete;
    TriedAtSteps& operator=(const TriedAtSteps&) = delete;
    virtual ~TriedAtSteps() = default;

    /// After each step of `loop`: tries what is due, up to `horizon`. Throws core::EnvironmentError when no
    /// copy can be made, core::SimulatorError when one fails.
    virtual void look(ClosedLoop& loop, core::Seconds horizon) = 0;
};

/// Moments at which other choices for an emergency vehicle were driven to their ends in copies of the run.
class Trials {
  public:
    /// After each step of the run.
    void note(const truth::Events& events);
    /// Of `tried` others, these arrive at `others_s`. Several vehicles were chosen together: the one that
    /// arrives first is judged by the first of all, the second by the second, and so on.
    void add(std::vector<core::VehicleKey> vehicles, std::vector<double> others_s, std::uint64_t tried);
    /// Once the run is over; a vehicle that did not arrive counts with `horizon`.
    metrics::TriedChoices result(core::Seconds horizon) const;

  private:
    struct Trial {
        std::vector<core::VehicleKey> vehicles;
        std::vector<double> others_s;
        std::uint64_t tried = 0;
    };
    /// Sorted.
    std::vector<double> arrivals_s(const Trial& trial, core::Seconds horizon) const;

    std::map<core::VehicleKey, double> arrived_s_;
    std::vector<Trial> trials_;
};

}  // namespace clearway::loop
