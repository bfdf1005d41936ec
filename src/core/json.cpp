#include "core/json.hpp"

namespace clearway::core {

std::string to_text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ObjectReader::ObjectReader(const Json& object, std::string where, std::vector<core::Problem>& problems)
    : object_(object), where_(std::move(where)), problems_(problems) {
    if (!object.is_object()) problems_.push_back({where_, "is not a JSON object", "", ""});
}

void ObjectReader::refuse_others() {
    if (!object_.is_object()) return;
    for (const auto& [key, value] : object_.items()) {
        if (!asked_for_.contains(key)) problem(key.c_str(), "is unknown");
    }
}

const Json* ObjectReader::find(const char* key) {
    asked_for_.emplace(key);
    const auto found = object_.is_object() ? object_.find(key) : object_.end();
    if (found != object_.end()) return &*found;
    if (object_.is_object()) problem(key, "is missing");
    return nullptr;
}

const Json& ObjectReader::child(const char* key, Json::value_t type) {
    static const Json empty_object = Json::object();
    static const Json empty_array = Json::array();
    const Json& empty = type == Json::value_t::object ? empty_object : empty_array;
    const Json* node = find(key);
    if (node == nullptr) return empty;
    if (node->type() == type) return *node;
    problem(key, "is of another type");
    return empty;
}

void ObjectReader::problem(const char* key, std::string what) {
    problems_.push_back({fmt::format("{}: {}", where_, key), std::move(what), "", ""});
}

Json parse_object(const std::string& text, const std::string& where) {
    // Clearway writes at most ten levels. Whatever copies or prints JSON calls itself for each.
    constexpr int most_levels = 100;
    const auto check_level = [&](int level, Json::parse_event_t event, const Json&) {
        const bool opens =
            event == Json::parse_event_t::object_start || event == Json::parse_event_t::array_start;
        if (opens && level >= most_levels)
            throw core::InputError({where, fmt::format("has more than {} levels", most_levels),
                                    fmt::format("at most {} levels", most_levels),
                                    "Check that it is the right file"});
        return true;
    };
    // The parser takes U+0000 for the end of the text.
    const bool is_text = text.find('\0') == std::string::npos;
    Json json = is_text ? Json::parse(text, check_level, false) : Json();
    if (!json.is_object())
        throw core::InputError(
            {where, "is not a JSON object", "", "Check that the file is complete and was not edited"});
    return json;
}

}  // namespace clearway::core
