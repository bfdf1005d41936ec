#pragma once

#include <filesystem>

#include "roads/network.hpp"
#include "scenario_import/detail/additional.hpp"
#include "scenario_import/detail/demand_reader.hpp"
#include "scenario_import/import.hpp"

namespace clearway::scenario_import::detail {

/// Departures that a scenario takes, times of the route files.
struct Window {
    double begin_s = 0.0;
    double length_s = 0.0;

    double end_s() const { return begin_s + length_s; }
    bool holds(double depart_s) const { return depart_s >= begin_s && depart_s < end_s(); }
};

/// What the steps of one import share.
struct Import {
    const ImportRequest& request;
    const OnProgress& on_progress;
    std::filesystem::path scenario;  ///< The folder that becomes the scenario's.
    std::filesystem::path work;      ///< For what is thrown away.
    Findings findings = {};
    LeftOut left_out = {};
    Additional additional = {};  ///< What additional.add.xml holds.
};

}  // namespace clearway::scenario_import::detail
