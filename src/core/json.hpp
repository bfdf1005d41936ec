#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/spellings.hpp"

namespace clearway::core {

/// Keeps the order of its keys, so that equal values give equal bytes.
using Json = nlohmann::ordered_json;

/// A value as text, indented by two spaces, with a newline at the end. Invalid UTF-8 is replaced, because
/// names come from the user's files.
std::string to_text(const Json& json);

/// Reads one object of a file strictly and collects its problems.
class ObjectReader {
  public:
    ObjectReader(const Json& object, std::string where, std::vector<core::Problem>& problems);

    /// A required key.
    template <class Value>
    void read(const char* key, Value& target) {
        const Json* node = find(key);
        if (node == nullptr) return;
        if constexpr (OptionalMember<Value>::value) {
            if (node->is_null()) {
                target = std::nullopt;
            } else {
                typename Value::value_type value{};
                convert(key, *node, value);
                target = value;
            }
        } else {
            convert(key, *node, target);
        }
    }
    /// An optional key.
    template <class Value>
    void read_if_there(const char* key, Value& target) {
        if (object_.is_object() && object_.contains(key)) read(key, target);
    }
    /// A required key that holds the name of an enumerator.
    template <class Enum, class FromName>
    void read_name(const char* key, Enum& target, FromName&& from_name) {
        std::string word;
        read(key, word);
        if (find(key) == nullptr) return;
        if (const auto value = from_name(word)) {
            target = *value;
        } else {
            problem(key, fmt::format("\"{}\" is not known", word));
        }
    }
    /// Every member of a field table.
    template <class Struct>
    void read_fields(Struct& target) {
        core::for_each_field<Struct>([&](const auto& field) { read(field.name, target.*field.member); });
    }
    /// Reports every key that was not read.
    void refuse_others();
    /// A required key that holds an object or an array (`type`); an empty one when it does not.
    const Json& child(const char* key, Json::value_t type);
    void problem(const char* key, std::string what);

  private:
    const Json* find(const char* key);

    template <Spelled Value>
    void convert(const char* key, const Json& node, Value& target) {
        if (const auto value = node.is_string() ? value_from<Value>(node.get<std::string>()) : std::nullopt) {
            target = *value;
        } else {
            problems_.push_back({fmt::format("{}: {}", where_, key), node.dump() + " is not known",
                                 spelling_list<Value>(), ""});
        }
    }

    template <Spelled Value>
    void convert(const char* key, const Json& node, std::vector<Value>& target) {
        if (!node.is_array()) return problem(key, "is not a list");
        for (const Json& element : node)
            convert(key, element, target.emplace_back());
    }

    template <class Value>
    void convert(const char* key, const Json& node, Value& target) {
        try {
            if constexpr (std::is_arithmetic_v<Value>) {
                if (!node.is_number()) return problem(key, "is not a number");
            }
            node.get_to(target);
        } catch (const Json::exception&) {
            problem(key, "is of another type");
        }
    }

    const Json& object_;
    std::set<std::string, std::less<>> asked_for_;
    std::string where_;
    std::vector<core::Problem>& problems_;
};

/// Words of enumerators, null for an empty optional, other values as they are.
template <class Value>
Json to_json_value(const Value& value) {
    if constexpr (Spelled<Value>) {
        return name(value);
    } else {
        return value;
    }
}
template <class Value>
Json to_json_value(const std::optional<Value>& value) {
    return value ? to_json_value(*value) : Json(nullptr);
}
template <Spelled Value>
Json to_json_value(const std::vector<Value>& values) {
    Json list = Json::array();
    for (const Value value : values)
        list.push_back(name(value));
    return list;
}

/// Every member of a field table.
template <class Struct>
void write_fields(Json& object, const Struct& source) {
    core::for_each_field<Struct>(
        [&](const auto& field) { object[field.name] = to_json_value(source.*field.member); });
}

/// Throws core::InputError, naming `where`, for text that is not one JSON object.
Json parse_object(const std::string& text, const std::string& where);

}  // namespace clearway::core
