#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace clearway::study {

/// What runs the shards of a study.
enum class SubmitEngine : std::uint8_t {
    slurm,     ///< A Slurm job array, and a job that merges its shards.
    parallel,  ///< GNU parallel, on this host or those of its --sshloginfile.
    local,     ///< Processes of this host.
};

/// A study divided among many machines. Paths are absolute and the same on all of them.
struct Submission {
    SubmitEngine engine = SubmitEngine::local;
    std::uint32_t shards = 1;
    std::filesystem::path program;  ///< `clearway`.
    std::filesystem::path study;
    /// Shards go to `shards/`, the result to `merged/`; logs and exit codes of the last call to `logs/`.
    std::filesystem::path folder;
    double shard_limit_s = 3600.0;           ///< Wall time that Slurm grants a shard.
    std::vector<std::string> study_options;  ///< Passed on to `clearway study`.
};

/// One of the files of a submission.
struct Script {
    std::string name;
    std::string text;
};

/// The scripts; the last, `submit.sh`, starts everything. A shard that is killed or reaches its time limit is
/// queued again and continues in its folder, or in a folder next to it if a lost node may still hold that
/// one. If a shard refuses its input or finds a conflict, `merge.sh` names it, merges nothing and ends with
/// that exit code (the largest, if several do). A signal to `submit.sh` ends its shards first. Throws
/// core::InputError for a folder that cannot be written in an option of sbatch, with SubmitEngine::slurm.
std::vector<Script> scripts_of(const Submission& submission);

}  // namespace clearway::study
