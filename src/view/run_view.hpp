#pragma once

#include <string>

namespace clearway::view {

/// What a page shows of one run.
struct RunView {
    std::string about;   ///< JSON: run, scenario, condition, replication, policies, failure, predictor.
    std::string stream;  ///< Blocks.
    double begin_s = 0.0, end_s = 0.0;
};

}  // namespace clearway::view
