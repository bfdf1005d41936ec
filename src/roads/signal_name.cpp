#include "roads/signal_name.hpp"

#include <fmt/format.h>

#include "core/number.hpp"

namespace clearway::roads {

std::optional<core::SignalIndex> named_signal(const Network& network, const std::string& name,
                                              const std::string& where,
                                              std::vector<core::Problem>& problems) {
    if (const auto signal = network.find_signal(name)) return signal;
    const std::size_t count = network.signals().size();
    std::string cure = "`clearway scenario signals SCENARIO` lists them";
    const bool is_numbered = name.starts_with('#');
    const auto number = core::number_from<std::uint32_t>(name.substr(is_numbered ? 1 : 0));
    const bool is_known = number && *number >= 1 && *number <= count;
    if (is_numbered) {
        if (is_known) return core::SignalIndex{*number - 1};
    } else if (is_known) {
        cure = fmt::format("Did you mean '#{}'?", *number);
    } else {
        cure = core::did_you_mean(name, core::texts_of(network.signals(), &Signal::id), cure);
    }
    problems.push_back({where, fmt::format("the network has no signal '{}'", name),
                        count == 0 ? "none: the network has no signals"
                                   : fmt::format("ids of its signals, or their numbers, #1 to #{}", count),
                        cure});
    return std::nullopt;
}

}  // namespace clearway::roads
