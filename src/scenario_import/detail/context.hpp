#pragma once

#include <filesystem>

#include "scenario_import/detail/left_out.hpp"
#include "scenario_import/import.hpp"
#include "scenario_import/sumo/additional.hpp"

namespace clearway::scenario_import::detail {

/// State shared by the steps of one import.
struct Import {
    const ImportRequest& request;
    const OnProgress& on_progress;
    std::filesystem::path scenario;  ///< The folder that becomes the scenario.
    std::filesystem::path work;      ///< For temporary files.
    Findings findings = {};
    LeftOut left_out = {};
    Additional additional = {};  ///< Contents of additional.add.xml.
};

}  // namespace clearway::scenario_import::detail
