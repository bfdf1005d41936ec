#!/usr/bin/env python3
"""What a study on the city costs beside its simulations, from processor time, which other load disturbs little.

    benchmarks/study_costs.py build/release/bin [--replications 20]

Prints, as JSON:
  overhead_share       processor time of `clearway` itself (scheduling, statistics, tables, report) over that of its
                       workers (loading, warm-up, simulation, storing a run)
  warm_up_saved_share  of the processor time that one warm-up for each of five conditions would need, what one shared
                       warm-up for all five saves
  speed_up             wall time on one core over that on two; `speed_up_of_the_machine` is the same for two busy
                       loops that share nothing, the most that can be had at this moment
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

TICKS_S = os.sysconf("SC_CLK_TCK")


def study_text(replications, conditions):
    """The city under baselines of other names, which all take the same time, or under the built-in conditions."""
    text = f'seed = 1\nreplications = {replications}\nscenarios = ["city"]\n'
    if conditions is None:
        return text + ('conditions = ["baseline", "graph_simulation", "graph_graphsage", "b10_no_repair", '
                       '"b10_dead_reckoning", "solo"]\n')
    return text + "".join(f'[[condition]]\nname = "copy{i}"\n' for i in range(conditions))


def run(program, study, out, jobs):
    """Wall time, processor time of the program itself, and of its workers, s."""
    started = time.monotonic()
    child = subprocess.Popen([program, "study", study, "--out", out, "--jobs", str(jobs)],
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    own = workers = 0.0
    while child.poll() is None:
        try:
            fields = pathlib.Path(f"/proc/{child.pid}/stat").read_text().rsplit(")", 1)[1].split()
            own, workers = [sum(map(int, fields[i:i + 2])) / TICKS_S for i in (11, 13)]
        except (FileNotFoundError, ProcessLookupError, IndexError):
            pass
        time.sleep(0.002)
    if child.returncode != 0:
        sys.exit(child.stderr.read().decode())
    return {"wall_s": time.monotonic() - started, "own_s": own, "workers_s": workers}


def machine_speed_up():
    """Two busy loops after each other, over the same two at one time."""
    loop = [sys.executable, "-c", "sum(i * i for i in range(12_000_000))"]
    started = time.monotonic()
    for _ in range(2):
        subprocess.run(loop, check=True)
    alone_s = time.monotonic() - started
    started = time.monotonic()
    for process in [subprocess.Popen(loop) for _ in range(2)]:
        process.wait()
    return alone_s / (time.monotonic() - started)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path, help="folder of the programs")
    parser.add_argument("--replications", type=int, default=20)
    arguments = parser.parse_args()
    program = arguments.bin / "clearway"
    with tempfile.TemporaryDirectory(prefix="clearway-costs-") as folder:
        place = pathlib.Path(folder)

        def measure(name, conditions, jobs):
            study = place / f"{name}.toml"
            study.write_text(study_text(arguments.replications, conditions))
            return run(program, study, place / name, jobs)

        one_core = measure("one", None, 1)
        two_cores = measure("two", None, 2)
        five = measure("five", 5, 2)
        single = measure("single", 1, 2)
        figures = {
            "runs": 6 * arguments.replications,
            "one_core": one_core,
            "two_cores": two_cores,
            "overhead_share": one_core["own_s"] / one_core["workers_s"],
            "warm_up_saved_share": 1.0 - five["workers_s"] / (5.0 * single["workers_s"]),
            "speed_up": one_core["wall_s"] / two_cores["wall_s"],
            "speed_up_of_the_machine": machine_speed_up(),
            "load_average": os.getloadavg()[0],
        }
    print(json.dumps(figures, indent=2))


main()
