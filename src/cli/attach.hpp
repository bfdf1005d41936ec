#pragma once

#include "cli/verb.hpp"

namespace clearway::cli {

/// `clearway attach`: the pipeline on a SUMO that was started elsewhere.
Action configure_attach(CLI::App& app);

}  // namespace clearway::cli
