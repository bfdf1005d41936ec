#include "campaign/stored_folder.hpp"

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/error.hpp"
#include "experiment/code_parts.hpp"
#include "python/part_name.hpp"
#include "results/table_reader.hpp"
#include "results/table_writer.hpp"

namespace clearway::campaign {

std::optional<results::Manifest> study_in(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder / "manifest.json")) return std::nullopt;
    return results::Store::open(folder).manifest();
}

void require_trust(const std::vector<experiment::ConditionSpec>& conditions, const std::string& where,
                   CodeTrust trust) {
    if (trust == CodeTrust::trusted) return;
    std::vector<core::Problem> problems;
    const auto check = [&](const experiment::ConditionSpec& condition, const std::string& word) {
        const auto part = python::part_name_from(word);
        if (!part) return;
        problems.push_back(
            {fmt::format("{}: condition {}", where, condition.name),
             fmt::format("names code in Python, {}, which would run with your rights", part->file.string()),
             "code that you trust",
             fmt::format("Read it, or its copy in code/{} of the run folder, then add --trust-code",
                         part->hash)});
    };
    for (const experiment::ConditionSpec& condition : conditions) {
        check(condition, condition.predictor);
        for (const std::string& policy : condition.policies)
            check(condition, policy);
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

experiment::ConditionSpec with_files_found(const experiment::ConditionSpec& condition,
                                           const std::filesystem::path& run_folder) {
    const std::filesystem::path folder = std::filesystem::absolute(run_folder / ".").lexically_normal();
    std::vector<std::filesystem::path> folders = experiment::kept_code(folder);
    folders.insert(folders.end(), {folder.parent_path().parent_path(), folder, "."});
    return experiment::located(condition, folders,
                               fmt::format("{}: condition {}: ", run_folder.string(), condition.name));
}

void renew_edited_tables(const results::Store& store) {
    const std::vector<std::string> edited = results::edited_tables(store);
    if (edited.empty()) return;
    fmt::print(stderr, "clearway: {}: {} {} from the records of the runs\n", store.folder().string(),
               core::listed(edited), edited.size() == 1 ? "differs" : "differ");
    try {
        results::write_tables(store);
        fmt::print(stderr, "clearway: the tables are made anew\n");
    } catch (const core::EnvironmentError& error) {
        fmt::print(stderr, "clearway: warning: they stay as they are: {}\n", error.what());
    }
}

core::ExitCode tell_missing(std::size_t missing, std::size_t all) {
    if (missing == 0) return core::ExitCode::ok;
    fmt::print(stderr, "clearway: {} of {} are missing; repeat the command that started them to continue\n",
               missing, core::counted(all, "run"));
    return core::ExitCode::incomplete;
}

}  // namespace clearway::campaign
