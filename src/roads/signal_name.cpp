#include "roads/signal_name.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

namespace clearway::roads {

std::optional<core::SignalIndex> named_signal(const Network& network, const std::string& name,
                                              const std::string& where,
                                              std::vector<core::Problem>& problems) {
    if (const auto signal = network.find_signal(name)) return signal;
    const std::size_t count = network.signals().size();
    std::string cure = "`clearway scenario signals SCENARIO` lists them";
    if (name.starts_with('#')) {
        std::uint32_t number = 0;
        const char* const end = name.data() + name.size();
        const auto [rest, fault] = std::from_chars(name.data() + 1, end, number);
        if (fault == std::errc{} && rest == end && number >= 1 && number <= count)
            return core::SignalIndex{number - 1};
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
