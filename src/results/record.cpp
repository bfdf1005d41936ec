#include "results/record.hpp"

#include <array>

#include <fmt/format.h>

namespace clearway::results {
namespace {

constexpr std::array causes = {FailureCause::simulator, FailureCause::signal,    FailureCause::time_limit,
                               FailureCause::memory,    FailureCause::bad_input, FailureCause::other};

}  // namespace

std::string_view name(FailureCause cause) {
    switch (cause) {
        case FailureCause::simulator:
            return "simulator";
        case FailureCause::signal:
            return "signal";
        case FailureCause::time_limit:
            return "time_limit";
        case FailureCause::memory:
            return "memory";
        case FailureCause::bad_input:
            return "bad_input";
        case FailureCause::other:
            return "other";
    }
    return "";
}

std::optional<FailureCause> failure_cause_from(std::string_view word) {
    for (const FailureCause cause : causes) {
        if (name(cause) == word) return cause;
    }
    return std::nullopt;
}

bool worth_retrying(FailureCause cause) {
    return cause == FailureCause::signal || cause == FailureCause::time_limit;
}

}  // namespace clearway::results
