"""Runs, tables, paired differences and recordings, against the program's own tables and sums made here."""
import csv
import dataclasses
import errno
import io
import json
import math
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

import clearway
import clearway.recording as recording_module
import numpy as np
from support import PROGRAMS, FolderCase, Terminal, program, told_when

T_975_4 = 2.7764451051977987  # Student's t, 4 degrees of freedom


class ResultsTest(FolderCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.holder = tempfile.TemporaryDirectory(prefix="clearway-test-")
        cls.addClassCleanup(cls.holder.cleanup)
        cls.results = clearway.run("intersection", ["corridor"], seeds=5, out=os.path.join(cls.holder.name, "runs"), record=True)

    def test_tables_are_those_of_the_program(self) -> None:
        for name in ("runs", "vehicles", "leases"):
            lines = list(csv.DictReader(io.StringIO(program("export", "results", str(self.results.folder), name, "--csv"))))
            table = self.results.table(name)
            self.assertEqual((table.row_count, list(table)), (len(lines), list(lines[0])), name)
            self.assertIs(getattr(self.results, name), table)
            for column, array in table.items():
                for cell, value in zip((line[column] for line in lines), array):
                    if array.dtype.kind == "U":
                        self.assertEqual(cell, value, column)
                    else:
                        self.assertTrue(math.isnan(value) if cell == "" else math.isclose(float(cell), value, rel_tol=1e-12), column)

    def test_every_kind_of_factor_is_the_same_in_csv_sqlite_json_and_python(self) -> None:
        self.write("mine.py", "class Mine:\n    def __init__(self, on=True, word='a'):\n        pass\n"
                              "    def act(self, belief):\n        return []\n")
        # Kind of each column and the texts of its values; `set` is a factor that sets several.
        conditions = {"condition.policy": (str, {"clear_lane", "clear_lane.preempt_signals"}), "preempt_signals.lead_s": (float, {"8", "12.5"}),
                      "Mine.on": (str, {"true", "false"}), "Mine.word": (str, {"12", "a"}),
                      "clear_lane.horizon_m": (float, {"150"}), "clear_lane.beside_m": (float, {"20"})}
        scenarios = {"condition.failure": (str, {"perfect", "B10"}), "scenario.friction": (float, {"1", "0.4"})}
        for name, columns, factors in (
                ("conditions", conditions, 'design = "one_at_a_time"\ncondition.policy = [["clear_lane"], ["clear_lane", "preempt_signals"]]\n'
                 'preempt_signals.lead_s = [8, 12.5]\nMine.on = [true, false]\nMine.word = ["12", "a"]\n'
                 'set = [{ "clear_lane.horizon_m" = 150, "clear_lane.beside_m" = 20 }]\n'),
                ("scenarios", scenarios, 'condition.failure = ["perfect", "B10"]\nscenario.friction = [1.0, 0.4]\n')):
            own = '[[condition]]\nname = "mine"\npolicy = ["mine.py:Mine"]\n' if name == "conditions" else ""
            self.write("study.toml", f'replications = 1\nscenarios = ["intersection"]\nconditions = ["baseline"]\n[[condition]]\n'
                                     f'name = "lanes"\npolicy = ["corridor"]\n{own}[factors]\n{factors}')
            results = clearway.study("study.toml", out=name)
            self.assertEqual(results.errors.row_count, 0)
            for column, (kind, values) in columns.items():
                self.check_factor(results, column, kind, values)
        with self.assertRaisesRegex(clearway.InputError, r"\. where\(\*\*\{'condition.failure': 'B10'\}\) chooses by factor"):
            results.runs.where(condition="B10")
        self.assertEqual(results.runs.where(**{"condition.failure": "B10", "scenario.friction": 0.4}).row_count, 1)
        with self.assertRaisesRegex(clearway.InputError, "no condition.failure 'B1O'; it has B10, perfect"):
            results.runs.where(**{"condition.failure": "B1O"})
        failing = results.vehicles.where(**{"condition.failure": "B10"})  # no column there
        self.assertEqual(set(failing["condition"]), set(results.runs.where(**{"condition.failure": "B10"})["condition"]))
        self.assertGreater(failing.row_count, 0)
        with self.assertRaisesRegex(clearway.InputError, "no condition.failure 'B1O'"):
            results.vehicles.where(**{"condition.failure": "B1O"})

    def check_factor(self, results: clearway.Results, column: str, kind: type, values: set[str]) -> None:
        """A column of factors has the same values in each row of each table, and all of ``values``."""
        lines = list(csv.DictReader((results.folder / "runs.csv").read_text().splitlines()))
        printed = json.loads(program("export", "results", str(results.folder), "runs", "--json"))
        connection = sqlite3.connect(results.folder / "results.sqlite")
        self.addCleanup(connection.close)
        stored = [row[0] for row in connection.execute(f'SELECT "{column}" FROM runs ORDER BY scenario, condition')]
        for value, line, row, cell in zip(results.runs[column], lines, printed, stored, strict=True):
            if line[column] == "":
                self.assertEqual((row[column], cell), (None, None))
                self.assertTrue(value == "" if kind is str else math.isnan(value))
            else:
                self.assertEqual((kind(value), kind(row[column]), kind(cell)), (kind(line[column]),) * 3)
                self.assertEqual(isinstance(cell, str), kind is str)
        self.assertEqual({line[column] for line in lines} - {""}, values)

    def test_head_and_a_notebook_show_the_first_rows(self) -> None:
        runs = self.results.runs
        self.assertEqual((runs.head().row_count, runs.head(3).row_count, runs.head(10**6).row_count), (5, 3, 10))
        self.assertEqual(list(runs.head(2)["condition"]), list(runs["condition"][:2]))
        for count in (-1, 1.5, True):
            self.assertIn("allowed: a number of rows", self.message_of(clearway.InputError, lambda: runs.head(count)))
        shown = self.results.vehicles._repr_html_()
        self.assertEqual(shown.count("<tr>"), 1 + 10)
        self.assertIn(f"{self.results.vehicles.row_count} rows", shown)
        table = clearway.Table({"a<b": np.array(["<x>", "y"]), "n": np.array([1.0 / 3.0, math.nan])})
        self.assertIn("<tr><th>a&lt;b</th><th>n</th></tr>", table._repr_html_())
        self.assertIn("<tr><td>&lt;x&gt;</td><td>0.333333</td></tr><tr><td>y</td><td></td></tr>", table._repr_html_())
        self.assertIn("<p>0 rows, 0 columns</p>", clearway.Table({})._repr_html_())
        whole = self.results._repr_html_()
        self.assertIn("<li>intersection: corridor - Baseline, emergency_restricted_travel_time_s: ", whole)
        self.assertIn(runs._repr_html_(), whole)

    def printed(self, table: clearway.Table, columns: int = 80) -> list[str]:
        with mock.patch.dict(os.environ, COLUMNS=str(columns)):
            lines = str(table).splitlines()
        self.assertLessEqual(max(map(len, lines[:-1])), columns)
        return lines

    def test_reasons_and_messages_are_shown_and_conditions_by_their_titles(self) -> None:
        class Titles:
            def title_of(self, name: str) -> str:
                return "Ours, B10" if name == "p+failure=B10+policy=my.py_Mine" else name
        rows = 12
        keys = {"scenario": np.array(["intersection"] * rows), "condition": np.array(["p+failure=B10+policy=my.py_Mine", "baseline"] * 6),
                "replication": np.arange(rows)}
        leases = clearway.Table({**keys, "policy": np.array(["Mine"] * rows), "action": np.array(["hold_green", "change_lane"] * 6),
                                 "outcome": np.array(["refused"] * rows), "reason": np.array(["not_controllable", ""] * 6),
                                 "leases": np.arange(rows)}, conditions=Titles())  # type: ignore[arg-type]
        names, first, *_ = self.printed(leases)
        self.assertEqual(names.split()[:5], ["title", "replication", "outcome", "reason", "leases"])
        self.assertTrue(first.startswith("Ours, B10  "), first)
        self.assertEqual(leases["condition"][0], "p+failure=B10+policy=my.py_Mine")
        errors = clearway.Table({**keys, "cause": np.array(["python"] * rows), "message": np.array(["TypeError: " + "x" * 90] * rows)})
        names, first, *_ = self.printed(errors)
        self.assertEqual(names.split(), ["condition", "replication", "cause", "message"])
        self.assertRegex(first, r"0  python +TypeError: x+\.\.x+$")
        vehicles = clearway.Table({**keys, "class": np.array(["EV"] * rows), "id": np.array(["emergency.0", "human.1"] * 6)})
        self.assertEqual(self.printed(vehicles.head())[0].split()[3], "id")

    def test_an_array_of_truth_values_chooses_rows(self) -> None:
        runs = self.results.runs
        chosen = runs[runs["condition"] == "baseline"]
        self.assertEqual(list(chosen["replication"]), list(runs.where(condition="baseline")["replication"]))
        for wrong in (np.array([True]), np.array([0, 1])):
            self.assertIn("allowed: a truth value for each of 10 rows; where(COLUMN=VALUE)",
                          self.message_of(clearway.InputError, lambda: runs[wrong]))

    def test_a_printed_table_shows_rows_as_wide_as_the_terminal(self) -> None:
        runs, metric = self.results.runs, "emergency_restricted_travel_time_s"
        names, first, *others, last = self.printed(runs.head())
        self.assertEqual(names.split(), ["scenario", "condition", "replication", metric])
        self.assertEqual(first.split(), ["intersection", "baseline", "0", f"{runs[metric][0]:.6g}"])
        self.assertEqual((len(others), last), (4, f"[5 rows, 4 of {len(list(runs))} columns: list(table) names all, table.head(5, NAME, ...) "
                                                  "shows one]"))
        self.assertGreater(len(self.printed(runs, 200)[0].split()), 6)
        self.assertTrue(self.printed(runs.where(condition="corridor"))[-1].startswith("[5 rows, "))
        self.assertTrue(self.printed(self.results.vehicles)[-1].startswith(f"[10 of {len(self.results.vehicles)} rows, "))
        chosen = runs.head(2, "collisions", "study_seed")
        self.assertEqual(list(chosen), ["scenario", "condition", "replication", "collisions", "study_seed"])
        self.assertEqual(self.printed(chosen)[-1], "[2 rows, 5 columns]")
        with mock.patch.dict(os.environ, COLUMNS="20"):  # what was asked for is shown on any terminal
            self.assertIn("study_seed", str(chosen))
        self.assertEqual(list(runs[["condition", "collisions"]]), ["condition", "collisions"])
        self.assertIn("Did you mean 'collisions'", self.message_of(clearway.InputError, lambda: runs.head(2, "colisions")))
        self.assertEqual(("nothing" in runs, "collisions" in runs, runs.get("nothing", 3)), (False, True, 3))
        self.assertIn("there is no column {}", self.message_of(clearway.InputError, lambda: runs[{}]))

    def test_long_names_of_conditions_are_shortened_and_lines_kept_whole(self) -> None:
        table = clearway.Table({"condition": np.array(["policy+failure=B10+policy=my_policy.py_Green", "baseline"]),
                                "condition.failure": np.array(["B10", ""]), "message": np.array(["one\ntwo " + "x" * 90, "short"]),
                                "same": np.array([1.0, 1.0]), "number": np.array([math.nan, 2.5])})
        names, first, second, _ = self.printed(table)
        self.assertEqual(names.split()[0], "condition")
        self.assertTrue(first.startswith("policy+..B10+..my_policy.py_Green  one two xx"), first)
        self.assertIn("x..x", first)
        self.assertEqual(self.printed(table, 200)[1].split()[0], "policy+failure=B10+policy=my_policy.py_Green")
        self.assertEqual(self.printed(table, 200)[0].split()[-1], "same")  # what says least comes last
        self.assertEqual(second.split()[:2], ["baseline", "short"])
        self.assertEqual(str(clearway.Table({})), "<Table without columns>")

    def test_of_many_names_the_nearest_are_told(self) -> None:
        message = self.message_of(clearway.InputError, lambda: self.results.runs["emergency_travel_time"])
        self.assertTrue(message.startswith("there is no column 'emergency_travel_time'. Did you mean 'emergency_travel_time_s' or "), message)
        self.assertTrue(message.endswith(f"? list(table) names all {len(list(self.results.runs))} columns"), message)
        self.assertLess(len(message), 250)
        self.assertEqual(self.message_of(clearway.InputError, lambda: self.results.runs["xyzzy"]),
                         f"there is no column 'xyzzy'. It has scenario, condition, replication and others. list(table) names all "
                         f"{len(list(self.results.runs))} columns")

    def test_a_policy_is_looked_for_where_it_stands(self) -> None:
        where = self.results.runs.where
        for value in ("corridor", "dissertation"):
            self.assertEqual(self.message_of(clearway.InputError, lambda: where(policy=value)),
                             f"there is no column 'policy'. Did you mean 'condition'? where(condition={value!r}) chooses by it")
        table = clearway.Table({"condition": np.array(["a"]), "condition.policy": np.array(["corridor"])})
        self.assertIn("Did you mean 'condition.policy'? where(**{'condition.policy': 'corridor'}) chooses by it",
                      self.message_of(clearway.InputError, lambda: table.where(policy="corridor")))

    def test_event_logs_of_signals_are_tables(self) -> None:
        for name in ("signals", "signal_events"):
            lines = list(csv.DictReader(io.StringIO(program("export", "results", str(self.results.folder), name, "--csv"))))
            table = self.results.table(name)
            self.assertEqual((table.row_count, list(table)), (len(lines), list(lines[0])), name)
            self.assertEqual(set(table["condition"]), {"corridor"})

    def test_what_is_misspelt_names_the_nearest(self) -> None:
        for call, meant in ((lambda: self.results.runs["emergency_travel_time"], "emergency_travel_time_s"),
                            (lambda: self.results.table("vehicle"), "vehicles"),
                            (lambda: self.results.paired_difference("emergency_travel_time", "corridor"), "emergency_travel_time_s")):
            self.assertIn(f"Did you mean '{meant}'", self.message_of(clearway.InputError, call))

    def test_where_and_pandas(self) -> None:
        corridor = self.results.runs.where(condition="corridor", replication=2)
        self.assertEqual((corridor.row_count, len(corridor)), (1, 1))
        self.assertEqual(len(self.results.runs.where(replication=77)), 0)
        self.assertIn("the study has no condition 'coridor'; it has baseline, corridor",
                      self.message_of(clearway.InputError, lambda: self.results.runs.where(condition="coridor")))
        frame = self.results.vehicles.to_pandas()
        columns = list(self.results.vehicles)
        columns.insert(columns.index("condition") + 1, "title")
        self.assertEqual(list(frame.columns), columns)
        self.assertEqual(len(frame), self.results.vehicles.row_count)
        titled = clearway.run("merge", [clearway.Condition("mine", policy="clear_lane", title="Ours")], seeds=1, out="titled")
        frame = titled.runs.to_pandas()
        self.assertEqual(list(frame.columns)[:3], ["scenario", "condition", "title"])
        self.assertEqual(dict(zip(frame["condition"], frame["title"])), {"mine": "Ours", "baseline": "Baseline"})

    def test_a_paired_difference_is_the_mean_with_its_interval(self) -> None:
        metric = "emergency_travel_time_s"
        runs = self.results.runs
        pairs = runs.where(condition="corridor")[metric] - runs.where(condition="baseline")[metric]
        half = T_975_4 * pairs.std(ddof=1) / math.sqrt(5)
        found = self.results.paired_difference(metric, "corridor")
        self.assertAlmostEqual(found.difference, pairs.mean(), places=9)
        self.assertAlmostEqual(found.interval_95[0], pairs.mean() - half, places=6)
        self.assertAlmostEqual(found.interval_95[1], pairs.mean() + half, places=6)
        self.assertEqual((found.complete_pairs, found.compared_with), (5, "baseline"))
        self.assertIn("corridor - Baseline", str(found))
        turned = self.results.paired_difference(metric, "baseline", against="corridor")
        self.assertAlmostEqual(turned.difference, -found.difference, places=9)
        self.assertEqual(turned.compared_with, "corridor")
        self.assertEqual((found.locked_pairs, found.difference_without_locks), (0, None))

    def test_a_recording_is_what_replay_prints(self) -> None:
        file = self.results.folder / "recordings/intersection/corridor/00000.h5"
        lines = csv.DictReader(io.StringIO(program("replay", str(file), "--csv", "snapshot")))
        printed = {(float(line["time_s"]), line["vehicle"]): np.float32(line["x_m"]) for line in lines}
        with clearway.trace(file) as recording:
            read = {(step.time_s, name): x_m for step in recording for name, x_m in zip(step.id, step.x_m)}
            asked = sum(len(step.leases["policy"]) for step in recording)
            self.assertEqual(len(recording[-1].id), len(recording[len(recording) - 1].id))
        self.assertEqual(len(read), len(printed))
        self.assertTrue(read == printed)
        self.assertEqual(asked, program("replay", str(file), "--csv", "leases").count("\n") - 1)

    def test_leases_and_events_of_a_recording_lack_what_the_program_leaves_empty(self) -> None:
        file = self.results.folder / "recordings/intersection/corridor/00000.h5"
        with clearway.trace(file) as recording:
            steps = [step.leases for step in recording]
            events, names = recording.events, {"event": "kind", "other_vehicle": "other"}
        leases = {name: np.concatenate([step[name] for step in steps]) for name in steps[0]}
        self.assertGreater(len(set(leases["action"])), 2)
        for table, kind, apart in ((leases, "leases", {"time_s", "signal", "stretch_lane"}), (dict(events), "events", {"lane"})):
            lines = list(csv.DictReader(io.StringIO(program("replay", str(file), "--csv", kind))))
            for column in set(lines[0]) - {"time_s"}:
                for line, value in zip(lines, table[names.get(column, column)], strict=True):
                    is_missing = value == "" if isinstance(value, str) else math.isnan(value)
                    self.assertEqual(line[column] == "", is_missing, (column, line, value))
                    if not is_missing and column not in apart:  # lanes and signals are numbers here
                        said = line[column] if isinstance(value, str) else float(line[column])
                        self.assertTrue(said == value or math.isclose(said, value, rel_tol=1e-6), (column, line, value))
        for table in (leases, dict(events), dict(self.results.events)):
            self.assertFalse([name for name, values in table.items() if values.dtype.kind in "iuf" and (values > 4e9).any()])
        self.assertEqual(set(events["place"]), {""})
        self.assertEqual(events["lane"].dtype, np.float64)

    def test_a_missing_number_is_nan_and_whole_numbers_without_one_stay_whole(self) -> None:
        lanes = np.array([3, recording_module.NONE], np.uint32)
        some = recording_module._only_where(lanes != recording_module.NONE, lanes)
        self.assertEqual((some.dtype, some[0], math.isnan(some[1])), (np.float64, 3.0, True))
        every = recording_module._only_where(lanes[:1] != recording_module.NONE, lanes[:1])
        self.assertEqual((every.dtype, every.tolist()), (np.int64, [3]))

    def test_events_of_all_recordings(self) -> None:
        events = self.results.events
        self.assertEqual(events.where(condition="Baseline").row_count, events.where(condition="baseline").row_count)
        self.assertIn("no condition 'coridor'", self.message_of(clearway.InputError, lambda: events.where(condition="coridor")))
        arrived = (events["kind"] == "arrived") & (events["condition"] == "corridor") & (events["replication"] == 1)
        run = self.results.runs.where(condition="corridor", replication=1)
        outcome = self.results.vehicles.where(condition="corridor", replication=1)["outcome"]
        # Vehicles that were there before the fork are in no recording as departed, but all arrive in it or were counted before.
        self.assertLessEqual(arrived.sum(), (outcome == "arrived").sum())
        self.assertGreater(arrived.sum(), 0.5 * run["arrived"][0])

    def test_the_same_call_repeats_nothing(self) -> None:
        before = {file: file.stat().st_mtime_ns for file in self.results.folder.glob("runs/*/*/*/run.json")}
        clearway.run("intersection", ["corridor"], seeds=5, out=self.results.folder, record=True)
        self.assertEqual(before, {file: file.stat().st_mtime_ns for file in before})
        self.assertEqual(len(before), 10)
        for stream, shown in ((Terminal(), True), (io.StringIO(), False)):
            with mock.patch("sys.stderr", stream):
                clearway.run("intersection", ["corridor"], seeds=5, out=self.results.folder, record=True)
            self.assertEqual("10/10" in stream.getvalue(), shown, stream.getvalue())

    def test_wrong_names_are_told_with_what_there_is(self) -> None:
        for call, says in ((lambda: self.results.table("nothing"), "it has"),
                           (lambda: self.results.runs["nothing"], "It has scenario"),
                           (lambda: self.results.paired_difference("nothing_s", "corridor"), "nothing_s"),
                           (lambda: self.results.paired_difference("collisions", "mine"), "no condition 'mine'; it has baseline, corridor"),
                           (lambda: self.results.paired_difference("collisions", "baseline"), "'baseline': is not compared with a baseline: one of the two is a reference"),
                           (lambda: self.results.paired_differences("collisions", "mine"), "no condition 'mine'; it has baseline, corridor"),
                           (lambda: self.results.paired_difference("collisions", {"condition.policy": "a"}), "no factor 'condition.policy'"),
                           (lambda: clearway.open("no-folder"), "no-folder"),
                           (lambda: clearway.trace("no.h5"), "no.h5: cannot be read: No such file or directory. Check"),
                           (lambda: clearway.trace(__file__), "is not a recording"),
                           (lambda: clearway.study("no.toml"), "no.toml"),
                           (lambda: clearway.run("intersectoin", seeds=1), "intersectoin"),
                           (lambda: clearway.run("intersection", ["coridor"], seeds=1), "corridor"),
                           (lambda: clearway.run("intersection", [3], seeds=1), "neither a name nor"),
                           (lambda: clearway.run("intersection", seeds=0), "seeds: 0"),
                           (lambda: clearway.run("intersection", seeds=None), "seeds: None"),
                           (lambda: clearway.run("intersection", seeds=[1, 2]), "seeds: [1, 2]"),
                           (lambda: clearway.run("intersection", seed=-1), "seed: -1"),
                           (lambda: clearway.run("intersection", None), "None is neither a name nor"),
                           (lambda: clearway.run(None), "scenario is None"),
                           (lambda: clearway.run("intersection", [clearway.Condition("a", policy=3)]), "is 3"),
                           (lambda: clearway.run("intersection", [clearway.Condition("a", set=["b"])]), "set is ['b']"),
                           (lambda: clearway.run("intersection", seeds=1, step_length_s=None), "None cannot be part of"),
                           (lambda: self.results.paired_difference("collisions", "corridor", scenario="intersectoin"),
                            "no scenario 'intersectoin'"),
                           (lambda: self.results.runs.where(condition=3), "compared with 3 (allowed: a text)"),
                           (lambda: self.results.paired_difference(3, "corridor"), "`3` is unknown"),
                           (lambda: clearway.open("--help"), "is not a run folder")):
            message = self.message_of(clearway.InputError, call)
            self.assertIn(says, message)
            self.assertNotIn("study.toml", message)  # nobody wrote that file

    def test_keywords_that_a_call_does_not_have_name_the_nearest(self) -> None:
        condition = "conditions=[clearway.Condition(NAME, policy=...)]"
        for call, says in ((lambda: clearway.run("intersection", [], dense=True), "run() has no keyword 'dense'. Did you mean variant=\"dense\"?"),
                           (lambda: clearway.run("intersection", [], recrod=True), "run() has no keyword 'recrod'. Did you mean 'record'"),
                           (lambda: clearway.run("intersection", [], seeds=1, step_lenght_s=1), "Did you mean 'step_length_s'?"),
                           (lambda: clearway.run("intersection", [], replications=1), "Did you mean 'seeds'?"),
                           (lambda: clearway.run("intersection", seeds=1, policy="corridor"), f"Did you mean {condition}?"),
                           (lambda: clearway.run("intersection", seeds=1, xyzzy=1), "'xyzzy'; it has scenario, conditions, seeds, "),
                           (lambda: clearway.run("intersection", seeds=1, variant="dens"), "allowed: standard, dense"),
                           (lambda: clearway.study("a.toml", recrod=True), "study() has no keyword 'recrod'. Did you mean 'record'? The file says"),
                           (lambda: clearway.study("a.toml", seeds=3), "study() has no keyword 'seeds'; it has file, out, "),
                           (lambda: clearway.Condition("a", polcy="corridor"), "Condition() has no keyword 'polcy'. Did you mean 'policy'?"),
                           (lambda: clearway.env("intersection", seed=3), "env() has no keyword 'seed'. Did you mean 'seeds' or"),
                           (lambda: clearway.env("intersection", dense=True), "env() has no keyword 'dense'. Did you mean variant=\"dense\"?"),
                           (lambda: clearway.env("intersection", variants="dense"), "Did you mean 'variant'?"),
                           (lambda: clearway.parallel_env("intersection", seed=3), "env() has no keyword 'seed'. Did you mean 'seeds' or"),
                           (lambda: clearway.vector_env("intersection", 1, seed=3), "env() has no keyword 'seed'. Did you mean 'seeds' or"),
                           (lambda: clearway.run("intersection", [clearway.Condition("a", set={"G.leads": [1, 2]})], seeds=1),
                            "condition a: set: G.leads is [1, 2] (allowed: a number")):
            message = self.message_of(clearway.InputError, call)
            self.assertIn(says, message)
            self.assertLess(len(message), 260)

    def test_seeds_are_a_number_or_its_range(self) -> None:
        folder = self.results.folder
        self.assertEqual(clearway.run("intersection", ["corridor"], seeds=range(5), out=folder, record=True).runs.row_count, 10)
        for seeds in (range(1, 5), range(0, 9, 2), [0, 1], range(0)):
            message = self.message_of(clearway.InputError, lambda: clearway.run("intersection", seeds=seeds))
            self.assertIn("allowed: a whole number from 1 to 100000", message)
            self.assertEqual("or range(N): a run takes the replications from 0 on; clearway.env takes chosen ones)" in message, len(seeds) > 0)

    def test_a_condition_has_every_key_of_a_study_file(self) -> None:
        given = {"traffic_model": "sublane", "bluelight": True, "safety_checks": False, "rerouting_s": 30, "rerouting_signal_penalty": 0.5}
        conditions = [clearway.Condition("plain", traffic_model="sublane"), clearway.Condition("own", **given)]
        results = clearway.run("intersection", conditions, seeds=1, baseline=False, out="runs")
        self.assertEqual(results.study, json.loads((results.folder / "manifest.json").read_text(encoding="utf-8")))
        self.assertEqual((results.study["study"], results.study["replications"]), ("intersection", 1))
        stored = results.study["conditions"][1]
        said = {key: {"on": True, "off": False}.get(value, value) for key, value in stored.items() if key in given}
        self.assertEqual(said, given)
        names = {field.name for field in dataclasses.fields(clearway.Condition)} | {"policies"}  # policy
        self.assertEqual(set(stored) - names, set())
        nobody_calls = self.message_of(clearway.InputError, lambda: clearway.run(
            "intersection", [clearway.Condition("own", dispatch="believed")], seeds=1, out="other"))
        self.assertIn("dispatch", nobody_calls)

    def test_numbers_of_numpy_are_numbers(self) -> None:
        results = clearway.run("intersection", [], seeds=np.int64(1), step_length_s=np.float64(0.5), out="runs")
        self.assertEqual(results.runs.row_count, 1)

    def test_folders_may_have_any_name(self) -> None:
        folder = self.folder / "ü n%20?#ö"
        shutil.copytree(self.results.folder, folder)
        self.assertEqual(clearway.open(folder).runs.row_count, self.results.runs.row_count)
        self.assertEqual([one.name for one in self.folder.iterdir()], [folder.name])

    def test_a_study_that_is_not_text_is_told(self) -> None:
        (self.folder / "study.toml").write_bytes(b"name = \xff\n")
        self.assertIn("is not UTF-8", self.message_of(clearway.InputError, lambda: clearway.study("study.toml")))

    def test_a_recording_is_found_by_the_name_of_its_run(self) -> None:
        with clearway.trace(f"{self.results.folder}/intersection/corridor/0") as recording:
            self.assertEqual(recording.file.name, "00000.h5")
        self.assertIn("recordings/intersection/corridor/00099.h5: cannot be read", self.message_of(
            clearway.InputError, lambda: clearway.trace(f"{self.results.folder}/intersection/corridor/99")))

    def test_what_the_package_hands_out_stands_for_its_path(self) -> None:
        with self.results.recording("intersection", "corridor") as recording, clearway.trace(recording) as again:
            self.assertEqual((again.file, len(again)), (recording.file, len(recording)))
            for call in (clearway.trace, clearway.open, clearway.dataset, clearway.study):
                self.assertIn("file is a Table (allowed: a path" if call in (clearway.trace, clearway.study) else "folder is a Table (allowed",
                              self.message_of(clearway.InputError, lambda: call(self.results.runs)))
            self.assertIn(f"file is {recording[0]!r} (allowed: a path", self.message_of(clearway.InputError, lambda: clearway.trace(recording[0])))
        self.assertEqual(clearway.open(self.results).folder, self.results.folder)
        self.assertIn("is a folder (allowed: the file of a recording, or a run: FOLDER/SCENARIO/CONDITION/REPLICATION). "
                      "clearway.open(FOLDER).recording(", self.message_of(clearway.InputError, lambda: clearway.trace(self.results)))
        self.assertIn("holds neither *.samples nor", self.message_of(clearway.InputError, lambda: clearway.dataset(self.results)))
        self.assertIn(f"{self.results.folder}: cannot be read: Is a directory",
                      self.message_of(clearway.InputError, lambda: clearway.study(self.results)))
        for keyword, given in (("benchmark", 3), ("models", {"net": 3})):
            self.assertIn(f"{keyword} is 3 (allowed: a path",
                          self.message_of(clearway.InputError, lambda: clearway.links.evaluate("intersection", **{keyword: given})))

    def interrupted(self, program_folder: str, begun: str) -> str:
        """What Python says at Ctrl-C, which reaches the program, too, once there is a file of this pattern."""
        code = "import clearway\nclearway.run('intersection', ['corridor'], seeds=20, out='runs/c', jobs=1, progress=True)\n"
        with subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True, start_new_session=True,
                              env={**os.environ, "CLEARWAY_PROGRAMS": program_folder}) as process:
            while process.poll() is None and not list(self.folder.glob(begun)):
                time.sleep(0.01)
            os.killpg(process.pid, signal.SIGINT)
            said = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, -signal.SIGINT, said)
        self.assertNotIn("Exception in thread", said)
        self.assertNotIn("To continue", said, "its command is not the user's")
        self.assertEqual(said.count("Traceback"), 1, said)
        return said.splitlines()[-1]

    def test_ctrl_c_says_how_to_go_on_and_the_same_call_does(self) -> None:
        said = self.interrupted(str(PROGRAMS), "runs/c/runs/intersection/*/*")
        self.assertRegex(said, r"^KeyboardInterrupt: interrupted with \d+ of 40 runs complete; they are kept in runs/c\. The same call continues$")
        done = int(said.split()[3])
        with mock.patch("sys.stderr", Terminal()) as told:
            self.assertEqual(clearway.run("intersection", ["corridor"], seeds=20, out="runs/c").runs.row_count, 40)
        self.assertIn("40/40", told.getvalue())
        self.assertLess(done, 40)
        self.write("clearway", f"#!/bin/sh\ntouch '{self.folder}/begun'\nexec sleep 60\n").chmod(0o755)  # silent
        self.write("clearway-run", "").chmod(0o755)
        self.assertEqual(self.interrupted(str(self.folder), "begun"),
                         "KeyboardInterrupt: interrupted. What is complete is kept in runs/c. The same call continues")

    def test_ctrl_c_that_comes_twice_says_it_once(self) -> None:
        code = "from clearway import run; print('begun', flush=True); run('intersection', ['corridor'], seeds=40, jobs=1)"
        for after_s in (0.05, 0.1, 0.3, 1.0, 2.0):
            with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                  start_new_session=True) as process:
                process.stdout.readline()
                time.sleep(after_s)
                for _ in range(2):  # as timeout -s INT does: to the process, then to its group
                    process.send_signal(signal.SIGINT)
                    os.killpg(process.pid, signal.SIGINT)
                said = process.communicate(timeout=60)[1]
            self.assertNotIn("During handling", said)
            self.assertEqual(said.count("Traceback"), 1, said)
            self.assertRegex(said.splitlines()[-1], r"^KeyboardInterrupt: interrupted.* The same call (continues|starts again)$")
            if after_s >= 1.0:
                self.assertRegex(said.splitlines()[-1], r"kept in runs/intersection-\w{6}\. The same call continues$")

    def test_damaged_and_closed_recordings_are_told(self) -> None:
        with self.results.recording("intersection", "corridor") as recording:
            whole = recording.file.read_bytes()
            start = recording._file["snapshot/x_m"].id.get_chunk_info(0).byte_offset
            with self.assertRaisesRegex(AttributeError, "no 'x_km'. Did you mean 'x_m'.* It has acceleration_mps2, .*vehicle_class"):
                _ = recording[0].x_km
            with self.assertRaisesRegex(AttributeError, "Recording has no 'event'. Did you mean 'events'"):
                _ = recording.event
        for closed in (lambda: recording[0].x_m, lambda: recording[0].leases, lambda: recording.events):
            self.assertIn("is closed", self.message_of(clearway.ClearwayError, closed))
        for at in (100, 512 + 200, start, len(whole) - 1):  # of the seal, of HDF5's structure, of numbers
            changed = bytearray(whole)
            changed[at] ^= 1
            (self.folder / "bad.h5").write_bytes(changed)
            self.assertIn("bad.h5: is cut short or damaged", self.message_of(clearway.InputError, lambda: clearway.trace("bad.h5")))
        (self.folder / "bad.h5").write_bytes(whole[:-1])
        self.assertIn("cut short", self.message_of(clearway.InputError, lambda: clearway.trace("bad.h5")))
        (self.folder / "bad.h5").write_bytes(whole.replace(b"format 6", b"format 4", 1))
        self.assertIn("of format '4' (allowed: 6)", self.message_of(clearway.InputError, lambda: clearway.trace("bad.h5")))

    def test_what_changes_after_the_seal_was_read_is_told_in_one_line(self) -> None:
        with self.results.recording("intersection", "corridor") as recording:
            content = bytearray(recording.file.read_bytes())
            start = recording._file["snapshot/x_m"].id.get_chunk_info(0).byte_offset
        content[start:start + 20] = b"\xff" * 20
        (self.folder / "bad.h5").write_bytes(content)
        with mock.patch("clearway.recording._check_seal"), clearway.trace("bad.h5") as bad:
            self.assertRegex(self.message_of(clearway.InputError, lambda: bad[0].x_m), r"^bad\.h5: snapshot/x_m is damaged \(.*\)\. Record")
            self.assertIn("x is damaged (one two)", str(bad._told("x", OSError("one\n two"))))

    def test_no_file_is_blamed_for_the_machine(self) -> None:
        file = self.results.folder / "recordings/intersection/corridor/00000.h5"
        read = f"list(step.x_m for step in clearway.trace({str(file)!r})), clearway.trace({str(file)!r}).events"
        events, runs = f"clearway.open({str(self.results.folder)!r}).events", f"clearway.open({str(self.results.folder)!r}).runs"
        device, descriptors = "Input/output error", "Too many open files"
        for call, reason, said, place, expression, firsts in (
                ("read", "EIO", device, file, read, (1,)), ("pread64", "EIO", device, file, read, (1, 4, 6, 8, 12, 20, 60)),
                ("openat", "EMFILE", descriptors, file, read, (1, 2)),
                ("getdents64", "EIO", device, file.parent, events, (1,)),
                ("read", "EIO", device, self.results.folder / "manifest.json", runs, (1,)),
                ("pread64", "EIO", device, self.results.folder / "results.sqlite", runs, (1,)),
                ("openat", "EMFILE", descriptors, self.results.folder / "results.sqlite", runs, (1,))):
            for first in firsts:
                with self.subTest(call=call, place=place.name, first=first):
                    told = told_when(call, reason, place, expression, first)
                    self.assertEqual(told, f"EnvironmentFault: {place}: cannot be read: {said}. The machine failed, not the file's content: "
                                           "give the same call again")

    def test_what_is_no_file_is_refused_and_not_waited_for(self) -> None:
        os.mkfifo("pipe")
        self.assertIn("pipe: is not a regular file", self.message_of(clearway.InputError, lambda: clearway.study("pipe")))
        self.assertIn("pipe: is not a regular file", self.message_of(clearway.InputError, lambda: clearway.trace("pipe")))
        opened = self.copy()
        for name, read in (("manifest.json", lambda: opened.recording("intersection", "corridor")), ("results.sqlite", lambda: opened.runs)):
            os.remove(opened.folder / name)
            os.mkfifo(opened.folder / name)
            self.assertIn(f"{name}: is not a regular file", self.message_of(clearway.InputError, read))

    def copy(self) -> clearway.Results:
        return clearway.open(shutil.copytree(self.results.folder, self.folder / "copy"))

    def test_a_damaged_manifest_is_told(self) -> None:
        for text in ("{", "[]", '{"scenarios": [{}]}'):
            shutil.rmtree("copy", ignore_errors=True)
            opened = self.copy()
            (opened.folder / "manifest.json").write_text(text)
            self.assertIn("manifest.json: is damaged", self.message_of(clearway.InputError, lambda: opened.recording("a", "b")))

    def test_a_folder_of_recordings_that_cannot_be_listed_is_told(self) -> None:
        def refuse(place: os.PathLike) -> list[str]:
            if os.path.basename(place) == "corridor":
                raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), place)
            return listing(place)
        listing = os.listdir
        with mock.patch("os.listdir", refuse):
            self.assertIn("/corridor: cannot be read: Permission denied", self.message_of(clearway.InputError, lambda: self.results.events))

    def test_a_data_set_of_the_programs_fits_its_hash(self) -> None:
        program("links", "dataset", "merge", "--samples", "--failure", "B10", "--seeds", "1", "--out", "data")
        self.assertGreater(len(clearway.dataset("data")), 0)
        (file,) = self.folder.glob("data/*.samples")
        changed = bytearray(file.read_bytes())
        changed[400] ^= 0x80
        file.write_bytes(changed)
        self.assertIn("It was changed or damaged", self.message_of(clearway.InputError, lambda: clearway.dataset("data")))

    def test_names_that_no_run_has_are_refused(self) -> None:
        recording, null = self.results.recording, "has the character U+0000"
        for call, says in ((lambda: recording("intersection", "corridor", "a"), "replication: 'a' (allowed: a whole number from 0 to"),
                           (lambda: recording("intersection", "corridor", -1), "replication: -1"),
                           (lambda: recording("intersectoin", "corridor"), "no scenario 'intersectoin'"),
                           (lambda: recording("intersection", "\0"), "no condition '\\x00'; it has baseline, corridor"),
                           (lambda: recording("intersection", "corridor", 7), "00007.h5: cannot be read: No such file"),
                           (lambda: clearway.open("\0"), "folder is '\\x00'"),
                           (lambda: clearway.open(None), "folder is None"),
                           (lambda: clearway.trace("a\0"), "file is 'a\\x00'"),
                           (lambda: clearway.study("a\0"), "file is 'a\\x00'"),
                           (lambda: clearway.run("a\0"), "scenario is 'a\\x00'"),
                           (lambda: clearway.run("merge", out="\0"), "out is '\\x00'"),
                           (lambda: clearway.run("merge", ["a\0"]), null),
                           (lambda: clearway.run("merge", [clearway.Condition("a", policy="a\0.py:A")]), "is 'a\\x00.py:A'"),
                           (lambda: clearway.run("merge", [clearway.Condition("a", model="a\0")]), "condition a: model is 'a\\x00'"),
                           (lambda: self.results.paired_difference("a\0", "corridor"), null),
                           (lambda: clearway.env("a\0"), null)):
            self.assertIn(says, self.message_of(clearway.InputError, call))


if __name__ == "__main__":
    unittest.main()
