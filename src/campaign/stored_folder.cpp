#include "campaign/stored_folder.hpp"

#include <fstream>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/counted.hpp"
#include "core/error.hpp"
#include "experiment/code_parts.hpp"
#include "python/part_name.hpp"
#include "results/table_reader.hpp"
#include "results/table_writer.hpp"

namespace clearway::campaign {
namespace {

std::set<std::string> names_of_parts(const experiment::ConditionSpec& condition) {
    const std::vector<std::string> names = experiment::part_names(condition);
    return {names.begin(), names.end()};
}

}  // namespace

std::optional<results::Manifest> study_in(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder / "manifest.json")) return std::nullopt;
    return results::Store::open(folder).manifest();
}

void require_trust(const std::vector<experiment::ConditionSpec>& conditions, const core::Settings& titles,
                   const std::string& where, CodeTrust trust) {
    if (trust == CodeTrust::trusted) return;
    std::map<std::string, std::vector<std::string>> users;  // by part, the titles of its conditions
    for (const experiment::ConditionSpec& condition : conditions) {
        std::vector<std::string> words = condition.policies;
        words.push_back(condition.predictor);
        const auto title = titles.find(condition.name);
        for (const std::string& word : words)
            if (python::part_name_from(word))
                users[word].push_back(title == titles.end() ? condition.name : title->second);
    }
    std::vector<core::Problem> problems;
    for (const auto& [word, names] : users) {
        const python::PartName part = *python::part_name_from(word);
        problems.push_back(
            {fmt::format("{}: condition {}", where, fmt::join(names, "; ")),
             fmt::format("names code in Python, {}, which would run with your rights", part.file.string()),
             "code that you trust",
             fmt::format("Read it, or its copy in code/{} of the run folder, then add --trust-code",
                         part.hash)});
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

void tell_printed(const results::Store& store) {
    std::set<std::string> parts;
    for (const experiment::ConditionSpec& condition : store.manifest().conditions)
        parts.merge(names_of_parts(condition));
    const std::filesystem::path folder = store.log_file("").parent_path();
    if (parts.empty() || !std::filesystem::is_directory(folder)) return;
    std::size_t lines = 0;
    std::set<std::string> printing;
    std::set<std::filesystem::path> logs;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream log(entry.path());
        for (std::string line; std::getline(log, line);) {
            const std::string part = line.substr(0, line.find("| "));  // as python/clearway/_host.py marks it
            if (part.size() == line.size() || !parts.contains(part)) continue;
            ++lines;
            printing.insert(part);
            logs.insert(entry.path());
        }
    }
    if (logs.empty()) return;
    fmt::print(stderr, "clearway: {} printed {}: {}{}\n", fmt::join(printing, " and "),
               core::counted(lines, "line"), logs.begin()->string(),
               logs.size() == 1 ? "" : fmt::format(" and {} more", logs.size() - 1));
}

core::ExitCode tell_missing(std::size_t missing, std::size_t all) {
    if (missing == 0) return core::ExitCode::ok;
    fmt::print(stderr, "clearway: {} of {} are missing; repeat the command that started them to continue\n",
               missing, core::counted(all, "run"));
    return core::ExitCode::incomplete;
}

}  // namespace clearway::campaign
