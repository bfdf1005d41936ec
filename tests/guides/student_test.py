"""The first ten minutes of a student: a policy of one's own against four, two failures, a figure and a table in a LaTeX file."""
import re
import shutil
import subprocess
import unittest
from pathlib import Path

import clearway
from guide import blocks, commands, the, type_in
from support import FolderCase

GUIDE = "docs/guides/your-study.md"
HEADING = "Your policy against others, for a paper"


class StudentTest(FolderCase):
    def test_from_a_policy_to_a_figure_and_a_table(self) -> None:
        policy = next(block for block in blocks("docs/guides/python.md", "A policy") if "class Green" in block)
        self.write("my_policy.py", policy)
        study, latex = (next(block for block in blocks(GUIDE, HEADING) if begin in block)
                        for begin in ("[factors]", "\\begin{document}"))
        self.assertIn("replications = 30", study)
        self.write("mine.toml", study.replace("replications = 30", "replications = 2"))
        found = commands(GUIDE, HEADING)
        type_in(the("study", found))
        runs = clearway.open("runs/mine").runs
        self.assertEqual(len(set(runs["condition.policy"]) - {""}), 5)
        self.assertEqual(set(runs["condition.failure"]) - {""}, {"perfect", "B10"})
        for command in found:
            if "export figures" in command:
                type_in(command)
        used = re.findall(r"\\(?:input|includegraphics(?:\[.*?\])?)\{(.+?)\}", latex)
        self.assertEqual(len(used), 3)
        for name in used:
            if name.endswith(".tex") or shutil.which("rsvg-convert"):
                self.assertTrue(Path(name).is_file(), f"{name}; there are {sorted(map(str, Path('figures').iterdir()))}")
        for name in (name for name in used if name.endswith(".tex")):
            table = Path(name).read_text(encoding="utf-8")
            rows = [line for line in table.splitlines() if line.endswith(r"\\")]
            self.assertEqual(len(rows), 3, "the head, and a row a failure")
            self.assertEqual(len({row.count("&") + row.count(r"\multicolumn{2}") for row in rows}), 1,
                             "each row has as many cells")
            self.assertIn("Ours", rows[0])
            self.assertEqual("corridor" in rows[0], name.startswith("figures"), "it is not compared with itself")
        self.assertIn("(baseline: the same with condition.policy corridor)", table)
        if shutil.which("pdflatex"):
            self.write("paper.tex", latex)
            ended = subprocess.run(["pdflatex", "-halt-on-error", "paper.tex"], capture_output=True, text=True, check=False)
            self.assertEqual(ended.returncode, 0, ended.stdout)


if __name__ == "__main__":
    unittest.main()
