#include "report/signal_name.hpp"

#include "report/text.hpp"

namespace clearway::report {

std::string short_signal_name(const std::string& id) {
    constexpr std::size_t most = 24;
    return printable(id.size() <= most ? id : id.substr(0, most - 3) + "...");
}

}  // namespace clearway::report
