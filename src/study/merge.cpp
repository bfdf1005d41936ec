#include "study/merge.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <span>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/part_folder.hpp"
#include "core/plain_files.hpp"
#include "study/folder_lock.hpp"
#include "study/plan.hpp"
#include "study/shard.hpp"

namespace clearway::study {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t named_missing = 10;

/// What a study keeps beside its runs, as study/side_files.hpp does.
constexpr std::array side_files = {"command.txt", "study.toml", "titles.json", "controls.json"};

/// Everything that a merge reads of a run folder is a file or a folder.
void require_plain(const fs::path& folder) {
    for (const char* const part :
         {"manifest.json", ".shard", "scenarios", "training", "code", "runs", "errors", "recordings"})
        core::require_plain_files(folder / part);
    for (const char* const name : side_files)
        core::require_plain_files(folder / name);
}

bool is_run_folder(const fs::path& folder) {
    return fs::exists(fs::symlink_status(folder / "manifest.json"));
}

void require_same_study(const results::Store& first, const results::Store& other) {
    const std::string differing = results::differences(first.manifest(), other.manifest());
    if (differing.empty()) return;
    if (differing == results::another_build)
        throw core::InputError(
            {other.folder().string(),
             fmt::format("was made by another build of Clearway than {}: {}, not {}", first.folder().string(),
                         other.manifest().clearway_build, first.manifest().clearway_build),
             "shards of one build", "Make the shards of one of them again with the build of the others"});
    throw core::InputError(
        {other.folder().string(),
         fmt::format("belongs to another study than {}: different {}", first.folder().string(), differing),
         "shards of one study", "Merge only run folders of one study file"});
}

/// Why a scenario's folder is not taken, in whole sentences; nothing for one that a study has completed and
/// that is as it was made. Its picture is made last, and no file is empty that was not lost in a power
/// failure.
std::optional<std::string> damage_of(const fs::path& folder, const results::ScenarioEntry& entry) try {
    if (!fs::exists(folder / "network.svg")) return folder.string() + ": is not complete";
    const auto is_lost = [](const auto& each) { return each.is_regular_file() && each.file_size() == 0; };
    if (std::any_of(fs::recursive_directory_iterator(folder), fs::recursive_directory_iterator(), is_lost))
        return folder.string() + ": has an empty file";
    require_unchanged(entry, folder);
    return std::nullopt;
} catch (const core::InputError& error) {
    return error.what();
}

/// Copies a scenario from the first folder that has it whole, unless the target has.
void copy_scenario(const std::vector<fs::path>& folders, const results::ScenarioEntry& entry,
                   const results::Store& target, MergeResult& result) {
    const fs::path copy = target.scenario_folder(entry.name);
    if (!damage_of(copy, entry)) return;
    bool exists = false;
    for (const fs::path& folder : folders) {
        const fs::path source = folder / "scenarios" / entry.name;
        if (!fs::exists(source)) continue;
        exists = true;
        const auto damage = damage_of(source, entry);
        // Demand of single runs is made anew where it is needed.
        if (!damage) return core::copy_folder(source, copy, "demand");
        result.damaged.push_back(*damage + ". It is left out");
    }
    if (exists || fs::exists(copy)) result.lost.push_back("scenario " + entry.name);
}

/// The first of these run folders' `part`; an empty path when none has it.
fs::path first_of(const std::vector<fs::path>& folders, const char* part) {
    const auto found =
        std::ranges::find_if(folders, [&](const fs::path& each) { return fs::exists(each / part); });
    return found == folders.end() ? fs::path() : *found / part;
}

/// Copies what a report needs besides the runs: configurations, networks, pictures, the command.
void copy_surroundings(const std::vector<fs::path>& folders, const results::Store& target,
                       MergeResult& result) {
    for (const results::ScenarioEntry& entry : target.manifest().scenarios)
        copy_scenario(folders, entry, target, result);
    for (const char* const name : {"training", "code"})
        core::copy_folder(first_of(folders, name), target.folder() / name);
    for (const char* const name : side_files) {
        const fs::path file = first_of(folders, name);
        if (!file.empty() && !fs::exists(target.folder() / name))
            core::write_atomically(target.folder() / name, core::read_file(file));
    }
}

/// The folder among `folders` that has the run, for messages.
std::string holder_of(const experiment::RunKey& key, std::span<const fs::path> folders) {
    for (const fs::path& folder : folders) {
        if (results::Store::open(folder).complete(key)) return folder.string();
    }
    return "an earlier merge";
}

/// Adds the runs of `folders[number]` to `target`. A damaged record is never adopted, and one that the target
/// has gives way. Returns the runs whose recording is damaged there.
std::set<experiment::RunKey> adopt_runs(const std::vector<fs::path>& folders, std::size_t number,
                                        const results::Store& target, MergeResult& result) {
    const results::Store source = results::Store::open(folders[number]);
    const std::vector<experiment::RunKey> keys = source.complete_runs();
    std::set<experiment::RunKey> damaged;
    for (const experiment::RunKey& key : keys) {
        for (const auto& moved :
             {target.set_damaged_aside({key}), target.set_damaged_recordings_aside({key})})
            for (const results::SetAside& aside : moved)
                result.damaged.push_back(
                    fmt::format("{}. It is kept in {}", aside.why, aside.place.string()));
        try {
            const bool first = target.adopt(source, key) == results::Store::Written::first;
            ++(first ? result.adopted : result.duplicates);
        } catch (const core::InputError& error) {
            result.damaged.push_back(fmt::format("{}. It is left out", error.what()));
            continue;
        } catch (const core::ConflictError& error) {
            throw core::ConflictError(fmt::format("{}. The other one is from {}", error.what(),
                                                  holder_of(key, std::span(folders).first(number))));
        }
        try {
            target.adopt_recording(source, key);
        } catch (const core::InputError& error) {
            result.damaged.push_back(fmt::format("{}. It is left out", error.what()));
            damaged.insert(key);
        }
    }
    target.flush(keys);
    return damaged;
}

void adopt_errors(const results::Store& source, const results::Store& target, MergeResult& result) {
    for (const experiment::RunKey& key : source.failed_runs()) {
        try {
            if (const auto error = source.read_error(key)) target.write(*error);
        } catch (const core::InputError& error) {
            result.damaged.push_back(fmt::format("{}. It is left out", error.what()));
        }
    }
}

std::vector<std::string> absent_shards(const std::vector<fs::path>& folders) {
    std::set<std::uint32_t> counts;
    std::set<std::uint32_t> present;
    for (const fs::path& folder : folders) {
        const Shard shard = shard_of(folder);
        counts.insert(shard.count);
        present.insert(shard.index);
    }
    std::vector<std::string> absent;
    if (counts.size() != 1) return absent;
    for (std::uint32_t index = 1; index <= *counts.begin(); ++index) {
        if (!present.contains(index)) absent.push_back(to_text(Shard{index, *counts.begin()}));
    }
    return absent;
}

std::vector<experiment::RunKey> first_missing(const results::Store& store) {
    std::vector<experiment::RunKey> missing;
    store.manifest().for_each_run([&](const experiment::RunKey& key) {
        if (missing.size() < named_missing && !store.complete(key) && !store.read_error(key))
            missing.push_back(key);
    });
    return missing;
}

}  // namespace

std::vector<fs::path> run_folders(const fs::path& path) {
    if (is_run_folder(path)) return {path};
    std::vector<fs::path> folders;
    std::error_code none;
    for (auto entry = fs::directory_iterator(path / "shards", none);
         !none && entry != fs::directory_iterator(); entry.increment(none)) {
        if (is_run_folder(entry->path())) folders.push_back(entry->path());
    }
    std::ranges::sort(folders);
    if (folders.empty())
        throw core::InputError({path.string(), "is not a run folder and has none in shards/",
                                "a folder written with --out", ""});
    return folders;
}

MergeResult merge(const std::vector<fs::path>& sources, const fs::path& out,
                  const std::function<void(std::size_t)>& on_folder) {
    std::vector<fs::path> folders;
    for (const fs::path& source : sources)
        std::ranges::copy(run_folders(source), std::back_inserter(folders));
    std::ranges::for_each(folders, require_plain);
    const results::Store first = results::Store::open(folders.front());
    for (const fs::path& folder : folders)
        require_same_study(first, results::Store::open(folder));
    claim(out, {});
    results::Store::refuse_others(out);
    const FolderLock lock(out);
    const results::Store target = results::Store::create(out, first.manifest());
    MergeResult result;
    copy_surroundings(folders, target, result);
    std::set<experiment::RunKey> damaged_recordings;
    for (std::size_t number = 0; number < folders.size(); ++number) {
        on_folder(number);
        damaged_recordings.merge(adopt_runs(folders, number, target, result));
    }
    for (const experiment::RunKey& key : damaged_recordings)
        if (!target.has_recording(key)) result.lost.push_back("recording " + experiment::to_text(key));
    for (const fs::path& folder : folders)
        adopt_errors(results::Store::open(folder), target, result);
    target.remove_leftovers();
    result.counts = results::write_tables(target);
    if (result.counts.missing > 0) {
        result.missing = first_missing(target);
        result.absent_shards = absent_shards(folders);
    }
    return result;
}

}  // namespace clearway::study
