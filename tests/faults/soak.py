"""A long study: many short runs with recordings and a part in Python, whose workers are killed now and then. Wanted: all runs complete,
memory and descriptors of the parent flat, no process and no temporary file left. (Memory that is shared has no name and goes with
its processes.)

    soak.py BIN [RUNS] [--folder FOLDER] [--jobs N]

FOLDER stays, and the same command with it continues a study that was ended by SIGTERM; memory is judged over the runs of each call.
"""
import argparse
import contextlib
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

KILLED = 20  # About one worker in so many units; in a short study one in every eighth part of it.
GROWTH_KIB = 4096  # Of the parent in the second half; a run's row takes some hundred bytes.
STUDY = """name = "soak"
scenarios = ["merge"]
conditions = ["baseline"]
replications = {replications}

[[condition]]
name = "yields"
policy = ["yield_policy.py:Yield"]
"""


def children(process):
    try:
        text = pathlib.Path(f"/proc/{process}/task/{process}/children").read_text(encoding="ascii")
        return [int(word) for word in text.split()]
    except OSError:
        return []


def resident_kib(process):
    for line in pathlib.Path(f"/proc/{process}/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1])
    return 0


def sample(process, folder):
    """Runs that are complete, KiB in memory, open descriptors; None when the process has gone."""
    try:
        # First what is judged: counting takes a while, in which the last run may end.
        kib, descriptors = resident_kib(process), len(os.listdir(f"/proc/{process}/fd"))
        return sum(1 for _ in (folder / "out" / "runs").glob("*/*/*/run.json")), kib, descriptors
    except OSError:
        return None


def watch(study, folder, draw, runs):
    """Samples of the parent until it ends; kills workers."""
    samples, killed = [], 0
    while study.poll() is None:
        if seen := sample(study.pid, folder):
            samples.append(seen)
        workers = children(study.pid)
        # About twice a second, and a unit takes about a second. What checks the program before the first unit is no worker.
        begun = samples and samples[-1][0] > 0
        if begun and workers and draw.random() < 0.5 / min(KILLED, runs / 8):
            os.kill(workers[0], signal.SIGKILL)
            killed += 1
        time.sleep(0.5)
    return samples, killed


def judge(samples, runs):
    first = samples[0][0] if samples else 0  # of an earlier call
    quarter, half = first + (runs - first) // 4, first + (runs - first) // 2
    early = [seen for seen in samples if quarter <= seen[0] < half]
    late = [seen for seen in samples if half <= seen[0] < runs]
    if not early or not late:
        return ["too few samples"]
    wrong = []
    most, end = max(seen[1] for seen in early), max(seen[1] for seen in late)
    fewest, fewest_late = min(seen[2] for seen in early), min(seen[2] for seen in late)  # between two units; a leak raises them
    print(f"parent: {most} KiB in the second quarter, {end} KiB in the second half; {fewest} and {fewest_late} descriptors at least, "
          f"{max(seen[2] for seen in early)} and {max(seen[2] for seen in late)} at most")
    if end > most + GROWTH_KIB:
        wrong.append(f"the parent grows from {most} to {end} KiB")
    if fewest_late > fewest:
        wrong.append("the parent opens more and more files")
    return wrong


def make_study(folder, runs):
    """Does nothing where it has been made."""
    if (folder / "study.toml").exists():
        return
    source = pathlib.Path(__file__).resolve().parents[2]
    shutil.copy2(source / "examples" / "python" / "yield_policy.py", folder)
    (folder / "temporary").mkdir()
    (folder / "study.toml").write_text(STUDY.format(replications=runs // 2), encoding="utf-8")


def run_study(words, folder, runs):
    """Samples, how many workers were killed, exit code, processes that are left. Ends the study when it is ended itself."""
    with open(folder / "log", "w", encoding="utf-8") as log, subprocess.Popen(
            words, cwd=folder, stdout=log, stderr=log, env={**os.environ, "TMPDIR": str(folder / "temporary")},
            start_new_session=True) as study:
        try:
            samples, killed = watch(study, folder, random.Random(1), runs)
        finally:
            study.terminate()  # of no effect on one that has ended
    time.sleep(2.0)  # for the children of a worker that was killed
    # Not those that have ended and that the first process of a container does not wait for.
    words = ["pgrep", "-a", "-r", "D,R,S,T", "-s", str(study.pid)]
    left = subprocess.run(words, check=False, capture_output=True, text=True).stdout
    return samples, killed, study.returncode, left


def end(number, _):
    sys.exit(128 + number)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", metavar="BIN", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("runs", metavar="RUNS", nargs="?", type=int, default=40)
    parser.add_argument("--folder", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    asked = parser.parse_args()
    signal.signal(signal.SIGTERM, end)
    with contextlib.nullcontext(asked.folder) if asked.folder else tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.mkdir(exist_ok=True)
        make_study(folder, asked.runs)
        words = [asked.programs / "clearway", "study", "study.toml", "--out", "out", "--record", "--jobs", str(asked.jobs)]
        samples, killed, code, processes = run_study(words, folder, asked.runs)
        wrong = judge(samples, asked.runs)
        complete = sum(1 for _ in (folder / "out" / "runs").glob("*/*/*/run.json"))
        recordings = sum(1 for _ in (folder / "out" / "recordings").rglob("*.h5"))
        print(f"{complete} of {asked.runs} runs complete, {recordings} recordings; {killed} workers were killed")
        if code or complete != asked.runs or recordings != asked.runs:
            wrong.append(f"exit code {code}: {(folder / 'log').read_text(encoding='utf-8')[-500:]}")
        if left := os.listdir(folder / "temporary"):
            wrong.append(f"left in the folder for temporary files: {left[:5]}")
        if left := list((folder / "out").rglob("*-part")):
            wrong.append(f"left in the run folder: {left[:5]}")
        if processes:
            wrong.append(f"processes are left: {processes}")
    print("\n".join(wrong))
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
