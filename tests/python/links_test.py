"""``clearway.links.evaluate`` measures what ``clearway links evaluate`` prints."""
import io
import json
import unittest
from unittest import mock

import clearway
import numpy as np
from support import FolderCase, SOURCE, Terminal, program

DISTANCE = str(SOURCE / "examples" / "python" / "distance_predictor.py:ByDistance")
#: Time is no result.
UNLIKE = "us_per_report"


class LinksTest(FolderCase):
    def test_scores_are_those_of_the_console(self) -> None:
        scores = clearway.links.evaluate("intersection", [DISTANCE, "last_seen", "dead_reckoning"], failures="B10", exits="known", seeds=1,
                                         validation_seeds=range(1000, 1001), against="last_seen", out="here")
        printed = json.loads(program("links", "evaluate", "intersection", "--predictor", DISTANCE, "last_seen", "dead_reckoning", "--failure",
                                     "B10", "--exits", "known", "--seeds", "1", "--validation-seeds", "1", "--against", "last_seen", "--out",
                                     "here", "--json"))
        for stream, shown in ((Terminal(), True), (io.StringIO(), False)):
            with mock.patch("sys.stderr", stream):
                clearway.links.evaluate("intersection", [DISTANCE, "last_seen", "dead_reckoning"], failures="B10", exits="known", seeds=1,
                                        validation_seeds=range(1000, 1001), against="last_seen", out="here")
            self.assertEqual("links.html" in stream.getvalue(), shown, stream.getvalue())
        self.assertEqual(scores.results["predictor"].tolist(), ["ByDistance", "last_seen", "dead_reckoning"])
        for row, told in enumerate(printed["results"]):
            for name, value in told.items():
                if name != UNLIKE:
                    np.testing.assert_equal(scores.results[name][row], np.nan if value is None else value, name)
        self.assertEqual(scores.against, "last_seen")
        self.assertEqual(scores.seeds, printed["seeds"])
        gain = scores.gains.where(predictor="dead_reckoning")
        ap = dict(zip(scores.results["predictor"], scores.results["ap"]))
        self.assertAlmostEqual(gain["ap_difference"][0], ap["dead_reckoning"] - ap["last_seen"])
        self.assertTrue((scores.folder / "links.html").exists())
        self.assertIn("dead_reckoning", repr(scores))
        self.assertIn("Did you mean 'predictor'", self.message_of(clearway.InputError, lambda: scores.results["predictr"]))

    def test_settings_seeds_and_overrides_are_those_of_a_run(self) -> None:
        given = dict(predictors="dead_reckoning", failures=["B10"], exits="known", seeds=range(3, 4), validation_seeds=1)
        usual = clearway.links.evaluate("intersection", **given)
        strict = clearway.links.evaluate("intersection", set={"dead_reckoning.link_threshold": 0.95}, **given)
        coarse = clearway.links.evaluate("intersection", step_length_s=0.5, **given)
        self.assertIn("replications 3 to 3", usual.seeds)
        self.assertLess(strict.results["end_to_end_recall"][0], usual.results["end_to_end_recall"][0])
        self.assertNotEqual(coarse.results["true_links"][0], usual.results["true_links"][0])

    def test_what_is_wrong_is_told_with_what_is_meant(self) -> None:
        for call, told in ((lambda: clearway.links.evaluate("intersection", "kalmann"), "kalman"),
                           (lambda: clearway.links.evaluate("intersecton", "kalman"), "intersection"),
                           (lambda: clearway.links.evaluate("intersection", "kalman", failure="B10"),
                            "clearway.links.evaluate() has no keyword 'failure'. Did you mean 'failures'"),
                           (lambda: clearway.links.evaluate("intersection", "kalman", seeds=range(0, 4, 2)), "a range without gaps"),
                           (lambda: clearway.links.evaluate("intersection", "kalman", seeds=-1), "seeds: -1 (allowed: a whole number"),
                           (lambda: clearway.links.evaluate("intersection", "my_net.py:Mine"), "my_net.py is not a file")):
            self.assertIn(told, self.message_of(clearway.InputError, call))
        self.assertIn("Did you mean 'links'", self.message_of(AttributeError, lambda: clearway.link))


if __name__ == "__main__":
    unittest.main()
