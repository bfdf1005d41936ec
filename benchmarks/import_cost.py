#!/usr/bin/env python3
"""What an import costs: makes a map with about so many edges, imports it, and prints wall time, processor time, which
other load disturbs little, and the largest resident size of any process of it.

    benchmarks/import_cost.py 5000 100000 [--clearway ./clearway]

The map is a grid of streets, each crossing moved a little, with a signal at every fourth and names on all streets.
"""
import argparse
import math
import os
import random
import resource
import subprocess
import tempfile
import time


def write_map(path, edges):
    """A grid of n x n crossings has 4 n (n - 1) edges, both directions counted."""
    side = max(3, round(0.5 + math.sqrt(0.25 + edges / 4)))
    draw = random.Random(1)
    spacing = 0.0012
    with open(path, "w") as out:
        out.write("<osm version='0.6'>\n")
        for row in range(side):
            for column in range(side):
                latitude = 48.0 + spacing * (row + 0.3 * draw.random())
                longitude = 11.0 + 1.5 * spacing * (column + 0.3 * draw.random())
                signal = "<tag k='highway' v='traffic_signals'/>" if row % 4 == 2 and column % 4 == 2 else ""
                out.write(f"<node id='{1 + row * side + column}' version='1' lat='{latitude:.6f}' lon='{longitude:.6f}'>"
                          f"{signal}</node>\n")
        way = 10 ** 7
        for line in range(side):
            kind = "primary" if line % 8 == 0 else "secondary" if line % 4 == 2 else "residential"
            for nodes in ([1 + line * side + at for at in range(side)], [1 + at * side + line for at in range(side)]):
                way += 1
                references = "".join(f"<nd ref='{node}'/>" for node in nodes)
                out.write(f"<way id='{way}' version='1'>{references}<tag k='highway' v='{kind}'/>"
                          f"<tag k='name' v='Street {way}'/></way>\n")
        out.write("</osm>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("edges", type=int, nargs="+")
    parser.add_argument("--clearway", default="./clearway")
    options = parser.parse_args()
    program = os.path.abspath(options.clearway)
    for edges in options.edges:
        with tempfile.TemporaryDirectory() as folder:
            write_map(os.path.join(folder, "town.osm"), edges)
            started = time.monotonic()
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run([program, "scenario", "import", "town.osm", "--name", "town"], cwd=folder, check=True)
            wall_s = time.monotonic() - started
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            busy_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            print(f"{edges} edges: {wall_s:.1f} s, {busy_s:.1f} s of processor time, "
                  f"at most {after.ru_maxrss / 1024:.0f} MiB in one process", flush=True)


if __name__ == "__main__":
    main()
