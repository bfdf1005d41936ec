#pragma once

#include <string>

#include "core/error.hpp"

namespace clearway::support {

/// The message of the error that `action` throws; empty when it throws none.
template <class Error = core::InputError, class Action>
std::string message_of(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace clearway::support
