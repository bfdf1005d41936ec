#pragma once

#include <string>

namespace clearway::links {

/// Two predictors that a benchmark compares, as it says in advance.
struct ComparedPair {
    std::string predictor;
    std::string against;

    bool operator==(const ComparedPair&) const = default;
};

}  // namespace clearway::links
