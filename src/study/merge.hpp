#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "results/store.hpp"
#include "results/table_writer.hpp"

namespace clearway::study {

/// The run folders that a path stands for: itself, or those in `shards/` below it, by name. Throws
/// core::InputError when there is none.
std::vector<std::filesystem::path> run_folders(const std::filesystem::path& path);

/// What came of a merge.
struct MergeResult {
    results::RunCounts counts;                ///< Of the merged folder.
    std::size_t adopted = 0;                  ///< Runs that were new to it.
    std::size_t duplicates = 0;               ///< Runs that it had already, with the same bytes.
    std::vector<experiment::RunKey> missing;  ///< The first ten that nobody has, sorted.
    std::vector<std::string> absent_shards;   ///< `3/8`, where the sources are shards of one count.
};

/// Puts the runs of several run folders of one study into `out`, which may hold some already, and writes its
/// tables. The result depends on the runs alone: not on their number of folders, nor their order. Files are
/// linked where that is possible; memory is that of one run and of one folder's list of runs. `on_folder` is
/// called before each source with its number. Throws core::InputError when a source is of another study,
/// core::ConflictError, naming run and folders, when two records of a run differ, core::EnvironmentError.
MergeResult merge(const std::vector<std::filesystem::path>& sources, const std::filesystem::path& out,
                  const std::function<void(std::size_t)>& on_folder);

}  // namespace clearway::study
