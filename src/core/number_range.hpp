#pragma once

#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/settings.hpp"

namespace clearway::core {

/// Validator of an option: a number from `minimum` to `maximum`, both inclusive.
struct NumberRange {
    double minimum;
    double maximum;

    /// The error message for `text`; empty when it is valid.
    std::string operator()(const std::string& text) const {
        double number = 0.0;
        const std::optional<Problem> problem = set_member(*this, text, "", number);
        return problem ? fmt::format("{} (allowed: {})", problem->what, problem->allowed) : std::string();
    }
};

}  // namespace clearway::core
