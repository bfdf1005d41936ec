#pragma once

#include <string>
#include <vector>

#include "experiment/condition.hpp"
#include "roads/network.hpp"

namespace clearway::experiment {

/// The setting that says which signals are equipped: their ids or numbers (roads::named_signal) separated by
/// commas, `all` or `none`. A signal that is not equipped takes part in no policy: it hears no request, holds
/// no green and gives no time back, as if there were no policy for it.
inline constexpr const char* equipped_setting = "actuation.equipped";
inline constexpr const char* all_equipped = "all";
inline constexpr const char* none_equipped = "none";

/// What is wrong with the text of that setting whatever the network: an id that is empty or named twice.
std::vector<core::Problem> check_equipped(const std::string& text, const std::string& where);

/// By core::SignalIndex; empty: all are. Throws core::InputError with every signal that the network does
/// not have.
std::vector<bool> equipped_signals(const ConditionSpec& condition, const roads::Network& network);

}  // namespace clearway::experiment
