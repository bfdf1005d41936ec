#include "experiment/condition.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/folder_name.hpp"
#include "core/json.hpp"
#include "experiment/condition_json.hpp"
#include "python/part_name.hpp"

namespace clearway::experiment {

namespace {

std::string part_without_folder(const std::string& word) {
    std::optional<python::PartName> name = python::part_name_from(word);
    if (!name) return word;
    name->file = name->file.filename();
    return python::to_text(*name);
}

/// The files of a condition with the hashes of their contents: parts in Python and the model.
std::map<std::string, std::string> hashes_of(const ConditionSpec& condition) {
    std::map<std::string, std::string> hashes;
    std::vector<std::string> words = condition.policies;
    words.push_back(condition.predictor);
    for (const std::string& word : words) {
        if (const auto part = python::part_name_from(word))
            hashes[part->file.filename().string()] = part->hash;
    }
    if (!condition.model_file.empty())
        hashes[std::filesystem::path(condition.model_file).filename().string()] = condition.model_hash;
    return hashes;
}

}  // namespace

ProcessOptions process_of(const ConditionSpec& condition) {
    return {condition.traffic_model, condition.rerouting_s > 0.0 ? condition.rerouting_signal_penalty : 0.0};
}

std::string to_text(const ProcessOptions& process) {
    const std::string model(name(process.traffic_model));
    return process.signal_penalty == 0.0 ? model
                                         : fmt::format("{}-penalty-{:g}", model, process.signal_penalty);
}

ConditionSpec without_folders(ConditionSpec condition) {
    condition.predictor = part_without_folder(condition.predictor);
    for (std::string& policy : condition.policies)
        policy = part_without_folder(policy);
    condition.model_file = std::filesystem::path(condition.model_file).filename().string();
    return condition;
}

bool ConditionSpec::operator==(const ConditionSpec& other) const {
    return to_json(without_folders(*this)) == to_json(without_folders(other));
}

std::string what_differs(const ConditionSpec& one, const ConditionSpec& other) {
    const auto before = hashes_of(one);
    std::vector<std::string> found;
    for (const auto& [file, hash] : hashes_of(other)) {
        const auto same = before.find(file);
        if (same != before.end() && same->second != hash) found.push_back(file + " has changed");
    }
    if (!found.empty()) return core::listed(found);
    const core::Json left = to_json(without_folders(one));
    const core::Json right = to_json(without_folders(other));
    for (const auto& [key, value] : right.items()) {
        if (!left.contains(key) || left[key] != value) found.push_back(key);
    }
    for (const auto& [key, value] : left.items()) {
        if (!right.contains(key)) found.push_back(key);
    }
    return core::listed(found);
}

core::Json to_json(const ConditionSpec& condition) {
    core::Json object;
    object["name"] = condition.name;
    core::write_fields(object, condition);
    object["policies"] = condition.policies;
    if (!condition.settings.empty()) object["settings"] = condition.settings;
    if (!condition.model_file.empty())
        object["model"] = {{"file", condition.model_file}, {"hash", condition.model_hash}};
    if (!condition.factors.empty()) object["factors"] = condition.factors;
    return object;
}

ConditionSpec condition_from(const core::Json& object, const std::string& where,
                             std::vector<core::Problem>& problems) {
    ConditionSpec condition;
    core::ObjectReader reader(object, where, problems);
    reader.read("name", condition.name);
    core::check_folder_name(where + ": name", condition.name, problems);
    reader.read_fields(condition);
    reader.read("policies", condition.policies);
    reader.read_if_there("settings", condition.settings);
    if (object.contains("model")) {
        core::ObjectReader model(reader.child("model", core::Json::value_t::object), where + ": model",
                                 problems);
        model.read("file", condition.model_file);
        model.read("hash", condition.model_hash);
    }
    reader.read_if_there("factors", condition.factors);
    return condition;
}

}  // namespace clearway::experiment
