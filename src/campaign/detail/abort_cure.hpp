#pragma once

#include <string>

#include "results/record.hpp"

namespace clearway::campaign {

/// What helps after SUMO or Clearway itself aborted a run, by the assertion in its log; empty for other
/// errors.
std::string cure_of_abort(const results::RunError& error);

}  // namespace clearway::campaign
