"""`python3 -m clearway.conformance` judges parts: what keeps the rules passes, and each rule is broken by a part made for it."""
import os
import re
import signal
import subprocess
import sys
import time
import unittest

from clearway.conformance import RULES
from support import FolderCase, SOURCE, program

GALLERY = SOURCE / "examples" / "python"

# The policies of docs/guides/python.md, and those that break rules.
POLICIES = """
import time
import numpy as np
import clearway
from clearway import Lease

class Green(clearway.Policy):
    def act(self, belief):
        return [Lease.hold_green(approach.signal, approach.links, approach.own_links, serves=ev)
                for ev in belief.emergency_vehicles for approach in ev.approaches if approach.distance_m < 100.0]

class Careless(clearway.Policy):
    "Finds EVs by their reports, asks everybody for too much, says where its objects are, and takes a row for a key."
    def act(self, belief):
        vehicles = belief.vehicles
        leases = [Lease.drive_at(vehicles.key[row], 80.0, serves=vehicles.key[there], reason=str(id(self)))
                  for there in np.flatnonzero(vehicles.vehicle_class == 2) if vehicles.lane_position_m[there] > 350.0
                  for row in range(len(vehicles)) if row != there and len(vehicles) > 4]
        return leases + [Lease.hold_lane(0)] * bool(leases)

class Eager(clearway.Policy):
    "Asks whoever is there, and fails where nobody reports."
    def act(self, belief):
        return [Lease.hold_lane(belief.vehicles.key[belief.vehicles.is_automated].tolist()[0])] if len(belief.vehicles.key) != 1 else []

class OneAtATime(clearway.Policy):
    def act(self, belief):
        return [lease for lease in Green().act(belief)] if len(belief.emergency_vehicles) == 1 else []

class NeedsReports(clearway.Policy):
    def act(self, belief):
        if belief.emergency_vehicles and not (belief.vehicles.vehicle_class == 2).any():
            raise KeyError("no EV reports")
        return Green().act(belief)

class Idle(clearway.Policy):
    def __init__(self, within_m=0.0):
        self.within_m = within_m
    def act(self, belief):
        return [Lease.hold_green(approach.signal, approach.links, serves=ev)
                for ev in belief.emergency_vehicles for approach in ev.approaches if approach.distance_m < self.within_m]

class Lost(clearway.Policy):
    "Names what no network has."
    def act(self, belief):
        return [lease for ev in belief.emergency_vehicles for approach in ev.approaches for lease in (
            Lease.hold_green(99, [0], serves=ev), Lease.hold_green(approach.signal, [500], serves=ev),
            Lease.hold_green(approach.signal, approach.links, [499], serves=ev), Lease.hold_green(approach.signal, [], serves=ev, lasting_s=61),
            Lease.change_lane(ev, 7, serves=ev), Lease.take_route(ev, [*ev.route, ev.route[0]], serves=ev),
            Lease.take_route(ev, ev.route[:1], serves=ev), Lease.hold_lane(ev, serves=5),
            *(Lease.take_route(key, ev.route) for key in belief.vehicles.key[belief.vehicles.is_automated]))]

class Endless(clearway.Policy):
    def act(self, belief):
        while belief.emergency_vehicles:
            pass
        return []

class Prints(clearway.Policy):
    def act(self, belief):
        print("seen", len(belief.vehicles))
        return Green().act(belief)

class Slow(clearway.Policy):
    def act(self, belief):
        open("begun", "w").close()
        time.sleep(0.5)
        return []

class Refuses(clearway.Policy):
    def act(self, belief):
        raise TimeoutError("its own server")

class Stays(clearway.Policy):
    "Asks for the lane that a vehicle is on, by its number or, wrongly, by its row in the network."
    def __init__(self, one_moves=False):
        self.one_moves = one_moves
    def act(self, belief):
        vehicles = belief.vehicles
        assert all(vehicles.lane_number[row] == belief.network.lane_number[vehicles.lane[row]] for row in range(len(vehicles))
                   if vehicles.lane[row] != clearway.parts.NO_LANE)
        numbers = 1 - vehicles.lane_number if self.one_moves else vehicles.lane_number
        return [Lease.change_lane(vehicles.key[row], int(numbers[row]), serves=ev) for ev in belief.emergency_vehicles
                for row in ev.ahead() if vehicles.is_automated[row] and vehicles.lane_number[row] in (0, 1)]

class Never:
    def predict(self, observation):
        return np.zeros(observation.pairs.shape[1])

class Chance:
    def predict(self, observation):
        return np.random.default_rng().random(observation.pairs.shape[1])
"""


class ConformanceTest(FolderCase):
    def setUp(self) -> None:
        super().setUp()
        self.write("parts.py", POLICIES)

    def judged(self, *words: object) -> subprocess.CompletedProcess:
        return subprocess.run([sys.executable, "-m", "clearway.conformance", *map(str, words)], capture_output=True, text=True, check=False,
                              timeout=120)

    def broken(self, *words: object) -> set[str]:
        """The rules that a part breaks; exit code and last line have to fit."""
        ended = self.judged(*words)
        self.assertEqual(ended.stderr, "")
        self.said = ended.stdout
        rules = set(re.findall(r"^  FAIL  (\w+)", ended.stdout, re.MULTILINE))
        self.assertEqual(ended.returncode, 1 if rules else 0, ended.stdout)
        self.assertRegex(ended.stdout.splitlines()[-1], rf"^{len(rules)} of \d+ rules broken$" if rules else "^all rules kept$")
        return rules

    def test_files_with_names_of_pythons_modules_hide_nothing_from_parts_and_are_named_where_they_hide_from_a_script(self) -> None:
        parts = self.write("mine.py", "import clearway\nclass Mine(clearway.Policy):\n    def act(self, belief):\n        return []\n")
        for module in ("numpy", "random", "signal", "struct", "typing"):
            self.write(f"{module}.py", "raise RuntimeError('not the one')\n")
            program("run", "intersection", "--policy", f"{parts.name}:Mine", "--no-solo", "--seeds", "1", "--out", module)
            if module != "signal":
                done = self.judged(f"{parts.name}:Mine")
                self.assertEqual(done.returncode, 1)
                self.assertIn(f"{module}.py hides the module of Python's of that name. Rename it", done.stderr)
            (self.folder / f"{module}.py").unlink()

    def test_examples_keep_all_rules(self) -> None:
        self.assertEqual(self.broken(GALLERY / "yield_policy.py:Yield"), set())
        self.assertRegex(self.said, r"time a decision: \d+\.\d\d ms, at most \d+\.\d ms \(")
        self.assertEqual(self.broken("parts.py:Green"), set())
        self.assertEqual(self.broken(GALLERY / "distance_predictor.py:ByDistance", "--predictor"), set())

    def test_each_rule_for_policies_is_broken_by_one_made_for_it(self) -> None:
        found = [self.broken("parts.py:Careless"), self.broken("parts.py:Eager"), self.broken("parts.py:OneAtATime"),
                 self.broken("parts.py:Stays"), self.broken("parts.py:Idle")]
        self.assertEqual(found, [{"possible", "humans", "lost", "same"}, {"answers", "no_ev", "no_need"}, {"two"}, {"lanes"},
                                 {"acts"}])
        self.assertEqual(set.union(*found), {rule.name for rule in RULES["policy"]})
        self.assertIn("it asked for nothing in any scene", self.said)
        self.assertRegex(self.said, r"- +lost +serves an EV whose reports are lost \(not judged\)")

    def test_what_a_part_prints_is_counted_and_shown_on_request(self) -> None:
        self.assertEqual(self.broken("parts.py:Prints"), set())
        decisions = re.search(r"(\d+) decisions", self.said)[1]
        self.assertIn(f"\n  printed: {decisions} lines; --all shows them\n", self.said)
        self.assertNotIn("seen", self.said)
        self.assertEqual(self.broken("parts.py:Prints", "--all"), set())
        self.assertEqual(self.said.count("\n    Prints| seen "), int(decisions))
        self.assertEqual(self.broken("parts.py:Green"), set())
        self.assertNotIn("printed:", self.said)

    def test_ctrl_c_ends_it_at_once(self) -> None:
        with subprocess.Popen([sys.executable, "-m", "clearway.conformance", "parts.py:Slow"], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
            while process.poll() is None and not (self.folder / "begun").exists():
                time.sleep(0.01)
            os.killpg(process.pid, signal.SIGINT)
            said = process.communicate(timeout=20)  # all scenes take a minute
        self.assertEqual((process.returncode, said), (130, ("", "clearway: interrupted; nothing was judged\n")))

    def test_an_error_of_several_lines_stands_before_the_advice(self) -> None:
        self.write("bad.py", "class Green:\n    def act(self, belief)\n        return []\n")
        ended = self.judged("bad.py:Green")
        self.assertEqual((ended.returncode, ended.stdout), (3, ""))
        first, *lines = ended.stderr.splitlines()
        self.assertTrue(first.endswith("SyntaxError: expected ':' (bad.py, line 2)"), ended.stderr)
        self.assertIn("    def act(self, belief)", lines)
        self.assertEqual(lines[-1], "  Correct the file or the settings")

    def test_own_lanes_may_be_asked_for_beside_others(self) -> None:
        self.assertEqual(self.broken("parts.py:Stays"), {"lanes"})
        self.assertRegex(self.said, r"change_lane for vehicle \d+: lane_number [01], and so each that it asks for")
        self.assertIn("belief.vehicles.lane is a row of all lanes of the network", self.said)
        self.assertEqual(self.broken("parts.py:Stays", "--set", "Stays.one_moves=true"), set())

    def test_what_follows_from_a_failure_is_not_held_against_a_part(self) -> None:
        self.assertEqual(self.broken("parts.py:NeedsReports"), {"answers"})
        self.assertRegex(self.said, r"- +lost .* \(not judged\)")

    def test_what_cannot_be_is_told_with_its_value_and_what_is_allowed(self) -> None:
        self.assertEqual(self.broken("parts.py:Careless", "--leave-out", "humans", "lost", "same"), {"possible"})
        self.assertRegex(self.said, r"an EV drives .*, \d+(\.\d)? s: drive_at for vehicle \d+: speed_mps 80 \(allowed: up to 16\.67, the limit")
        self.assertIn("vehicle 0 was never in a belief", self.said)
        self.assertIn("  -     lost", self.said)
        self.assertIn("possible", self.broken("parts.py:Lost", "--all"))
        for problem in ("signal 99 (allowed: 0 to 1", "link 500 of signal 0 (allowed: 0 to 15)", "own_links [499] (allowed: those of links [",
                        "links is empty", "lasting_s 61 (allowed: up to 60)", "lane_number 7 (allowed: 0 to 1", "serves 5 (allowed: an EV of the belief)",
                        "take_route for a vehicle that is no EV"):
            self.assertIn(problem, self.said)
        for problem in (r"edges: west_A does not follow \w+_\w+ \(allowed: those of belief.network.onward", r"edges end with west_A \(allowed: \w+_\w+, its"):
            self.assertRegex(self.said, problem)

    def test_a_loop_without_end_is_told_with_its_line_and_waited_for_once(self) -> None:
        self.assertIn("answers", self.broken("parts.py:Endless"))
        self.assertRegex(self.said, r"TimeoutError: no answer after 10 s \(parts.py, line \d+\)")
        self.assertEqual(self.said.count("TimeoutError: no answer"), 1)

    def test_a_part_that_always_raises_is_judged_by_that_alone(self) -> None:
        self.assertEqual(self.broken("parts.py:Refuses"), {"answers"})
        self.assertEqual(self.said.count("TimeoutError: its own server"), 1, "the same failure is told once")
        self.assertRegex(self.said, r"s and \d+ other scenes: ")  # it ends no scene but its own
        self.assertRegex(self.said, r"- +same +answers the same to the same \(not judged\)")
        self.assertRegex(self.said, r"- +acts .* \(not judged\)")

    def test_predictors_are_judged_too(self) -> None:
        self.assertEqual(self.broken("parts.py:Never", "--predictor"), {"links"})
        self.assertEqual(self.broken("parts.py:Chance", "--predictor"), {"same"})
        self.assertRegex(self.said, r"probability 0\.\d+ for pair 0, then 0\.\d+")

    def test_settings_reach_the_class(self) -> None:
        self.assertEqual(self.broken("parts.py:Idle", "--set", "Idle.within_m=90"), set())

    def test_what_no_run_takes_is_refused_with_its_words(self) -> None:
        for words, told in ((["nix.py:Green"], "nix.py is not a file"), (["parts.py"], "does not name a class (allowed: FILE.py:CLASS)"),
                            (["parts.py:Gren"], "has no class 'Gren'; it has Green, Careless"),
                            (["parts.py:Never"], "Never has no method act(), which a policy needs. Correct the file or the settings, or say "
                                                 "--predictor"),
                            (["parts.py:Idle", "--set", "Idle.within=1"], "Idle.within is unknown"),
                            (["parts.py:Idle", "--set", "within_m=1"], "--set within_m=1 (allowed: Idle.NAME=VALUE)"),
                            (["parts.py:Idle", "--leave-out", "act"], "Did you mean 'acts'?")):
            ended = self.judged(*words)
            self.assertEqual(ended.returncode, 3, words)
            self.assertIn(told, ended.stderr)
            self.assertTrue(ended.stderr.startswith("clearway: ") and ended.stderr.count("\n") == 1, ended.stderr)
            self.assertEqual(ended.stdout, "")


if __name__ == "__main__":
    unittest.main()
