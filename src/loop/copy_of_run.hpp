#pragma once

#include <filesystem>
#include <functional>

#include "core/units.hpp"

namespace clearway::loop {

/// What `drive` finds in a forked copy of the whole run, which ends with it: the run itself does not notice.
/// The copy writes into `folder`, which is made and removed. Throws core::EnvironmentError when no copy can
/// be made, core::SimulatorError when it does not come to its end; its own words go to standard error.
core::Seconds in_copy(const std::filesystem::path& folder, const std::function<core::Seconds()>& drive);

}  // namespace clearway::loop
