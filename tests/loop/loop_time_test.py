"""benchmarks/loop_time.py on a short scenario, and loop_growth.py on a small grid: what they measure fits together. Times themselves are
not judged."""
import os
import pathlib
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "benchmarks"))
import loop_growth  # noqa: E402
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


class LoopGrowth(unittest.TestCase):
    def test_a_grid_has_its_vehicles_and_the_phases_add_up(self):
        with tempfile.TemporaryDirectory() as place:
            rows = dict(loop_growth.costs(os.environ["CLEARWAY"], 200, pathlib.Path(place)))
        whole = rows.pop("all beside SUMO's step, us")
        for at, condition in enumerate(loop_growth.CONDITIONS):
            self.assertGreater(rows["vehicles on the road"][at], 100.0, condition)
            self.assertLess(rows["vehicles on the road"][at], 200.0, condition)
            self.assertAlmostEqual(sum(rows[f"{phase}, us"][at] for phase in loop_time.PHASES), whole[at])
        self.assertEqual(rows["prediction, us"][0], 0.0, "the baseline predicts nothing")
        self.assertGreater(rows["prediction, us"][1], 0.0)
        self.assertGreater(rows["loading, routes and demand, ms a vehicle"][0], 0.0)
        self.assertLessEqual(set(loop_growth.PUBLISHED), set(rows) | {"all beside SUMO's step, us"})


if __name__ == "__main__":
    unittest.main()
