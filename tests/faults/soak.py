"""A long study: many short runs with recordings and a part in Python, whose workers are killed now and then. Wanted: all runs complete,
memory and descriptors of the parent flat, no process, no temporary file and no shared memory left.

    soak.py BIN [RUNS]     40 runs where no number is given
"""
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

KILLED = 20  # One worker in so many units, on the average.
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
        complete = sum(1 for _ in (folder / "out" / "runs").glob("*/*/*/run.json"))
        return complete, resident_kib(process), len(os.listdir(f"/proc/{process}/fd"))
    except OSError:
        return None


def watch(study, folder, draw):
    """Samples of the parent until it ends; kills workers."""
    samples, killed = [], 0
    while study.poll() is None:
        if seen := sample(study.pid, folder):
            samples.append(seen)
        workers = children(study.pid)
        # About twice a second, and a unit takes about a second.
        if workers and draw.random() < 0.5 / KILLED:
            os.kill(workers[0], signal.SIGKILL)
            killed += 1
        time.sleep(0.5)
    return samples, killed


def judge(samples, runs):
    early = [seen for seen in samples if runs // 4 <= seen[0] < runs // 2]
    late = [seen for seen in samples if seen[0] >= runs // 2 and seen[0] < runs]
    if not early or not late:
        return ["too few samples"]
    wrong = []
    most, end = max(seen[1] for seen in early), max(seen[1] for seen in late)
    print(f"parent: {most} KiB in the second quarter, {end} KiB in the second half; "
          f"{max(seen[2] for seen in early)} and {max(seen[2] for seen in late)} descriptors")
    if end > most + GROWTH_KIB:
        wrong.append(f"the parent grows from {most} to {end} KiB")
    if max(seen[2] for seen in late) > max(seen[2] for seen in early):
        wrong.append("the parent opens more and more files")
    return wrong


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    clearway, runs = pathlib.Path(sys.argv[1]).resolve() / "clearway", int((sys.argv[2:] or ["40"])[0])
    source = pathlib.Path(__file__).resolve().parents[2]
    shared = set(os.listdir("/dev/shm"))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        shutil.copy2(source / "examples" / "python" / "yield_policy.py", folder)
        (folder / "temporary").mkdir()
        (folder / "study.toml").write_text(STUDY.format(replications=runs // 2), encoding="utf-8")
        with open(folder / "log", "w", encoding="utf-8") as log, subprocess.Popen(
                [clearway, "study", "study.toml", "--out", "out", "--record"], cwd=folder, stdout=log, stderr=log,
                env={**os.environ, "TMPDIR": str(folder / "temporary")}, start_new_session=True) as study:
            samples, killed = watch(study, folder, random.Random(1))
        wrong = judge(samples, runs)
        complete = sum(1 for _ in (folder / "out" / "runs").glob("*/*/*/run.json"))
        recordings = sum(1 for _ in (folder / "out" / "recordings").rglob("*.h5"))
        print(f"{complete} of {runs} runs complete, {recordings} recordings; {killed} workers were killed")
        if study.returncode or complete != runs or recordings != runs:
            wrong.append(f"exit code {study.returncode}: {(folder / 'log').read_text(encoding='utf-8')[-500:]}")
        if left := os.listdir(folder / "temporary"):
            wrong.append(f"left in the folder for temporary files: {left[:5]}")
        if left := [name for name in set(os.listdir("/dev/shm")) - shared if "clearway" in name]:
            wrong.append(f"left in shared memory: {left[:5]}")
        if left := [path for path in (folder / "out").rglob("*.part")]:
            wrong.append(f"left in the run folder: {left[:5]}")
        time.sleep(2.0)  # for the children of a worker that was killed
        if left := subprocess.run(["pgrep", "-a", "-s", str(study.pid)], check=False, capture_output=True, text=True).stdout:
            wrong.append(f"processes are left: {left}")
    print("\n".join(wrong))
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
