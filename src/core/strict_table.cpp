#include "core/strict_table.hpp"

#include <limits>
#include <regex>
#include <sstream>

#include <fmt/format.h>

#include "core/toml_levels.hpp"

namespace clearway::core {
namespace {

const char* type_word(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::string:
            return "text";
        case toml::node_type::integer:
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "a truth value";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::table:
            return "a table";
        default:
            return "another type";
    }
}

/// `text, ""`, `a truth value, true`, `a table`: its type, with the value where that is one.
std::string type_and_value(const toml::node& node) {
    if (!node.is_value()) return type_word(node);
    if (const auto text = node.value_exact<std::string>()) return fmt::format("text, \"{}\"", *text);
    std::ostringstream value;
    node.visit([&](const auto& one) { value << one; });
    return fmt::format("{}, {}", type_word(node), value.str());
}

/// What the parser found, in other words where its own mislead: it takes a bare word for a boolean or a
/// number.
std::string words_of(std::string_view what) {
    for (const char* const guess : {"expected 'true'", "expected 'false'", "expected 'inf'", "expected 'nan'",
                                    "could not determine value type"})
        if (what.find(guess) != std::string_view::npos)
            return "a value is neither a number, nor true or false, nor a text in quotes";
    return std::string(what);
}

/// What to do about an error at this line, of which `what` is the parser's word.
std::string cure_of_line(const std::string& line, const std::string& what) {
    constexpr const char* usual = "Correct this line; texts stand in quotes, numbers do not";
    constexpr std::size_t longest = 200;  // std::regex recurses for each letter
    if (line.size() > longest) return usual;
    static const std::regex comma(R"(=\s*([+-]?\d+),(\d+)\s*(#.*)?$)");
    static const std::regex table(R"(^\s*\[\s*([\w.-]+)\s*\])");
    static const std::regex open(R"(^\s*\[\s*([\w.-]+)\s*(#.*)?$)");
    std::smatch found;
    if (std::regex_search(line, found, open)) return fmt::format("Write [{}]", found.str(1));
    if (std::regex_search(line, found, comma))
        return fmt::format("Write {}.{}: decimals have a point", found.str(1), found.str(2));
    if (what.find("redefine") != std::string::npos && std::regex_search(line, found, table))
        return fmt::format("Write [[{}]], with two brackets, if there may be several; else join the two",
                           found.str(1));
    return usual;
}

std::string line_of(const std::string& text, std::size_t number) {
    std::istringstream lines(text);
    std::string line;
    for (std::size_t at = 0; at < number && std::getline(lines, line); ++at) {
    }
    if (line.ends_with('\r')) line.pop_back();
    return line;
}

}  // namespace

StrictTable::StrictTable(const toml::table& table, std::string path, TomlReading& reading)
    : table_(table), path_(std::move(path)), reading_(reading) {}

const toml::node* StrictTable::find(const std::string& key) {
    known_.insert(key);
    const toml::node* const node = table_.get(key);
    if (node != nullptr) reading_.origins[full(key)] = where(key);
    return node;
}

std::string StrictTable::place(const toml::source_region& source, const std::string& name) const {
    if (source.begin.line == 0) return fmt::format("{}: {}", reading_.file, name);
    return fmt::format("{}:{}:{}: {}", reading_.file, source.begin.line, source.begin.column, name);
}

std::string StrictTable::where(const std::string& key) const {
    const auto found = table_.find(key);
    if (found == table_.end()) return place(table_.source(), full(key));
    const toml::source_region& source = found->first.source();
    return place(source, full(key)) + (source.begin.line == 0 ? ", set by a factor" : "");
}

void StrictTable::problem(const std::string& key, std::string what, std::string allowed, std::string cure) {
    reading_.problems.push_back({where(key), std::move(what), std::move(allowed), std::move(cure)});
}

void StrictTable::wrong_type(const toml::node& node, const std::string& key, std::string wanted) {
    problem(key, "is " + type_and_value(node), std::move(wanted), "");
}

std::optional<std::string> StrictTable::any_text(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    auto value = node->value_exact<std::string>();
    if (!value) wrong_type(*node, key, "text");
    return value;
}

void StrictTable::text_or_empty(const std::string& key, std::string& target) {
    const auto value = any_text(key);
    if (has(key)) target = value.value_or("");  // its default would be taken for what was given
}

void StrictTable::text(const std::string& key, std::string& target) {
    const auto value = any_text(key);
    if (!value) return;
    if (value->empty()) return problem(key, "is empty", "text in quotes", "");
    target = *value;
}

void StrictTable::texts(const std::string& key, std::vector<std::string>& target) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr) return wrong_type(*node, key, "an array of texts");
    target.clear();
    for (const toml::node& element : *array) {
        const auto value = element.value_exact<std::string>();
        if (!value) return wrong_type(element, key, "an array of texts");
        target.push_back(*value);
    }
}

void StrictTable::text_lists(const std::string& key, std::vector<std::vector<std::string>>& target) {
    const char* const wanted = "an array of arrays of texts";
    const toml::node* node = find(key);
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr) return wrong_type(*node, key, wanted);
    target.clear();
    for (const toml::node& element : *array) {
        const toml::array* texts = element.as_array();
        if (texts == nullptr) return wrong_type(element, key, wanted);
        std::vector<std::string>& list = target.emplace_back();
        for (const toml::node& text : *texts) {
            const auto value = text.value_exact<std::string>();
            if (!value) return wrong_type(text, key, wanted);
            list.push_back(*value);
        }
    }
}

void StrictTable::number(const std::string& key, std::optional<double>& target) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_number()) return wrong_type(*node, key, "a number");
    target = node->value<double>();
}

std::optional<double> StrictTable::number_within(const std::string& key, double minimum, double maximum) {
    const std::size_t found = reading_.problems.size();
    std::optional<double> value;
    number(key, value);
    if (value && !(*value >= minimum && *value <= maximum))
        problem(key, fmt::format("{} is out of range", *value), fmt::format("{} to {}", minimum, maximum),
                "");
    return reading_.problems.size() == found ? value : std::numeric_limits<double>::quiet_NaN();
}

std::optional<std::int64_t> StrictTable::whole_number(const std::string& key, std::int64_t minimum,
                                                      std::int64_t maximum) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const auto value = node->value_exact<std::int64_t>();
    if (!value) {
        wrong_type(*node, key, fmt::format("a whole number from {} to {}", minimum, maximum));
        return std::nullopt;
    }
    if (*value >= minimum && *value <= maximum) return value;
    problem(key, fmt::format("{} is {}", *value, *value < 0 ? "negative" : "out of range"),
            fmt::format("{} to {}", minimum, maximum), "");
    return std::nullopt;
}

const toml::table* StrictTable::table(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return nullptr;
    if (!node->is_table()) wrong_type(*node, key, "a table");
    return node->as_table();
}

std::optional<StrictTable> StrictTable::below(const std::string& key) {
    const toml::table* const found = table(key);
    if (found == nullptr) return std::nullopt;
    return StrictTable(*found, full(key), reading_);
}

std::vector<const toml::table*> StrictTable::tables(const std::string& key) {
    std::vector<const toml::table*> result;
    const toml::node* node = find(key);
    if (node == nullptr) return result;
    const toml::array* array = node->as_array();
    if (array == nullptr || !array->is_array_of_tables()) {
        const char* const wanted = "an array of tables, [[...]]";
        if (node->is_table())
            problem(key, "is a table", wanted,
                    fmt::format("Write [[{}]], with two brackets, before each", full(key)));
        else
            wrong_type(*node, key, wanted);
        return result;
    }
    for (const toml::node& element : *array)
        result.push_back(element.as_table());
    return result;
}

std::vector<StrictTable> StrictTable::rows(const std::string& key) {
    std::vector<StrictTable> result;
    for (const toml::table* row : tables(key)) {
        const std::string name = fmt::format("{}[{}]", full(key), result.size());
        reading_.origins[name] = place(row->source(), name);
        result.emplace_back(*row, name, reading_);
    }
    return result;
}

void StrictTable::finish() {
    const std::vector<std::string> valid(known_.begin(), known_.end());
    for (const auto& [name, node] : table_) {
        const std::string key(name.str());
        if (known_.contains(key)) continue;
        problem(key, "unknown key", listed(valid), did_you_mean(key, valid, "Remove it"));
        reading_.misspelt.insert(path_);
        if (const std::string near = nearest(key, valid); !near.empty()) reading_.meant.insert(full(near));
    }
}

toml::table parse_toml(const std::string& text, const std::string& file) {
    check_toml_levels(text, file);
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        const toml::source_position place = error.source().begin;
        const std::string what = words_of(error.description());
        throw InputError({fmt::format("{}:{}:{}", file, place.line, place.column), what, "a TOML file",
                          cure_of_line(line_of(text, place.line), what)});
    }
}

void set_value(toml::table& table, const std::string& key, const std::string& value) {
    const toml::table parsed = parse_toml("value = " + value, key);
    table.erase(key);  // also forgets its place in the file
    parsed.get("value")->visit([&](const auto& node) { table.insert(key, node); });
}

}  // namespace clearway::core
