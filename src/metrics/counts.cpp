#include "metrics/counts.hpp"

#include <cmath>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/number.hpp"

namespace clearway::metrics {
namespace {

constexpr const char* header = "edge,vehicles_per_hour";

/// False unless the text is a finite number, 0 or more.
bool read_flow(const std::string& text, double& flow) {
    flow = core::number_from(text).value_or(-1.0);
    return std::isfinite(flow) && flow >= 0.0;
}

/// The next line, without the carriage return of other systems.
std::string line_from(std::istringstream& lines, bool& found) {
    std::string line;
    found = static_cast<bool>(std::getline(lines, line));
    if (line.ends_with('\r')) line.pop_back();
    return line;
}

}  // namespace

std::vector<EdgeCount> read_counts(const std::filesystem::path& file) {
    std::istringstream lines(core::read_file(file));
    std::vector<core::Problem> problems;
    const auto refuse = [&](std::size_t line, const std::string& what, const std::string& allowed) {
        problems.push_back({fmt::format("{}:{}", file.string(), line), what, allowed, ""});
    };
    bool found = false;
    const bool header_fits = line_from(lines, found) == header;
    if (!header_fits) refuse(1, "is not the header of counted flows", header);
    std::vector<EdgeCount> counts;
    std::set<std::string> edges;
    for (std::size_t number = 2; header_fits; ++number) {
        const std::string line = line_from(lines, found);
        if (!found) break;
        if (line.empty()) continue;
        const std::size_t comma = line.rfind(',');
        EdgeCount count;
        if (comma == std::string::npos || comma == 0 ||
            !read_flow(line.substr(comma + 1), count.vehicles_per_hour)) {
            refuse(number, fmt::format("\"{}\" is not a counted flow", line),
                   "EDGE,NUMBER with a number of 0 or more");
            continue;
        }
        count.edge = line.substr(0, comma);
        if (!edges.insert(count.edge).second)
            refuse(number, fmt::format("edge {} is listed twice", count.edge), "");
        counts.push_back(std::move(count));
    }
    if (problems.empty() && counts.empty()) refuse(2, "lists no edge", "at least one");
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return counts;
}

}  // namespace clearway::metrics
