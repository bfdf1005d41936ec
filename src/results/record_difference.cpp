#include "results/record_difference.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/json.hpp"
#include "experiment/condition_json.hpp"

namespace clearway::results {
namespace {

using core::Json;
using Cells = std::vector<std::string_view>;

/// Values on the top level of `run.json` that are no tables.
constexpr const char* top_level = "run";
constexpr const char* condition_key = "condition_spec";
/// The hash of everything else in `run.json`, so it differs if anything does.
constexpr const char* hash_key = "hash";
/// `vehicles_hash` is the hash of `vehicles.csv`.
constexpr std::string_view file_hash_end = "_hash";
/// Holds tables as CSV texts.
constexpr std::string_view traffic_key = "traffic";

/// To compare: 1 is not 1.0 here.
std::string exact(const Json& value) {
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// To show.
std::string shown(const Json* value) {
    if (value == nullptr) return "missing";
    if (value->is_object()) return "an object";
    if (value->is_array()) return "a list";
    return value->is_string() ? value->get<std::string>() : exact(*value);
}

const Json* find(const Json& object, const std::string& key) {
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

/// The keys of both, in the order of `one`.
std::vector<std::string> keys_of(const Json& one, const Json& other) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : one.items())
        keys.push_back(key);
    for (const auto& [key, value] : other.items())
        if (!one.contains(key)) keys.push_back(key);
    return keys;
}

bool is_rows(const Json& value) {
    return value.is_array() &&
           std::all_of(value.begin(), value.end(), [](const Json& row) { return row.is_object(); });
}

/// The first text of a row, which tells it from others.
std::string label_of(const Json& row) {
    const auto found =
        std::find_if(row.begin(), row.end(), [](const Json& value) { return value.is_string(); });
    return found == row.end() ? "" : found->get<std::string>();
}

class Finder {
  public:
    /// `where` names the record in errors.
    explicit Finder(std::string where) : where_(std::move(where)) {}

    void start(std::string name) {
        table_ = std::move(name);
        row_.clear();
        of_table_ = 0;
    }

    /// A value at `path`, such as `refused.outranked`, or all that an object or a list holds.
    void value(const std::string& path, const Json* one, const Json* other) {
        if (one != nullptr && other != nullptr && one->is_object() && other->is_object()) {
            for (const std::string& key : keys_of(*one, *other))
                value(path.empty() ? key : path + "." + key, find(*one, key), find(*other, key));
        } else if (one != nullptr && other != nullptr && one->is_array() && other->is_array()) {
            for (std::size_t i = 0; i < std::max(one->size(), other->size()); ++i)
                value(fmt::format("{}[{}]", path, i), i < one->size() ? &(*one)[i] : nullptr,
                      i < other->size() ? &(*other)[i] : nullptr);
        } else if (one == nullptr || other == nullptr || exact(*one) != exact(*other)) {
            cell(path, shown(one), shown(other));
        }
    }

    /// Lists of objects.
    void rows(const Json& one, const Json& other) {
        for (std::size_t i = 0; i < std::max(one.size(), other.size()); ++i) {
            const bool is_in_one = i < one.size();
            const bool is_in_other = i < other.size();
            row_ = fmt::format("{} ({})", i + 1, label_of(is_in_one ? one[i] : other[i]));
            if (is_in_one && is_in_other)
                value("", &one[i], &other[i]);
            else
                missing_row(is_in_one, is_in_other);
        }
    }

    /// Tables with a header.
    void csv(std::string_view one, std::string_view other) try {
        csv_rows(one, other);
    } catch (const std::runtime_error& error) {
        throw core::InputError({where_ + ": " + table_, error.what(), "a table as CSV",
                                "Repeat the command that made the study (command.txt) with another --out"});
    }

    std::size_t count() const { return found_.size(); }
    std::vector<CellDifference> take() { return std::move(found_); }

  private:
    void csv_rows(std::string_view one, std::string_view other) {
        core::CsvReader left(one);
        core::CsvReader right(other);
        bool is_in_one = left.next();
        bool is_in_other = right.next();
        const Cells& head = is_in_one ? left.cells() : right.cells();
        if (is_in_one && is_in_other && left.cells() != right.cells())
            return cell("(columns)", fmt::format("{}", fmt::join(left.cells(), ",")),
                        fmt::format("{}", fmt::join(right.cells(), ",")));
        const std::vector<std::string> columns(head.begin(), head.end());
        for (std::size_t number = 1;; ++number) {
            is_in_one = is_in_one && left.next();
            is_in_other = is_in_other && right.next();
            if (!is_in_one && !is_in_other) return;
            const Cells& present = is_in_one ? left.cells() : right.cells();
            row_ = fmt::format("{} ({})", number, present.front());
            if (is_in_one && is_in_other)
                cells(columns, left.cells(), right.cells());
            else
                missing_row(is_in_one, is_in_other);
        }
    }

    void cell(const std::string& column, const std::string& one, const std::string& other) {
        // One row more moves all that follow, and a table may have a million.
        if (++of_table_ <= most_differences + 1) found_.push_back({table_, row_, column, one, other});
    }

    void missing_row(bool is_in_one, bool is_in_other) {
        cell("(row)", is_in_one ? "there" : "missing", is_in_other ? "there" : "missing");
    }

    void cells(const std::vector<std::string>& columns, const Cells& one, const Cells& other) {
        for (std::size_t i = 0; i < std::max(one.size(), other.size()); ++i) {
            const bool is_in_both = i < one.size() && i < other.size();
            if (is_in_both && one[i] == other[i]) continue;
            cell(i < columns.size() ? columns[i] : fmt::format("(cell {})", i + 1),
                 i < one.size() ? std::string(one[i]) : "missing",
                 i < other.size() ? std::string(other[i]) : "missing");
        }
    }

    std::string where_;
    std::string table_;
    std::string row_;
    std::size_t of_table_ = 0;
    std::vector<CellDifference> found_;
};

void compare_traffic(Finder& finder, const Json& one, const Json& other) {
    for (const std::string& name : keys_of(one, other)) {
        const Json* const left = find(one, name);
        const Json* const right = find(other, name);
        finder.start(fmt::format("{}.{}", traffic_key, name));
        if (left != nullptr && right != nullptr && left->is_string() && right->is_string())
            finder.csv(left->get_ref<const std::string&>(), right->get_ref<const std::string&>());
        else
            finder.value("(table)", left, right);
    }
}

/// The table of the file whose hash is stored under `key`. Returns whether its cells tell the difference.
bool compare_file(Finder& finder, const std::string& key, const std::filesystem::path& one,
                  const std::filesystem::path& other) {
    const std::string name = key.substr(0, key.size() - file_hash_end.size());
    const std::size_t before = finder.count();
    finder.start(name);
    finder.csv(core::read_file(one / (name + ".csv")), core::read_file(other / (name + ".csv")));
    return finder.count() > before;
}

/// What a key on the top level of `run.json` holds.
void compare_key(Finder& finder, const std::string& key, const Json* one, const Json* other) {
    const bool is_in_both = one != nullptr && other != nullptr;
    if (is_in_both && one->is_object() && other->is_object()) {
        if (key == traffic_key) return compare_traffic(finder, *one, *other);
        finder.start(key);
        finder.value("", one, other);
    } else if (is_in_both && is_rows(*one) && is_rows(*other)) {
        finder.start(key);
        finder.rows(*one, *other);
    } else {
        finder.start(top_level);
        finder.value(key, one, other);
    }
}

/// Whether two `condition_spec` differ at most in the folders of the same parts and models.
bool are_same_conditions(const Json& one, const Json& other) {
    std::vector<core::Problem> problems;
    const experiment::ConditionSpec left = experiment::condition_from(one, condition_key, problems);
    const experiment::ConditionSpec right = experiment::condition_from(other, condition_key, problems);
    return problems.empty() && left == right;
}

Json record_of(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "run.json";
    return core::parse_object(core::read_file(file), file.string());
}

}  // namespace

std::vector<CellDifference> differences(const Store& one, const Store& other, const experiment::RunKey& key) {
    const std::filesystem::path left = one.run_folder(key);
    const std::filesystem::path right = other.run_folder(key);
    const Json stored = record_of(left);
    const Json made = record_of(right);
    Finder finder((left / "run.json").string());
    bool is_elsewhere = false;  // what the condition names
    for (const std::string& name : keys_of(stored, made)) {
        if (name == hash_key) continue;
        const Json* const before = find(stored, name);
        const Json* const now = find(made, name);
        if (name == condition_key && before != nullptr && now != nullptr && exact(*before) != exact(*now) &&
            are_same_conditions(*before, *now)) {
            is_elsewhere = true;
            continue;
        }
        const bool is_other_file = name.ends_with(file_hash_end) && before != nullptr && now != nullptr &&
                                   exact(*before) != exact(*now);
        if (!is_other_file || !compare_file(finder, name, left, right))
            compare_key(finder, name, before, now);
    }
    // Other bytes of equal values, such as quotes in a table.
    if (finder.count() == 0 && !is_elsewhere)
        compare_key(finder, hash_key, find(stored, hash_key), find(made, hash_key));
    return finder.take();
}

}  // namespace clearway::results
