#pragma once

#include <cstdint>
#include <string>

#include "campaign/printing.hpp"
#include "core/error.hpp"
#include "experiment/run_job.hpp"
#include "study/config.hpp"
#include "study/submission.hpp"

namespace clearway::campaign {

/// How a study is divided among machines.
struct SubmitRequest {
    std::string file;  ///< The study file.
    std::string out;   ///< Folder on a file system that all machines share.
    study::SubmitEngine engine = study::SubmitEngine::local;
    std::uint32_t shards = 0;  ///< 0: about five minutes of work each.
    enum class Start : std::uint8_t { write_only, go } start = Start::write_only;
    experiment::RunLimits limits;
    Printing printing = Printing::text;
    std::string command;  ///< What the user typed.
};

/// Writes the scripts of a study in `out` and says so; with `go` it runs submit.sh and returns as that does.
/// `in_file` is the study as the file has it, `config` the same with models from the command line, which the
/// shards are given. SIGINT and SIGTERM end the shards, which close their files, and then this. Throws
/// core::InputError, before it writes anything, where `out` is somebody else's or holds another study or
/// division, and where SUMO or sbatch could not read its name.
core::ExitCode submit(const study::StudyConfig& in_file, const study::StudyConfig& config,
                      const SubmitRequest& request);

}  // namespace clearway::campaign
