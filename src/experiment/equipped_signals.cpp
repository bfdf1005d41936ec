#include "experiment/equipped_signals.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/error.hpp"
#include "roads/signal_name.hpp"

namespace clearway::experiment {
namespace {

constexpr const char* allowed = "ids or numbers (#7) of signals separated by commas, all or none";

std::vector<std::string> ids_in(const std::string& text) {
    std::vector<std::string> ids;
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        ids.push_back(text.substr(begin, comma - begin));
        begin = comma + 1;
    }
    return ids;
}

}  // namespace

std::vector<core::Problem> check_equipped(const std::string& text, const std::string& where) {
    std::vector<core::Problem> problems;
    std::set<std::string> seen;
    for (const std::string& id : ids_in(text)) {
        if (id.empty()) {
            problems.push_back({where, fmt::format("\"{}\" has an empty id", text), allowed, ""});
        } else if (!seen.insert(id).second) {
            problems.push_back({where, fmt::format("names signal \"{}\" twice", id), allowed, ""});
        }
    }
    return problems;
}

std::vector<bool> equipped_signals(const ConditionSpec& condition, const roads::Network& network) {
    const auto set = condition.settings.find(equipped_setting);
    if (set == condition.settings.end() || set->second == all_equipped) return {};
    std::vector<bool> equipped(network.signals().size(), false);
    if (set->second == none_equipped) return equipped;
    const std::string where = fmt::format("condition {}: {}", condition.name, equipped_setting);
    std::vector<core::Problem> problems = check_equipped(set->second, where);
    for (const std::string& name : ids_in(set->second)) {
        if (name.empty()) continue;
        const auto signal = roads::named_signal(network, name, where, problems);
        if (!signal) continue;
        if (equipped[signal->value])
            problems.push_back(
                {where, fmt::format("\"{}\" is a signal that is named before", name), allowed, ""});
        equipped[signal->value] = true;
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return equipped;
}

}  // namespace clearway::experiment
