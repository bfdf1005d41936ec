#!/usr/bin/env python3
"""What a search of a way costs (`navigate`), on square grids that netgenerate makes: 1,000 searches where times change on the way.

    benchmarks/route_search.py BUILD               prints the times
    benchmarks/route_search.py BUILD --publish     also writes them into results/cost.csv; then: scripts/render-docs

BUILD is the folder of a build with optimisation and benchmarks: cmake --preset release -B build/bench -DCLEARWAY_BENCHMARKS=ON. Of
three runs the fastest counts: the others measure the machine.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "scripts"))
import published_rows  # noqa: E402

SIDES = (60, 159)  # junctions of a grid: 14,160 and 100,488 edges
REPEATS = 3
PRINTED = re.compile(r"edges (\d+), first search to a destination at most ([\d.]+) ms, then median ([\d.]+) ms, "
                     r"99th percentile ([\d.]+) ms")
NAMES = ("first search to a destination, at most", "median", "99th percentile")


def times(program, side, folder):
    """Edges, and the times of NAMES, ms."""
    grid = folder / f"grid{side}.net.xml"
    subprocess.run(["netgenerate", "--grid", "--grid.number", str(side), "--grid.length", "100", "-o", grid], check=True,
                   capture_output=True)
    runs = []
    for _ in range(REPEATS):
        said = subprocess.run([program, grid], check=True, capture_output=True, text=True).stdout
        edges, *found = PRINTED.search(said).groups()
        runs.append([float(time_ms) for time_ms in found])
    return int(edges), min(runs, key=lambda run: run[-1])


def publish(table):
    made = published_rows.made(ROOT, "route_search", "benchmarks/route_search.py build/bench --publish")
    common = made | {"measure": "time_ms", "unit": "ms"}
    rows = [common | {"scenario": f"{edges:,} edges", "condition": name, "mean": f"{time_ms:.2f}"}
            for edges, found in table for name, time_ms in zip(NAMES, found)]
    published_rows.put_rows(ROOT / "results/cost.csv", rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", metavar="BUILD", type=pathlib.Path)
    parser.add_argument("--publish", action="store_true")
    given = parser.parse_args()
    program = given.build.resolve() / "benchmarks/route_search_times"
    with tempfile.TemporaryDirectory() as folder:
        table = [times(program, side, pathlib.Path(folder)) for side in SIDES]
    for edges, found in table:
        print(f"{edges:,} edges: " + ", ".join(f"{name} {time_ms:.2f} ms" for name, time_ms in zip(NAMES, found)))
    if given.publish:
        publish(table)


if __name__ == "__main__":
    main()
