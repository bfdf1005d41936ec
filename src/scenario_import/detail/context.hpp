#pragma once

#include <filesystem>

#include "scenario_import/detail/left_out.hpp"
#include "scenario_import/import.hpp"
#include "scenario_import/sumo/additional.hpp"

namespace clearway::scenario_import::detail {

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
