"""Tests of scripts/check-harm with a program that stands in for clearway: what it tells, and what it leaves when it is ended."""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STANDS_IN = """#!/bin/bash
case $1 in
    list) echo "$LISTED" ;;
    study)
        mkdir -p "$4"
        trap 'sleep 0.3; echo late >"$4/late"; echo ended >>"$ENDED"; exit 143' TERM
        echo "runs 1 of 9" >&2
        if [[ $SLOW == yes ]]; then sleep 60 >/dev/null 2>&1 & wait; fi ;;
    compare) echo "$COMPARED" ;;
esac
"""


class Harm(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        (self.root / "tmp").mkdir()
        for name, text in (("clearway", STANDS_IN), ("netgenerate", "#!/bin/sh\n")):
            (self.root / name).write_text(text)
            (self.root / name).chmod(0o755)

    def start(self, *words, listed='{"policies": [], "scenarios": []}', slow="no", tree=ROOT, compared='{"comparisons": []}'):
        return subprocess.Popen([sys.executable, tree / "scripts/check-harm", *words], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                env=os.environ | {"CLEARWAY": str(self.root / "clearway"), "PATH": f"{self.root}:{os.environ['PATH']}",
                                                  "TMPDIR": str(self.root / "tmp"), "LISTED": listed, "SLOW": slow, "COMPARED": compared,
                                                  "ENDED": str(self.root / "ended")})

    def test_each_study_is_told_as_it_begins_and_ends(self):
        harm = self.start()
        printed, said = harm.communicate(timeout=60)
        self.assertEqual(harm.returncode, 0, said)
        self.assertIn("study 2 of 4: rescue_lane, 2 conditions on grid_right, grid_left, intersection", said)
        self.assertIn("runs 1 of 9", said)
        self.assertIn("roads: no harm", said)
        self.assertIn("no harm shown on ", printed)
        self.assertEqual(list((self.root / "tmp").iterdir()), [])

    def test_a_program_that_is_none_is_told(self):
        (self.root / "clearway").unlink()
        _, said = self.start().communicate(timeout=60)
        self.assertIn("is no program. CLEARWAY names the one to use", said)

    def test_one_policy_runs_where_it_has_a_condition_and_no_other_does(self):
        out = self.root / "out"
        harm = self.start("--policy", "corridor", "--out", out)
        printed, said = harm.communicate(timeout=60)
        self.assertEqual(harm.returncode, 0, said)
        self.assertIn("study 2 of 2: roads, 1 condition on", said)
        self.assertRegex(printed, r"corridor: no harm shown on .*\nnot run: .*city.* \(--full\)")
        self.assertEqual((out / "corridor/studies/roads.toml").read_text().count("policy = ["), 1)
        _, said = self.start("--out", out).communicate(timeout=60)
        self.assertIn("study 2 of 4: rescue_lane", said)  # all policies in the same folder: none is left out
        _, said = self.start("--policy", "corider").communicate(timeout=60)
        self.assertIn("no condition of studies/harm has the policy `corider`", said)
        self.assertIn("Did you mean `corridor`?", said)

    def test_a_signal_ends_the_study_and_leaves_nothing(self):
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            harm = self.start(slow="yes")
            for line in harm.stderr:
                if "runs 1 of 9" in line:
                    break
            harm.send_signal(number)
            _, said = harm.communicate(timeout=60)
            self.assertEqual(harm.returncode, 128 + number)
            self.assertNotIn("Traceback", said)
            self.assertIn("check-harm: interrupted; with --out, this same command continues", said)
            self.assertEqual(list((self.root / "tmp").iterdir()), [])
        self.assertEqual((self.root / "ended").read_text(), "ended\n" * 3)

    def test_a_policy_without_a_condition_is_told_the_file(self):
        harm = self.start(listed='{"policies": [{"name": "keep_distance"}], "scenarios": []}')
        _, said = harm.communicate(timeout=60)
        self.assertEqual(harm.returncode, 1)
        self.assertIn('add a condition such as {name = "keep_distance", policy = ["keep_distance"]} to studies/harm/roads.toml', said)

    def tree(self):
        """What check-harm reads of this tree, to be changed."""
        tree = self.root / "tree"
        for name in ("scripts/check-harm", "docs/reference/policies.md", "docs/limits.md"):
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, tree / name)
        shutil.copytree(ROOT / "studies/harm", tree / "studies/harm")
        return tree

    def test_a_study_that_was_corrected_is_taken_anew(self):
        tree, out = self.tree(), self.root / "out"
        for line in ("# wrong\n", "# corrected\n"):
            (tree / "studies/harm/roads.toml").write_text(line + (ROOT / "studies/harm/roads.toml").read_text())
            harm = self.start("--policy", "corridor", "--out", out, tree=tree)
            _, said = harm.communicate(timeout=60)
            self.assertEqual(harm.returncode, 0, said)
        self.assertTrue((out / "corridor/studies/roads.toml").read_text().startswith("# corrected"))

    def test_harm_that_the_page_does_not_name_comes_with_the_line_to_write(self):
        worse = {"difference": 4.0, "holm_p": 0.01}
        level = {"difference": 0.1, "holm_p": 0.9}
        pair = {"scenario": "city", "condition": "preempt_signals", "objections": "",
                "metrics": {"emergency_restricted_travel_time_s": level, "others_time_loss_s": worse}}
        harm = self.start("--policy", "preempt_signals", compared=json.dumps({"comparisons": [pair]}))
        _, said = harm.communicate(timeout=60)
        self.assertEqual(harm.returncode, 1)
        self.assertIn("preempt_signals others city: docs/limits.md does not name it", said)
        self.assertIn("- **`preempt_signals`**: others in `city`, `grid_right`, `intersection`.", said)


if __name__ == "__main__":
    unittest.main()
