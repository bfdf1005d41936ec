#include "study/fresh_seeds.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/read_failure.hpp"
#include "core/strict_table.hpp"
#include "experiment/run_key.hpp"
#include "results/manifest.hpp"
#include "results/store.hpp"
#include "study/plan.hpp"

namespace clearway::study {
namespace {

namespace fs = std::filesystem;

/// Sorted, so that a message names the same one on every machine.
std::set<fs::path> entries_of(const fs::path& folder) {
    std::set<fs::path> entries;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
        entries.insert(entry.path());
    if (error && error != std::errc::no_such_file_or_directory) core::fail_to_read(folder, error.value());
    return entries;
}

/// The seed that the plan of a study file fixes; nothing for other TOML files.
std::optional<std::uint64_t> planned_seed(const fs::path& file) {
    try {
        const toml::table table = core::parse_toml(core::read_file(file), file.string());
        if (!table.contains("plan")) return std::nullopt;
        return static_cast<std::uint64_t>(table["seed"].value_or<std::int64_t>(1));
    } catch (const core::InputError&) {
        return std::nullopt;
    }
}

std::string user_among_files(const StudyConfig& config, const fs::path& file) {
    std::error_code none;
    const fs::path absolute = fs::absolute(file);
    for (const fs::path& other : entries_of(absolute.parent_path())) {
        if (other.extension() != ".toml" || fs::equivalent(other, absolute, none)) continue;
        if (planned_seed(other) == config.seed) return other.string() + ": it is the seed of its [plan]";
    }
    return "";
}

/// The manifest of a run folder, if it is one. What cannot be read is added to `unread`.
std::optional<results::Manifest> manifest_in(const fs::path& folder, std::vector<core::Problem>& unread) {
    const fs::path file = folder / "manifest.json";
    std::error_code unknown;
    if (!fs::exists(file, unknown)) {
        if (unknown) unread.push_back({file.string(), "cannot be read: " + unknown.message(), "", ""});
        return std::nullopt;
    }
    try {
        return results::manifest_from_json(core::read_file(file), file.string());
    } catch (const core::InputError& error) {
        unread.push_back(error.problems().front());
        return std::nullopt;
    }
}

/// What a stored study has other than the wanted one; empty when the wanted one goes on with it. Versions do
/// not count: nobody chooses them by results. Conditions and replications may have been added because of
/// results.
std::string other_settings(const results::Manifest& stored, results::Manifest wanted) {
    wanted.clearway_version = stored.clearway_version;
    wanted.sumo_version = stored.sumo_version;
    wanted.clearway_build = stored.clearway_build;
    const bool same = wanted.conditions == stored.conditions && wanted.replications == stored.replications &&
                      results::continues(wanted, stored);
    return same ? "" : results::differences(stored, wanted);
}

/// `; it ran line/baseline/0`, or what its plan has fixed; nothing for a folder that was only prepared.
std::string use_of(const fs::path& folder, const results::Manifest& manifest) {
    const std::vector<experiment::RunKey> complete = results::Store::open(folder).complete_runs();
    if (!complete.empty()) {
        const experiment::RunKey& first = *std::ranges::min_element(complete);
        return fmt::format("; it ran {}/{}/{}", first.scenario, first.condition, first.replication);
    }
    return manifest.plan ? "; nothing ran, but it is the seed of its plan" : "";
}

/// `runs/first: different conditions; it ran line/baseline/0`, `runs/first: 8 replications instead of 10;
/// ...` or nothing.
std::string user_among_runs(const StudyConfig& config, const fs::path& folder,
                            std::vector<core::Problem>& unread) {
    std::error_code none;
    fs::path absolute = fs::absolute(folder).lexically_normal();
    if (!absolute.has_filename()) absolute = absolute.parent_path();  // `runs/x/`
    const results::Manifest wanted = manifest_of(config, {});
    for (const fs::path& other : entries_of(absolute.parent_path())) {
        const auto manifest = manifest_in(other, unread);
        if (!manifest || manifest->study_seed != config.seed) continue;
        const std::string different = other_settings(*manifest, wanted);
        const std::string use = different.empty() ? "" : use_of(other, *manifest);
        if (use.empty()) continue;
        if (different != "replications")
            return fmt::format("{}: different {}{}", other.string(), different, use);
        // The study's own folder with more: nothing would run, and the folder says so itself.
        if (manifest->replications > wanted.replications && fs::equivalent(other, absolute, none)) continue;
        return fmt::format("{}: {} replications instead of {}{}", other.string(), manifest->replications,
                           wanted.replications, use);
    }
    return "";
}

core::InputError used_before(const StudyConfig& config, const fs::path& file, const std::string& user,
                             const char* cure) {
    return core::InputError({fmt::format("{}: seed", file.string()),
                             fmt::format("{} was used before, by {}", config.seed, user),
                             "a seed that nothing was tuned on or looked at", cure});
}

}  // namespace

std::vector<core::Problem> check_fresh_seed(const StudyConfig& config, const fs::path& file,
                                            const fs::path& folder) {
    std::vector<core::Problem> unread;
    if (!config.plan) return unread;
    if (const std::string user = user_among_files(config, file); !user.empty())
        throw used_before(config, file, user,
                          "Give the study another seed, or remove [plan] and call its results exploratory");
    if (const std::string user = user_among_runs(config, folder, unread); !user.empty())
        throw used_before(config, file, user,
                          "Go on with those settings, take a seed that was never run, or remove [plan], take "
                          "another --out and call the results exploratory");
    return unread;
}

}  // namespace clearway::study
