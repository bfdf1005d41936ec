#include "samples/dataset_files.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/number.hpp"

namespace clearway::samples {
namespace {

constexpr std::size_t most_problems = 20;

/// Collects problems; beyond `most_problems` it only counts them.
class Problems {
  public:
    void add(core::Problem problem) {
        if (problems_.size() < most_problems)
            problems_.push_back(std::move(problem));
        else
            ++more_;
    }
    void throw_if_any() {
        if (problems_.empty()) return;
        if (more_ > 0) problems_.push_back({"and", fmt::format("{} more of this kind", more_), "", ""});
        throw core::InputError(std::move(problems_));
    }

  private:
    std::vector<core::Problem> problems_;
    std::size_t more_ = 0;
};

/// A file as rows of trimmed cells, without empty lines at the end.
struct Table {
    std::string file;
    std::vector<std::vector<std::string_view>> rows;

    std::string where(std::size_t row, std::size_t column) const {
        return fmt::format("{}:{}: value {}", file, row + 1, column + 1);
    }
    std::string where(std::size_t row) const { return fmt::format("{}:{}", file, row + 1); }
};

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    while (true) {
        const std::size_t end = text.find(separator);
        parts.push_back(trimmed(text.substr(0, end)));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

/// `content` must outlive the table.
Table parse(const std::string& file, std::string_view content) {
    const std::size_t last = content.find_last_not_of(" \t\r\n");
    Table table{file, {}};
    if (last == std::string_view::npos) return table;
    for (std::string_view line : split(content.substr(0, last + 1), '\n'))
        table.rows.push_back(split(line, ','));
    return table;
}

template <class Number>
std::optional<Number> number_from(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    return core::number_from<Number>(text);
}

std::string quoted(std::string_view text) {
    constexpr std::size_t longest = 40;
    return text.empty() ? "nothing"
                        : fmt::format("`{}`{}", text.substr(0, longest), text.size() > longest ? "..." : "");
}

void read_features(const Table& table, PairDataset& dataset, Problems& problems) {
    if (table.rows.empty()) {
        problems.add({table.file, "no vehicle", "one row per vehicle", "Write the data set again"});
        return;
    }
    const std::size_t columns = table.rows[0].size();
    if (columns != 2 && columns != 5) {
        problems.add({table.where(0), fmt::format("{} values", columns), "2 or 5",
                      "GraphSAGENet takes 2 or 5 features per vehicle"});
        return;
    }
    dataset.feature_count = static_cast<std::uint32_t>(columns);
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        if (table.rows[row].size() != columns) {
            problems.add({table.where(row),
                          fmt::format("{} values, the first row has {}", table.rows[row].size(), columns),
                          fmt::format("{}", columns), "Give every vehicle the same number of features"});
        }
        for (std::size_t column = 0; column < table.rows[row].size(); ++column) {
            const auto value = number_from<float>(table.rows[row][column]);
            if (!value || !std::isfinite(*value)) {
                problems.add({table.where(row, column), quoted(table.rows[row][column]), "a finite number",
                              "Correct the value or leave the vehicle out"});
            }
            dataset.features.push_back(value.value_or(0.0F));
        }
    }
}

std::vector<std::uint32_t> read_indices(const Table& table, std::size_t row, std::size_t vehicles,
                                        Problems& problems) {
    std::vector<std::uint32_t> indices;
    for (std::size_t column = 0; column < table.rows[row].size(); ++column) {
        const std::string_view text = table.rows[row][column];
        const auto value = number_from<long long>(text);
        if (!value) {
            problems.add(
                {table.where(row, column), quoted(text), "an integer", "Give the vehicle's row, from 0"});
        } else if (*value < 0 || static_cast<unsigned long long>(*value) >= vehicles) {
            problems.add(
                {table.where(row, column),
                 fmt::format("vehicle {}, but {} has {} rows", *value, vehicle_features_file, vehicles),
                 vehicles == 0 ? "" : fmt::format("0 to {}", vehicles - 1),
                 "Correct the index or add the vehicle's features"});
        }
        indices.push_back(static_cast<std::uint32_t>(value.value_or(0)));
    }
    return indices;
}

void read_edges(const Table& table, PairDataset& dataset, Problems& problems) {
    if (table.rows.size() != 2) {
        problems.add({table.file, fmt::format("{} rows", table.rows.size()), "2",
                      "Write the sources in the first row and the targets in the second"});
        return;
    }
    dataset.source = read_indices(table, 0, dataset.vehicle_count(), problems);
    dataset.target = read_indices(table, 1, dataset.vehicle_count(), problems);
    if (dataset.source.size() != dataset.target.size()) {
        problems.add({table.where(1),
                      fmt::format("{} targets for {} sources", dataset.target.size(), dataset.source.size()),
                      "rows of equal length", "Write one target for each source"});
        return;
    }
    for (std::size_t pair = 0; pair < dataset.source.size(); ++pair) {
        if (dataset.source[pair] == dataset.target[pair]) {
            problems.add({table.where(1, pair),
                          fmt::format("vehicle {} paired with itself", dataset.target[pair]),
                          "two different vehicles", "Remove the pair and its label"});
        }
    }
}

void read_labels(const Table& table, PairDataset& dataset, Problems& problems) {
    if (table.rows.size() != 1) {
        problems.add(
            {table.file, fmt::format("{} rows", table.rows.size()), "1", "Write all labels in one row"});
        return;
    }
    for (std::size_t column = 0; column < table.rows[0].size(); ++column) {
        const std::string_view text = table.rows[0][column];
        const auto value = number_from<float>(text);
        if (!value || (*value != 0.0F && *value != 1.0F)) {
            problems.add(
                {table.where(0, column), quoted(text), "0 or 1", "Write 1 for a link and 0 for none"});
        }
        dataset.label.push_back(value.value_or(0.0F));
    }
    if (dataset.label.size() != dataset.source.size()) {
        problems.add({table.where(0),
                      fmt::format("{} labels, but {} has {} pairs", dataset.label.size(), edge_list_file,
                                  dataset.source.size()),
                      "one label per pair", "Write both files from the same snapshot"});
    }
}

std::string joined(const auto& values) {
    return fmt::format("{}\n", fmt::join(values, ","));
}

}  // namespace

PairDataset read_pair_dataset(const std::filesystem::path& folder) {
    Problems problems;
    const auto content_of = [&](const char* name) -> std::string {
        try {
            return core::read_file(folder / name);
        } catch (const core::InputError&) {
            problems.add({(folder / name).string(), "cannot be read",
                          "a folder with edge_list.csv, vehicle_features.csv "
                          "and target_y.csv",
                          "Make one with `clearway links dataset SCENARIO --out DIR`"});
            return {};
        }
    };
    const std::string features = content_of(vehicle_features_file);
    const std::string edges = content_of(edge_list_file);
    const std::string labels = content_of(target_file);
    problems.throw_if_any();

    PairDataset dataset;
    read_features(parse((folder / vehicle_features_file).string(), features), dataset, problems);
    problems.throw_if_any();
    read_edges(parse((folder / edge_list_file).string(), edges), dataset, problems);
    read_labels(parse((folder / target_file).string(), labels), dataset, problems);
    problems.throw_if_any();
    return dataset;
}

void write_pair_dataset(const std::filesystem::path& folder, const PairDataset& dataset) {
    if ((dataset.feature_count != 2 && dataset.feature_count != 5) ||
        dataset.features.size() != dataset.vehicle_count() * dataset.feature_count ||
        dataset.source.size() != dataset.label.size() || dataset.target.size() != dataset.label.size()) {
        throw std::logic_error("pair data set: the sizes of its columns differ");
    }
    std::string rows;
    for (std::size_t vehicle = 0; vehicle < dataset.vehicle_count(); ++vehicle) {
        const auto first =
            dataset.features.begin() + static_cast<std::ptrdiff_t>(vehicle * dataset.feature_count);
        rows += fmt::format("{}\n", fmt::join(first, first + dataset.feature_count, ","));
    }
    core::make_folder(folder);
    core::write_atomically(folder / vehicle_features_file, rows);
    core::write_atomically(folder / edge_list_file, joined(dataset.source) + joined(dataset.target));
    core::write_atomically(folder / target_file, joined(dataset.label));
}

}  // namespace clearway::samples
