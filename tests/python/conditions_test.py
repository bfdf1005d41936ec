"""Conditions of a run folder are given by their names, their titles, or factors."""
import json
import os
import shutil
import tempfile
import unittest

import clearway
from clearway import _conditions, _program
from support import FolderCase, program

STUDY = """replications = 2
scenarios = ["intersection"]
conditions = ["baseline"]
[[condition]]
name = "policy"
policy = ["corridor"]
[factors]
condition.policy = ["corridor", "preempt_signals", "check_in_out"]
condition.failure = ["perfect", "B10"]
[titles]
preempt_signals = "Ours"
"""


class ConditionsTest(FolderCase):
    """A condition is given by its name, by its title, or by factors."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.holder = tempfile.TemporaryDirectory(prefix="clearway-test-")
        cls.addClassCleanup(cls.holder.cleanup)
        file = os.path.join(cls.holder.name, "study.toml")
        with open(file, "w", encoding="utf-8") as stream:
            stream.write(STUDY)
        cls.results = clearway.study(file, out=os.path.join(cls.holder.name, "runs"))
        cls.metric = "emergency_travel_time_s"

    def name(self, policy: str, failure: str) -> str:
        return f"policy+failure={failure}+policy={policy}"

    def mean(self, left: str, right: str) -> float:
        runs = self.results.runs
        return float((runs.where(condition=left)[self.metric] - runs.where(condition=right)[self.metric]).mean())

    def test_titles_are_those_of_the_report(self) -> None:
        before = (self.results.folder / "report.html").stat()
        found = clearway.open(self.results.folder)._conditions.titles
        self.assertEqual((self.results.folder / "report.html").stat(), before, "the folder stays as it is")
        said = json.loads(program("report", str(self.results.folder), "--json"))["scenarios"][0]["conditions"]
        self.assertEqual(found, {one["title"]: {one["name"]} for one in said})
        self.assertEqual(found["Ours, B10"], {self.name("preempt_signals", "B10")})

    def test_a_title_is_taken_where_a_name_is(self) -> None:
        ours, other = self.name("preempt_signals", "B10"), self.name("corridor", "perfect")
        difference = self.results.paired_difference
        for given in (ours, "Ours, B10", "Ours, B10 (!)", {"condition.policy": "preempt_signals", "condition.failure": "B10"}):
            self.assertEqual(difference(self.metric, given), difference(self.metric, ours))
            found = difference(self.metric, given, against="corridor, perfect sensors")
            self.assertEqual((found.condition, found.compared_with), (ours, other))
            self.assertAlmostEqual(found.difference, self.mean(ours, other), places=9)
        self.assertEqual(self.results.paired_differences(self.metric, "Ours, B10"), self.results.paired_differences(self.metric, ours))
        self.assertEqual(set(self.results.runs.where(condition="Ours, B10")["condition"]), {ours})
        runs = self.results.runs
        chosen = runs.where(title="Ours, B10")
        self.assertEqual(set(chosen["condition"]), {ours})
        self.assertEqual(set(chosen["title"]), {"Ours, B10"})
        self.assertEqual(set(runs[runs["title"] == "Ours, B10"]["condition"]), {ours})
        shown = str(runs.head(2, "title")).splitlines()
        self.assertEqual(shown[0].split().count("title"), 1, shown)
        self.assertIn("Did you mean 'condition'?", self.message_of(clearway.InputError, lambda: self.results.runs.where(condtion="corridor")))
        self.assertEqual(self.results.vehicles.where(condition="Ours, B10").row_count, self.results.vehicles.where(condition=ours).row_count)
        self.assertIn(f"intersection/{ours}/00000.h5: cannot be read",
                      self.message_of(clearway.InputError, lambda: self.results.recording("intersection", "Ours, B10")))

    def test_a_title_is_taken_where_a_level_of_a_factor_is(self) -> None:
        runs, named = self.results.runs, {"condition.policy": "preempt_signals"}
        titled = {"condition.policy": "Ours"}
        self.assertEqual(set(runs.where(**titled)["condition"]), set(runs.where(**named)["condition"]))
        self.assertEqual(self.results.paired_difference(self.metric, {**titled, "condition.failure": "B10"}),
                         self.results.paired_difference(self.metric, "Ours, B10"))
        compared = [program("compare", str(self.results.folder), "--against", f"policy={policy}", "--json")
                    for policy in ("Ours", "preempt_signals")]
        self.assertEqual(*compared)
        self.assertIn("has no condition.policy 'Theirs'",
                      self.message_of(clearway.InputError, lambda: runs.where(**{"condition.policy": "Theirs"})))

    def test_damaged_titles_are_told_and_missing_ones_are_none(self) -> None:
        place = self.folder / "part"
        place.mkdir()
        shutil.copy(self.results.folder / "manifest.json", place)
        def ask() -> object:
            return clearway.open(place)._conditions.levels({"condition.policy": "Ours"})
        self.assertIn("has no condition.policy 'Ours'", self.message_of(clearway.InputError, ask))
        (place / "titles.json").write_text("{")
        self.assertIn("titles.json: is damaged", self.message_of(clearway.InputError, ask))

    def test_a_condition_of_ones_own_has_a_title_which_is_taken_too(self) -> None:
        def run(title: str) -> clearway.Results:
            return clearway.run("intersection", [clearway.Condition("own", policy="corridor", title=title),
                                                 clearway.Condition("other", policy="preempt_signals", title="Theirs")], seeds=2)
        results = run("Ours")
        found = results.paired_difference(self.metric, "Ours", against="Theirs")
        self.assertEqual((found.condition, found.title, found.compared_with, found.compared_title), ("own", "Ours", "other", "Theirs"))
        self.assertEqual(found, results.paired_difference(self.metric, "own", against="other"))
        renamed = run("Mine")
        self.assertEqual(renamed.folder, results.folder, "other titles are no other study")
        self.assertEqual(renamed.paired_difference(self.metric, "own").title, "Mine")

    def test_a_misspelt_metric_is_told_in_one_line_with_the_one_that_is_meant(self) -> None:
        for ask in (lambda: self.results.paired_difference("emergncy_travel_time_s", "Ours, B10"),
                    lambda: self.results.runs["emergncy_travel_time_s"], lambda: self.results.runs.head(2, "emergncy_travel_time_s"),
                    lambda: self.results.runs.where(emergncy_travel_time_s=1.0)):
            said = self.message_of(clearway.InputError, ask)
            self.assertIn("Did you mean 'emergency_travel_time_s'", said)
            self.assertLess(len(said), 250)
            self.assertNotIn("\n", said)

    def test_an_incomplete_folder_has_titles(self) -> None:
        place = self.folder / "part"
        place.mkdir()
        for name in ("manifest.json", "titles.json"):
            shutil.copy(self.results.folder / name, place)
        part = clearway.open(place)
        self.assertEqual(part._conditions.titles, self.results._conditions.titles)
        self.assertEqual(part.runs.where(condition="Ours, B10").row_count, 0)

    def test_a_title_of_two_is_refused(self) -> None:
        opened = clearway.open(self.results.folder)
        opened._conditions.titles = {"Ours": {"a", "b"}}
        self.assertIn("several conditions have the title 'Ours': a, b. Give the name of one",
                      self.message_of(clearway.InputError, lambda: opened.runs.where(condition="Ours")))

    def test_factors_that_are_left_out_are_those_of_the_other_condition(self) -> None:
        against = {"condition.policy": "corridor"}
        for failure in ("perfect", "B10"):
            ours = {"condition.policy": "preempt_signals", "condition.failure": failure}
            names = self.name("preempt_signals", failure), self.name("corridor", failure)
            for given in (ours, names[0]):
                found = self.results.paired_difference(self.metric, given, against=against)
                self.assertEqual((found.condition, found.compared_with), names)
                self.assertAlmostEqual(found.difference, self.mean(*names), places=9)
        every = self.results.paired_differences(self.metric, against=against)
        self.assertEqual([(one.condition, one.compared_with) for one in every],
                         [(self.name(policy, failure), self.name("corridor", failure)) for failure in ("perfect", "B10")
                          for policy in ("preempt_signals", "check_in_out")])
        said = _program.call_json(["compare", str(self.results.folder.absolute()), "--metric", self.metric, "--against", "policy=corridor"])
        self.assertEqual([one.holm_p for one in every], [row["metrics"][self.metric]["holm_p"] for row in said["comparisons"]])
        self.assertEqual({one.holm_over for one in every}, {sum(one.holm_p is not None for one in every)})
        ours = self.results.paired_difference(self.metric, self.name("preempt_signals", "B10"), against=against)
        self.assertIn(ours, every)

    def test_what_chooses_no_condition_or_several_is_told(self) -> None:
        difference, policy, failure = self.results.paired_difference, "condition.policy", "condition.failure"
        for given, says in (("Our, B10", "no condition 'Our, B10'. Did you mean 'Ours, B10'"), ("B10", "no condition 'B10'. Did you mean"),
                            ("xyzzy", "no condition 'xyzzy'. It has baseline, "), ("xyzzy", 'set(results.runs["title"]) names all 7 titles'),
                            ({policy: "corridor"}, "chooses 2 conditions: policy+failure=perfect+policy=corridor, policy+failure=B10"),
                            ({policy: "coridor"}, "no condition.policy 'coridor'; it has corridor, preempt_signals, check_in_out. Did you mean"),
                            ({policy: 3}, "no condition.policy 3"), ({"policy": "corridor"}, "chooses 2 conditions: policy+failure=perfect+"),
                            ({"polcy": "corridor"}, "no factor 'polcy'; it has condition.failure, "),
                            ({}, "chooses 7 conditions: ")):
            message = self.message_of(clearway.InputError, lambda: difference(self.metric, given))
            self.assertIn(says, message)
            self.assertLess(len(message), 400)
        for against, says in (({failure: "B1O"}, "no condition.failure 'B1O'; it has perfect, B10"),
                              ({failure: "B10", policy: "corridor", "a.b": 1}, "no factor 'a.b'")):
            self.assertIn(says, self.message_of(clearway.InputError, lambda: self.results.paired_differences(self.metric, against)))

    def test_numbers_and_factors_of_scenarios_choose_too(self) -> None:
        conditions = _conditions.Conditions(self.folder)
        levels = [("8", "true"), ("12.5", "true"), ("8", "false")]
        spec = [{"name": f"{stem}+{lead}+{on}", "factors": {"a.lead_s": lead, "a.on": on}} for stem in ("x", "y") for lead, on in levels]
        scenarios = [{"name": f"city+{friction}", "factors": {"scenario.friction": friction}} for friction in ("1", "0.4")]
        self.write("manifest.json", json.dumps({"scenarios": scenarios, "conditions": [{"name": "baseline"}, *spec]}))
        self.assertEqual(conditions.name_of({"a.lead_s": 12.5}, like="y+8+true"), "y+12.5+true")
        self.assertEqual(conditions.name_of({"a.on": False}, like="x+8+true"), "x+8+false")
        self.assertEqual(conditions.levels({"a.on": True, "a.lead_s": 12.5, "scenario.friction": 0.4}), "a.on=true,a.lead_s=12.5")
        self.assertEqual(conditions.scenario_with({"scenario.friction": 0.4, "a.on": True}), "city+0.4")
        self.assertEqual((conditions.scenario_with({"a.on": True}), conditions.scenario_with("x")), (None, None))
        self.assertIn("chooses 2 conditions: x+12.5+true, y+12.5+true",
                      self.message_of(clearway.InputError, lambda: conditions.name_of({"a.lead_s": 12.5})))


if __name__ == "__main__":
    unittest.main()
