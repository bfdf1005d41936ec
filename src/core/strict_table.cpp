#include "core/strict_table.hpp"

#include <fmt/format.h>

namespace clearway::core {

StrictTable::StrictTable(const toml::table& table, std::string path, std::string file,
                         std::vector<core::Problem>& problems)
    : table_(table), path_(std::move(path)), file_(std::move(file)), problems_(problems) {}

const toml::node* StrictTable::find(const std::string& key) {
    known_.insert(key);
    return table_.get(key);
}

std::string StrictTable::where(const std::string& key) const {
    const toml::node* node = table_.get(key);
    const toml::source_position place = (node != nullptr ? node->source() : table_.source()).begin;
    return fmt::format("{}:{}:{}: {}", file_, place.line, place.column,
                       path_.empty() ? key : path_ + "." + key);
}

void StrictTable::problem(const std::string& key, std::string what, std::string allowed, std::string cure) {
    problems_.push_back({where(key), std::move(what), std::move(allowed), std::move(cure)});
}

void StrictTable::text(const std::string& key, std::string& target) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (const auto value = node->value_exact<std::string>(); value && !value->empty()) {
        target = *value;
    } else {
        problem(key, value ? "is empty" : "is not text", "text in quotes", "");
    }
}

void StrictTable::texts(const std::string& key, std::vector<std::string>& target) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr) return problem(key, "is not a list", "a list of quoted texts", "");
    for (const toml::node& element : *array) {
        const auto value = element.value_exact<std::string>();
        if (!value) return problem(key, "holds something other than text", "a list of quoted texts", "");
        target.push_back(*value);
    }
}

void StrictTable::number(const std::string& key, std::optional<double>& target) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_number()) return problem(key, "is not a number", "a number", "");
    target = node->value<double>();
}

std::optional<std::int64_t> StrictTable::whole_number(const std::string& key, std::uint64_t minimum,
                                                      std::uint64_t maximum) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const std::string allowed = fmt::format("{} to {}", minimum, maximum);
    const auto value = node->value_exact<std::int64_t>();
    if (!value) {
        problem(key, "is not a whole number", allowed, "");
        return std::nullopt;
    }
    if (*value < 0 || static_cast<std::uint64_t>(*value) < minimum ||
        static_cast<std::uint64_t>(*value) > maximum) {
        problem(key, fmt::format("{} is {}", *value, *value < 0 ? "negative" : "out of range"), allowed, "");
        return std::nullopt;
    }
    return value;
}

const toml::table* StrictTable::table(const std::string& key) {
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_table()) problem(key, "is not a table", "[" + key + "]", "");
    return node == nullptr ? nullptr : node->as_table();
}

std::vector<const toml::table*> StrictTable::tables(const std::string& key) {
    std::vector<const toml::table*> result;
    const toml::node* node = find(key);
    if (node == nullptr) return result;
    const toml::array* array = node->as_array();
    if (array == nullptr || !array->is_array_of_tables()) {
        problem(key, "is not a list of tables", "[[" + key + "]]", "");
        return result;
    }
    for (const toml::node& element : *array)
        result.push_back(element.as_table());
    return result;
}

void StrictTable::finish() {
    const std::vector<std::string> valid(known_.begin(), known_.end());
    for (const auto& [name, node] : table_) {
        const std::string key(name.str());
        if (known_.contains(key)) continue;
        const std::string near = core::nearest(key, valid);
        std::string list;
        for (const std::string& word : valid)
            list += (list.empty() ? "" : ", ") + word;
        problem(key, "unknown key", list,
                near.empty() ? "Remove it" : fmt::format("Did you mean '{}'?", near));
    }
}

toml::table parse_toml(const std::string& text, const std::string& file) {
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        const toml::source_position place = error.source().begin;
        throw core::InputError({fmt::format("{}:{}:{}", file, place.line, place.column),
                                std::string(error.description()), "a TOML file", "Correct this line"});
    }
}

}  // namespace clearway::core
