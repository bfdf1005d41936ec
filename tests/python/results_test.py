"""Runs, tables, paired differences and recordings, against the program's own tables and sums made here."""
import csv
import io
import json
import math
import os
import shutil
import sqlite3
import tempfile
import unittest

import clearway
import numpy as np
from support import FolderCase, program

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
            for column, array in table.items():
                for cell, value in zip((line[column] for line in lines), array):
                    if array.dtype.kind == "U":
                        self.assertEqual(cell, value, column)
                    else:
                        self.assertTrue(math.isnan(value) if cell == "" else math.isclose(float(cell), value, rel_tol=1e-12), column)

    def test_every_kind_of_factor_is_the_same_in_csv_sqlite_json_and_python(self) -> None:
        self.write("study.toml", '''
name = "factors"
replications = 1
scenarios = ["intersection"]
conditions = ["baseline"]

[[condition]]
name = "mine"
policy = ["corridor"]

[factors]
condition.failure = ["perfect", "B10"]
preempt_signals.lead_s = [8, 12.5]
scenario.friction = [1.0, 0.4]
''')
        results = clearway.study("study.toml", out="runs")
        factors = {"condition.failure": str, "preempt_signals.lead_s": float, "scenario.friction": float}
        runs = results.runs
        lines = list(csv.DictReader((results.folder / "runs.csv").read_text().splitlines()))
        printed = json.loads(program("export", "results", str(results.folder), "runs", "--json"))
        connection = sqlite3.connect(results.folder / "results.sqlite")
        self.addCleanup(connection.close)
        self.assertEqual(set(runs["condition.failure"]), {"", "perfect", "B10"})
        for factor, kind in factors.items():
            stored = [row[0] for row in connection.execute(f'SELECT "{factor}" FROM runs ORDER BY scenario, condition')]
            for value, line, row, cell in zip(runs[factor], lines, printed, stored, strict=True):
                if line[factor] == "":
                    self.assertEqual((row[factor], cell), (None, None))
                    self.assertTrue(value == "" if kind is str else math.isnan(value))
                else:
                    self.assertEqual((kind(value), kind(row[factor]), kind(cell)), (kind(line[factor]),) * 3)
        self.assertEqual(runs.where(**{"condition.failure": "B10", "preempt_signals.lead_s": 8.0}).row_count, 2)

    def test_where_and_pandas(self) -> None:
        corridor = self.results.runs.where(condition="corridor", replication=2)
        self.assertEqual(corridor.row_count, 1)
        frame = self.results.vehicles.to_pandas()
        self.assertEqual(list(frame.columns), list(self.results.vehicles))
        self.assertEqual(len(frame), self.results.vehicles.row_count)

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
        self.assertIn("corridor - baseline", str(found))

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

    def test_events_of_all_recordings(self) -> None:
        events = self.results.events
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

    def test_wrong_names_are_told_with_what_there_is(self) -> None:
        for call, says in ((lambda: self.results.table("nothing"), "it has"),
                           (lambda: self.results.runs["nothing"], "columns are scenario"),
                           (lambda: self.results.paired_difference("nothing_s", "corridor"), "nothing_s"),
                           (lambda: self.results.paired_difference("collisions", "mine"), "intersection/corridor"),
                           (lambda: clearway.open("no-folder"), "no-folder"),
                           (lambda: clearway.trace("no.h5"), "no.h5 is not a file"),
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
                           (lambda: self.results.runs.where(condition=3), "compared with 3 (allowed: a text)"),
                           (lambda: self.results.paired_difference(3, "corridor"), "`3` is unknown"),
                           (lambda: clearway.open("--help"), "is not a run folder")):
            message = self.message_of(clearway.InputError, call)
            self.assertIn(says, message)
            self.assertNotIn("study.toml", message)  # nobody wrote that file

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

    def test_damaged_and_closed_recordings_are_told(self) -> None:
        with self.results.recording("intersection", "corridor") as recording:
            content = bytearray(recording.file.read_bytes())
            start = recording._file["snapshot/x_m"].id.get_chunk_info(0).byte_offset
        self.assertIn("is closed", self.message_of(clearway.ClearwayError, lambda: recording[0].x_m))
        content[start:start + 20] = b"\xff" * 20
        (self.folder / "bad.h5").write_bytes(content)

        def read() -> None:
            with clearway.trace("bad.h5") as bad:
                _ = bad[0].x_m
        self.assertIn("snapshot/x_m is damaged", self.message_of(clearway.InputError, read))


if __name__ == "__main__":
    unittest.main()
