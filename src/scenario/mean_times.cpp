#include "scenario/mean_times.hpp"

#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/csv.hpp"
#include "core/files.hpp"
#include "core/number.hpp"

namespace clearway::scenario {
namespace {

using core::Problem;

constexpr std::string_view first_words = "# clearway mean times 1: ";
constexpr std::string_view header_line = "edge,vehicles,time_s";
constexpr double longest_s = 86400.0;
/// Problems of rows that are told; a file of something else has one in every row.
constexpr std::size_t most_problems = 20;
constexpr const char* cure_write = "`clearway scenario mean-times SCENARIO --out FILE` writes it";

/// What stands behind `key ` up to the next comma.
std::string_view word_after(std::string_view line, std::string_view key) {
    const std::size_t at = line.find(key);
    if (at == std::string_view::npos) return {};
    line.remove_prefix(at + key.size());
    return line.substr(0, line.find(','));
}

/// Reads the first line; the number of rows that the file should have, or nothing.
std::optional<std::size_t> read_origin(std::string_view line, MeanTimes& times) {
    if (!line.starts_with(first_words)) return std::nullopt;
    line.remove_prefix(first_words.size());
    times.network = word_after(line, "network ");
    const auto seed = core::number_from<std::uint64_t>(word_after(line, "study seed "));
    const auto runs = core::number_from<std::uint32_t>(word_after(line, "runs "));
    const auto edges = core::number_from<std::size_t>(word_after(line, "edges "));
    if (times.network.empty() || !seed || !runs || !edges) return std::nullopt;
    times.study_seed = *seed;
    times.replications = *runs;
    return edges;
}

/// What is wrong with a row, or an empty text.
std::string read_row(const std::vector<std::string_view>& cells, MeanTimes& times) {
    if (cells.size() != 3) return fmt::format("has {}", core::counted(cells.size(), "cell"));
    const auto vehicles = core::number_from<std::uint64_t>(cells[1]);
    const auto time_s = core::number_from(cells[2]);
    if (cells[0].empty()) return "names no edge";
    if (!vehicles || *vehicles == 0)
        return fmt::format("vehicles: \"{}\" is no whole number above 0", cells[1]);
    if (!time_s || !(*time_s > 0.0 && *time_s <= longest_s))
        return fmt::format("time_s: \"{}\" is no number above 0 and up to {:g}", cells[2], longest_s);
    times.edges.push_back({std::string(cells[0]), *vehicles, *time_s});
    return "";
}

void check_whole(const MeanTimes& times, std::size_t edges, const std::string& file,
                 std::vector<Problem>& problems) {
    std::set<std::string_view> seen;
    for (const EdgeMean& row : times.edges) {
        if (seen.insert(row.edge).second) continue;
        problems.push_back({file, fmt::format("edge '{}' is there twice", row.edge), "one row for each edge",
                            "Remove one of the rows"});
        return;
    }
    if (times.edges.size() == edges) return;
    problems.push_back(
        {file,
         fmt::format("has {}, and its first line says {}", core::counted(times.edges.size(), "row"), edges),
         "all of its rows", fmt::format("Copy it again, or write it again: {}", cure_write)});
}

}  // namespace

std::string mean_times_csv(const MeanTimes& times) {
    std::string text =
        fmt::format("{}network {}, study seed {}, runs {}, edges {}\n{}\n", first_words, times.network,
                    times.study_seed, times.replications, times.edges.size(), header_line);
    for (const EdgeMean& row : times.edges)
        text += fmt::format("{},{},{:.2f}\n", core::csv_text(row.edge), row.vehicles, row.time_s);
    return text;
}

MeanTimes read_mean_times(const std::filesystem::path& file, std::vector<Problem>& problems) {
    const std::string text = core::read_file(file);
    std::string_view rest = text;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // spreadsheets write it
    if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
    MeanTimes times;
    const std::optional<std::size_t> edges = read_origin(core::take_line(rest), times);
    if (!edges) {
        problems.push_back({file.string() + ":1", "is no file of mean times of this version",
                            fmt::format("`{}network HASH, study seed N, runs N, edges N`", first_words),
                            cure_write});
        return times;
    }
    if (const std::string_view header = core::take_line(rest); header != header_line) {
        problems.push_back({file.string() + ":2", fmt::format("\"{}\" are not the columns", header),
                            std::string(header_line), cure_write});
        return times;
    }
    const std::size_t before = problems.size();
    core::CsvReader reader(rest);
    std::size_t line = 3;
    try {
        for (; reader.next() && problems.size() < before + most_problems; ++line) {
            if (reader.cells().size() == 1 && reader.cells().front().empty()) continue;
            const std::string wrong = read_row(reader.cells(), times);
            if (!wrong.empty())
                problems.push_back(
                    {fmt::format("{}:{}", file.string(), line), wrong, std::string(header_line), ""});
        }
    } catch (const std::runtime_error& error) {
        problems.push_back({fmt::format("{}:{}", file.string(), line), error.what(), "", cure_write});
    }
    if (problems.size() == before) check_whole(times, *edges, file.string(), problems);
    return times;
}

std::vector<double> mean_times_of(const MeanTimes& times, const std::filesystem::path& file,
                                  const roads::Network& network, const std::string& inputs_hash) {
    if (times.network != inputs_hash)
        throw core::InputError({file.string(), fmt::format("holds times of network {}", times.network),
                                fmt::format("those of this scenario's network, {}", inputs_hash),
                                "Write it again for this scenario: remove network.mean_times, then `clearway "
                                "scenario mean-times SCENARIO --out FILE`"});
    std::vector<double> mean_s(network.edges().size(), 0.0);
    for (const EdgeMean& row : times.edges) {
        const auto edge = network.find_edge(row.edge);
        if (!edge)
            throw core::InputError({file.string(), fmt::format("the network has no edge '{}'", row.edge),
                                    "ids of its edges", cure_write});
        mean_s[edge->value] = row.time_s;
    }
    return mean_s;
}

}  // namespace clearway::scenario
