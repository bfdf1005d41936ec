#!/usr/bin/env bash
# A study on a real Slurm: slurmctld, munge and two nodes on this host, in a folder of their own and without systemd.
# An array of shards runs over both nodes; one node is killed in the middle of a shard; Slurm requeues the shard; the
# merged database must be that of the study on one machine, byte for byte.
#   slurm.sh BIN   BIN: folder of the programs
# Exit code 77 where Slurm is not installed. Everything that was started is ended, whatever happens.
set -euo pipefail
readonly bin=$1
readonly shards=4
for program in slurmctld slurmd munged sbatch squeue scontrol; do
    if ! command -v "$program" >/dev/null; then
        echo "skipped: $program is not installed (packages slurmctld slurmd slurm-client munge)"
        exit 77
    fi
done

folder=$(mktemp -d /tmp/clearway-slurm-XXXXXX)
readonly folder
export SLURM_CONF=$folder/slurm.conf
started=()

# Processes of jobs that a node runs, and the slurmstepd above each.
steps_of() {
    local node=$1 process parent
    for process in $(grep -lsz "^SLURMD_NODENAME=$node$" /proc/[0-9]*/environ | cut -d/ -f3); do
        grep -qsz "^SLURM_CONF=$SLURM_CONF$" "/proc/$process/environ" || continue
        echo "$process"
        parent=$(awk '/^PPid:/ {print $2}' "/proc/$process/status" 2>/dev/null || true)
        if [[ $(cat "/proc/$parent/comm" 2>/dev/null) == slurmstepd ]]; then echo "$parent"; fi
    done
}

kill_all() {
    local process
    for process in "$@"; do kill -KILL "$process" 2>/dev/null || true; done
}

clean_up() {
    local code=$?
    trap - EXIT
    # shellcheck disable=SC2046 # one word a process
    kill_all "${started[@]}" $(steps_of n1) $(steps_of n2)
    if [[ $code != 0 ]]; then tail -n 15 "$folder"/*.log "$folder"/study/logs/* 2>/dev/null || true; fi
    rm -rf "$folder"
    exit "$code"
}
trap clean_up EXIT
trap 'exit 1' INT TERM

fail() {
    echo "slurm.sh: $1" >&2
    exit 1
}

# wait_for SECONDS WHAT COMMAND: until the command succeeds.
wait_for() {
    local patience=$((SECONDS + $1)) what=$2
    shift 2
    until "$@"; do
        [[ $SECONDS -lt $patience ]] || fail "$what did not happen in time"
        sleep 0.1
    done
}

# The shell does not report the end of what it does not own.
note_start() {
    started+=("$1")
    disown "$1"
}

free_port() {
    local port
    for ((port = 20000 + RANDOM % 20000;; port++)); do
        if ! (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; then break; fi
    done
    echo "$port"
}

start_munge() {
    install -d -m 700 "$folder/munge"
    (umask 077 && head -c 1024 /dev/urandom >"$folder/munge/key")
    munged --force --foreground --socket="$folder/munge/socket" --key-file="$folder/munge/key" \
        --pid-file="$folder/munge/pid" --log-file="$folder/munge.log" --seed-file="$folder/munge/seed" \
        >/dev/null 2>&1 &
    note_start $!
    wait_for 10 "the start of munged" test -S "$folder/munge/socket"
}

write_configuration() {
    local host user
    host=$(hostname)
    user=$(id -un)
    cat >"$SLURM_CONF" <<END
ClusterName=clearway
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket,cred_expire=5
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool-%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
SchedulerType=sched/builtin
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdTimeout=5
MinJobAge=3600
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$(free_port) CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$(free_port) CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=60 State=UP
END
    mkdir "$folder/state" "$folder/spool-n1" "$folder/spool-n2"
}

start_slurm() {
    slurmctld -D -c >/dev/null 2>&1 &
    note_start $!
    slurmd -D -N n1 >/dev/null 2>&1 &
    note_start $!
    slurmd -D -N n2 >/dev/null 2>&1 &
    second_node=$!
    note_start "$second_node"
    wait_for 30 "two idle nodes" bash -c '[[ $(sinfo -h -o %D -t idle 2>/dev/null) == 2 ]]'
}

write_study() {
    cat >"$folder/study.toml" <<END
name = "cluster"
seed = 3
replications = 32
scenarios = ["intersection"]
conditions = ["baseline", "graph_simulation", "b10_dead_reckoning", "solo"]
END
}

running_on() { squeue -h -t running -w "$1" -o %K 2>/dev/null; }

runs_in() { find "$@" -name run.json 2>/dev/null | wc -l; }

# Sets `victim` once the second node is in the middle of a shard: some of its runs are there, not all.
in_the_middle() {
    victim=$(running_on n2)
    [[ -n $victim && $(runs_in "$folder/study/shards/$victim-of-$shards") -ge 4 ]]
}

start_munge
write_configuration
start_slurm
write_study
"$bin/clearway" study submit "$folder/study.toml" --engine slurm --shards "$shards" --out "$folder/study" --go

victim=
wait_for 60 "a shard on the second node" in_the_middle
[[ -n $(running_on n1) ]] || fail "the first node does not work at the same time"
# Until nothing of it is left: a process may be born between looking and killing.
second_node_is_gone() {
    # shellcheck disable=SC2046 # one word a process
    kill_all "$second_node" $(steps_of n2)
    [[ -z $(steps_of n2) ]]
}
wait_for 10 "the death of the second node" second_node_is_gone
kept=$(runs_in "$folder/study/shards/$victim-of-$shards")
touch "$folder/killed"
echo "killed node n2 in shard $victim of $shards, which had $kept runs"
[[ $kept -lt 32 ]] || fail "the shard was over before it was killed"

wait_for 240 "the end of all jobs" bash -c '[[ -z $(squeue -h -o %i) ]]'
# Not through a pipe: `grep -q` ends at its first match, and what still writes to it then fails the pipeline.
jobs=$(scontrol -o show job)
grep -q "ArrayTaskId=$victim .*Restarts=1" <<<"$jobs" || fail "shard $victim was not requeued: $jobs"
[[ $(runs_in "$folder/study/shards/$victim-of-$shards" ! -newer "$folder/killed") == "$kept" ]] ||
    fail "the shard that came back made runs again that it had"
cat "$folder/study/logs/merge.log"

"$bin/clearway" study "$folder/study.toml" --out "$folder/single" >/dev/null 2>&1
for table in results.sqlite runs.csv vehicles.csv; do
    cmp "$folder/study/merged/$table" "$folder/single/$table" || fail "$table differs from one machine's"
done
[[ $(runs_in "$folder/study/shards") == 128 ]] || fail "there are duplicate or missing runs in the shards"
[[ $(runs_in "$folder/study/merged") == 128 ]] || fail "the merged folder has not 128 runs"
state=$("$bin/clearway" study status "$folder/study")
grep -q "complete; 128 of 128" <<<"$state" || fail "status does not tell the end: $state"
echo "the merged database is the single machine's, byte for byte: 128 runs, no duplicates, one shard requeued"
