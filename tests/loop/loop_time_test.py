"""benchmarks/loop_time.py on a short scenario: what it measures fits together. Times themselves are not judged."""
import os
import pathlib
import sys
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "benchmarks"))
import loop_time  # noqa: E402

CONDITIONS = ["baseline", "corridor", "corridor_B10_graphsage"]


class LoopTime(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.measured = loop_time.measure(os.environ["CLEARWAY"], "merge", ["corridor"], 10, [])

    def test_each_condition_has_each_round(self):
        found, step_s, shared_s = self.measured
        self.assertEqual(list(found), CONDITIONS)
        self.assertEqual([len(timings) for timings, _ in found.values()], [10, 10, 10])
        self.assertEqual(step_s, 0.25)
        self.assertGreater(shared_s, 0.0)

    def test_the_phases_of_a_run_add_up_to_its_loop(self):
        for name, (timings, _) in self.measured[0].items():
            for timing in timings:
                ratios = loop_time.ratios(timing)
                whole = ratios.pop("all")
                self.assertEqual(set(timing["phases"]), {f"{phase}_s" for phase in ratios}, name)
                self.assertAlmostEqual(sum(ratios.values()), whole)
                self.assertGreaterEqual(min(ratios.values()), 0.0)
                self.assertGreater(timing["vehicle_steps"], timing["steps"])
                policy = timing["phases"]["prediction_s"] > 0.0
                self.assertEqual(policy, name != "baseline", "without a policy nothing is predicted")

    def test_it_asks_for_as_many_pairs_as_the_product(self):
        self.assertEqual(loop_time.pairs_needed(5.0), 99)  # t(98) = 1.98447, and 1.98447^2 * 25 = 98.5
        for _, precision in list(self.measured[0].values())[1:]:
            if precision["replications_needed"] is not None:
                self.assertEqual(loop_time.pairs_needed(precision["deviation_s"]), precision["replications_needed"])

    def test_a_row_has_a_number_for_each_condition(self):
        rows = dict(loop_time.rows_of(*self.measured))
        for name, numbers in rows.items():
            self.assertEqual(len(numbers), len(CONDITIONS), name)
        self.assertEqual(rows["pairs for +-1 s"][0], None, "the baseline is not compared")
        self.assertGreater(rows["processor time for them, s"][1], 0.0)


if __name__ == "__main__":
    unittest.main()
