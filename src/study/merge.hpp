#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "results/store.hpp"
#include "results/table_writer.hpp"

namespace clearway::study {

/// The run folders that a path stands for: itself, or those in its `shards/`, sorted by name. Throws
/// core::InputError when there is none.
std::vector<std::filesystem::path> run_folders(const std::filesystem::path& path);

/// The result of a merge.
struct MergeResult {
    results::RunCounts counts;                ///< Runs of the merged folder.
    std::size_t adopted = 0;                  ///< Runs that were new to it.
    std::size_t duplicates = 0;               ///< Runs that it already had, with the same bytes.
    std::vector<experiment::RunKey> missing;  ///< The first ten runs that no folder has, sorted.
    /// Damaged records, recordings and scenarios: where, what is wrong, what became of them.
    std::vector<std::string> damaged;
    std::vector<std::string> lost;  ///< Scenarios and recordings of the sources of which none is whole.
    std::vector<std::string> absent_shards;  ///< `3/8`, ...; if all sources are shards of the same count.
};

/// Puts the runs of several run folders of one study into `out`, which may already hold some, and writes its
/// tables. The result depends only on the runs, not on the number or order of folders. Files are linked where
/// possible, and flushed; a damaged record is left out, and one of `out` replaced. Memory holds one run and
/// one folder's list of runs. `on_folder` is called with the number of each source before it is merged.
/// Throws core::InputError when a source belongs to another study, core::ConflictError, naming run and
/// folders, when two records of a run differ, and core::EnvironmentError.
MergeResult merge(const std::vector<std::filesystem::path>& sources, const std::filesystem::path& out,
                  const std::function<void(std::size_t)>& on_folder);

}  // namespace clearway::study
