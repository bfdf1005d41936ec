#!/usr/bin/env python3
"""What the loop costs beside SUMO's step, in five fixed runs: instructions, which are exact, and time as a ratio.

    benchmarks/loop_cost.py BUILD                  prints the table
    benchmarks/loop_cost.py BUILD --publish        also writes instructions into results/cost.csv; then: scripts/render-docs
    benchmarks/loop_cost.py BUILD --check          fails where a run needs 5 % more instructions than instructions.csv says
    benchmarks/loop_cost.py BUILD --renew          writes tests/loop/instructions.csv

BUILD is the folder of the preset `ci`. Instructions are counted by valgrind in the middle of a run, with nothing of its
start: those of libsumo's `Simulation::step` are SUMO's, all others are the loop's. Folder and environment change them by
up to 0.2 %. They depend on the compiler and on AVX2, for which the nets have a kernel: without it, and without valgrind,
nothing is checked (exit code 77). Times of so short a part mean nothing on a busy machine, so they are not published.
"""
import argparse
import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "scripts"))
import published_rows  # noqa: E402

COUNTS = ROOT / "tests/loop/instructions.csv"
ROWS = ROOT / "results/cost.csv"
ALLOWED = 1.05
REPEATS = 5
SKIPPED = 77
TITLES = {"intersection_baseline": "dense intersection, baseline", "city_baseline": "dense city, baseline",
          "city_corridor": "dense city, corridor, perfect sensing",
          "city_corridor_repaired": "dense city, corridor under B10 with graphsage",
          "arterial_linked": "arterial, vacate_lane and pull_aside that ask linked vehicles, under B10 with graphsage"}
TOTAL = re.compile(r"^ *([\d,]+) .*PROGRAM TOTALS", re.MULTILINE)
STEP = re.compile(r"^ *([\d,]+) .*:libsumo::Simulation::step\(double\)", re.MULTILINE)


def why_not():
    """Why nothing can be counted here, or nothing."""
    if shutil.which("valgrind") is None:
        return "valgrind is not installed (`./test --full` installs it)"
    if "avx2" not in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"):
        return "this processor has no AVX2, for which the counts are"
    return None


def output_of(command):
    environment = {"PATH": os.environ["PATH"], "CLEARWAY_HOME": str(ROOT), "LD_BIND_NOW": "1",
                   "SUMO_HOME": os.environ.get("SUMO_HOME", "/usr/share/sumo")}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if "vex amd64->IR: unhandled instruction" in done.stderr:
        print("skipped: valgrind does not know an instruction that a library executes on this processor")
        sys.exit(SKIPPED)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} failed with {done.returncode}:\n{done.stderr}")
    return done.stdout


def count(program, run):
    """Instructions of SUMO's step and of the loop."""
    with tempfile.TemporaryDirectory() as folder:
        counts = pathlib.Path(folder) / "counts"
        output_of(["valgrind", "--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={counts}", program, run])
        text = output_of(["callgrind_annotate", "--inclusive=yes", "--threshold=100", counts])
    total, sumo = (int(pattern.search(text)[1].replace(",", "")) for pattern in (TOTAL, STEP))
    return sumo, total - sumo


def ratios(program, run):
    """Time of the loop over that of SUMO's step, ascending, each of both in one run."""
    times = [[float(word) for word in output_of([program, run]).split()] for _ in range(REPEATS)]
    return sorted(loop_s / sumo_s for sumo_s, loop_s, _ in times)


def known_counts():
    with COUNTS.open(encoding="utf-8", newline="") as file:
        return {row["run"]: int(row["loop"]) for row in csv.DictReader(file)}


def check(counts):
    known = known_counts()
    failed = False
    for run, (sumo, loop) in counts.items():
        change = 100.0 * (loop / known[run] - 1.0)
        print(f"{run}: {known[run]:,} -> {loop:,} instructions of the loop ({change:+.2f} %); SUMO {sumo:,}")
        if loop > ALLOWED * known[run]:
            failed = True
            print(f"{run}: more than {100.0 * (ALLOWED - 1.0):.0f} % above tests/loop/instructions.csv. Make it cheaper; or, if "
                  "it must be so, say why in the commit and renew the file: benchmarks/loop_cost.py build/ci --renew")
    sys.exit(1 if failed else 0)


def renew(counts):
    with COUNTS.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["run", "simulator", "loop"])
        writer.writerows([run, sumo, loop] for run, (sumo, loop) in counts.items())


def publish(counts):
    made = published_rows.made(ROOT, "loop", "benchmarks/loop_cost.py build/ci --publish")
    common = made | {"measure": "million_instructions"}
    rows = []
    for run, (sumo, loop) in counts.items():
        for part, number in (("SUMO's step", sumo), ("the loop", loop)):
            rows.append(common | {"condition": TITLES[run], "scenario": part, "mean": f"{number / 1e6:.1f}"})
    published_rows.put_rows(ROWS, rows)


def show(counts, times):
    print(f"{'run':24} {'SUMO, M instr.':>15} {'loop, M instr.':>15} {'loop / SUMO':>12} {'in time':>8} (lowest, highest)")
    for run, (sumo, loop) in counts.items():
        print(f"{run:24} {sumo / 1e6:15.1f} {loop / 1e6:15.1f} {loop / sumo:12.3f} {times[run][REPEATS // 2]:8.2f} "
              f"({times[run][0]:.2f}, {times[run][-1]:.2f})")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    what = parser.add_mutually_exclusive_group()
    for name in ("check", "renew", "publish"):
        what.add_argument(f"--{name}", action="store_true")
    given = parser.parse_args()
    program = given.build.resolve() / "tests/loop_fixed_runs"
    if not program.exists():
        sys.exit(f"{program} is missing: cmake --build --preset ci --target loop_fixed_runs")
    if reason := why_not():
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)
    counts = {run: count(program, run) for run in TITLES}
    if given.check:
        check(counts)
    if given.renew:
        renew(counts)
        return
    times = {run: ratios(program, run) for run in TITLES}
    show(counts, times)
    if given.publish:
        publish(counts)


if __name__ == "__main__":
    main()
