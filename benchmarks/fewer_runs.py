#!/usr/bin/env python3
"""Intervals of 10 pairs with 40 runs of the baseline against those of 20 and 30 pairs, and what pairing alone is worth.

    clearway study studies/fewer_runs.toml
    benchmarks/fewer_runs.py BUILD runs/fewer_runs               prints the figures
    benchmarks/fewer_runs.py BUILD runs/fewer_runs --publish     also writes them into results/cost.csv; then: scripts/render-docs

BUILD is the folder of a build with benchmarks: cmake --preset release -B build/bench -DCLEARWAY_BENCHMARKS=ON.
"""
import argparse
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "scripts"))
import published_rows  # noqa: E402

MEASURES = (("unpaired_runs", "runs"), ("explained_by_baseline_pct", "%"), ("explained_by_trips_pct", "%"),
            ("half_width_20_s", "s"), ("coverage_20_pct", "%"), ("half_width_30_s", "s"), ("coverage_30_pct", "%"),
            ("half_width_adjusted_s", "s"), ("coverage_adjusted_pct", "%"))


def gains(program, folder):
    """Scenario, pairs, and the figures of MEASURES."""
    said = subprocess.run([program, folder], check=True, capture_output=True, text=True).stdout
    return [line.split() for line in said.splitlines()]


def publish(table):
    made = published_rows.made(ROOT, "fewer_runs", "benchmarks/fewer_runs.py build/bench runs/fewer_runs --publish")
    rows = [made | {"scenario": scenario, "seed": "7591", "pairs": pairs, "condition": "corridor", "measure": measure, "unit": unit,
                    "mean": mean}
            for scenario, pairs, *means in table for (measure, unit), mean in zip(MEASURES, means)]
    published_rows.put_rows(ROOT / "results/cost.csv", rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", metavar="BUILD", type=pathlib.Path)
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path)
    parser.add_argument("--publish", action="store_true")
    given = parser.parse_args()
    table = gains(given.build.resolve() / "benchmarks/fewer_runs_gain", given.folder)
    for scenario, pairs, *means in table:
        print(f"{scenario}, {pairs} pairs: " + ", ".join(f"{name} {mean} {unit}".strip() for (name, unit), mean in zip(MEASURES, means)))
    if given.publish:
        publish(table)


if __name__ == "__main__":
    main()
