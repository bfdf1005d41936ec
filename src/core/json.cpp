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

namespace {

/// Deepest object or list that is read; Clearway writes at most ten levels. Whatever copies or prints JSON
/// calls itself for each level.
constexpr std::size_t most_json_levels = 100;

/// Whether JSON text has no more levels than that; for other text it does not matter.
bool is_shallow(std::string_view text) {
    std::size_t open = 0;
    bool in_text = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char letter = text[at];
        if (in_text && letter == '\\') {
            ++at;
        } else if (letter == '"') {
            in_text = !in_text;
        } else if (!in_text && (letter == '{' || letter == '[')) {
            if (++open > most_json_levels) return false;
        } else if (!in_text && (letter == '}' || letter == ']') && open > 0) {
            --open;
        }
    }
    return true;
}

}  // namespace

Json parse_object(const std::string& text, const std::string& where) {
    if (!is_shallow(text))
        throw core::InputError({where, fmt::format("has more than {} levels", most_json_levels),
                                fmt::format("at most {} levels", most_json_levels),
                                "Check that it is the right file"});
    Json json = Json::parse(text, nullptr, false);
    if (!json.is_object())
        throw core::InputError(
            {where, "is not a JSON object", "", "Check that the file is complete and was not edited"});
    return json;
}

}  // namespace clearway::core
