#include "study/fresh_seeds.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/strict_table.hpp"
#include "results/manifest.hpp"

namespace clearway::study {
namespace {

namespace fs = std::filesystem;

/// Sorted, so that a message names the same one on every machine.
std::set<fs::path> entries_of(const fs::path& folder) {
    std::set<fs::path> entries;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
        entries.insert(entry.path());
    return entries;
}

/// The seeds of a study file: its own and that of its trial. Empty for other TOML files.
std::vector<std::uint64_t> seeds_of(const fs::path& file) {
    try {
        const toml::table table = core::parse_toml(core::read_file(file), file.string());
        if (!table.contains("conditions") && !table.contains("condition")) return {};
        const auto own = static_cast<std::uint64_t>(table["seed"].value_or<std::int64_t>(1));
        const auto quick = table["quick"]["seed"].value<std::int64_t>();
        return quick ? std::vector{own, static_cast<std::uint64_t>(*quick)} : std::vector{own};
    } catch (const core::InputError&) {
        return {};
    }
}

std::optional<results::Manifest> manifest_in(const fs::path& folder) {
    const fs::path file = folder / "manifest.json";
    std::error_code none;
    if (!fs::is_regular_file(file, none)) return std::nullopt;
    try {
        return results::manifest_from_json(core::read_file(file), file.string());
    } catch (const core::InputError&) {
        return std::nullopt;
    }
}

std::string user_among_files(const StudyConfig& config, const fs::path& file) {
    std::error_code none;
    const fs::path absolute = fs::absolute(file);
    for (const fs::path& other : entries_of(absolute.parent_path())) {
        if (other.extension() != ".toml" || fs::equivalent(other, absolute, none)) continue;
        const std::vector<std::uint64_t> seeds = seeds_of(other);
        if (std::ranges::find(seeds, config.seed) != seeds.end()) return other.string();
    }
    return "";
}

std::string user_among_runs(const StudyConfig& config, const fs::path& folder) {
    std::error_code none;
    const fs::path absolute = fs::absolute(folder);
    for (const fs::path& other : entries_of(absolute.parent_path())) {
        if (fs::equivalent(other, absolute, none)) continue;
        const auto manifest = manifest_in(other);
        if (!manifest || manifest->study_seed != config.seed) continue;
        const bool is_itself = manifest->study == config.name && manifest->plan == config.plan;
        if (!is_itself) return other.string();
    }
    return "";
}

}  // namespace

void check_fresh_seed(const StudyConfig& config, const fs::path& file, const fs::path& folder) {
    if (!config.plan) return;
    std::string user = user_among_files(config, file);
    if (user.empty()) user = user_among_runs(config, folder);
    if (user.empty()) return;
    throw core::InputError(
        {fmt::format("{}: seed", file.string()), fmt::format("{} was used before, by {}", config.seed, user),
         "a seed that nothing was tuned on or looked at",
         "Give the study another seed, or remove [plan] and call its results exploratory"});
}

}  // namespace clearway::study
