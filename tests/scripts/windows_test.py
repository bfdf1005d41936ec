"""Tests of scripts/windows: what a window of a grid keeps, calculated by hand, and a window of Bologna that covers everything."""
import csv
import importlib.machinery
import importlib.util
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
LOADER = importlib.machinery.SourceFileLoader("windows", str(ROOT / "scripts/windows"))
windows = importlib.util.module_from_spec(importlib.util.spec_from_loader("windows", LOADER))
sys.modules["windows"] = windows
LOADER.exec_module(windows)


ROUTES = """<routes>
    <vehicle id="through" type="car" depart="5.00" departPos="3" arrivalPos="7">
        <route edges="A0B0 B0B1 B1B2 B2C2 C2C1 C1C0" exitTimes="10.00 17.25 30.00 40.50 50.00 60.00"/>
        <stop lane="B1B2_0" duration="5"/>
        <stop lane="B2C2_0" duration="5"/>
    </vehicle>
    <vehicle id="within" type="car" depart="1.00" departPos="3">
        <route edges="A1B1 B1B0 B0A0" exitTimes="9.00 20.00 30.00"/>
    </vehicle>
    <vehicle id="turns" type="car" depart="4.00"><route edges="A1A0 A0A1" exitTimes="20.00 44.00"/></vehicle>
    <vehicle id="elsewhere" type="car" depart="2.00"><route edges="A0B0 B0C0" exitTimes="9.00 20.00"/></vehicle>
    <vehicle id="not_yet" type="car" depart="3.00"><route edges="A0B0 B0B1" exitTimes="-1.00 -1.00"/></vehicle>
</routes>"""


class Grid(unittest.TestCase):
    """Three by three junctions, 200 m apart, A0 to C2. The EV drives along the middle row."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.file = self.folder / "grid.net.xml"
        subprocess.run(["netgenerate", "--grid", "--grid.number", "3", "--grid.length", "200", "--tls.set", "B1,B2",
                        "--no-turnarounds", "-o", self.file], check=True, capture_output=True)
        self.network = windows.Network(self.file)
        self.window = windows.Window.around(self.network, ["A1B1", "B1C1"], 50.0)
        (self.folder / "routes.xml").write_text(ROUTES)

    def cut(self):
        vehicles = ElementTree.fromstring(ROUTES).findall("vehicle")
        return windows.cut_routes(vehicles, windows.recorded_ways(self.folder / "routes.xml"), {}, self.window, self.network)

    def test_junctions_within_the_margin_keep_all_their_roads_and_signals(self):
        self.assertEqual(self.window.inner, {"A1", "B1", "C1"})
        self.assertEqual(len(self.window.roads), 16)
        self.assertEqual(self.window.signals, {"B1"})
        wide = windows.Window.around(self.network, ["A1B1"], 205.0)  # the lane ends at the junction: C1 is 210 m from it
        self.assertEqual(wide.inner, {"A0", "A1", "A2", "B0", "B1", "B2"})

    def test_sumo_drives_the_window_with_the_signals_of_the_original(self):
        windows.write(self.window.network(self.network), self.folder / "window.net.xml")
        windows.write(self.cut(), self.folder / "cut.xml")
        (self.folder / "types.xml").write_text('<additional><vType id="car"/></additional>')
        subprocess.run(["sumo", "-n", self.folder / "window.net.xml", "-r", self.folder / "cut.xml", "-a",
                        self.folder / "types.xml", "--tripinfo-output", self.folder / "trips.xml"], check=True, capture_output=True)
        self.assertEqual(len(ElementTree.parse(self.folder / "trips.xml").getroot()), 5)
        for row in self.network.root.iter("tlLogic"):
            window = windows.parse(self.folder / "window.net.xml")
            cut = [other for other in window.iter("tlLogic") if other.get("id") == row.get("id")]
            expected = [ElementTree.tostring(row).strip()] if row.get("id") == "B1" else []
            self.assertEqual([ElementTree.tostring(other).strip() for other in cut], expected)

    def test_vehicles_enter_when_they_came_there(self):
        found = {row.get("id"): row for row in self.cut()}
        self.assertEqual({name: (row.get("depart"), row.find("route").get("edges")) for name, row in found.items()},
                         {"within": ("1.00", "A1B1 B1B0"), "turns": ("4.00", "A1A0"), "turns@1": ("20.00", "A0A1"),
                          "through": ("10.00", "B0B1 B1B2"), "through@1": ("40.50", "C2C1 C1C0")})
        self.assertEqual([row.get("id") for row in self.cut()], ["within", "turns", "through", "turns@1", "through@1"])
        self.assertEqual((found["within"].get("departPos"), found["within"].get("departLane")), ("3", None))
        self.assertEqual((found["through"].get("departPos"), found["through"].get("departLane")), (None, "best"))
        self.assertEqual((found["through"].get("arrivalPos"), found["through@1"].get("arrivalPos")), (None, "7"))
        self.assertEqual([stop.get("lane") for row in found.values() for stop in row.iter("stop")], ["B1B2_0"])

    def test_an_interval_needs_two_values(self):
        self.assertEqual(repr(windows.interval([3.0])), "(3.0, nan, nan)")
        mean, low, high = windows.interval([1.0, 2.0, 3.0])
        self.assertEqual(mean, 2.0)
        self.assertAlmostEqual(high - mean, mean - low)
        self.assertEqual(repr(windows.interval([])), "(nan, nan, nan)")

    def test_roads_that_lead_out_have_the_mean_speed_of_the_background(self):
        signs = {row.get("id"): row for row in
                 windows.exit_speeds([(0.0, {"B1B2": 3.0, "A1B1": 2.0}), (60.0, {"B1B2": 0.1})], self.window, self.network)}
        self.assertEqual(set(signs), {f"exit.{column}1{column}{row}" for column in "ABC" for row in "02"})
        self.assertEqual([(step.get("time"), step.get("speed")) for step in signs["exit.B1B2"]], [("0", "3.00"), ("60", "0.50")])
        self.assertEqual({step.get("speed") for step in signs["exit.A1A0"]}, {"13.89"})


class Whole(unittest.TestCase):
    def test_a_window_that_covers_the_network_has_the_same_runs(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            scenario = windows.Scenario("bologna_v2", folder)
            scenario.leave_s, scenario.end_s = 60.0, 330.0
            way = scenario.draw_ways(1)[0]
            scenario.write("whole", way)
            window = windows.Window.around(scenario.network, way, 1e6)
            vehicles = scenario.write_window("window", way, window, {}, [])
            self.assertGreater(vehicles, 500)
            tables = []
            for case in ("whole", "window"):
                _, runs = scenario.study(case, 1)
                with open(runs / "vehicles.csv", encoding="utf-8", newline="") as file:
                    tables.append([row | {"scenario": ""} for row in csv.DictReader(file)])
            self.assertEqual(tables[0], tables[1])
            self.assertIn("arrived", {row["outcome"] for row in tables[0] if row["class"] == "emergency"})


if __name__ == "__main__":
    unittest.main()
