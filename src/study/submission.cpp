#include "study/submission.hpp"

#include <cmath>

#include <fmt/format.h>

#include "core/process.hpp"

namespace clearway::study {
namespace {

std::string word(const std::filesystem::path& path) {
    return core::shell_text({path.string()});
}

/// Runs shard "$1", with the exit codes of clearway.
std::string shard_script(const Submission& submission) {
    std::vector<std::string> options = submission.study_options;
    const std::string extra = options.empty() ? "" : " " + core::shell_text(options);
    return fmt::format(R"(#!/usr/bin/env bash
# Runs one shard of {count}: shard.sh I. A second call continues where the first one stopped.
set -uo pipefail
readonly shard=$1 count={count} folder={folder}
readonly out=$folder/shards/$shard-of-$count

run_in() {{
    {program} study {study} --shard "$shard/$count" --out "$1"{extra} &
    child=$!
    # A signal is passed on, and its shard closes its files; then the wait is over.
    trap 'kill -TERM "$child" 2>/dev/null' TERM INT
    wait "$child"
    code=$?
    while kill -0 "$child" 2>/dev/null; do wait "$child"; code=$?; done
    return "$code"
}}

mkdir -p "$folder/shards" "$folder/logs"
exec >>"$folder/logs/shard-$shard.log" 2>&1
run_in "$out"
code=$?
if [[ $code == 4 && ${{SLURM_RESTART_COUNT:-0}} -gt 0 ]]; then
    # A node that was declared dead may still hold the folder, so this attempt works in another one. Units are the same
    # wherever they are made, and the merge checks that.
    run_in "$out.$SLURM_RESTART_COUNT"
    code=$?
fi
exit "$code"
)",
                       fmt::arg("count", submission.shards), fmt::arg("folder", word(submission.folder)),
                       fmt::arg("program", word(submission.program)),
                       fmt::arg("study", word(submission.study)), fmt::arg("extra", extra));
}

std::string merge_command(const Submission& submission) {
    return fmt::format("{} study merge {} --out {}", word(submission.program), word(submission.folder),
                       word(submission.folder / "merged"));
}

/// The job array. Slurm reads its options from the comments.
std::string slurm_script(const Submission& submission) {
    const auto minutes = static_cast<long>(std::ceil(submission.shard_limit_s / 60.0));
    return fmt::format(R"(#!/usr/bin/env bash
#SBATCH --job-name=clearway
#SBATCH --array=1-{count}
#SBATCH --cpus-per-task=1
#SBATCH --time={minutes}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@60
#SBATCH --output={folder}/logs/slurm-%a.log
# A minute before its time limit a shard gets SIGTERM, closes its files, and is queued again.
child=
warned=no
trap 'warned=yes; kill -TERM "$child" 2>/dev/null' TERM
bash {folder}/shard.sh "$SLURM_ARRAY_TASK_ID" &
child=$!
wait "$child"
code=$?
while kill -0 "$child" 2>/dev/null; do wait "$child"; code=$?; done
if [[ $warned == yes && $code == 143 ]]; then
    scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
fi
exit "$code"
)",
                       fmt::arg("count", submission.shards), fmt::arg("minutes", minutes),
                       fmt::arg("folder", submission.folder.string()));
}

std::string slurm_merge_script(const Submission& submission) {
    return fmt::format(R"(#!/usr/bin/env bash
#SBATCH --job-name=clearway-merge
#SBATCH --cpus-per-task=1
#SBATCH --output={}/logs/merge.log
exec {}
)",
                       submission.folder.string(), merge_command(submission));
}

constexpr const char* submit_head = R"(#!/usr/bin/env bash
# Runs the shards of a study and merges them. A second call runs what is missing.
set -euo pipefail
)";

std::string submit_script(const Submission& submission) {
    const std::string folder = word(submission.folder);
    std::string text = fmt::format("{}mkdir -p {}/logs\n", submit_head, folder);
    if (submission.engine == SubmitEngine::slurm) {
        // The merge runs even if shards failed: it says what is missing.
        return text + fmt::format(R"(array=$(sbatch --parsable {0}/array.sbatch)
merge=$(sbatch --parsable --dependency="afterany:${{array%%;*}}" {0}/merge.sbatch)
echo "job array ${{array%%;*}}, merge ${{merge%%;*}}; squeue shows them, and: {1} study status {0}"
)",
                                  folder, word(submission.program));
    }
    if (submission.engine == SubmitEngine::parallel) {
        text += fmt::format(
            R"(# Options of GNU parallel can be added in PARALLEL, for example --jobs 32 --sshloginfile hosts.
seq {1} | parallel -q --retries 3 --joblog {0}/logs/parallel.log bash {0}/shard.sh {{}} || true
)",
            folder, submission.shards);
    } else {
        text += fmt::format(R"sh(seq {1} | xargs -P "$(nproc)" -I '{{}}' bash {0}/shard.sh '{{}}' || true
)sh",
                            folder, submission.shards);
    }
    return text + "exec " + merge_command(submission) + "\n";
}

}  // namespace

std::vector<Script> scripts_of(const Submission& submission) {
    std::vector<Script> scripts = {{"shard.sh", shard_script(submission)}};
    if (submission.engine == SubmitEngine::slurm) {
        scripts.push_back({"array.sbatch", slurm_script(submission)});
        scripts.push_back({"merge.sbatch", slurm_merge_script(submission)});
    }
    scripts.push_back({"submit.sh", submit_script(submission)});
    return scripts;
}

}  // namespace clearway::study
