#include "campaign/run_name.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "campaign/names.hpp"
#include "core/error.hpp"
#include "core/number.hpp"
#include "core/read_failure.hpp"
#include "trace/recording.hpp"

namespace clearway::campaign {
namespace {

namespace fs = std::filesystem;

/// `mine/city/corridor/7` in its four parts.
struct Parts {
    fs::path folder;
    std::string scenario;
    std::string condition;
    std::string number;
};

bool is_run_folder(const fs::path& folder) {
    std::error_code error;  // a text that is no path is no folder either
    const bool exists = fs::exists(folder / "manifest.json", error);
    if (core::is_of_machine(error.value())) core::fail_to_read(folder / "manifest.json", error.value());
    return exists;
}

std::optional<Parts> parts_of(const std::string& name) {
    fs::path path = fs::path(name).lexically_normal();
    if (path.filename().empty()) path = path.parent_path();  // a slash at the end
    Parts parts{path.parent_path().parent_path().parent_path(),
                path.parent_path().parent_path().filename().string(), path.parent_path().filename().string(),
                path.filename().string()};
    if (parts.scenario.empty() || parts.condition.empty()) return std::nullopt;
    if (parts.folder.empty()) parts.folder = ".";
    // Shell completion leads to a run's own files, FOLDER/runs/SCENARIO/CONDITION/00007.
    const bool is_below = parts.folder.filename() == "runs" || parts.folder.filename() == "recordings";
    if (!is_run_folder(parts.folder) && is_below) {
        parts.folder = parts.folder.parent_path();
        if (parts.folder.empty()) parts.folder = ".";
    }
    return parts;
}

}  // namespace

std::string run_name(const fs::path& folder, const experiment::RunKey& key) {
    return (folder / experiment::to_text(key)).lexically_normal().string();
}

bool names_a_run(const std::string& text) {
    const std::optional<Parts> parts = parts_of(text);
    return parts && is_run_folder(parts->folder);
}

NamedRun run_named(const std::string& name, const std::string& where) {
    const std::optional<Parts> parts = parts_of(name);
    if (!parts || !is_run_folder(parts->folder))
        throw core::InputError(
            {where,
             parts ? fmt::format("`{}` is not a run: {} is not a run folder", name, parts->folder.string())
                   : fmt::format("`{}` is not a run", name),
             run_name_form, "for example runs/city-1a2b3c/city/corridor/0"});
    NamedRun run{results::Store::open(parts->folder), {parts->scenario, {}, 0}};
    const results::Manifest& manifest = run.store.manifest();
    std::vector<core::Problem> problems;
    const std::vector<std::string> known = core::texts_of(manifest.scenarios, &results::ScenarioEntry::name);
    if (!core::contains(known, parts->scenario))
        problems.push_back({name + ": scenario", fmt::format("`{}` is not in this study", parts->scenario),
                            core::listed(known), core::did_you_mean(parts->scenario, known)});
    try {
        run.key.condition = condition_called(parts->condition, run.store, name + ": condition");
    } catch (const core::InputError& error) {
        std::ranges::copy(error.problems(), std::back_inserter(problems));
    }
    const std::optional<std::uint32_t> number = core::number_from<std::uint32_t>(parts->number);
    if (number && *number < manifest.replications) {
        run.key.replication = *number;
    } else {
        problems.push_back({name + ": replication", fmt::format("`{}` is not in this study", parts->number),
                            fmt::format("0 to {}", manifest.replications - 1), ""});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return run;
}

NamedRecording recording_named(const std::string& name, const std::string& where) {
    const auto open = [](const fs::path& file) {
        return NamedRecording{fs::absolute(file).lexically_normal(),
                              std::make_unique<trace::RecordingReader>(file)};
    };
    if (fs::is_regular_file(name)) return open(name);
    const NamedRun run = run_named(name, where);
    const fs::path file = trace::recording_file(run.store.folder(), run.key);
    if (!fs::exists(file))
        throw core::InputError(
            {where,
             fmt::format("{} has no recording {}", run_name(run.store.folder(), run.key), file.string()),
             "a recorded run", "Repeat the command that made it, with --record"});
    NamedRecording recording = open(file);
    const experiment::RunKey& held = recording.reader->info().key;
    if (held != run.key)
        throw core::InputError({where,
                                fmt::format("{} holds the run {}", file.string(), experiment::to_text(held)),
                                experiment::to_text(run.key), "Make the recording again with --record"});
    return recording;
}

}  // namespace clearway::campaign
