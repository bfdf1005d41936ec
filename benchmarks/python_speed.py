"""What Python costs: a step of an environment against the C++ loop, a reset, two processes against one, and a policy at 2 Hz.

    PYTHONPATH=python /usr/bin/python3 benchmarks/python_speed.py [--seeds N] [--scenario city] [--what step reset processes policy bell]

Run it with programs of the release build, on an idle machine: walls and rates are worth nothing on a busy one; it prints the load. A
step of the C++ loop is that of the same condition: `timing.json` of its run (simulator and coupling), so nothing but what the
environment adds is in the difference. Times of the processor, of a process and of those that it waited for, suffer less from others.
"""
from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import clearway
import numpy as np

ANSWER = """
import os, sys
read, write = int(sys.argv[1]), int(sys.argv[2])
while os.read(read, 1):
    os.write(write, b"x")
"""


def bell(rounds: int = 20000) -> None:
    """Round trip of the bell between two Python processes: what a question costs before anything is said."""
    their_read, our_write = os.pipe()
    our_read, their_write = os.pipe()
    child = subprocess.Popen([sys.executable, "-c", ANSWER, str(their_read), str(their_write)], pass_fds=(their_read, their_write))
    os.close(their_read)
    os.close(their_write)
    times = []
    for _ in range(rounds):
        begin = time.perf_counter()
        os.write(our_write, b"x")
        os.read(our_read, 1)
        times.append(time.perf_counter() - begin)
    os.close(our_write)
    child.wait()
    os.close(our_read)
    print(f"bell: {1e6 * statistics.median(times):.1f} us there and back")


def episode(env: clearway.Env) -> tuple[int, float]:
    """Steps and wall time of an episode without actions, after its reset."""
    action = np.zeros(env.action_space.shape, dtype=np.int64)
    steps, done, begin = 0, False, time.perf_counter()
    while not done:
        _, _, terminated, truncated, _ = env.step(action)
        steps, done = steps + 1, terminated or truncated
    return steps, time.perf_counter() - begin


def timings(results: clearway.Results, scenario: str, condition: str) -> list[dict]:
    return [json.loads(file.read_text()) for file in sorted(results.folder.glob(f"runs/{scenario}/{condition}/*/timing.json"))]


def cpu_s(who: int) -> float:
    """Processor time of this process, or of its children that have ended and theirs."""
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def loop_s(scenario: str, seed: int) -> tuple[float, float]:
    """Wall time of all steps of a run of the C++ loop, and vehicles on the road at a time."""
    with tempfile.TemporaryDirectory() as folder:
        results = clearway.run(scenario, ["corridor"], seeds=seed + 1, out=Path(folder) / "runs", jobs=1)
        runs = results.runs.where(condition="corridor", replication=seed)
        timing = timings(results, scenario, "corridor")[seed]
        return timing["simulator_s"] + timing["coupling_s"], runs["vehicle_steps"][0] * 0.25 / runs["simulated_s"][0]


def step(scenario: str, seeds: int, rounds: int = 5) -> None:
    """Cost of the agent in an episode: its wall time from the first decision to the end against that of the steps of the same run,
    per decision. Both are the least of some rounds in turn, because others use the machine, too."""
    extra_us, vehicles, own_us = [], [], []
    for seed in range(seeds):
        walls, loops = [], []
        with clearway.env(scenario, policy="corridor", seeds=[seed], until="end") as env:
            for _ in range(rounds):
                env.reset()
                before = cpu_s(resource.RUSAGE_SELF)
                decisions, wall_s = episode(env)
                own_us.append(1e6 * (cpu_s(resource.RUSAGE_SELF) - before) / decisions)
                walls.append(wall_s)
                wall_s, count = loop_s(scenario, seed)
                loops.append(wall_s)
        extra_us.append(1e6 * (min(walls) - min(loops)) / decisions)
        vehicles.append(count)
    allowed = 10.0 + 0.02 * statistics.mean(vehicles)
    print(f"step: {statistics.median(extra_us):+.1f} us a decision against the C++ loop of the same condition "
          f"({statistics.mean(vehicles):.0f} vehicles: 10 us + 20 ns each are {allowed:.1f} us); "
          f"processor time of Python {min(own_us):.1f} us")


def reset(scenario: str) -> None:
    with clearway.env(scenario, seeds=[0]) as env:
        begin = time.perf_counter()
        env.reset()
        first = time.perf_counter() - begin
        times = []
        for _ in range(7):
            begin = time.perf_counter()
            env.reset()
            times.append(time.perf_counter() - begin)
    print(f"reset: first {first:.3f} s after loading, then {statistics.median(times):.3f} s")


def processes(scenario: str, seeds: int) -> None:
    """Steps a second of one and of two environments at a time: of one program, in step, and of two programs."""
    rates, own_us = [], []
    for count in (1, 2):
        with clearway.vector_env(scenario, count, seeds=range(count)) as envs:
            action = np.zeros(envs.action_space.shape, dtype=np.int64)
            envs.reset()
            begin, before, total = time.perf_counter(), cpu_s(resource.RUSAGE_SELF), 300 * seeds
            for _ in range(total):
                envs.step(action)
            rates.append(count * total / (time.perf_counter() - begin))
            own_us.append(1e6 * (cpu_s(resource.RUSAGE_SELF) - before) / total)
    print(f"processes: {rates[0]:.0f} steps/s alone, {rates[1]:.0f} with two in step: {rates[1] / rates[0]:.2f} times; "
          f"Python itself takes {own_us[0]:.0f} and {own_us[1]:.0f} us of a step")
    alone = sum(own_rates(scenario, [seed])[0] for seed in (0, 1)) / 2.0
    both = sum(own_rates(scenario, [0, 1]))
    print(f"processes: {alone:.0f} steps/s alone, {both:.0f} in two programs of their own: {both / alone:.2f} times")


OWN_PROGRAM = """
import sys, time, clearway, numpy as np
scenario, seed, begin_s, steps = sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), 3000
with clearway.env(scenario, seeds=[seed]) as env:
    action = np.zeros(env.action_space.shape, dtype=np.int64)
    env.reset()
    time.sleep(max(0.0, begin_s - time.time()))
    begin = time.perf_counter()
    for _ in range(steps):
        _, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            env.reset()
    print(steps / (time.perf_counter() - begin))
"""


def own_rates(scenario: str, seeds: list[int]) -> list[float]:
    """Steps a second of environments in Python programs of their own, which begin at the same time."""
    begin_s = time.time() + 3.0
    programs = [subprocess.Popen([sys.executable, "-c", OWN_PROGRAM, scenario, str(seed), str(begin_s)], stdout=subprocess.PIPE,
                                 text=True) for seed in seeds]
    return [float(program.communicate()[0]) for program in programs]


def policy(scenario: str, seeds: int, dense: bool) -> None:
    """A policy in Python that reads everything, at 2 Hz, against the same run without it."""
    source = ("import numpy as np\nclass Reads:\n    def act(self, belief):\n        v = belief.vehicles\n"
              "        near = v.is_automated & (v.speed_mps > 1.0)\n        belief.links.index\n"
              "        for ev in belief.emergency_vehicles:\n            ev.ahead(150.0), ev.approaches\n"
              "        return []\n")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "reads.py"
        file.write_text(source)
        conditions = {"baseline": [], "without": [clearway.Condition("without", policy="corridor")],
                      "with": [clearway.Condition("with", policy=["corridor", f"{file}:Reads"])]}
        costs, results = {}, {}
        for name, own in conditions.items():
            before = cpu_s(resource.RUSAGE_CHILDREN)
            results[name] = clearway.run(scenario, own, seeds=seeds, out=Path(folder) / name, jobs=1,
                                         **({"variant": "dense"} if dense else {}))
            costs[name] = cpu_s(resource.RUSAGE_CHILDREN) - before
        walls, hashes = {}, {}
        for name in ("without", "with"):
            walls[name] = [one["wall_s"] for one in timings(results[name], scenario, name)]
            hashes[name] = results[name].runs.where(condition=name)["trace_hash"].tolist()
    shares = [mine / plain - 1.0 for mine, plain in zip(walls["with"], walls["without"])]
    run_s = {name: costs[name] - costs["baseline"] for name in walls}
    print(f"policy: processor time of the runs {run_s['without']:.1f} s without, {run_s['with']:.1f} s with: "
          f"{100 * (run_s['with'] / run_s['without'] - 1.0):+.1f} %; wall time {100 * statistics.median(shares):+.1f} % "
          f"(start of Python included; {'same' if hashes['with'] == hashes['without'] else 'NOT the same'} traffic)")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--scenario", default="intersection", help="for all but the policy [intersection]")
    parser.add_argument("--policy-scenario", default="city", help="dense variant [city]")
    parser.add_argument("--what", nargs="+", default=["bell", "reset", "step", "processes", "policy"])
    arguments = parser.parse_args()
    calls = {"bell": bell, "reset": lambda: reset(arguments.scenario), "step": lambda: step(arguments.scenario, arguments.seeds),
             "processes": lambda: processes(arguments.scenario, arguments.seeds),
             "policy": lambda: policy(arguments.policy_scenario, arguments.seeds, True)}
    for name in arguments.what:
        calls[name]()
    print(f"load of the last minute: {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")


if __name__ == "__main__":
    main()
