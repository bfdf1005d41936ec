#pragma once

#include <vector>

namespace clearway::analysis::examples {

/// Hours of additional sleep of ten patients under two drugs. Student 1908, "The probable error of a mean",
/// Biometrika 6; data set `sleep` of R.
inline const std::vector<double> first_drug = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
inline const std::vector<double> second_drug = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

/// Cross- less self-fertilised maize, eighths of an inch. Darwin 1876, in Fisher 1935, "The Design of
/// Experiments", section 17.
inline const std::vector<double> maize = {49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48};

/// Depression scale factor of nine patients at two visits. Hollander and Wolfe 1973, table 3.1; R's help page
/// of wilcox.test.
inline const std::vector<double> first_visit = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
inline const std::vector<double> second_visit = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};

/// Spatial test, column A. Efron and Tibshirani 1993, table 14.1.
inline const std::vector<double> spatial_a = {48, 36, 20, 29, 42, 42, 20, 42, 22, 41, 45, 14, 6,
                                              0,  33, 28, 34, 4,  32, 24, 47, 41, 24, 26, 30, 41};

}  // namespace clearway::analysis::examples
