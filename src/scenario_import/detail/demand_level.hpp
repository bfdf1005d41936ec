#pragma once

#include "scenario_import/detail/context.hpp"
#include "scenario_import/detail/load_watch.hpp"

namespace clearway::scenario_import::detail {

/// A number of cars that a network can carry.
struct DemandLevel {
    int cars = 0;
    Load load;                ///< Under the first demand.
    double free_speed = 0.0;  ///< Mean ratio of speed to limit with `fewest_cars`, signals as they are.
    int fewest_cars = 0;
    int demands = 0;  ///< In so many demands it was tried.
};

/// Sets the number of cars of a synthetic demand, a share of them automated.
void set_cars(scenario::ScenarioConfig& config, int cars, double automated_share);

/// Finds the largest number of cars, on a ladder of at most ten rungs down from `most` (factor 1.5; at least
/// four cars), that the network can carry, tried with SUMO at steps of 1 s: everybody arrives by the horizon,
/// at most 1 % teleport, and over minutes 12 to 15 the mean speed is at least half of that on the lowest rung
/// and at most 5 % wait to enter. Two more demands are tried unless `most` is carried with room to spare
/// (LoadWatch::has_room). Begins at a usual density and bisects, so it makes two to eight runs; one ends as
/// soon as it is too much. Throws core::InputError, with the reason, when the network cannot carry the
/// lowest rung.
DemandLevel find_level(Import& import, scenario::ScenarioConfig& config, int most);

}  // namespace clearway::scenario_import::detail
