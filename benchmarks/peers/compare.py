#!/usr/bin/python3
"""Clearway's loop beside two loops in Python, in the same session: the same vehicles and the same work, times as ratios.

    benchmarks/peers/compare.py BUILD                  prints the table
    benchmarks/peers/compare.py BUILD --publish        also writes it into results/cost.csv; then: scripts/render-docs
    benchmarks/peers/compare.py BUILD --check          two minutes of one scenario; fails where the work is not the same

BUILD is the folder of a build, for --publish of the preset `release`. Every step of 0.25 s all three read every vehicle, link pairs of
different classes nearer than 50 m, predict the links that outages hide (B10) with the net `graphsage_corrected`, and let the
dissertation's policy act. peer.py names what Clearway does beyond that. getters_loop.py is a loop of the dissertation's kind,
best_python.py the best that was found. Each has one thread; beside getters_loop.py SUMO has a process of its own.

First, without outages and actions, all three see the same traffic: numbers of vehicles and links must agree. Then they run in turns, of
which the least time counts, because others use the machine. "beside" is all but SUMO's own step; "whole" contains it. Needs the packages
sumo, python3-numpy, python3-scipy and python3-torch: exit code 77 where one is missing.
"""
import argparse
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.append(str(ROOT / "scripts"))
import published_rows  # noqa: E402

SKIPPED = 77
ROUNDS = 3
LEAD_S = 60.0  # lead_before_emergency of src/loop/unit_run.hpp
STEP_S = 0.25
AGREEMENT = 0.001  # of vehicles and links, relative: positions are rounded differently
# Options, and when vehicles cease to depart, where runs end. The loops begin a minute before the first emergency vehicle.
SCENARIOS = {"dense city": (["city", "--dense"], 600.0), "dense intersection": (["intersection", "--dense"], 400.0)}
SHORT = {"intersection": (["intersection"], 120.0)}
NET = "graphsage_corrected"
LOOPS = {"clearway": "Clearway", "getters_loop": "Python: TraCI getters, all pairs, PyTorch",
         "best_python": "Python: libsumo, k-d trees, NumPy"}
SEES_ALL = ["--failure", "perfect", "--set", "dissertation.min_edges=1000000"]
# As src/sumo/detail/options.cpp has them, beyond what the exported run.sumocfg says.
SUMO_OPTIONS = ("--route-steps 0 --collision.check-junctions true --collision.mingap-factor 0 --tripinfo-output.write-unfinished true "
                "--tripinfo-output.write-undeparted true --no-step-log true --duration-log.disable true").split()
ENVIRONMENT = {"SUMO_HOME": "/usr/share/sumo"} | os.environ | {
    "CLEARWAY_HOME": str(ROOT), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
WIDTHS = {"vehicles": 9, "links": 7, "believed": 9, "beside_s": 9, "beside_times": 13, "whole_s": 8, "whole_times": 12}


def said_by(*command):
    done = subprocess.run([str(word) for word in command], env=ENVIRONMENT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} failed with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


class Comparison:
    """One scenario, and its runs as files below `folder`. A run gives `simulator_s`, `beside_s`, and means of vehicles on the road
    over all steps and of links over those of the loop."""

    def __init__(self, build, scenario, folder):
        self.program, self.folder, self.runs = build / "bin/clearway", folder, 0
        self.scenario, self.end_s = scenario
        recorded = self.clearway_run(*SEES_ALL, "--record")
        said_by(self.program, "export", "trajectories", recorded, "--out", folder / "exported")
        self.sumo = folder / "exported/sumo"
        departures = xml.parse(self.sumo / "emergency.rou.xml").iter("vehicle")
        self.begin_s = min(float(vehicle.get("depart")) for vehicle in departures) - LEAD_S

    def clearway_run(self, *options):
        self.runs += 1
        out = self.folder / f"run{self.runs}"
        said_by(self.program, "run", *self.scenario, "--seeds", 1, "--jobs", 1, "--no-solo", "--no-perfect", "--name", "peers",
                "--horizon", self.end_s, "--policy", "dissertation", "--predictor", NET, "--set", "loop.policy_period_s=0.25",
                "--set", f"{NET}.reach_by_twin=0", *options, "--out", out)
        return next(out.glob("runs/*/peers/*"))

    def clearway(self, sees_all):
        run = self.clearway_run(*(SEES_ALL if sees_all else ["--failure", "B10"]))
        times, metrics = (json.loads((run / name).read_text(encoding="utf-8")) for name in ("timing.json", "run.json"))
        metrics = metrics["metrics"]
        links = metrics["links_true_positive"] + metrics["links_false_positive"]  # at reports
        loop_s = metrics["simulated_s"] - self.begin_s // STEP_S * STEP_S
        return {"simulator_s": times["simulator_s"], "beside_s": times["coupling_s"],
                "vehicles": metrics["vehicle_steps"] * STEP_S / metrics["simulated_s"],
                "links": links * (STEP_S if sees_all else 1.0) / loop_s}

    def python(self, loop, sees_all):
        self.runs += 1
        file = self.folder / f"run{self.runs}.json"
        arguments = ["-c", self.sumo / "run.sumocfg", "--tripinfo-output", file.with_suffix(".xml"), *SUMO_OPTIONS]
        file.write_text(json.dumps({
            "arguments": [str(word) for word in arguments], "begin_s": self.begin_s, "end_s": self.end_s,
            "weights": str(ROOT / f"src/prediction/models/{NET}.weights"), "fails": not sees_all, "acts": not sees_all}), encoding="utf-8")
        return json.loads(said_by(sys.executable, HERE / f"{loop}.py", file).splitlines()[-1])

    def run(self, loop, sees_all=False):
        return self.clearway(sees_all) if loop == "clearway" else self.python(loop, sees_all)


def compared(build, scenario, rounds):
    """Of each loop what it saw when all see the same, and the least of its times."""
    with tempfile.TemporaryDirectory() as folder:
        comparison = Comparison(build, scenario, pathlib.Path(folder))
        result = {}
        for loop in LOOPS:
            seen = comparison.run(loop, sees_all=True)
            result[loop] = {name: seen[name] for name in ("vehicles", "links")}
        turns = [{loop: comparison.run(loop) for loop in LOOPS} for _ in range(rounds)]
    for loop, row in result.items():
        made = [turn[loop] for turn in turns]
        row["believed"] = made[0]["links"]
        row["beside_s"] = min(run["beside_s"] for run in made)
        row["whole_s"] = min(run["beside_s"] + run["simulator_s"] for run in made)
    for name in ("beside", "whole"):
        for row in result.values():
            row[f"{name}_times"] = row[f"{name}_s"] / result["clearway"][f"{name}_s"]
    return result


def show(scenario, result):
    print(f"{scenario:42}" + "".join(f"{name:>{width}}" for name, width in WIDTHS.items()))
    for loop, row in result.items():
        print(f"{LOOPS[loop]:42}" + "".join(f"{row[name]:{width}.2f}" for name, width in WIDTHS.items()), flush=True)


def check(result):
    """Ends with 1 where the three did not do the same work."""
    for name in ("vehicles", "links"):
        numbers = [row[name] for row in result.values()]
        if not 0.0 < max(numbers) <= (1.0 + AGREEMENT) * min(numbers):
            sys.exit(f"the loops do not do the same work: {name} {', '.join(f'{number:.2f}' for number in numbers)} "
                     f"(allowed: {100 * AGREEMENT:g} % apart)")


def publish(results):
    common = published_rows.made(ROOT, "peers", "benchmarks/peers/compare.py build/release --publish")
    units = {"vehicles": "", "links": "", "beside_times": "times", "whole_times": "times"}
    rows = [common | {"scenario": scenario, "condition": LOOPS[loop], "measure": name, "unit": unit, "mean": f"{row[name]:.1f}"}
            for scenario, result in results.items() for loop, row in result.items() for name, unit in units.items()]
    published_rows.put_rows(ROOT / "results/cost.csv", rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", metavar="BUILD", type=pathlib.Path)
    what = parser.add_mutually_exclusive_group()
    for name in ("check", "publish"):
        what.add_argument(f"--{name}", action="store_true")
    given = parser.parse_args()
    if missing := [name for name in ("libsumo", "traci", "numpy", "scipy", "torch") if importlib.util.find_spec(name) is None]:
        print(f"skipped: Python has no {', '.join(missing)} (Debian: sumo, python3-numpy, python3-scipy, python3-torch)")
        sys.exit(SKIPPED)
    if not (given.build / "bin/clearway-run").exists():
        sys.exit(f"{given.build}/bin/clearway-run is missing: cmake --build {given.build} --target clearway clearway-run")
    results = {}
    for scenario, options in (SHORT if given.check else SCENARIOS).items():
        results[scenario] = compared(given.build.resolve(), options, 1 if given.check else ROUNDS)
        show(scenario, results[scenario])
        check(results[scenario])
    if given.publish:
        publish(results)


if __name__ == "__main__":
    main()
