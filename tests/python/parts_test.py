"""Policies and predictors in Python: they equal the same parts in C++, and what goes wrong is told and ends."""
import os
import signal
import subprocess
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
class Sleeps(Policy):
    def act(self, belief):
        time.sleep(1000)
class NoAct:
    pass
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
        if (b"clearway._host" in words or b"clearway-run" in words) and place == str(folder):
            found.append(int(process.name))
    return found


class EqualPartsTest(FolderCase):
    def test_a_policy_in_python_is_the_same_run_as_in_cpp(self) -> None:
        self.write("mine.py", PREEMPT)
        results = clearway.run("intersection", [
            clearway.Condition("cpp", policy="preempt_signals", set={"preempt_signals.lead_per_halted_s": 0}),
            clearway.Condition("python", policy="mine.py:Preempt")], seeds=1, out="runs")
        self.assertEqual(results.errors.row_count, 0)
        left, right = (results.runs.where(condition=name) for name in ("cpp", "python"))
        for column in left:
            if column not in ("condition", "trace_hash"):
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
                "NotANumber": "speed_mps is nan (allowed: 0 to 200)", "NotALease": "'hold_green' in its list, which is not a",
                "Nothing": "act returned None", "Writes": "read-only"}
        results = self.run_all(list(says))
        for name, message in says.items():
            (found,) = results.errors.where(condition=name)["message"]
            self.assertIn(message, found)
            if name != "Dies":
                self.assertIn("Traceback", found)
                self.assertIn("bad.py" if name != "Nothing" else "act", found)
        self.assertEqual(list(results.runs["condition"]), ["baseline"])
        self.assertEqual(hosts_of(self.folder), [])

    def test_a_predictor_of_wrong_shape_or_with_nan_fails(self) -> None:
        conditions = [clearway.Condition(name, policy="corridor", failure="B10", predictor=f"bad.py:{name}")
                      for name in ("WrongShape", "WrongNumber")]
        with self.assertWarns(RuntimeWarning):
            results = clearway.run("intersection", conditions, seeds=1, out="runs")
        self.assertIn("one number for each of the", results.errors.where(condition="WrongShape")["message"][0])
        self.assertIn("the probability nan for pair 0 (allowed: 0 to 1)", results.errors.where(condition="WrongNumber")["message"][0])

    def test_a_lease_for_a_vehicle_that_is_gone_is_counted(self) -> None:
        results = clearway.run("intersection", [clearway.Condition("Gone", policy="bad.py:Gone")], seeds=1, out="runs")
        leases = results.leases.where(policy="Gone", reason="vehicle_gone")
        self.assertGreater(leases["leases"].sum(), 0)

    def test_what_cannot_be_loaded_is_told_before_anything_runs(self) -> None:
        self.write("syntax.py", "class Mine(:\n")
        self.write("raises.py", "raise OSError('no net here')\n")
        for word, says in (("nowhere.py:Mine", "nowhere.py is not a file"), ("bad.py:Mine", "has no class 'Mine'; it has Raises"),
                           ("bad.py:NoAct", "NoAct has no method act()"), ("bad.py", "FILE.py:CLASS"),
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

    def start_sleeping(self) -> subprocess.Popen:
        process = subprocess.Popen([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", "bad.py:Sleeps", "--no-solo",
                                    "--seeds", "1", "--out", "runs"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        end = time.monotonic() + 60.0
        while time.monotonic() < end and not self.sleeping():
            time.sleep(0.1)
        return process

    def sleeping(self) -> bool:
        """Whether a run (not only the check before it) has asked its part."""
        return Path("runs/runs/intersection/baseline/0").is_dir() and any(
            b"_host" in Path(f"/proc/{pid}/cmdline").read_bytes() for pid in hosts_of(self.folder))

    def test_killed_parents_leave_no_process(self) -> None:
        process = self.start_sleeping()
        self.assertGreaterEqual(len(hosts_of(self.folder)), 3)  # worker, its child, the part
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


if __name__ == "__main__":
    unittest.main()
