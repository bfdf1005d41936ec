#include "study/submission.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/process.hpp"

namespace clearway::study {
namespace {

std::string word(const std::filesystem::path& path) {
    return core::shell_text({path.string()});
}

/// sbatch reads its options from comments: no shell does, and file names have `%` and `\\` for its own use.
void require_sbatch_reads(const std::filesystem::path& folder) {
    const std::string text = folder.string();
    const auto is_special = [](unsigned char letter) {
        return letter < ' ' || letter == 0x7f || letter == '"' || letter == '\\' || letter == '%';
    };
    if (std::ranges::none_of(text, is_special)) return;
    throw core::InputError({"--out", fmt::format("{} cannot be written in an option of sbatch", text),
                            "a path without \", \\, % and control characters for --engine slurm",
                            "Choose another folder"});
}

/// Runs shard "$1", with the exit codes of clearway, and notes the code for the merge.
std::string shard_script(const Submission& submission) {
    std::vector<std::string> options = submission.study_options;
    const std::string extra = options.empty() ? "" : " " + core::shell_text(options);
    return fmt::format(R"(#!/usr/bin/env bash
# Runs one shard of {count}: shard.sh I. A second call continues where the first one stopped.
set -uo pipefail
readonly shard=$1 count={count} folder={folder}
readonly out=$folder/shards/$shard-of-$count noted=$folder/logs/shard-$shard.exit

# A signal is passed on, and its shard closes its files; then the wait is over.
child=
stopped=no
stop() {{
    stopped=yes
    [[ -z $child ]] || kill -TERM "$child" 2>/dev/null
}}
trap stop TERM INT

run_in() {{
    {program} study {study} --shard "$shard/$count" --out "$1"{extra} &
    child=$!
    [[ $stopped == no ]] || stop # it came before the child had a number
    wait "$child"
    code=$?
    while kill -0 "$child" 2>/dev/null; do wait "$child"; code=$?; done
    return "$code"
}}

mkdir -p "$folder/shards" "$folder/logs"
exec >>"$folder/logs/shard-$shard.log" 2>&1
rm -f "$noted"
run_in "$out"
code=$?
if [[ $code == 4 && ${{SLURM_RESTART_COUNT:-0}} -gt 0 ]]; then
    # A node that was declared dead may still hold the folder, so this attempt works in another one. Units are
    # the same wherever they are made, and the merge checks that.
    run_in "$out.$SLURM_RESTART_COUNT"
    code=$?
fi
echo "$code" >"$noted"
exit "$code"
)",
                       fmt::arg("count", submission.shards), fmt::arg("folder", word(submission.folder)),
                       fmt::arg("program", word(submission.program)),
                       fmt::arg("study", word(submission.study)), fmt::arg("extra", extra));
}

/// Merges the shards for every engine. Where a shard refused its input, its folder may hold another study, so
/// nothing is merged.
std::string merge_script(const Submission& submission) {
    return fmt::format(R"(#!/usr/bin/env bash
# Merges the shards of a study, unless one refused its input (exit codes 2, 3) or found a conflict (7).
set -uo pipefail
readonly count={count} folder={folder}
worst=0
for ((shard = 1; shard <= count; ++shard)); do
    code=
    read -r code 2>/dev/null <"$folder/logs/shard-$shard.exit"
    # The merge itself tells of failed runs (1), and of runs that a killed shard (no exit code) has not made.
    case $code in
        "" | 0 | 1) continue ;;
        2 | 3 | 7) if [[ $code -gt $worst ]]; then worst=$code; fi ;;
    esac
    echo "clearway: shard $shard of $count ended with exit code $code: see $folder/logs/shard-$shard.log" >&2
done
if [[ $worst != 0 ]]; then
    echo "clearway: nothing is merged. Do what the logs of these shards say, then give the command again" >&2
    exit "$worst"
fi
exec {program} study merge "$folder" --out "$folder/merged"
)",
                       fmt::arg("count", submission.shards), fmt::arg("folder", word(submission.folder)),
                       fmt::arg("program", word(submission.program)));
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
#SBATCH --output="{plain_folder}/logs/slurm-%a.log"
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
                       fmt::arg("plain_folder", submission.folder.string()),
                       fmt::arg("folder", word(submission.folder)));
}

std::string slurm_merge_script(const Submission& submission) {
    return fmt::format(R"(#!/usr/bin/env bash
#SBATCH --job-name=clearway-merge
#SBATCH --cpus-per-task=1
#SBATCH --output="{}/logs/merge.log"
exec bash {}/merge.sh
)",
                       submission.folder.string(), word(submission.folder));
}

constexpr const char* submit_head = R"(#!/usr/bin/env bash
# Runs the shards of a study and merges them. A second call runs what is missing.
set -euo pipefail
)";

/// A signal ends the shards, which close their files, and then the script.
constexpr const char* stop_shards = R"(stop() {
    trap '' TERM INT HUP
    # shellcheck disable=SC2046 # one word a process
    kill -TERM $(jobs -p) 2>/dev/null || true
    wait
    exit "$1"
}
trap 'stop 143' TERM HUP
trap 'stop 130' INT
)";

/// Starts one shard per core. Their exit codes are for the merge.
constexpr const char* local_shards = R"(cores=$(nproc)
running=0
for ((shard = 1; shard <= count; ++shard)); do
    if ((running == cores)); then
        wait -n || true
        running=$((running - 1))
    fi
    bash "$folder/shard.sh" "$shard" &
    running=$((running + 1))
done
wait
)";

/// By default GNU parallel kills its jobs a fraction of a second after their first signal, too soon for them
/// to close their files.
constexpr const char* parallel_shards =
    R"(# Options of GNU parallel can be added in PARALLEL, for example --jobs 32 --sshloginfile hosts.
parallel -q --retries 3 --termseq TERM,60000,KILL,25 --joblog "$folder/logs/parallel.log" \
    bash "$folder/shard.sh" {} < <(seq "$count") &
wait
)";

std::string submit_script(const Submission& submission) {
    // Exit codes of an earlier call tell nothing about this one.
    std::string text = fmt::format(R"({}readonly folder={}
mkdir -p "$folder/logs"
find "$folder/logs" -name 'shard-*.exit' -delete
)",
                                   submit_head, word(submission.folder));
    if (submission.engine == SubmitEngine::slurm) {
        // The merge runs even if shards failed: it says what is missing.
        return text + fmt::format(R"(array=$(sbatch --parsable "$folder/array.sbatch")
merge=$(sbatch --parsable --dependency="afterany:${{array%%;*}}" "$folder/merge.sbatch")
printf 'job array %s, merge %s; squeue shows them, and: %q study status %q\n' \
    "${{array%%;*}}" "${{merge%%;*}}" {} "$folder"
)",
                                  word(submission.program));
    }
    text += fmt::format("readonly count={}\n{}", submission.shards, stop_shards);
    text += submission.engine == SubmitEngine::parallel ? parallel_shards : local_shards;
    return text + "exec bash \"$folder/merge.sh\"\n";
}

}  // namespace

std::vector<Script> scripts_of(const Submission& submission) {
    std::vector<Script> scripts = {{"shard.sh", shard_script(submission)},
                                   {"merge.sh", merge_script(submission)}};
    if (submission.engine == SubmitEngine::slurm) {
        require_sbatch_reads(submission.folder);
        scripts.push_back({"array.sbatch", slurm_script(submission)});
        scripts.push_back({"merge.sbatch", slurm_merge_script(submission)});
    }
    scripts.push_back({"submit.sh", submit_script(submission)});
    return scripts;
}

}  // namespace clearway::study
