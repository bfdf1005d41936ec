"""Policies and predictors in Python equal the same parts in C++, and have settings and sources."""
import json
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import clearway
from support import FolderCase, PROGRAMS, SOURCE, may_trace, program

# preempt_signals without its count of halted vehicles, as src/policy/preempt_signals.cpp has it.
PREEMPT = """
from clearway import Lease
class Preempt:
    def __init__(self):
        self.asked = set()
    def act(self, belief):
        asked, leases = set(), []
        for ev in belief.emergency_vehicles:
            speed = max(ev.speed_mps, 0.5 * ev.allowed_speed_mps, 0.1)
            for approach in ev.approaches:
                wanted = (ev.key, approach.signal)
                if approach.distance_m / speed > 8.0 and wanted not in self.asked:
                    continue
                asked.add(wanted)
                leases.append(Lease.hold_green(approach.signal, approach.links, approach.own_links, serves=ev,
                                               lasting_s=2 * self.period_s, reason="an emergency vehicle arrives"))
        self.asked = asked
        return leases
"""

# Once, an edge in the middle of the way is left out; the rest is the shortest.
DETOUR = """
import heapq
import numpy as np
from clearway import Lease
class Detour:
    def __init__(self):
        self.asked = set()
    def way(self, start, end, closed):
        net, best, before, queue = self.network, {start: 0.0}, {}, [(0.0, start)]
        while queue:
            now, edge = heapq.heappop(queue)
            if edge == end:
                way = [edge]
                while way[-1] in before:
                    way.append(before[way[-1]])
                return way[::-1]
            for other in net.onward[edge]:
                then = now + net.edge_free_s[other]
                if other != closed and then < best.get(other, 1e9):
                    best[other], before[other] = then, edge
                    heapq.heappush(queue, (then, other))
    def act(self, belief):
        self.network, leases = belief.network, []
        assert belief.incidents == {}
        times_s, net = belief.edge_times_s, belief.network
        assert len(times_s) == len(net.edge_ids) and np.isinf(times_s[net.edge_is_internal]).all()
        assert all(net.edge_free_s[edge] - 1e-3 <= times_s[edge] < np.inf for ev in belief.emergency_vehicles for edge in ev.route)
        for ev in belief.emergency_vehicles:
            route = ev.route.tolist()
            assert all(there in belief.network.onward[here] for here, there in zip(route, route[1:]))
            if ev.key in self.asked or len(route) < 6:
                continue
            self.asked.add(ev.key)
            way = self.way(route[0], route[-1], route[len(route) // 2])
            if way:
                leases.append(Lease.take_route(ev, way, serves=ev, lasting_s=20, reason="a detour"))
        return leases
"""

#: Beginnings of columns about messages with signals, which a part in C++ sends besides its leases.
BY_MESSAGE = ("signal_request", "signal_answers", "signal_told", "signal_granted")
#: Members of a result of `links evaluate` that differ although two predictors do the same.
UNLIKE = {"predictor", "us_per_report"}


class EqualPartsTest(FolderCase):
    def test_a_policy_in_python_is_the_same_run_as_in_cpp(self) -> None:
        self.write("mine.py", PREEMPT)
        results = clearway.run("intersection", [
            clearway.Condition("cpp", policy="preempt_signals", set={"preempt_signals.lead_per_halted_s": 0}),
            clearway.Condition("python", policy="mine.py:Preempt")], seeds=1, out="runs")
        self.assertEqual(results.errors.row_count, 0)
        left, right = (results.runs.where(condition=name) for name in ("cpp", "python"))
        for column in left:
            # The part in C++ tells signals of itself from afar; a policy in Python asks by its leases alone.
            if column not in ("condition", "trace_hash") and not column.startswith(BY_MESSAGE):
                self.assertEqual(str(left[column][0]), str(right[column][0]), column)
        leases = results.leases.where(condition="python")
        self.assertEqual(set(leases["policy"]), {"Preempt"})
        self.assertGreater(right["leases_issued"][0], 0)

    def test_a_policy_in_python_chooses_the_way(self) -> None:
        self.write("mine.py", DETOUR)
        results = clearway.run("city", [clearway.Condition("detour", policy="mine.py:Detour")], seeds=1, out="runs")
        self.assertEqual(results.errors.row_count, 0)
        ways = results.leases.where(condition="detour", action="take_route")
        self.assertGreater(ways.where(outcome="acted")["leases"].sum(), 0)
        self.assertEqual(set(ways["reason"]) & {"route_gap", "route_elsewhere", "no_such_edge"}, set())

    def test_a_predictor_in_python_is_the_same_run_as_in_cpp(self) -> None:
        mine = f"{SOURCE / 'examples/python/distance_predictor.py'}:ByDistance"
        results = clearway.run("intersection", [
            clearway.Condition("cpp", policy="corridor", failure="B10", predictor="dead_reckoning"),
            clearway.Condition("python", policy="corridor", failure="B10", predictor=mine)], seeds=1, out="runs")
        self.assertEqual(results.errors.row_count, 0)
        left, right = (results.runs.where(condition=name) for name in ("cpp", "python"))
        for column in ("emergency_travel_time_s", "others_time_loss_s", "links_true_positive", "links_false_positive",
                       "dark_links_true_positive", "dark_links_false_negative", "trace_hash"):
            self.assertEqual(left[column][0], right[column][0], column)
        self.assertGreater(right["dark_links_true_positive"][0], 0)

    def test_the_manifest_has_the_hash_and_a_changed_file_is_another_study(self) -> None:
        file = self.write("mine.py", PREEMPT)
        arguments = ["run", "intersection", "--policy", "mine.py:Preempt", "--seeds", "1", "--no-solo", "--out", "runs"]
        program(*arguments)
        manifest = Path("runs/manifest.json").read_text()
        self.assertRegex(manifest, f"{file}:Preempt@[0-9a-f]{{32}}")
        self.assertTrue(Path("runs/runs/intersection/Preempt").is_dir())
        file.write_text(PREEMPT + "# changed\n")
        program(*arguments, code=3)

    def test_a_folder_that_is_moved_continues_its_studies(self) -> None:
        def run_both() -> dict[Path, int]:
            """Times of all records after two studies, one of the command line and one of Python."""
            program("run", "intersection", "--policy", "mine.py:Preempt", "--seeds", "1", "--no-solo")
            clearway.run("intersection", [clearway.Condition("own", policy="mine.py:Preempt")], seeds=1)
            return {file: file.stat().st_mtime_ns for file in Path("runs").glob("*/runs/*/*/*/run.json")}
        Path("first").mkdir()
        self.write("first/mine.py", PREEMPT)
        os.chdir("first")
        before = run_both()
        self.assertEqual(len(before), 4)
        os.chdir(self.folder)
        Path("first").rename("second")
        os.chdir("second")
        self.assertEqual(run_both(), before, "no run is made again, nor another folder")
        for manifest in Path("runs").glob("*/manifest.json"):
            self.assertIn("/second/mine.py:Preempt@", manifest.read_text(), "where it is now, for what repeats the runs")
        folder = next(manifest.parent for manifest in Path("runs").glob("intersection-*/manifest.json"))
        program("verify", str(folder), "--sample", "1", "--trust-code")

    def test_an_edited_class_gets_a_new_folder_named_as_on_the_command_line(self) -> None:
        self.write("mine.py", PREEMPT)
        before = clearway.run("intersection", [clearway.Condition("own", policy="mine.py:Preempt")], seeds=1)
        self.write("mine.py", PREEMPT.replace("> 8.0", "> 9.0"))
        after = clearway.run("intersection", [clearway.Condition("own", policy="mine.py:Preempt")], seeds=1)
        self.assertNotEqual(before.folder, after.folder)
        program("run", "intersection", "--policy", "mine.py:Preempt", "--name", "own", "--seeds", "1", "--no-solo")
        self.assertEqual(set(Path("runs").glob("intersection-*")), {before.folder, after.folder})
        said = self.message_of(clearway.InputError, lambda: clearway.run(
            "intersection", [clearway.Condition("own", policy="mine.py:Preempt")], seeds=1, out=before.folder))
        self.assertIn("own: mine.py has changed", said)
        self.assertIn("Choose another folder with out=, or", said)
        self.assertIn("`clearway study FILE --out NEW --reuse", said)

    def test_runs_are_verified_where_folder_and_code_were_copied_to(self) -> None:
        Path("theirs").mkdir()
        self.write("theirs/helper.py", "LEAST_S = 8.0\n")
        self.write("theirs/mine.py", "from helper import LEAST_S\n" + PREEMPT.replace("> 8.0", "> LEAST_S"))
        os.chdir("theirs")
        program("run", "intersection", "--policy", "mine.py:Preempt", "--seeds", "1", "--no-solo", "--record", "--out", "out")
        os.chdir(self.folder)
        Path("theirs").rename("ours")
        for folder, here in (("ours/out", "."), ("out", "ours")):  # beside the run folder, by either name
            os.chdir(self.folder / here)
            program("verify", f"{folder}/intersection/Preempt/0", "--trust-code")
            program("replay", f"{folder}/intersection/Preempt/0", "--trust-code")
        os.chdir(self.folder)
        Path("runs").mkdir()
        Path("ours/out").rename("runs/out")
        program("verify", "runs/out/intersection/Preempt/0", "--trust-code")  # by the folder's own copy
        shutil.rmtree("runs/out/code")
        words = [str(PROGRAMS / "clearway"), "verify", "runs/out/intersection/Preempt/0", "--trust-code"]
        missing = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual(missing.returncode, 3)
        for said in ("condition Preempt: policy: mine.py is in none of", str(self.folder / "theirs"), str(self.folder / "runs"),
                     "content hash", "Copy", "beside the run folder, or into the current folder"):
            self.assertIn(said, missing.stderr)
        os.chdir("ours")  # the current folder
        program("verify", "../runs/out/intersection/Preempt/0", "--trust-code")
        self.write("ours/helper.py", "LEAST_S = 9.0\n")
        words[2] = "../runs/out/intersection/Preempt/0"
        changed = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual(changed.returncode, 3)
        self.assertIn(f"{self.folder / 'ours/mine.py'} is not the file of the run: it, or a file that it imports, was changed", changed.stderr)

    def test_code_that_a_folder_names_runs_only_where_it_is_trusted(self) -> None:
        self.write("mine.py", PREEMPT + "\nopen(__file__ + '.ran', 'a').close()\n")
        program("run", "intersection", "--policy", "mine.py:Preempt", "--seeds", "1", "--no-solo", "--record", "--out", "out")
        own = Path("mine.py.ran")
        for words in (["verify", "out/intersection/Preempt/0"], ["verify", "out", "--all"], ["replay", "out/intersection/Preempt/0"],
                      ["report", "out", "--replays"]):
            own.unlink(missing_ok=True)
            ended = subprocess.run([str(PROGRAMS / "clearway"), *words], capture_output=True, text=True, check=False)
            self.assertEqual(ended.returncode, 3, ended.stderr)
            for said in ("condition Preempt", str(self.folder / "mine.py"), "your rights", "--trust-code"):
                self.assertIn(said, ended.stderr)
            self.assertFalse(own.exists(), words)
            program(*words, "--trust-code")
        program("verify", "out/intersection/baseline/0")
        program("replay", "out/intersection/Preempt/0", "--policy", "mine.py:Preempt")
        program("report", "out")

    def test_code_of_several_conditions_is_named_once_with_their_titles(self) -> None:
        self.write("mine.py", PREEMPT)
        clearway.run("intersection", [clearway.Condition(name, title=title, policy="mine.py:Preempt", failure=failure) for name, title, failure
                                      in (("one", "Ours", "perfect"), ("two", "Ours, outages", "B10"))], seeds=1, out="out")
        ended = subprocess.run([str(PROGRAMS / "clearway"), "verify", "out", "--all"], capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 3, ended.stderr)
        self.assertIn("out: condition Ours; Ours, outages: names code in Python", ended.stderr)
        self.assertEqual(ended.stderr.count("your rights"), 1)


class ObservationTest(unittest.TestCase):
    def test_each_name_is_listed_once_also_when_it_was_read(self) -> None:
        observation = object.__new__(clearway.Observation)
        observation.__dict__["pair_dead_reckoned_m"] = None
        self.assertEqual(dir(observation).count("pair_dead_reckoned_m"), 1)


SLOW = """
from clearway import Lease
class Slow:
    def __init__(self, share: float = 1.0, within_m: float = 200.0, most: int = 100, on: bool = True, reason: str = "slow", other=None,
                 leads=[1, 2]):
        self.share, self.within_m, self.most, self.on, self.reason = share, within_m, most, on, reason
        assert (type(share), type(within_m), type(most), type(on), type(reason)) == (float, float, int, bool, str)
    def act(self, belief):
        rows = [row for ev in belief.emergency_vehicles for row in ev.ahead(self.within_m) if belief.vehicles.is_automated[row]]
        return [Lease.drive_at(belief.vehicles.key[row], 13.9 * self.share, reason=self.reason) for row in rows[:self.most] if self.on]
class Near:
    def __init__(self, scale=1.0):
        self.scale = scale
    def predict(self, observation):
        return observation.pair_dead_reckoned_m < self.scale * observation.link_radius_m
"""


class SettingsTest(FolderCase):
    """Arguments of a class that have defaults are settings, as those of parts in C++."""

    def setUp(self) -> None:
        super().setUp()
        self.write("slow.py", SLOW)

    def test_they_change_what_is_done_and_stand_in_the_manifest(self) -> None:
        changed = {"Slow.share": 0.2, "Slow.within_m": 150, "Slow.most": 3, "Slow.reason": "slower", "Near.scale": 0.1,
                   "Near.link_threshold": 0.4}
        parts = {"policy": "slow.py:Slow", "failure": "B10", "predictor": "slow.py:Near"}
        results = clearway.run("intersection", [
            clearway.Condition("usual", **parts), clearway.Condition("changed", **parts, set=changed),
            clearway.Condition("off", **parts, set={"Slow.on": False})], seeds=1, out="runs", variant="dense")
        self.assertEqual(results.errors.row_count, 0)
        leases = {name: results.leases.where(condition=name)["leases"].sum() for name in ("usual", "changed", "off")}
        self.assertGreater(leases["usual"], leases["changed"])
        self.assertGreater(leases["changed"], 0)
        self.assertEqual(leases["off"], 0)
        found = {name: results.runs.where(condition=name)["dark_links_true_positive"][0] for name in ("usual", "changed")}
        self.assertGreater(found["usual"], found["changed"])
        (spec,) = (one for one in json.loads(Path("runs/manifest.json").read_text())["conditions"] if one["name"] == "changed")
        self.assertEqual(spec["settings"], {name: str(value) for name, value in changed.items()})

    def test_they_are_factors_of_a_study(self) -> None:
        self.write("study.toml", 'replications = 1\nscenarios = ["intersection"]\nconditions = ["baseline"]\n[[condition]]\n'
                   'name = "mine"\npolicy = "slow.py:Slow"\nset = { "Slow.within_m" = 100 }\n[factors]\nSlow.share = [0.2, 0.6]\n'
                   '"Slow.most" = [1, 2]\n')
        said = program("study", "study.toml", "--dry-run", "--out", "runs")
        for share in ("0.2", "0.6"):
            for most in ("1", "2"):
                self.assertIn(f"mine, most {most}, share {share}", said)

    def test_what_does_not_fit_is_told_before_anything_runs(self) -> None:
        for setting, says in (("Slow.shares=1", "Slow.shares is unknown (allowed: arguments of __init__ that have a default: share=1.0"),
                              ("Slow.shar=1", "Did you mean 'share'?"),
                              ("Slow.other=1", "Slow.other cannot be set: its default is None (allowed: arguments of __init__ whose default"),
                              ("Slow.leads=1", "Slow.leads cannot be set: its default is [1, 2] (allowed: "),
                              ("Slow.share=fast", "Slow.share is 'fast' (allowed: a finite number"),
                              ("Slow.share=nan", "Slow.share is 'nan' (allowed: a finite number"),
                              ("Slow.within_m=-inf", "Slow.within_m is '-inf' (allowed: a finite number"),
                              ("Slow.most=1.5", "Slow.most is '1.5' (allowed: a whole number"), ("Slow.on=1", "allowed: true, false"),
                              ("Fast.share=1", ", Slow). Did you mean 'Slow.share'?")):
            ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", "slow.py:Slow", "--set", setting,
                                    "--out", "runs"], capture_output=True, text=True, check=False)
            self.assertEqual(ended.returncode, 3, setting)
            self.assertIn(says, ended.stderr)
            self.assertNotIn("Traceback", ended.stderr)
            self.assertFalse(Path("runs").exists())
        for predictor, setting, says in (("slow.py:Near", "Near.link_threshold=7", "7 is out of range"),
                                         ("slow.py:Near", "Near.scales=7", "scale=1.0")):
            ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--predictor", predictor, "--policy", "corridor",
                                    "--set", setting, "--out", "runs"], capture_output=True, text=True, check=False)
            self.assertEqual(ended.returncode, 3, setting)
            self.assertIn(says, ended.stderr)

    def test_two_parts_of_one_name_are_refused(self) -> None:
        self.write("again.py", SLOW)
        ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", "slow.py:Slow", "again.py:Slow", "--out",
                                "runs"], capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 3)
        self.assertIn("two are called `Slow`", ended.stderr)


class SourcesTest(FolderCase):
    """The hash of a part is that of its file and of what it imports from its own folder."""

    def files_of(self, name: str) -> list[str]:
        script = SOURCE / "python/clearway/_sources.py"
        ended = subprocess.run([sys.executable, "-I", "-S", str(script), str(self.folder / name)], capture_output=True, text=True,
                               check=True)
        return [str(Path(line).relative_to(self.folder)) for line in ended.stdout.splitlines()]

    def test_finds_modules_and_packages_of_the_folder(self) -> None:
        (self.folder / "kit/deep").mkdir(parents=True)
        for name in ("kit/__init__.py", "kit/deep/__init__.py", "unused.py", "kit/unused.py"):
            self.write(name, "")
        self.write("mine.py", "import os, numpy\ndef f():\n    from near import thing\nif 1:\n    import kit.deep.low as low\n")
        self.write("near.py", "from kit import (side,\n    not_a_module)\nimport mine\n")
        self.write("kit/side.py", "from . import beside\nfrom .deep import *\n")
        self.write("kit/beside.py", "from ..near import x\n")
        self.write("kit/deep/low.py", "from ..last import y\n")
        self.write("kit/last.py", "class Broken(:\n")
        self.assertEqual(self.files_of("mine.py"), ["mine.py", "kit/__init__.py", "kit/beside.py", "kit/deep/__init__.py",
                                                    "kit/deep/low.py", "kit/last.py", "kit/side.py", "near.py"])
        self.assertEqual(self.files_of("kit/last.py"), ["kit/last.py"])

    def test_finds_files_of_the_folder_that_texts_name(self) -> None:
        self.write("mine.py", "import helper\nweights = 'nets/own.pth'\nnotes = 'plain'\nother = '../outside.txt'\nwords = 'not.there'\n")
        self.write("helper.py", "from pathlib import Path\ntable = Path(__file__).parent / 'table.csv'\n")
        (self.folder / "nets").mkdir()
        for name in ("nets/own.pth", "table.csv", "plain", "unnamed.csv"):
            self.write(name, "1")
        self.assertEqual(self.files_of("mine.py"), ["mine.py", "helper.py", "nets/own.pth", "table.csv"])

    def test_changed_weights_are_another_study(self) -> None:
        self.write("mine.py", "from pathlib import Path\nclass Mine:\n    def __init__(self):\n"
                              "        self.net = (Path(__file__).parent / 'net.txt').read_text()\n"
                              "    def act(self, belief):\n        return []\n")
        self.write("net.txt", "1")
        arguments = ["run", "intersection", "--policy", "mine.py:Mine", "--seeds", "1", "--no-solo", "--out", "runs"]
        program(*arguments)
        program(*arguments)
        self.write("net.txt", "2")
        program(*arguments, code=3)

    def test_a_changed_import_is_another_study(self) -> None:
        self.write("mine.py", "import helper\nclass Mine:\n    def act(self, belief):\n        return helper.leases(belief)\n")
        self.write("helper.py", "def leases(belief):\n    return []\n")
        arguments = ["run", "intersection", "--policy", "mine.py:Mine", "--seeds", "1", "--no-solo", "--out", "runs"]
        program(*arguments)
        program(*arguments)
        self.write("unrelated.py", "")
        program(*arguments)
        self.write("helper.py", "def leases(belief):\n    return list()\n")
        program(*arguments, code=3)

    def test_an_import_that_the_machine_fails_to_read_is_not_left_out_of_the_hash(self) -> None:
        if not may_trace():
            self.skipTest("strace is not installed or may not trace")
        self.write("mine.py", "import helper\nclass Mine:\n    def act(self, belief):\n        return []\n")
        self.write("helper.py", "")
        for call in ("openat", "newfstatat"):
            ended = subprocess.run(["strace", "-f", "-qq", "-o", os.devnull, "-P", str(self.folder / "helper.py"), "-e", f"trace={call}",
                                    "-e", f"inject={call}:error=EIO:when=1", str(PROGRAMS / "clearway"), "run", "intersection", "--policy",
                                    "mine.py:Mine", "--seeds", "1", "--no-solo", "--out", call], capture_output=True, text=True, check=False)
            self.assertEqual(ended.returncode, 4, ended.stderr)
            for words in ("its imports could not be read", "helper.py", "Input/output error", "give the same command again"):
                self.assertIn(words, ended.stderr)


class JudgedTest(FolderCase):
    """A predictor in Python is judged as any other, and acts where data sets are recorded."""

    def test_links_evaluate_judges_it_as_the_same_in_cpp(self) -> None:
        gallery = SOURCE / "examples/python/distance_predictor.py"
        said = json.loads(program("links", "evaluate", "intersection", "--predictor", f"{gallery}:ByDistance", "dead_reckoning",
                                  "--failure", "B10", "--exits", "known", "--seeds", "1", "--validation-seeds", "1", "--against", "ByDistance",
                                  "--out", "runs", "--json"))
        results = {one["predictor"]: one for one in said["results"]}
        self.assertEqual(set(results), {"ByDistance", "dead_reckoning"})
        python, cpp = results["ByDistance"], results["dead_reckoning"]
        self.assertGreater(python["ap"], 0.5)
        self.assertEqual(python.keys(), cpp.keys())
        for key in python.keys() - UNLIKE:
            if isinstance(cpp[key], float):
                self.assertAlmostEqual(python[key], cpp[key], places=5, msg=key)  # probabilities differ in the last digits of a float
            else:
                self.assertEqual(python[key], cpp[key], key)
        self.assertRegex(Path("runs/links.html").read_text(), f"{gallery}:ByDistance@[0-9a-f]{{32}}")

    def test_links_evaluate_tells_what_is_wrong(self) -> None:
        self.write("bad.py", "class NoAct:\n    pass\n")
        self.write("slow.py", SLOW)
        self.write("other.py", SLOW + "class kalman(Near):\n    pass\n")
        for words, says in ((["--predictor", "nowhere.py:Mine"], "nowhere.py is not a file"),
                            (["--predictor", "bad.py:NoAct"], "NoAct has no method predict()"),
                            (["--predictor", "slow.py:Near", "other.py:Near"], "two are called `Near`"),
                            (["--predictor", "other.py:kalman"], "two are called `kalman`"),
                            (["--predictor", "slow.py:Near", "--model", "Near=bad.py"], "takes none"),
                            (["--predictor", "slow.py:Near", "--set", "Near.sclae=2"], "Near.sclae is unknown")):
            ended = subprocess.run([str(PROGRAMS / "clearway"), "links", "evaluate", "intersection", *words, "--seeds", "1", "--out", "runs"],
                                   capture_output=True, text=True, check=False)
            self.assertEqual(ended.returncode, 3, ended.stderr)
            self.assertIn(says, ended.stderr)
            self.assertFalse(Path("runs").exists())

    def test_a_data_set_is_recorded_under_a_policy_in_python(self) -> None:
        self.write("slow.py", SLOW)
        arguments = ["links", "dataset", "intersection", "--samples", "--policy", "slow.py:Slow", "--set", "Slow.share=0.5", "--out", "data"]
        program(*arguments)
        self.assertRegex(str(list(Path("data").glob("*.samples"))), r"intersection-B10-under-Slow-[0-9a-f]{8}-0000.samples")
        (sample, *_) = clearway.dataset("data")
        self.assertRegex(sample.origin["traffic"], f"{self.folder}/slow.py:Slow@[0-9a-f]{{32}}.*Slow.share=0.5")


class StudyFileTest(FolderCase):
    def test_a_file_is_relative_to_the_study_file(self) -> None:
        (self.folder / "sub").mkdir()
        self.write("sub/mine.py", PREEMPT)
        text = ('replications = 1\nscenarios = ["intersection"]\nconditions = ["baseline"]\n[[condition]]\nname = "mine"\n'
                'policy = ["mine.py:Preempt"]\n')
        self.write("sub/study.toml", text)
        program("study", "sub/study.toml", "--dry-run", "--out", "runs")
        self.write("sub/factors.toml", text + '[factors]\ncondition.policy = [["mine.py:Preempt"], ["corridor"]]\n')
        program("study", "sub/factors.toml", "--dry-run", "--out", "runs")
        self.write("sub/study.toml", text.replace("mine.py", "other.py"))
        ended = subprocess.run([str(PROGRAMS / "clearway"), "study", "sub/study.toml", "--dry-run", "--out", "runs"],
                               capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 3)
        self.assertRegex(ended.stderr, r"sub/study.toml: condition mine: policy: .*sub/other.py is not a file")


if __name__ == "__main__":
    unittest.main()
