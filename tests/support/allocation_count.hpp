#pragma once

#include <cstddef>

namespace clearway::support {

/// Calls of operator new in this program so far. Only in test programs that list `allocation_count.cpp` among
/// their sources; it replaces the operator for the whole program.
std::size_t allocation_count();

}  // namespace clearway::support
