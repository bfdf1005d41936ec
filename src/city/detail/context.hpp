#pragma once

#include <filesystem>

#include "city/detail/demand_reader.hpp"
#include "city/import.hpp"
#include "roads/network.hpp"

namespace clearway::city::detail {

/// What the steps of one import share.
struct Import {
    const ImportRequest& request;
    const OnProgress& on_progress;
    std::filesystem::path scenario;  ///< The folder that becomes the scenario's.
    std::filesystem::path work;      ///< For what is thrown away.
    Findings findings = {};
    LeftOut left_out = {};
};

}  // namespace clearway::city::detail
