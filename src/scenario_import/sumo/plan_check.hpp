#pragma once

#include <vector>

#include "core/error.hpp"
#include "roads/network.hpp"
#include "scenario_import/detail/context.hpp"
#include "scenario_import/sumo/demand_reader.hpp"

namespace clearway::scenario_import::detail {

/// Removes the persons whose plan SUMO 1.15 would reject, or whose walk would crash it, and counts them in
/// `left_out`. Returns them as problems, up to `named_problems`. The walks of the others have edges, or
/// `from` and `to`. `additional` has the stops that they name.
std::vector<core::Problem> take_out_bad_persons(Demand& demand, const roads::Network& network,
                                                const std::vector<Element>& additional, LeftOut& left_out);

}  // namespace clearway::scenario_import::detail
