#pragma once

namespace clearway::metrics::detail {

/// A vehicle below this speed stands, m/s: SUMO's own threshold for waiting.
inline constexpr float standing_mps = 0.1F;

}  // namespace clearway::metrics::detail
