#include "scenario_import/detail/left_out.hpp"

#include <fmt/format.h>

namespace clearway::scenario_import::detail {

void LeftOut::add(const std::string& what, const std::string& example, std::size_t examples) {
    Count& count = counts_[what];
    ++count.number;
    if (!example.empty() && count.examples.size() < examples) count.examples.push_back(example);
}

std::vector<std::string> LeftOut::lines() const {
    std::vector<std::string> lines;
    for (const auto& [what, count] : counts_) {
        std::string line = fmt::format("{} {}", count.number, what);
        if (!count.examples.empty())
            line += fmt::format(" ({}{})", fmt::join(count.examples, ", "),
                                count.number > count.examples.size() ? ", ..." : "");
        lines.push_back(std::move(line));
    }
    return lines;
}

}  // namespace clearway::scenario_import::detail
