#include "scenario/detail/toml_reader.hpp"

#include <cmath>

namespace clearway::scenario::detail {

std::string number_text(double value) {
    return fmt::format("{}", value);
}

const toml::node* TableReader::find(const std::string& key) {
    known_.insert(key);
    for (const auto& [name, node] : table_) {
        if (name.str() != key) continue;
        reading_.origins[full(key)] = reading_.place(name.source(), full(key));
        return &node;
    }
    return nullptr;
}

void TableReader::wrong_type(const toml::node& node, const std::string& key, const char* wanted) {
    std::string found = "another type";
    switch (node.type()) {
        case toml::node_type::string:
            found = "text";
            break;
        case toml::node_type::integer:
        case toml::node_type::floating_point:
            found = "a number";
            break;
        case toml::node_type::boolean:
            found = "true or false";
            break;
        case toml::node_type::array:
            found = "an array";
            break;
        case toml::node_type::table:
            found = "a table";
            break;
        default:
            break;
    }
    reading_.add(reading_.origins.at(full(key)), fmt::format("is {}", found), wanted);
}

void TableReader::number(const toml::node& node, const std::string& key, double minimum, double maximum,
                         double& target) {
    const auto value = node.value<double>();
    if (!value || !node.is_number()) return wrong_type(node, key, "a number");
    const std::string& where = reading_.origins.at(full(key));
    if (!(*value >= minimum && *value <= maximum)) {
        reading_.add(where, fmt::format("{} is out of range", number_text(*value)),
                     fmt::format("{} to {}", number_text(minimum), number_text(maximum)));
        return;
    }
    target = *value;
}

void TableReader::number(const toml::node& node, const std::string& key, double minimum, double maximum,
                         int& target) {
    const auto value = node.value_exact<std::int64_t>();
    if (!value) return wrong_type(node, key, "a whole number");
    const std::string& where = reading_.origins.at(full(key));
    const auto as_double = static_cast<double>(*value);
    if (as_double < minimum || as_double > maximum) {
        reading_.add(where, fmt::format("{} is {}", *value, *value < 0 ? "negative" : "out of range"),
                     fmt::format("{} to {}", number_text(minimum), number_text(maximum)));
        return;
    }
    target = static_cast<int>(*value);
}

const toml::table* TableReader::table(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return nullptr;
    if (!node->is_table()) wrong_type(*node, key, "a table");
    return node->as_table();
}

std::vector<const toml::table*> TableReader::tables(const std::string& key) {
    std::vector<const toml::table*> result;
    const toml::node* node = find(key);
    if (node == nullptr) return result;
    const toml::array* array = node->as_array();
    if (array == nullptr || !array->is_array_of_tables()) {
        wrong_type(*node, key, "an array of tables, [[...]]");
        return result;
    }
    for (const toml::node& element : *array)
        result.push_back(element.as_table());
    return result;
}

void TableReader::text(const std::string& key, std::string& target) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    const auto value = node->value_exact<std::string>();
    if (!value) return wrong_type(*node, key, "text");
    target = *value;
}

void TableReader::texts(const std::string& key, std::vector<std::string>& target) {
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

void TableReader::finish() {
    const std::vector<std::string> valid(known_.begin(), known_.end());
    for (const auto& [name, node] : table_) {
        const std::string key(name.str());
        if (known_.contains(key)) continue;
        const std::string near = core::nearest(key, valid);
        std::string list;
        for (const std::string& word : valid)
            list += (list.empty() ? "" : ", ") + word;
        reading_.add(reading_.place(name.source(), full(key)), "unknown key", list,
                     near.empty() ? "remove it" : fmt::format("did you mean '{}'?", near));
    }
}

}  // namespace clearway::scenario::detail
