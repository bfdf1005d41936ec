#include "experiment/code_parts.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <system_error>

#include "core/error.hpp"
#include "core/files.hpp"
#include "python/part_name.hpp"
#include "python/sources.hpp"

namespace clearway::experiment {
namespace {

constexpr const char* code_folder = "code";

/// Copies files, the first of which names them, where no copy has the hash.
void keep(const std::vector<std::filesystem::path>& files, const std::string& hash,
          const std::filesystem::path& run_folder, const std::string& where) {
    const std::filesystem::path from = files.front().parent_path();
    const std::filesystem::path folder = run_folder / code_folder / hash;
    std::vector<std::filesystem::path> copies;
    for (const std::filesystem::path& file : files)
        copies.push_back(folder / file.lexically_relative(from));
    const auto is_there = [](const auto& copy) { return std::filesystem::is_regular_file(copy); };
    if (std::ranges::all_of(copies, is_there) && python::hash_of(copies) == hash) return;
    for (std::size_t i = 0; i < files.size(); ++i) {
        core::make_folder(copies[i].parent_path());
        core::write_atomically(copies[i], core::read_file(files[i]));
    }
    if (python::hash_of(copies) != hash)
        throw core::InputError({where, files.front().string() + " was changed while the study was read",
                                "content hash " + hash, "Give the command again"});
}

/// `kept`: files and hashes that were looked at; conditions of a study often share them.
void keep_part(const std::string& word, const std::filesystem::path& run_folder, const std::string& where,
               std::set<std::string>& kept) {
    const auto part = python::part_name_from(word);
    if (part && !part->hash.empty() && kept.insert(part->file.string() + part->hash).second)
        keep(python::sources_of(part->file, where), part->hash, run_folder, where);
}

}  // namespace

void resolve_parts(ConditionSpec& condition, const std::filesystem::path& folder, const std::string& where) {
    condition.predictor = python::resolved(condition.predictor, folder, where + "predictor");
    for (std::string& policy : condition.policies)
        policy = python::resolved(policy, folder, where + "policy");
}

void keep_code(const std::vector<ConditionSpec>& conditions, const std::filesystem::path& run_folder) {
    std::set<std::string> kept;
    for (const ConditionSpec& condition : conditions) {
        const std::string where = "condition " + condition.name;
        keep_part(condition.predictor, run_folder, where, kept);
        for (const std::string& policy : condition.policies)
            keep_part(policy, run_folder, where, kept);
        if (!condition.model_file.empty() && kept.insert(condition.model_file + condition.model_hash).second)
            keep({condition.model_file}, condition.model_hash, run_folder, where);
    }
}

std::vector<std::filesystem::path> kept_code(const std::filesystem::path& run_folder) {
    std::vector<std::filesystem::path> folders;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(run_folder / code_folder, none))
        folders.push_back(entry.path());
    std::ranges::sort(folders);
    return folders;
}

ConditionSpec located(ConditionSpec condition, const std::vector<std::filesystem::path>& folders,
                      const std::string& where) {
    condition.predictor = python::located(condition.predictor, folders, where + "predictor");
    for (std::string& policy : condition.policies)
        policy = python::located(policy, folders, where + "policy");
    if (!condition.model_file.empty())
        condition.model_file =
            python::located_file(condition.model_file, condition.model_hash, folders, where + "model",
                                 [](const auto& file) { return core::content_hash(core::read_file(file)); })
                .string();
    return condition;
}

ConditionSpec with_kept_code(const ConditionSpec& condition, const std::filesystem::path& run_folder) {
    try {
        return located(condition, kept_code(run_folder), "");
    } catch (const core::InputError&) {
        return condition;
    }
}

std::optional<std::string> part_called(const std::string& word) {
    return python::part_name_from(word) ? std::optional(python::short_name(word)) : std::nullopt;
}

std::vector<std::string> part_names(const ConditionSpec& condition) {
    std::vector<std::string> names;
    for (const std::string& policy : condition.policies) {
        if (const auto name = part_called(policy)) names.push_back(*name);
    }
    if (const auto name = part_called(condition.predictor)) names.push_back(*name);
    return names;
}

}  // namespace clearway::experiment
