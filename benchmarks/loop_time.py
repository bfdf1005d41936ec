#!/usr/bin/env python3
"""Where the time of a run goes, on any scenario: each phase of the loop as a ratio to SUMO's step in the same run.

    benchmarks/loop_time.py SCENARIO [--policy NAME ...] [--rounds 10] [--bin build/release/bin] [options of clearway run]

Runs the baseline, the policies with perfect sensors, and the same under B10 with graphsage: one after another for each seed, so that
other load meets all of them. A ratio is the median of the rounds, so those of the phases add up to `all` only nearly. Vehicles and
speed are those of the part after the shared warm-up. The last lines say what an interval of +-1 s of the difference in EV travel time
needs: the pairs by FHWA's rule (docs/reference/study-file.md) from the spread of these, at least ten, and the processor time of their
workers: both runs, loading and warm-up. On a busy machine ratios suffer little, speed and milliseconds much.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import tomllib

PHASES = ("reading", "sensing", "prediction", "policy", "actuation", "recording")
FEWEST = 10
HALF_WIDTH_S = 1.0


def run(command):
    """What it prints, and the processor time of the workers that it waited for, s."""
    with tempfile.TemporaryFile("w+", encoding="utf-8") as said, tempfile.TemporaryFile("w+", encoding="utf-8") as errors:
        child = subprocess.Popen(command, stdout=said, stderr=errors)
        os.waitid(os.P_PID, child.pid, os.WEXITED | os.WNOWAIT)
        fields = pathlib.Path(f"/proc/{child.pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()
        workers_s = sum(map(int, fields[13:15])) / os.sysconf("SC_CLK_TCK")
        child.wait()
        if child.returncode != 0:
            errors.seek(0)
            sys.exit(errors.read())
        said.seek(0)
        return said.read(), workers_s


def pairs_needed(deviation_s):
    """The least n with n >= (t(n - 1) s / e)^2; t by the expansion of Cornish and Fisher, which is exact to 0.001 from n = 10."""
    z = statistics.NormalDist().inv_cdf(0.975)

    def quantile(freedom):
        return (z + (z**3 + z) / (4 * freedom) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * freedom**2)
                + (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / (384 * freedom**3))

    pairs = FEWEST
    while pairs < (quantile(pairs - 1) * deviation_s / HALF_WIDTH_S)**2:
        pairs += 1
    return pairs


def measure(program, scenario, policies, rounds, others):
    """By condition: its timings, and the deviation of the differences from the baseline, s. Then the step length and the processor
    time of loading and warm-up for a seed, both s."""
    with tempfile.TemporaryDirectory(prefix="clearway-loop-time-") as folder:
        out = pathlib.Path(folder) / "run"
        command = [program, "run", scenario, "--failure", "B10", "--predictor", "graphsage", "--no-solo", "--seeds", str(rounds),
                   "--jobs", "1", "--out", out, "--json", *others]
        for policy in policies:
            command += ["--policy", policy]
        said, workers_s = run(command)
        [described] = json.loads(said)["scenarios"]
        found = {}
        for condition in described["conditions"]:
            files = sorted(out.glob(f"runs/*/{condition['name']}/*/timing.json"))
            found[condition["name"]] = ([json.loads(file.read_text(encoding="utf-8")) for file in files],
                                        condition.get("precision", {}))
        [configuration] = out.glob("scenarios/*/scenario.toml")
        step_s = tomllib.loads(configuration.read_text(encoding="utf-8"))["time"]["step_length_s"]
        in_runs_s = sum(timing["processor_s"] for timings, _ in found.values() for timing in timings)
        return found, step_s, max(0.0, workers_s - in_runs_s) / rounds


def ratios(timing):
    """Each phase, and all, over SUMO's step."""
    found = {phase: timing["phases"][f"{phase}_s"] / timing["simulator_s"] for phase in PHASES}
    return found | {"all": timing["coupling_s"] / timing["simulator_s"]}


def rows_of(found, step_s, shared_s):
    """What is printed: a name and a number for each condition, or nothing."""
    runs = [timings for timings, _ in found.values()]

    def medians(name, value):
        return name, [statistics.median(map(value, timings)) for timings in runs]

    rows = [medians("SUMO's step, ms", lambda timing: 1e3 * timing["simulator_s"] / timing["steps"])]
    for part in (*PHASES, "all"):
        rows.append(medians(f"{part} / SUMO's step", lambda timing, part=part: ratios(timing)[part]))
    rows.append(medians("vehicles on the road", lambda timing: timing["vehicle_steps"] / timing["steps"]))
    rows.append(medians("times real time", lambda timing: timing["steps"] * step_s / (timing["simulator_s"] + timing["coupling_s"])))
    pairs = [pairs_needed(precision["deviation_s"]) if precision else None for _, precision in found.values()]
    processor_s = [statistics.mean(timing["processor_s"] for timing in timings) for timings in runs]
    rows.append(("pairs for +-1 s", pairs))
    rows.append(("processor time for them, s", [
        None if count is None else count * (shared_s + processor_s[0] + own_s) for count, own_s in zip(pairs, processor_s)]))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenario", help="name or folder")
    parser.add_argument("--policy", action="append", help="[corridor]")
    parser.add_argument("--rounds", type=int, default=FEWEST)
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"), help="folder of the programs")
    given, others = parser.parse_known_args()
    found, step_s, shared_s = measure(given.bin / "clearway", given.scenario, given.policy or ["corridor"], given.rounds, others)
    print(f"{'':28}" + "".join(f"  {name:>22}" for name in found))
    for name, numbers in rows_of(found, step_s, shared_s):
        print(f"{name:28}" + "".join(f"  {'-' if number is None else f'{number:.3g}':>22}" for number in numbers))


if __name__ == "__main__":
    main()
