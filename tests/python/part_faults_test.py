"""What goes wrong in policies and predictors in Python is told, and ends."""
import errno
import json
import os
import re
import selectors
import signal
import socket
import subprocess
import sys
import time
import unittest
from pathlib import Path
from unittest import mock

import clearway
from clearway._files import REASONS_OF_MACHINE, is_of_machine, refusal
from clearway._nursery import Nursery
from support import FolderCase, PROGRAMS, SOURCE, hosts_of, program

FAULTS = """
import errno, os, subprocess, sys, time
import numpy as np
import clearway
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
class Crashes(Policy):
    def act(self, belief):
        with open(os.path.join(os.path.dirname(__file__), "tries"), "a") as tries:
            tries.write("x")
        os.kill(os.getpid(), 11)
def first_time():
    try:
        open(os.path.join(os.path.dirname(__file__), "once"), "x").close()
        return True
    except FileExistsError:
        return False
class KilledOnce(Policy):
    def act(self, belief):
        if first_time():
            os.kill(os.getpid(), 9)
        return []
class NoMemoryOnce(Policy):
    def act(self, belief):
        if first_time():
            np.ones(2**50)
        return []
class NoSpaceOnce(Policy):
    def act(self, belief):
        if first_time():
            raise OSError(errno.ENOSPC, "No space left on device")
        return []
class NoDescriptorsOnce(Policy):
    def act(self, belief):
        if first_time():
            held = [open("/dev/null") for _ in range(10**6)]
        return []
class CaughtOnce(Policy):
    def act(self, belief):
        if first_time():
            try:
                np.ones(2**50)
            except MemoryError:
                raise ValueError("the table does not fit")
        return []
class SaidByTorchOnce(Policy):
    def act(self, belief):
        if first_time():
            raise RuntimeError("DefaultCPUAllocator: can't allocate memory: Error code 12 (Cannot allocate memory)")
        return []
class NotANumber(Policy):
    def act(self, belief):
        return [Lease.drive_at(1, float("nan"))]
class NotALease(Policy):
    def act(self, belief):
        return ["hold_green"]
class OneLease(Policy):
    def act(self, belief):
        return Lease.hold_lane(belief.emergency_vehicles[0]) if belief.emergency_vehicles else []
class Nothing(Policy):
    def act(self, belief):
        pass
class Writes(Policy):
    def act(self, belief):
        belief.vehicles.x_m[:] = 0.0
        return []
class Gone(Policy):
    first = None
    def act(self, belief):
        self.first = self.first or next(iter(belief.vehicles.key[belief.vehicles.is_automated]), None)
        return [] if self.first is None else [Lease.drive_at(self.first, 10.0, reason="to one that will leave")]
class Row(Policy):
    def act(self, belief):
        return [Lease.drive_at(12345, 10.0, reason="to nobody")]
class NoSignal(Policy):
    def act(self, belief):
        return [Lease.hold_green(77, [99], serves=ev) for ev in belief.emergency_vehicles]
class NoLink(Policy):
    def act(self, belief):
        return [Lease.hold_green(0, [99], serves=ev) for ev in belief.emergency_vehicles]
class NoWay(Policy):
    def act(self, belief):
        return [Lease.take_route(ev, [99, 99999], serves=ev) for ev in belief.emergency_vehicles]
class Gap(Policy):
    def act(self, belief):
        return [Lease.take_route(ev, [ev.route[0], *ev.route], serves=ev) for ev in belief.emergency_vehicles]
class Sleeps(Policy):
    def act(self, belief):
        time.sleep(1000)
class Fills(Policy):
    def act(self, belief):
        self.held = np.ones(600 * 2**20, dtype=np.uint8)
        time.sleep(1000)
class FillsElsewhere(Policy):
    def act(self, belief):
        subprocess.run([sys.executable, "-c", "held = b'x' * (600 * 2**20); import time; time.sleep(20)"])
class Orphan(Policy):
    def act(self, belief):
        with open(f"/proc/{os.getppid()}/cmdline") as parent:
            if "_nursery" in parent.read():
                os.kill(os.getppid(), 9)
                time.sleep(10)
        return []
class Interrupts(Policy):
    def act(self, belief):
        raise KeyboardInterrupt
class Stops(Policy):
    def act(self, belief):
        breakpoint()
        return []
class Text(Policy):
    def act(self, belief):
        return "green please"
class Shows(Policy):
    before = None
    def act(self, belief):
        if belief.emergency_vehicles:
            print(belief.emergency_vehicles[0], "then", belief, "before", self.before)
            self.before = belief
        return []
class Endless(Policy):
    def __init__(self):
        (sys.modules.get("clearway._host") or sys.modules["__main__"]).ANSWER_LIMIT_S = 2.0
    def act(self, belief):
        while True:
            pass
class Draws(Policy):
    def act(self, belief):
        import random
        raise OSError(f"drawn {random.random()} {np.random.random()} {list({'a', 'b', 'c', 'd', 'e', 'f'})}")
class Starts(Policy):
    alone = False
    def __init__(self):
        import subprocess
        subprocess.Popen([sys.executable, "-c", "import time; time.sleep(1000)  # clearway._host, for hosts_of"],
                         start_new_session=self.alone)
    def act(self, belief):
        return []
class StartsAlone(Starts):
    alone = True
class Prints(Policy):
    def act(self, belief):
        print("seen at", int(belief.time_s > 1e9))
        print("warned", file=sys.stderr)
        return []
class NoAct:
    pass
class Acts(Policy):
    def acts(self, belief):
        return []
class Needs(Policy):
    def __init__(self, within_m, most=3):
        self.within_m = within_m
    def act(self, belief):
        return []
class Inherits(Policy):
    pass
class NoBelief(Policy):
    def act(self):
        return []
class NoSelf(Policy):
    def act():
        return []
class BareInit(Policy):
    def __init__():
        pass
    def act(self, belief):
        return []
class Takes(Policy):
    def __init__(self, *words, most=1, **more):
        pass
    def act(self, belief, again=2, *others, **words):
        return []
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
class Misspelt(Policy):
    def act(self, belief):
        return [ev.approach for ev in belief.emergency_vehicles]
class Slowly(Policy):
    def act(self, belief):
        yield Lease.drive_at(1, -5)
class Caught(Policy):
    def act(self, belief):
        try:
            belief.vehicles.speed
        except AttributeError as error:
            raise ValueError("first\\nsecond") from error
class Keeps(Policy):
    kept = None
    def act(self, belief):
        if self.kept is not None:
            before, x_m, time_s, vehicle = self.kept
            assert before.time_s == time_s and len(x_m) and vehicle.key >= 0 and before.network is belief.network
            for ask in (lambda: before.vehicles.x_m, lambda: before.emergency_vehicles, lambda: before.incidents, lambda: vehicle.x_m,
                        lambda: before.links.of(0), lambda: before.signal_state(0), lambda: vehicle.approaches, lambda: len(before.vehicles)):
                try:
                    ask()
                    raise AssertionError("answered")
                except clearway.ClearwayError:
                    pass
            before.vehicles.y_m
        for vehicle in belief.emergency_vehicles:
            self.kept = belief, belief.vehicles.x_m.copy(), belief.time_s, vehicle
            belief.links.index
        return []
class WrongShape:
    def predict(self, observation):
        return np.zeros(len(observation.pairs[0]) + 1)
class NoArray:
    def predict(self, observation):
        pass
class KeepsObservation:
    kept = None
    def predict(self, observation):
        if self.kept is not None:
            self.kept.last_x_m
        self.kept = observation
        return observation.pair_last_seen_m < 0.0
class MisspeltColumn:
    def predict(self, observation):
        return observation.pair_last_m
class WrongNumber:
    def predict(self, observation):
        return np.full(observation.pairs.shape[1], np.nan)
"""


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
    def act(self, belief):
        return [{**GOOD, "vehicle": int(key)} for key in belief.vehicles.key[:1]]
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


MOODY_STUDY = ["run", "intersection", "--policy", "moody.py:Moody", "--seeds", "2", "--no-solo", "--jobs", "1", "--out", "runs"]


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
                "Interrupts": "KeyboardInterrupt", "Text": "act returned a str, not a list of clearway.Lease: 'green please'",
                "Stops": "BdbQuit: a part runs in a process of its own, without a terminal",
                "NotANumber": "speed_mps is nan (allowed: 0 to 200)", "NotALease": "'hold_green' in its list, which is not a",
                "OneLease": "act returned one lease: return a list, [lease]", "Nothing": "act returned None", "Writes": "read-only",
                "OwnFields": "made by its class methods", "Important": "priority is 1000",
                "TooMuch": "bytes (allowed", "Number": "act returned 3, which is not a list", "Slowly": "speed_mps is -5",
                "Misspelt": "EmergencyVehicle has no 'approach'. Did you mean 'approaches'? It has ahead, ", "Caught": "ValueError: first (bad.py",
                "Keeps": "y_m of an earlier decision was asked for", "Endless": "TimeoutError: no answer after 2 s"}
        results = self.run_all(list(says))
        for name, message in says.items():
            failed = results.errors.where(condition=name)
            (found,) = failed["message"]
            self.assertIn(message, found)
            if name != "Dies":
                first, *others = found.splitlines()
                self.assertRegex(first, r"bad.py: ([\w.]*Error|bdb.BdbQuit|SystemExit|KeyboardInterrupt).* \(bad.py, line \d+(, \w+\.act)?\)$")
                line = int(re.search(r"line (\d+)", first)[1])
                class_line = next(number for number, text in enumerate(FAULTS.splitlines(), 1) if text.startswith(f"class {name}("))
                self.assertTrue(class_line < line < class_line + 25, first)
                self.assertNotIn(str(Path(clearway.__file__).parent), found)
                answered = ("NotALease", "Nothing", "Number", "OneLease", "Text", "TooMuch")  # `act` has returned: no line of it runs
                self.assertEqual("Traceback" in found, name not in answered, found)
                self.assertEqual((name in answered, f"{name}.act" in first), (not others,) * 2, found)
                if others and name != "Caught":
                    self.assertEqual(others[-1].strip(), FAULTS.splitlines()[line - 1].strip())
                if name not in ("Caught", "Interrupts", "Stops"):  # another error was raised before; the line has its word
                    self.assertEqual(found.count(message), 1, found)
            # Who killed a process cannot be seen, so it counts as the system, which does so where memory is short.
            self.assertEqual(failed["cause"][0], "signal" if name == "Dies" else "python")
        self.assertEqual(list(results.runs["condition"]), ["baseline"])
        self.assertEqual(hosts_of(self.folder), [])

    def test_neither_frames_of_libraries_nor_warnings_of_sumo_are_told(self) -> None:
        (self.folder / "site-packages").mkdir()
        library = self.write("site-packages/deep.py", "import json\ndef fall(word):\n    return json.loads(word)\n")
        self.write("net.py", f"import sys\nsys.path.append({str(library.parent)!r})\nfrom clearway import Policy\nimport deep\n"
                   "class Net(Policy):\n    def act(self, belief):\n        return deep.fall('{')\n")
        self.write("my.toml", 'replications = 1\nscenarios = ["intersection"]\nconditions = ["baseline"]\n[[condition]]\nname = "net"\npolicy = ["net.py:Net"]\n')
        study = [str(PROGRAMS / "clearway"), "study", "my.toml", "--out", "runs"]
        first = subprocess.run(study, capture_output=True, text=True, check=False)
        self.assertEqual(first.returncode, 1, first.stderr)
        (found,) = clearway.open("runs").errors["message"]
        self.assertRegex(found.splitlines()[0], r"JSONDecodeError: .* \(net.py, line 7\)$")
        self.assertEqual(found.count("File "), 1, found)
        self.assertEqual(found.splitlines()[-1].strip(), "return deep.fall('{')")
        (file,) = [file for file in Path("runs").rglob("*.json") if "log_tail" in file.read_text()]
        file.write_text(json.dumps({**json.loads(file.read_text()), "log_tail": "Warning: no connection"}))
        ended = subprocess.run(study, capture_output=True, text=True, check=False)
        self.assertIn("line 7", ended.stderr)
        self.assertNotIn("no connection", ended.stderr)

    def test_what_is_believed_prints_with_its_values(self) -> None:
        clearway.run("intersection", [clearway.Condition("Shows", policy="bad.py:Shows")], seeds=1, out="runs")
        (log,) = [file.read_text() for file in Path("runs/logs").glob("*.log")]
        vehicle = r"EmergencyVehicle\(key=\d+, speed_mps=[\d.]+, lane=\d+, lane_position_m=[\d.]+, x_m=[\d.-]+, y_m=[\d.-]+\)"
        line = next(line for line in log.replace("\nShows| ", " ").splitlines() if line.startswith("Shows| Emerg") or " Emerg" in line)
        self.assertRegex(line, rf"{vehicle} then Belief\(time_s=[\d.]+, vehicles=Vehicles\(key=\[.*speed_mps=\[.*\), "
                               rf"emergency_vehicles=\[{vehicle}.*\]\) before None")
        self.assertIn("before <Belief: edge_times_s, emergency_vehicles, ", log)  # of an earlier decision

    def test_what_a_part_prints_is_in_the_log_of_its_run(self) -> None:
        clearway.run("intersection", [clearway.Condition("Prints", policy="bad.py:Prints")], seeds=1, out="runs")
        (log,) = [file.read_text() for file in Path("runs/logs").glob("*.log")]
        self.assertIn("Prints| seen at 0\nPrints| warned\n", log)
        ended = subprocess.run([str(PROGRAMS / "clearway"), "report", "runs"], capture_output=True, text=True, check=False)
        self.assertIn(f"clearway: Prints printed {log.count(chr(10)):,} lines: runs/logs/intersection-00000-standard.log\n", ended.stderr)

    def test_lines_that_a_part_did_not_print_do_not_count(self) -> None:
        with self.assertWarns(RuntimeWarning):
            clearway.run("intersection", [clearway.Condition(name, policy=f"bad.py:{name}") for name in ("Prints", "Raises")], seeds=1, out="runs")
        (log,) = Path("runs/logs").glob("*standard.log")
        lines = log.read_text().splitlines()
        printed = [line for line in lines if line.startswith("Prints| ")]
        self.assertIn("Traceback (most recent call last):", lines)
        said = subprocess.run([str(PROGRAMS / "clearway"), "report", "runs"], capture_output=True, text=True, check=False).stderr
        self.assertIn(f"clearway: Prints printed {len(printed):,} lines: {log}\n", said)
        log.write_text("".join(f"{line}\n" for line in lines if line not in printed))
        said = subprocess.run([str(PROGRAMS / "clearway"), "report", "runs"], capture_output=True, text=True, check=False).stderr
        self.assertNotIn(" printed ", said)

    def test_nothing_is_said_of_a_part_that_prints_nothing(self) -> None:
        ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", "bad.py:Gone", "--seeds", "1", "--no-solo"],
                               capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertNotIn("printed", ended.stderr)

    def test_a_number_that_names_nothing_and_a_way_with_a_gap_fail_with_what_is_allowed(self) -> None:
        says = {"Row": r"Row: a lease is for vehicle 12345, which was never in a belief \(allowed: belief.vehicles.key\[row\], ",
                "NoSignal": r"a lease is for signal 77 \(allowed: 0 to 0\) \(hold_green at \d+\.\d s; bad.py, line \d+\)", "NoLink": r"link 99 of signal 0 \(allowed: 0 to \d+\)",
                "NoWay": r"a way over edge 99 \(allowed: 0 to \d+, rows of belief.network.edge_ids\)",
                "Gap": r"""from edge "(\w+_in)" to edge "\1" \(allowed next: \w+_out(, \w+)*; belief.network.onward .* \(take_route at .*, line \d+"""}
        with self.assertWarns(RuntimeWarning):
            results = clearway.run("intersection", [clearway.Condition(name, policy=f"bad.py:{name}") for name in says], seeds=1,
                                   out="runs")
        for name, message in says.items():
            (failed,) = results.errors.where(condition=name)["message"]
            self.assertRegex(failed, message)
        self.assertEqual(set(results.errors["cause"]), {"python"})
        self.assertEqual(list(results.runs["condition"]), ["baseline"])  # nothing else is lost
        (line,) = [number for number, text in enumerate(Path("bad.py").read_text().splitlines(), 1) if "hold_green(77, [99]" in text]
        self.assertIn(f"bad.py, line {line})", results.errors.where(condition="NoSignal")["message"][0])
        with self.assertRaisesRegex(ValueError, "edges is empty"):
            clearway.Lease.take_route(1, [])

    def test_what_is_no_way_or_signal_is_told_with_the_row_that_is_meant(self) -> None:
        edge = r" \(allowed: a row of belief.network.edge_ids, from 0 on\)"
        for edges, kind, says in ((None, TypeError, r"^edges is None \(allowed: a list of rows of belief.network.edge_ids\)$"),
                                  (5, TypeError, r"^edges is 5 \(allowed: a list of rows "),
                                  (["A1B1"], TypeError, rf"^an edge of edges is 'A1B1'{edge}. belief.network.edge_ids.index\('A1B1'\) is its row$"),
                                  ([0, -1], ValueError, rf"^an edge of edges is -1{edge}$"), ([2**40], ValueError, f"is {2**40}{edge}$"),
                                  ([0.5], ValueError, rf"is 0.5{edge}$"), ([float("nan")], ValueError, rf"is nan{edge}$")):
            with self.assertRaisesRegex(kind, says):
                clearway.Lease.take_route(1, edges)
        with self.assertRaisesRegex(TypeError, r"^signal is 'C1' \(allowed: a row of belief.network.signal_ids, from 0 on\). belief"):
            clearway.Lease.adjust_green("C1", [0])
        with self.assertRaisesRegex(TypeError, r"^links is 3 \(allowed: a list of numbers of links of the signal\)$"):
            clearway.Lease.hold_green(0, 3)
        self.assertEqual(clearway.Lease.take_route(1, iter([3, 4])).fields["edges"], [3, 4])

    def test_an_incident_that_is_no_text_is_told_with_the_form_of_the_text(self) -> None:
        for wrong in ({"edge": "B1C1", "from_s": 100}, None, [1]):
            with self.assertRaises(clearway.InputError) as told:
                clearway.run("intersection", seeds=1, out="none", incident=wrong)
            self.assertEqual(str(told.exception), f"incident is {wrong!r} (allowed: a text such as 'edge=B1C1,from_s=100', several separated by "
                             "semicolons, or 'none')")
        self.assertFalse(Path("none").exists())

    def test_a_keyword_that_no_lease_has_is_told_with_the_one_that_is_meant(self) -> None:
        with self.assertRaisesRegex(TypeError, r"^Lease.hold_green\(\) has no keyword 'duration'. Did you mean 'lasting_s'\?$"):
            clearway.Lease.hold_green(0, [0], duration=5)
        with self.assertRaisesRegex(TypeError, "'lane'. Did you mean 'lane_number'"):
            clearway.Lease.change_lane(1, lane=0)
        with self.assertRaisesRegex(TypeError, r"has no keyword 'x'; it has vehicle, serves, lasting_s, priority, reason"):
            clearway.Lease.pass_red(1, x=0)
        self.assertEqual(clearway.Lease.pass_red(1), clearway.Lease.pass_red(1), "wherever they were made")

    def write_moody(self, *more: str) -> Path:
        """A policy that changes its own file, and does ``more``, when it first acts."""
        first = [*more, f"pathlib.Path({str(self.folder / 'moody.py')!r}).write_text('# changed')"]
        return self.write("moody.py", "\n".join((
            "import pathlib, shutil", "from clearway import Policy", f"once = pathlib.Path({str(self.folder / 'once')!r})", "class Moody(Policy):",
            "    def act(self, belief):", "        if not once.exists():", "            once.touch()",
            *(f"            {line}" for line in first), "        return []", "")))

    def test_a_study_goes_on_with_the_code_that_it_began_with(self) -> None:
        file = self.write_moody()
        text = file.read_text()
        program(*MOODY_STUDY)
        self.assertEqual(file.read_text(), "# changed")
        self.assertEqual(clearway.open("runs").runs.row_count, 4)
        self.assertEqual([copy.read_text() for copy in Path("runs/code").glob("*/moody.py")], [text])

    def test_a_file_that_changes_and_has_no_copy_blames_no_run_and_once_restored_the_study_goes_on(self) -> None:
        file = self.write_moody(f"shutil.rmtree({str(self.folder / 'runs/code')!r})")
        text = file.read_text()
        program(*MOODY_STUDY, code=7)
        self.assertEqual(list(clearway.open("runs").errors["cause"]), [""])  # missing, not failed
        file.write_text(text)
        program(*MOODY_STUDY)
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
        says = {"WrongShape": "one number for each of the", "WrongNumber": "the probability nan for pair 0 (allowed: 0 to 1)",
                "NoArray": "predict returned None", "KeepsObservation": "last_x_m of an earlier decision was asked for",
                "MisspeltColumn": "Observation has no 'pair_last_m'. Did you mean 'pair_last_seen_m'"}
        conditions = [clearway.Condition(name, policy="corridor", failure="B10", predictor=f"bad.py:{name}") for name in says]
        with self.assertWarns(RuntimeWarning):
            results = clearway.run("intersection", conditions, seeds=1, out="runs")
        for name, message in says.items():
            found = results.errors.where(condition=name)["message"][0]
            self.assertEqual(found.count(message), 1, found)
            self.assertRegex(found.splitlines()[0], r" \(bad.py, line \d+(, \w+\.predict)?\)$")
            self.assertNotIn(str(Path(clearway.__file__).parent), found)

    def test_links_evaluate_ends_with_the_traceback_of_a_predictor_that_fails(self) -> None:
        ended = subprocess.run([str(PROGRAMS / "clearway"), "links", "evaluate", "intersection", "--predictor", "bad.py:WrongShape",
                                "--failure", "B10", "--exits", "known", "--seeds", "1", "--validation-seeds", "1", "--out", "runs"],
                               capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("one number for each of the", ended.stderr)

    def test_a_policy_that_always_fails_is_told_once_and_has_no_empty_tables(self) -> None:
        self.write("mine.py", "import clearway\nclass Mine(clearway.Policy):\n    def act(self, belief):\n"
                              "        raise KeyError(f'no EV at {belief.time_s} s')\n")
        ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", "mine.py:Mine", "--seeds", "3",
                                "--out", "runs"], capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertEqual(ended.stderr.count("KeyError: "), 1, ended.stderr)
        self.assertRegex(ended.stderr, r"\n  runs/intersection/Mine/0 \(in 3 of 3 runs\): Mine of .*mine\.py: KeyError: 'no EV at .* s' "
                                       r"\(mine\.py, line 4\)\n    Traceback .*\n.*\n +raise KeyError\(.*\n"
                                       r"    in full: runs/errors/intersection/Mine/00000\.json\n")
        self.assertTrue((self.folder / "runs/errors/intersection/Mine/00000.json").is_file())
        self.assertEqual(ended.stderr.splitlines()[-1], "clearway: 3 of 9 runs failed, all of Mine (exit code 1)")
        self.assertIn("Mine: 3 of 3 runs failed; no verdict", ended.stdout)
        self.assertNotIn("Measure, condition", ended.stdout)
        self.assertNotIn("KeyError", ended.stdout)
        seen = subprocess.run(["stdbuf", "-oL", str(PROGRAMS / "clearway"), "report", "runs"], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False).stdout
        self.assertLess(seen.index("KeyError: "), seen.index("intersection: 3 replications"), "the cause comes first")
        self.assertNotIn("preemption is likely", seen)
        self.assertRegex(program("compare", "runs"), r"^Not paired: intersection/Mine: 3 of 3 runs failed or are missing\n")

    def test_two_kinds_of_failure_are_two(self) -> None:
        self.write("mine.py", "import clearway\nclass Mine(clearway.Policy):\n    def act(self, belief):\n"
                              "        if len(belief.vehicles) % 2:\n            raise ValueError('odd')\n"
                              "        raise ValueError('even')\n")
        ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", "mine.py:Mine", "--seeds", "8", "--no-solo",
                                "--out", "runs"], capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertEqual((ended.stderr.count("ValueError: odd"), ended.stderr.count("ValueError: even")), (1, 1), ended.stderr)

    def test_whatever_is_drawn_without_a_seed_is_drawn_again(self) -> None:
        drawn = set()
        for folder in ("one", "two"):
            says = r"2 runs failed; Draws in 2 of 2 runs: Draws of .*bad\.py, line \d+\); see `errors` of these results"
            with self.assertWarnsRegex(RuntimeWarning, says) as warned:
                results = clearway.run("intersection", [clearway.Condition("Draws", policy="bad.py:Draws")], seeds=2, out=folder)
            self.assertEqual(warned.filename, __file__, "the line that called it, not one of the package")
            drawn |= {message.splitlines()[0].rpartition("drawn")[2] for message in results.errors["message"]}
        self.assertEqual(len(drawn), 1)
        self.assertIn("0.844", drawn.pop())  # random.seed(0)

    def test_what_the_machine_did_to_a_part_is_tried_again_and_what_its_code_did_is_not(self) -> None:
        says = {"NoMemoryOnce": "Unable to allocate", "NoSpaceOnce": "No space left on device", "NoDescriptorsOnce": "Too many open files",
                "CaughtOnce": "the table does not fit", "SaidByTorchOnce": "can't allocate memory"}
        for name, message in says.items():
            (self.folder / "once").unlink(missing_ok=True)
            words = ["run", "intersection", "--policy", f"bad.py:{name}", "--no-solo", "--seeds", "1", "--out", name]
            program(*words, code=1)
            errors = clearway.open(name).errors
            self.assertEqual(list(errors["cause"]), ["machine"])
            self.assertIn("give the same command again", errors["message"][0])
            self.assertIn(message, errors["message"][0])
            program(*words)
            self.assertEqual(len(clearway.open(name).errors), 0)
        for _ in range(2):
            program("run", "intersection", "--policy", "bad.py:Crashes", "--no-solo", "--seeds", "1", "--out", "crashed", code=1)
            self.assertEqual(list(clearway.open("crashed").errors["cause"]), ["python"])
        self.assertEqual((self.folder / "tries").read_text(), "x")

    def test_errors_that_are_chained_in_a_circle_have_an_end(self) -> None:
        first, second = ValueError("first"), ValueError("second")
        first.__cause__, second.__cause__ = second, first
        self.assertFalse(is_of_machine(first))
        second.__cause__ = MemoryError()
        self.assertTrue(is_of_machine(first))

    def test_the_reasons_of_the_machine_are_those_of_the_programs(self) -> None:
        source = (SOURCE / "src/core/read_failure.cpp").read_text()
        named = re.search(r"reasons_of_machine = \{(.*?)\}", source)[1]
        self.assertEqual({getattr(errno, name) for name in named.split(", ")}, REASONS_OF_MACHINE)

    def test_a_file_that_the_machine_did_not_read_is_not_blamed_on_the_part(self) -> None:
        for reason in REASONS_OF_MACHINE:
            self.assertTrue(is_of_machine(refusal("data", reason)))
        for reason in (errno.ENOENT, errno.EACCES, errno.EISDIR):
            self.assertFalse(is_of_machine(refusal("data", reason)))

    def test_a_part_that_gets_no_memory_while_it_is_loaded_is_not_blamed(self) -> None:
        self.write("large.py", "raise MemoryError\n")
        ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", "large.py:Mine", "--out", "runs"],
                               capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 4, ended.stderr)
        self.assertIn("give the same command again: MemoryError", ended.stderr)

    def test_what_a_policy_starts_ends_with_it(self) -> None:
        conditions = [clearway.Condition(name, policy=f"bad.py:{name}") for name in ("Starts", "StartsAlone")]
        results = clearway.run("intersection", conditions, seeds=1, out="runs")
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

        def line_of(text: str) -> int:
            return FAULTS.split(text)[0].count("\n") + 1
        program("run", "intersection", "--policy", "bad.py:Takes", "--seeds", "1", "--dry-run")
        for word, says in (("nowhere.py:Mine", "nowhere.py is not a file"), ("bad.py:Mine", "has no class 'Mine'; it has Raises"),
                           ("bad.py:Raise", "Did you mean 'Raises'?"), ("bad.py:NoAct", "NoAct has no method act()"),
                           ("bad.py:Acts", "Acts has no method act(), which a policy needs. Did you mean 'acts'?"),
                           ("bad.py:Needs", ", Needs.__init__: within_m of __init__ has no default"),
                           ("bad.py:Inherits", "Inherits has no method act()"), ("bad.py", "FILE.py:CLASS"),
                           ("bad.py:NoBelief", f"bad.py, line {line_of('def act(self):')}, NoBelief.act: def act(self) (allowed: "
                                               "def act(self, belief))"),
                           ("bad.py:NoSelf", "NoSelf.act: def act() (allowed: def act(self, belief))"),
                           ("bad.py:BareInit", "BareInit.__init__: def __init__() (allowed: def __init__(self))"),
                           ("syntax.py:Mine", "SyntaxError: invalid syntax (syntax.py, line 1)\n"), ("raises.py:Mine", "OSError: no net here")):
            ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", word, "--out", "runs"],
                                   capture_output=True, text=True, check=False)
            self.assertEqual(ended.returncode, 3, ended.stderr)
            self.assertIn(says, ended.stderr)
            self.assertEqual("Traceback" in ended.stderr, word == "raises.py:Mine")
            self.assertNotIn("_host.py", ended.stderr)
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

    def test_a_part_that_ends_while_its_run_does_is_waited_for_once(self) -> None:
        with socket.socket(socket.AF_UNIX) as listener:
            nursery = Nursery(listener)
            ours, theirs = socket.socketpair()
            process = subprocess.Popen(["true"])
            os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
            handle = os.pidfd_open(process.pid)
            nursery._parts[process.pid] = handle, theirs
            for place in (handle, theirs):
                nursery._selector.register(place, selectors.EVENT_READ)
            with mock.patch("clearway._host.end_children"):
                nursery._ended(process.pid)
                nursery._left(process.pid)  # one look at the selector told both
            self.assertEqual((nursery._parts, nursery._overdue, len(ours.recv(9))), ({}, {}, 4))
            nursery._selector.close()
            ours.close()
            process.returncode = 0

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

    def test_a_run_whose_part_is_killed_from_outside_is_tried_again(self) -> None:
        for name in ("Orphan", "KilledOnce"):
            program("run", "intersection", "--policy", f"bad.py:{name}", "--no-solo", "--seeds", "1", "--out", name)
            self.assertEqual(len(clearway.open(name).errors), 0)

    def test_the_memory_of_a_part_and_of_what_it_starts_is_that_of_its_run(self) -> None:
        for part in ("Fills", "FillsElsewhere"):
            subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--policy", f"bad.py:{part}", "--no-solo", "--seeds", "1",
                            "--memory-limit", "500", "--out", part], capture_output=True, check=False, timeout=100)
            errors = clearway.open(part).errors
            self.assertEqual(list(errors["cause"]), ["memory"])
            self.assertIn("500 MiB", errors["message"][0])

    def test_a_part_that_does_not_answer_ends_with_the_time_limit(self) -> None:
        program("run", "intersection", "--policy", "bad.py:Sleeps", "--no-solo", "--seeds", "1", "--out", "runs", "--run-time-limit",
                "20", code=1)
        self.assertIn("did not end within", clearway.open("runs").errors["message"][0])
        time.sleep(1.5)
        self.assertEqual(hosts_of(self.folder), [])


if __name__ == "__main__":
    unittest.main()
