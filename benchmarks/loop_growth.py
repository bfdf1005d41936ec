#!/usr/bin/env python3
"""How the loop's cost grows with the traffic: square grids of ever more streets, as full and with as many emergency vehicles a vehicle.

    benchmarks/loop_growth.py BUILD [--vehicles 1000 3000 10000 30000] [--publish]

BUILD is the folder of the preset `release`. For each number it draws a grid with signals by netgenerate, lets all depart in a minute and
runs the baseline and `corridor` under B10 with graphsage, one after the other, for half a minute of full traffic. It prints, for a
vehicle and step, the time of SUMO's step and of each phase beside it, which is level where no part grows faster than its input, and the
processor time of loading, routes and demand. --publish writes the times into results/cost.csv; then: scripts/render-docs
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE), str(HERE.parent / "scripts")]
import loop_time  # noqa: E402
import published_rows  # noqa: E402

VEHICLES = (1000, 3000, 10000, 30000)
VEHICLES_AN_EDGE = 2.5
VEHICLES_AN_EMERGENCY_VEHICLE = 500
AUTOMATED_SHARE = 0.35
CONDITIONS = ("baseline", "corridor under B10 with graphsage")
PUBLISHED = {"SUMO's step, us": "sumo_us", "reading, us": "reading_us", "all beside SUMO's step, us": "beside_us",
             "loading, routes and demand, ms a vehicle": "loading_ms"}
SCENARIO = """name = "grid"
version = "v1"
title = "Grid for {vehicles} vehicles"
[network]
file = "grid.net.xml"
[time]
warm_up_s = 50.0
window_s = 60.0
horizon_s = 90.0
ignore_junction_blocker_s = 10.0
[demand]
human = {human}
automated = {automated}
emergency = {emergency}
[trips]
minimum_length_m = 1500.0
emergency_minimum_length_m = 1500.0
"""


def draw(vehicles, folder):
    side = round((1.0 + (1.0 + vehicles / VEHICLES_AN_EDGE) ** 0.5) / 2.0)  # 4 side (side - 1) edges
    folder.mkdir()
    subprocess.run(["netgenerate", "--grid", "--grid.number", str(side), "--grid.length", "200", "-L", "2", "--tls.guess", "true",
                    "--no-turnarounds", "true", "-o", folder / "grid.net.xml"], check=True, capture_output=True)
    automated = round(AUTOMATED_SHARE * vehicles)
    (folder / "scenario.toml").write_text(SCENARIO.format(
        vehicles=vehicles, human=vehicles - automated, automated=automated,
        emergency=max(2, vehicles // VEHICLES_AN_EMERGENCY_VEHICLE)), encoding="utf-8")


def costs(program, vehicles, place):
    """Rows of what is printed: a name and a number for each of CONDITIONS."""
    folder = place / f"grid{vehicles}"
    draw(vehicles, folder)
    found, _, shared_s = loop_time.measure(program, str(folder), ["corridor"], 1, [])
    runs = [found[name][0][0] for name in ("baseline", list(found)[-1])]

    def of_each(value):
        return [1e6 * value(timing) / timing["vehicle_steps"] for timing in runs]

    rows = [("vehicles on the road", [timing["vehicle_steps"] / timing["steps"] for timing in runs]),
            ("SUMO's step, us", of_each(lambda timing: timing["simulator_s"]))]
    rows += [(f"{phase}, us", of_each(lambda timing, phase=phase: timing["phases"][f"{phase}_s"])) for phase in loop_time.PHASES]
    rows.append(("all beside SUMO's step, us", of_each(lambda timing: timing["coupling_s"])))
    return rows + [("loading, routes and demand, ms a vehicle", [1e3 * shared_s / vehicles] * len(runs))]


def publish(table):
    made = published_rows.made(HERE.parent, "growth", "benchmarks/loop_growth.py build/release --publish")
    rows = [made | {"scenario": f"{vehicles:,}", "condition": condition, "measure": PUBLISHED[name], "mean": f"{number:.2f}"}
            for vehicles, found in table for name, numbers in found if name in PUBLISHED
            for condition, number in zip(CONDITIONS, numbers)]
    published_rows.put_rows(HERE.parent / "results/cost.csv", rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", metavar="BUILD", type=pathlib.Path)
    parser.add_argument("--vehicles", type=int, nargs="+", default=VEHICLES)
    parser.add_argument("--publish", action="store_true")
    given = parser.parse_args()
    table = []
    with tempfile.TemporaryDirectory(prefix="clearway-loop-growth-") as place:
        for vehicles in given.vehicles:
            table.append((vehicles, costs(given.build.resolve() / "bin/clearway", vehicles, pathlib.Path(place))))
            print(f"{vehicles} vehicles; {'; '.join(CONDITIONS)}")
            for name, numbers in table[-1][1]:
                print(f"  {name:42}" + "".join(f"{number:10.2f}" for number in numbers), flush=True)
    if given.publish:
        publish(table)


if __name__ == "__main__":
    main()
