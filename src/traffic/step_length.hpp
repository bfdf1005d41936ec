#pragma once

namespace clearway::traffic {

/// Coarser steps are for a comparison with figures made with such steps, and output marks them: decision 1.
inline constexpr double coarsest_trusted_step_s = 0.25;

}  // namespace clearway::traffic
