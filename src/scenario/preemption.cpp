#include "scenario/preemption.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/number.hpp"
#include "roads/own_clearance.hpp"
#include "roads/signal_name.hpp"
#include "traffic/signal.hpp"

namespace clearway::scenario {
namespace {

using core::Problem;
using traffic::Preemption;

constexpr const char* name_column = "signal";

std::vector<std::string> column_names() {
    std::vector<std::string> names = {name_column};
    core::for_each_field<Preemption>([&](const auto& field) { names.emplace_back(field.name); });
    return names;
}

std::string column_line() {
    return fmt::format("{}", fmt::join(column_names(), ","));
}

/// Line ends of other systems, and the mark that spreadsheets put before UTF-8.
std::string normalised(std::string text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    std::erase(text, '\r');
    return text;
}

/// A file while it is read.
class Reading {
  public:
    Reading(const std::filesystem::path& file, std::vector<Problem>& problems)
        : file_(file.string()), problems_(problems) {}

    /// Where each column stands; empty after a header that does not fit.
    void read_header(const std::vector<std::string_view>& cells) {
        if (cells.size() == 1 && refuse_separator(cells.front())) return;
        const std::vector<std::string> known = column_names();
        const std::size_t before = problems_.size();
        for (const std::string_view cell : cells) {
            const std::string name(cell);
            if (!core::contains(known, name))
                refuse(1, name, "is no column of this file", column_line(), core::did_you_mean(name, known));
            else if (core::contains(columns_, name))
                refuse(1, name, "is there twice", "each column once", "remove one");
            columns_.push_back(name);
        }
        for (const std::string& name : known) {
            if (!core::contains(columns_, name))
                refuse(1, name, "is missing", column_line(), "add the column; its cells may be empty");
        }
        if (problems_.size() > before) columns_.clear();
    }
    bool has_columns() const { return !columns_.empty(); }

    void read_row(std::size_t line, const std::vector<std::string_view>& cells, PreemptionRows& rows) {
        if (cells.size() != columns_.size()) {
            problems_.push_back({fmt::format("{}:{}", file_, line),
                                 fmt::format("has {}", core::counted(cells.size(), "cell")),
                                 fmt::format("{}, as in the header", columns_.size()), ""});
            return;
        }
        const auto name_at = std::ranges::find(columns_, name_column) - columns_.begin();
        const std::string id(cells[static_cast<std::size_t>(name_at)]);
        signal_ = id.empty() ? "" : fmt::format(" for signal '{}'", id);
        PreemptionRow row{{}, line};
        for (std::size_t column = 0; column < cells.size(); ++column) {
            core::for_each_field<Preemption>([&](const auto& field) {
                if (columns_[column] == field.name) read_value(line, cells[column], field, row.values);
            });
        }
        check_times(line, row.values);
        if (id.empty()) return refuse(line, name_column, "is empty", "id of a signal", "");
        const auto [first, is_new] = rows.emplace(id, row);
        if (!is_new)
            refuse(line, name_column, fmt::format("\"{}\" is in line {} already", id, first->second.line),
                   "one row for each signal", "remove one of the rows");
    }

  private:
    /// Whether the header is not separated by commas: one cause, one problem.
    bool refuse_separator(std::string_view header) {
        const bool is_semicolon = header.find(';') != std::string_view::npos;
        if (!is_semicolon && header.find('\t') == std::string_view::npos) return false;
        problems_.push_back({fmt::format("{}:1", file_),
                             fmt::format("is separated by {}, not by commas", is_semicolon ? ";" : "tabs"),
                             column_line(),
                             "Save it with commas between cells and points in numbers: many spreadsheets use "
                             "those of the system language"});
        return true;
    }

    /// What a controller cannot do: stay longer than it may be away from its program at most.
    void check_times(std::size_t line, const Preemption& values) {
        const double longest_s = values.maximum_presence_s.value_or(0.0);
        if (longest_s <= 0.0) return;
        for (const auto& [name, value] : {std::pair{"dwell_s", values.dwell_s},
                                          std::pair{"minimum_duration_s", values.minimum_duration_s}}) {
            if (value && *value > longest_s)
                refuse(line, name, fmt::format("{}{} is above its maximum_presence_s", *value, signal_),
                       fmt::format("up to {} s", longest_s),
                       "Lower it, or raise maximum_presence_s (0: no limit)");
        }
    }

    template <class Field>
    void read_value(std::size_t line, std::string_view cell, const Field& field, Preemption& values) {
        auto& target = values.*field.member;
        try {
            core::read_cell(cell, target);
        } catch (const std::runtime_error&) {
            target.reset();
            return refuse_value(line, cell, field,
                                core::number_from(cell) ? "is no whole number" : "is no number");
        }
        if (!target || (*target >= field.minimum && *target <= field.maximum)) return;
        target.reset();
        refuse_value(line, cell, field, "is out of range");
    }

    template <class Field>
    void refuse_value(std::size_t line, std::string_view cell, const Field& field, const char* what) {
        constexpr bool is_whole = std::is_same_v<std::decay_t<decltype(*(Preemption{}.*field.member))>, int>;
        refuse(
            line, field.name, fmt::format("\"{}\"{} {}", cell, signal_, what),
            fmt::format("{}{} to {}{}{}, or nothing", is_whole ? "a whole number from " : "", field.minimum,
                        field.maximum, *field.unit == '1' ? "" : " ", *field.unit == '1' ? "" : field.unit),
            "");
    }

    void refuse(std::size_t line, const std::string& column, std::string what, std::string allowed,
                std::string cure) {
        problems_.push_back({fmt::format("{}:{}: {}", file_, line, column), std::move(what),
                             std::move(allowed), std::move(cure)});
    }

    std::string file_;
    std::vector<Problem>& problems_;
    std::vector<std::string> columns_;
    std::string signal_;  ///< Words about that of the row; empty where it has none.
};

bool is_green_phase(const roads::Phase& phase) {
    return std::ranges::any_of(phase.state, traffic::is_green) &&
           std::ranges::none_of(phase.state, traffic::is_yellow);
}

/// The least green that all green phases have in common; nothing where they differ or have none, because the
/// controller has one for all.
std::optional<double> common_least_green_s(const roads::Signal& signal) {
    std::optional<double> common_s;
    for (const roads::Phase& phase : signal.program) {
        if (!is_green_phase(phase)) continue;
        if (phase.least_s <= 0.0 || phase.least_s != common_s.value_or(phase.least_s)) return std::nullopt;
        common_s = phase.least_s;
    }
    constexpr double longest_s = 255.0;
    if (common_s) common_s = std::min({*common_s, signal.cycle_s(), longest_s});
    return common_s;
}

/// Checks one row against its signal.
void check(const traffic::Preemption& row, const std::string& where, const roads::Signal& signal,
           std::vector<Problem>& problems) {
    const double longest_s = signal.cycle_s();
    for (const auto& [name, value] :
         {std::pair{"minimum_green_s", row.minimum_green_s}, std::pair{"walk_s", row.walk_s}}) {
        if (value && *value > longest_s)
            problems.push_back({fmt::format("{}: {}", where, name),
                                fmt::format("{} is longer than the cycle of signal '{}'", *value, signal.id),
                                fmt::format("up to {} s", longest_s), "lower it"});
    }
    if (!row.exit_phase) return;
    const auto phase = static_cast<std::size_t>(*row.exit_phase);
    std::vector<std::string> greens;
    for (std::size_t number = 0; number < signal.program.size(); ++number) {
        if (is_green_phase(signal.program[number])) greens.push_back(std::to_string(number));
    }
    if (core::contains(greens, std::to_string(phase))) return;
    problems.push_back(
        {fmt::format("{}: exit_phase", where),
         fmt::format("{} {} of signal '{}'", phase,
                     phase < signal.program.size() ? "is no green phase" : "is no phase", signal.id),
         core::listed(greens), "clearway scenario signals lists the phases"});
}

}  // namespace

PreemptionRows read_preemption_rows(const std::filesystem::path& file, std::vector<Problem>& problems) {
    const std::string text = normalised(core::read_file(file));
    PreemptionRows rows;
    Reading reading(file, problems);
    core::CsvReader reader(text);
    std::size_t line = 1;
    try {
        if (!reader.next()) {
            problems.push_back({file.string(), "is empty", column_line(),
                                "clearway scenario signals SCENARIO --out FILE writes it"});
            return rows;
        }
        reading.read_header(reader.cells());
        for (line = 2; reading.has_columns() && reader.next(); ++line) {
            const bool is_blank = reader.cells().size() == 1 && reader.cells().front().empty();
            if (!is_blank) reading.read_row(line, reader.cells(), rows);
        }
    } catch (const std::runtime_error& error) {
        problems.push_back({fmt::format("{}:{}", file.string(), line), error.what(), "", ""});
    }
    return rows;
}

std::vector<Preemption> preemption_of(const PreemptionRows& rows, const std::filesystem::path& file,
                                      const roads::Network& network) {
    std::vector<Problem> problems;
    std::vector<Preemption> signals(network.signals().size());
    std::map<std::size_t, std::size_t> lines;  // by signal
    for (const auto& [id, row] : rows) {
        const std::string where = fmt::format("{}:{}", file.string(), row.line);
        const auto signal =
            roads::named_signal(network, id, fmt::format("{}: {}", where, name_column), problems);
        if (!signal) continue;
        if (const auto [other, is_new] = lines.try_emplace(signal->value, row.line); !is_new)
            problems.push_back({fmt::format("{}: {}", where, name_column),
                                fmt::format("'{}' is the signal of line {}", id, other->second),
                                "one row for each signal", "remove one of the rows"});
        check(row.values, where, network.signal(*signal), problems);
        signals[signal->value] = row.values;
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return signals;
}

std::vector<Preemption> preemption_in(const roads::Network& network) {
    std::vector<Preemption> signals(network.signals().size());
    for (std::size_t row = 0; row < signals.size(); ++row) {
        const roads::Signal& signal = network.signals()[row];
        Preemption& known = signals[row];
        known.enabled = 1;
        known.minimum_green_s = common_least_green_s(signal);
        const std::vector<roads::OwnClearance> own = roads::own_clearances(signal);
        for (std::size_t link = 0; link < own.size(); ++link) {
            if (signal.crossings[link] && own[link].red_s > 0.0)
                known.pedestrian_clearance_s =
                    std::min(255.0, std::max(known.pedestrian_clearance_s.value_or(0.0), own[link].red_s));
        }
    }
    return signals;
}

std::string preemption_csv(const roads::Network& network, const std::vector<Preemption>& signals) {
    std::vector<std::size_t> order(signals.size());
    for (std::size_t row = 0; row < order.size(); ++row)
        order[row] = row;
    std::ranges::sort(order, {}, [&](std::size_t row) { return network.signals()[row].id; });
    std::string text = column_line() + "\n";
    for (const std::size_t row : order) {
        text += core::csv_text(network.signals()[row].id);
        core::append_cells(text, signals[row]);
        text += "\n";
    }
    return text;
}

}  // namespace clearway::scenario
