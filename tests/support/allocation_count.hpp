#pragma once

#include <cstddef>

namespace clearway::support {

/// Calls of operator new in this program so far. Only in test programs that list `allocation_count.cpp` among
/// their sources; it replaces the operator for the whole program.
std::size_t allocation_count();

/// From now on `look` is called in each of these calls, to see where it comes from; null ends that. What it
/// allocates itself is not looked at.
void look_at_allocations(void (*look)());

}  // namespace clearway::support
