#pragma once

#include <string_view>

namespace clearway::core {

/// Hash, 16 hex digits, of the sources of everything that makes a run: the worker and the modules it is made
/// of. `clearway` and `clearway-run` each carry that of their own build, and work together only if both are
/// the same, since defaults of settings and built-in models are in both. Other sources do not change it, nor
/// do commits. Only targets that link `clearway_build_stamp` have it, so that a change of a source links
/// those anew and no others.
std::string_view build_stamp();

}  // namespace clearway::core
