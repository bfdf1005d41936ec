#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenario_import/detail/left_out.hpp"
#include "scenario_import/import.hpp"
#include "scenario_import/sumo/additional.hpp"

namespace clearway::scenario_import::detail {

/// An element of the user's files that SUMO may complain about.
struct NamedElement {
    std::string name;  ///< `busStop`
    std::string id;
    std::string place;  ///< `stops.add.xml:12`
};

/// State shared by the steps of one import.
struct Import {
    const ImportRequest& request;
    const OnProgress& on_progress;
    std::filesystem::path scenario;  ///< The folder that becomes the scenario.
    std::filesystem::path work;      ///< For temporary files.
    Findings findings = {};
    LeftOut left_out = {};
    Additional additional = {};  ///< Contents of additional.add.xml.
    std::vector<NamedElement> named = {};
};

}  // namespace clearway::scenario_import::detail
