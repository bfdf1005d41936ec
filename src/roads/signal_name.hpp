#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/ids.hpp"
#include "roads/network.hpp"

namespace clearway::roads {

/// The signal that a user names: by SUMO's id, or `#7` by the number that tables and maps show, from 1. An id
/// that looks like a number comes first. Nothing after adding a problem at `where`.
std::optional<core::SignalIndex> named_signal(const Network& network, const std::string& name,
                                              const std::string& where, std::vector<core::Problem>& problems);

}  // namespace clearway::roads
