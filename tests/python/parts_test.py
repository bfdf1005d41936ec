"""Policies and predictors in Python: they equal the same parts in C++, and what goes wrong is told and ends."""
import json
import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import clearway
from support import FolderCase, PROGRAMS, SOURCE, program

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

FAULTS = """
import os, sys, time
import numpy as np
from clearway import Lease, Policy
class Raises(Policy):
    def act(self, belief):
        return 1 / 0
class Leaves(Policy):
    def act(self, belief):
        sys.exit(0)
class Dies(Policy):
    def act(self, belief):
        os.kill(os.getpid(), 9)
class NotANumber(Policy):
    def act(self, belief):
        return [Lease.drive_at(1, float("nan"))]
class NotALease(Policy):
    def act(self, belief):
        return ["hold_green"]
class Nothing(Policy):
    def act(self, belief):
        pass
class Writes(Policy):
    def act(self, belief):
        belief.vehicles.x_m[:] = 0.0
        return []
class Gone(Policy):
    def act(self, belief):
        return [Lease.drive_at(12345, 10.0, reason="to nobody")]
class NoSignal(Policy):
    def act(self, belief):
        return [Lease.hold_green(77, [99], serves=ev) for ev in belief.emergency_vehicles]
class Sleeps(Policy):
    def act(self, belief):
        time.sleep(1000)
class Interrupts(Policy):
    def act(self, belief):
        raise KeyboardInterrupt
class Draws(Policy):
    def act(self, belief):
        import random
        raise OSError(f"drawn {random.random()} {np.random.random()} {list({'a', 'b', 'c', 'd', 'e', 'f'})}")
class Starts(Policy):
    def __init__(self):
        import subprocess
        subprocess.Popen([sys.executable, "-c", "import time; time.sleep(1000)  # clearway._host, for hosts_of"])
    def act(self, belief):
        return []
class NoAct:
    pass
class Inherits(Policy):
    pass
class OwnFields(Policy):
    def act(self, belief):
        return [Lease({"action": "fly"})]
class TooMuch(Policy):
    def act(self, belief):
        return [Lease.hold_lane(1, reason="x" * 1000)] * 80000
class Important(Policy):
    def act(self, belief):
        return [Lease.hold_lane(1, priority=10**30)]
class Number(Policy):
    def act(self, belief):
        return 3
class WrongShape:
    def predict(self, observation):
        return np.zeros(len(observation.pairs[0]) + 1)
class WrongNumber:
    def predict(self, observation):
        return np.full(observation.pairs.shape[1], np.nan)
"""


def hosts_of(folder: Path) -> list[int]:
    """Processes of parts or workers that were started for this folder."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes()
            place = os.readlink(process / "cwd")
        except OSError:
            continue
        if any(word in words for word in (b"clearway._host", b"clearway._nursery", b"bin/clearway")) and place == str(folder):
            found.append(int(process.name))
    return found


# What reaches behind the package and answers as it likes.
RUDE = """
import json, struct, sys
import numpy as np
host = sys.modules.get("clearway._host") or sys.modules["__main__"]
GOOD = {"action": "hold_lane", "vehicle": 1, "beneficiary": 0, "lasting_s": 2.0, "priority": 0, "reason": "rude"}
class Rude:
    answer = [GOOD]
    def __init__(self):
        host.checked_leases = lambda answer: answer
    def act(self, belief):
        return self.answer
class Fine(Rude):
    pass
class NoList(Rude):
    answer = {"a": 1}
class NoAction(Rude):
    answer = [{**GOOD, "action": "fly"}]
class NoTarget(Rude):
    answer = [{name: value for name, value in GOOD.items() if name != "vehicle"}]
class Fast(Rude):
    answer = [{**GOOD, "action": "drive_at", "speed_mps": 1e300}]
class Huge(Rude):
    answer = [{**GOOD, "priority": 10**12}]
class Half(Rude):
    answer = [{**GOOD, "vehicle": 1.5}]
class Negative(Rude):
    answer = [{**GOOD, "signal": -1}]
class ManyLinks(Rude):
    answer = [{**GOOD, "action": "hold_green", "signal": 0, "links": [70000]}]
class Unordered(Rude):
    answer = [{**GOOD, "action": "hold_green", "signal": 0, "links": [2, 1]}]
class Past(Rude):
    answer = [{**GOOD, "lasting_s": -5}]
class Up(Rude):
    answer = [{**GOOD, "action": "pull_aside", "side": "up"}]
class NoJson:
    def act(self, belief):
        host.json.dumps = lambda *a, **k: "[{"
        return []
class Bell:
    def act(self, belief):
        host.ANSWER = b"?"
        return []
class Outside:
    def __init__(self):
        host.Sheet.write = lambda sheet, name, values: struct.pack_into("<2Q", sheet._memory, 0, 2**63, 2**62)
    def predict(self, observation):
        return np.zeros(observation.pairs.shape[1])
class Likely:
    def __init__(self):
        host.checked_probabilities = lambda answer, count: answer.astype("f4")
    def predict(self, observation):
        return np.full(observation.pairs.shape[1], 7.0)
class Few:
    def __init__(self):
        host.checked_probabilities = lambda answer, count: answer[:-1]
    def predict(self, observation):
        return np.zeros(observation.pairs.shape[1])
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
        program("verify", str(next(manifest.parent for manifest in Path("runs").glob("intersection-*/manifest.json"))), "--sample", "1")


SLOW = """
from clearway import Lease
class Slow:
    def __init__(self, share: float = 1.0, within_m: float = 200.0, most: int = 100, on: bool = True, reason: str = "slow", other=None):
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
                self.assertIn(f"mine+share={share}+most={most}", said)

    def test_what_does_not_fit_is_told_before_anything_runs(self) -> None:
        for setting, says in (("Slow.shares=1", "Slow.shares is unknown (allowed: arguments of __init__ that have a default: share=1.0"),
                              ("Slow.other=1", "Slow.other is unknown"), ("Slow.share=fast", "Slow.share is 'fast' (allowed: a finite number"),
                              ("Slow.share=nan", "Slow.share is 'nan' (allowed: a finite number"),
                              ("Slow.within_m=-inf", "Slow.within_m is '-inf' (allowed: a finite number"),
                              ("Slow.most=1.5", "Slow.most is '1.5' (allowed: a whole number"), ("Slow.on=1", "allowed: true, false"),
                              ("Fast.share=1", ", Slow). `clearway list settings`")):
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
        self.write("bad.py", FAULTS)
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

    def test_links_evaluate_ends_with_the_traceback_of_a_predictor_that_fails(self) -> None:
        self.write("bad.py", FAULTS)
        ended = subprocess.run([str(PROGRAMS / "clearway"), "links", "evaluate", "intersection", "--predictor", "bad.py:WrongShape",
                                "--failure", "B10", "--exits", "known", "--seeds", "1", "--validation-seeds", "1", "--out", "runs"],
                               capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("one number for each of the", ended.stderr)

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


class FaultTest(FolderCase):
    def setUp(self) -> None:
        super().setUp()
        self.write("bad.py", FAULTS)

    def run_all(self, names: list[str], **arguments: object) -> clearway.Results:
        conditions = [clearway.Condition(name, policy=f"bad.py:{name}") for name in names]
        with self.assertWarnsRegex(RuntimeWarning, f"{len(names)} runs failed"):
            return clearway.run("intersection", conditions, seeds=1, out="runs", **arguments)

    def test_an_exception_is_that_runs_failure_and_the_study_goes_on(self) -> None:
        says = {"Raises": "ZeroDivisionError: division by zero", "Leaves": "SystemExit: 0", "Dies": "killed by signal 9",
                "Interrupts": "KeyboardInterrupt",
                "NotANumber": "speed_mps is nan (allowed: 0 to 200)", "NotALease": "'hold_green' in its list, which is not a",
                "Nothing": "act returned None", "Writes": "read-only", "OwnFields": "made by its class methods", "Important": "priority is 1000",
                "TooMuch": "bytes (allowed", "Number": "act returned 3, which is not a list"}
        results = self.run_all(list(says))
        for name, message in says.items():
            failed = results.errors.where(condition=name)
            (found,) = failed["message"]
            self.assertIn(message, found)
            if name != "Dies":
                self.assertRegex(found.splitlines()[0], r"bad.py: (\w+Error|SystemExit|KeyboardInterrupt)")  # the cause comes first
                self.assertIn("Traceback", found)
                if name == "Raises":
                    self.assertRegex(found.splitlines()[0], r"division by zero \(bad.py, line \d+\)")
                answered = ("NotALease", "Nothing", "TooMuch", "Number")  # `act` has returned, so that nothing else is on the stack
                self.assertEqual("_host.py" in found, name in answered, found)
                self.assertIn("bad.py" if name not in ("Nothing", "TooMuch", "Number") else "act", found)
        self.assertEqual(set(results.errors["cause"]), {"python"})
        self.assertEqual(list(results.runs["condition"]), ["baseline"])
        self.assertEqual(hosts_of(self.folder), [])

    def test_a_signal_that_does_not_exist_is_refused(self) -> None:
        conditions = [clearway.Condition("no_signal", policy="bad.py:NoSignal"),
                      clearway.Condition("by_radio", policy="bad.py:NoSignal", failure="perfect,signal_request_propagation=sharp")]
        refused = clearway.run("intersection", conditions, seeds=1, out="runs").leases
        for condition in ("no_signal", "by_radio"):
            self.assertGreater(refused.where(condition=condition, reason="no_such_signal")["leases"].sum(), 0, condition)

    def test_a_file_that_changes_during_a_study_blames_no_run_and_once_restored_the_study_goes_on(self) -> None:
        text = ("import pathlib\nfrom clearway import Policy\nonce = pathlib.Path('%s')\nclass Moody(Policy):\n"
                "    def act(self, belief):\n        if not once.exists():\n            once.touch()\n"
                "            pathlib.Path('%s').write_text('# changed')\n        return []\n")
        text %= (self.folder / "once", self.folder / "moody.py")
        file = self.write("moody.py", text)
        study = ["run", "intersection", "--policy", "moody.py:Moody", "--seeds", "2", "--no-solo", "--jobs", "1", "--out", "runs"]
        program(*study, code=7)
        self.assertEqual(list(clearway.open("runs").errors["cause"]), [""])  # missing, not failed
        file.write_text(text)
        program(*study)
        self.assertEqual(clearway.open("runs").runs.row_count, 4)

    def test_an_answer_that_the_package_did_not_check_is_that_runs_failure(self) -> None:
        self.write("rude.py", RUDE)
        says = {"NoList": "it is no list", "NoAction": "`fly` is not an action", "NoTarget": "vehicle", "Fast": "speed_mps is 1e+300",
                "Huge": "priority is 1000000000000, not a whole number", "Half": "vehicle is 1.5", "Negative": "signal is -1",
                "ManyLinks": "links is 70000", "Unordered": "not in order", "Past": "lasting_s is -5", "Up": "side is `up`",
                "NoJson": "parse error", "Bell": "answered with byte 63"}
        predictors = {"Outside": "lies outside the memory", "Likely": "each 0 to 1", "Few": "are not the probabilities of"}
        conditions = [clearway.Condition(name, policy=f"rude.py:{name}") for name in ("Fine", *says)]
        conditions += [clearway.Condition(name, policy="corridor", failure="B10", predictor=f"rude.py:{name}") for name in predictors]
        with self.assertWarnsRegex(RuntimeWarning, f"{len(says) + len(predictors)} runs failed"):
            results = clearway.run("intersection", conditions, seeds=1, out="runs")
        for name, message in {**says, **predictors}.items():
            (found,) = results.errors.where(condition=name)["message"]
            self.assertIn(message, found)
            self.assertIn(name, found)
        self.assertEqual(set(results.errors["cause"]), {"python"})
        self.assertEqual(set(results.runs["condition"]), {"baseline", "Fine"})

    def test_a_predictor_of_wrong_shape_or_with_nan_fails(self) -> None:
        conditions = [clearway.Condition(name, policy="corridor", failure="B10", predictor=f"bad.py:{name}")
                      for name in ("WrongShape", "WrongNumber")]
        with self.assertWarns(RuntimeWarning):
            results = clearway.run("intersection", conditions, seeds=1, out="runs")
        self.assertIn("one number for each of the", results.errors.where(condition="WrongShape")["message"][0])
        self.assertIn("the probability nan for pair 0 (allowed: 0 to 1)", results.errors.where(condition="WrongNumber")["message"][0])

    def test_whatever_is_drawn_without_a_seed_is_drawn_again(self) -> None:
        drawn = set()
        for folder in ("one", "two"):
            with self.assertWarnsRegex(RuntimeWarning, "2 runs failed"):
                results = clearway.run("intersection", [clearway.Condition("Draws", policy="bad.py:Draws")], seeds=2, out=folder)
            drawn |= {message.rpartition("drawn")[2] for message in results.errors["message"]}
        self.assertEqual(len(drawn), 1)
        self.assertIn("0.844", drawn.pop())  # random.seed(0)

    def test_what_a_policy_starts_ends_with_it(self) -> None:
        results = clearway.run("intersection", [clearway.Condition("Starts", policy="bad.py:Starts")], seeds=1, out="runs")
        self.assertEqual(results.errors.row_count, 0)
        end = time.monotonic() + 5.0
        while hosts_of(self.folder) and time.monotonic() < end:
            time.sleep(0.1)
        self.assertEqual(hosts_of(self.folder), [])

    def test_a_lease_for_a_vehicle_that_is_gone_is_counted(self) -> None:
        results = clearway.run("intersection", [clearway.Condition("Gone", policy="bad.py:Gone")], seeds=1, out="runs")
        leases = results.leases.where(policy="Gone", reason="vehicle_gone")
        self.assertGreater(leases["leases"].sum(), 0)

    def test_what_cannot_be_loaded_is_told_before_anything_runs(self) -> None:
        self.write("syntax.py", "class Mine(:\n")
        self.write("raises.py", "raise OSError('no net here')\n")
        for word, says in (("nowhere.py:Mine", "nowhere.py is not a file"), ("bad.py:Mine", "has no class 'Mine'; it has Raises"),
                           ("bad.py:Raise", "Did you mean 'Raises'?"), ("bad.py:NoAct", "NoAct has no method act()"),
                           ("bad.py:Inherits", "Inherits has no method act()"), ("bad.py", "FILE.py:CLASS"),
                           ("syntax.py:Mine", "SyntaxError"), ("raises.py:Mine", "OSError: no net here")):
            ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", word, "--out", "runs"],
                                   capture_output=True, text=True, check=False)
            self.assertEqual(ended.returncode, 3, ended.stderr)
            self.assertIn(says, ended.stderr)
            self.assertFalse(Path("runs").exists())

    def test_another_python_is_told_what_it_lacks(self) -> None:
        ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", "bad.py:Gone", "--out", "runs"],
                               capture_output=True, text=True, check=False, env={**os.environ, "CLEARWAY_PYTHON": "/no/python"})
        self.assertEqual(ended.returncode, 3)
        self.assertIn("exit code 127", ended.stderr)
        self.assertIn("CLEARWAY_PYTHON", ended.stderr)

    def test_a_python_without_numpy_is_told(self) -> None:
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", "bare"], check=True)
        bare = str(self.folder / "bare/bin/python3")
        ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", "bad.py:Gone", "--out", "runs"],
                               capture_output=True, text=True, check=False, env={**os.environ, "CLEARWAY_PYTHON": bare})
        self.assertEqual(ended.returncode, 3)
        self.assertIn(f"clearway needs numpy, which {bare} does not have", ended.stderr)

    def start_sleeping(self) -> subprocess.Popen:
        return self.started([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", "bad.py:Sleeps", "--no-solo", "--seeds", "1",
                             "--out", "runs"])

    def started(self, words: list[str]) -> subprocess.Popen:
        process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + 60.0
        while time.monotonic() < end and not self.sleeping():
            time.sleep(0.1)
        return process

    def sleeping(self) -> bool:
        """Whether a run (not only the check before it) has asked its part: the nursery has become it."""
        nurseries = [pid for pid in hosts_of(self.folder) if b"_nursery" in Path(f"/proc/{pid}/cmdline").read_bytes()]
        return len(nurseries) == 2

    def test_killed_parents_leave_no_process(self) -> None:
        self.check_kill(self.start_sleeping())

    def test_a_killed_python_leaves_no_study_behind(self) -> None:
        self.check_kill(self.started([sys.executable, "-c", "import clearway; clearway.run('intersection', [clearway.Condition('mine', "
                                      "policy='bad.py:Sleeps')], seeds=1, out='runs')"]))

    def check_kill(self, process: subprocess.Popen) -> None:
        self.assertGreaterEqual(len(hosts_of(self.folder)), 5)  # program, worker, its child, nursery, the part
        process.send_signal(signal.SIGKILL)
        process.wait()
        end = time.monotonic() + 20.0
        while hosts_of(self.folder) and time.monotonic() < end:
            time.sleep(0.1)
        self.assertEqual(hosts_of(self.folder), [])

    def test_a_part_that_does_not_answer_ends_with_the_time_limit(self) -> None:
        program("run", "intersection", "--policy", "bad.py:Sleeps", "--no-solo", "--seeds", "1", "--out", "runs", "--run-time-limit",
                "20", code=1)
        self.assertIn("did not end within", clearway.open("runs").errors["message"][0])
        time.sleep(1.5)
        self.assertEqual(hosts_of(self.folder), [])


# A policy and what runs it, in one file, as one would write it first.
CLASS = """
import clearway
class G(clearway.Policy):
    def act(self, belief):
        return []
"""
RUN = 'clearway.run("intersection", [clearway.Condition("g", policy=G)], seeds=2)\n'
CURE = 'below `if __name__ == "__main__":`'
#: Stands where the program does and writes down each call; ends the fourth, so that a failing test starts no more.
COUNTING = """#!/bin/sh
echo "$*" >> '{log}'
[ $(wc -l < '{log}') -le 3 ] && exec '{program}' "$@"
echo "started again and again" >&2
exit 1
"""


class StartedAgainTest(FolderCase):
    def setUp(self) -> None:
        super().setUp()
        (self.folder / "bin").mkdir()
        (self.folder / "bin/clearway-run").symlink_to(PROGRAMS / "clearway-run")
        self.write("bin/clearway", COUNTING.format(log=self.folder / "calls", program=PROGRAMS / "clearway")).chmod(0o755)

    def ended(self, *words: str) -> subprocess.CompletedProcess:
        """Python with these words. ``started`` is then the verb of each call of the program."""
        (self.folder / "calls").write_text("")
        ended = subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False, timeout=100,
                               env={**os.environ, "CLEARWAY_PROGRAMS": str(self.folder / "bin")})
        self.assertEqual(hosts_of(self.folder), [])
        self.started = [line.split()[0] for line in (self.folder / "calls").read_text().splitlines()]
        return ended

    def test_a_file_that_starts_a_study_each_time_it_is_loaded_starts_one(self) -> None:
        ended = self.ended(str(self.write("mine.py", CLASS + RUN)))
        self.assertEqual(ended.returncode, 1)
        self.assertIn(f"{self.folder}/mine.py:G: clearway.run() was called while a run had loaded this part", ended.stderr)
        self.assertIn(CURE, ended.stderr)
        self.assertEqual(self.started, ["study"])

    def test_a_file_that_makes_an_environment_each_time_it_is_loaded_makes_one(self) -> None:
        for call in ("env('intersection', policy=G)", "parallel_env('intersection', policy=G)", "vector_env('intersection', 1, policy=G)"):
            ended = self.ended(str(self.write("mine.py", f"{CLASS}clearway.{call}\n")))
            self.assertEqual(ended.returncode, 1)
            self.assertIn("clearway.env() was called while a run had loaded this part", ended.stderr)
            self.assertIn(CURE, ended.stderr)
            self.assertEqual(self.started, ["python"])

    def test_a_study_file_that_names_the_file_that_runs_it_is_run_once(self) -> None:
        self.write("study.toml", "name = 'own'\nreplications = 1\nscenarios = ['intersection']\n[[condition]]\nname = 'g'\n"
                                 "policy = 'mine.py:G'\n")
        ended = self.ended(str(self.write("mine.py", CLASS + "clearway.study('study.toml')\n")))
        self.assertEqual(ended.returncode, 1)
        self.assertIn("clearway.study() was called while a run had loaded this part", ended.stderr)
        self.assertEqual(self.started, ["study"])

    def test_a_process_that_multiprocessing_starts_does_not_start_what_its_parent_did(self) -> None:
        for call in ("study('none.toml')", "env('none')"):
            script = self.write("mine.py", f"import multiprocessing, clearway\ntry:\n    clearway.{call}\n"
                                           "except clearway.ClearwayError as error:\n    print(error, flush=True)\n"
                                           "if __name__ == '__main__':\n    child = multiprocessing.get_context('spawn').Process(target=int)\n"
                                           "    child.start()\n    child.join()\n")
            ended = self.ended(str(script))
            self.assertEqual(ended.returncode, 0, ended.stderr)
            first, second = ended.stdout.splitlines()
            self.assertIn("none", first)
            self.assertIn("() was called while multiprocessing loaded the main file in a new process", second)
            self.assertIn(CURE, second)
            self.assertLessEqual(len(self.started), 1)

    def test_a_class_that_is_in_no_file_is_refused_with_the_cure(self) -> None:
        for call in (RUN, "clearway.env('intersection', policy=G)"):  # -c, like a notebook's cell, is the main module without a file
            ended = self.ended("-c", CLASS + call)
            self.assertEqual(ended.returncode, 1)
            self.assertIn("InputError: G is not at the top of a file", ended.stderr)
            self.assertIn("name it my_policy.py:G", ended.stderr)
            self.assertEqual(self.started, [])

    def test_with_the_guard_it_runs(self) -> None:
        ended = self.ended(str(self.write("mine.py", f"{CLASS}if __name__ == '__main__':\n    print({RUN.strip()}.runs.row_count)\n")))
        self.assertEqual((ended.returncode, ended.stdout), (0, "4\n"), ended.stderr)
        self.assertEqual(self.started.count("study"), 1)


if __name__ == "__main__":
    unittest.main()
