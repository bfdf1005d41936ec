#pragma once

#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/settings.hpp"

namespace clearway::core {

/// The numbers from `minimum` to `maximum`, both included, as a check of an option. What is not finite is
/// none of them.
struct NumberRange {
    double minimum;
    double maximum;

    /// What is wrong with `text` as one of these numbers; empty when nothing is.
    std::string operator()(const std::string& text) const {
        double number = 0.0;
        const std::optional<Problem> problem = set_member(*this, text, "", number);
        return problem ? fmt::format("{} (allowed: {})", problem->what, problem->allowed) : std::string();
    }
};

}  // namespace clearway::core
