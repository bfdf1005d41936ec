"""The first ten minutes of a student: a policy of one's own against four, two failures, a figure and a table in a LaTeX file."""
import ast
import contextlib
import importlib.util
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import clearway
from guide import blocks, commands, the, type_in
from support import SOURCE, FolderCase

GUIDE = "docs/guides/your-study.md"
HEADING = "Your policy against others, for a paper"


def python_blocks(page: str) -> list[str]:
    """The code in Python of a page."""
    found = []
    for heading in re.findall(r"^#+ (.+)$", (SOURCE / page).read_text(encoding="utf-8"), re.MULTILINE):
        for block in blocks(page, heading):
            with contextlib.suppress(SyntaxError):
                ast.parse(block)
                found += [block] if "clearway." in block else []
    return found


class StudentTest(FolderCase):
    def printed_by(self, name: str, code: str) -> str:
        """What a file prints when Python runs it."""
        ended = subprocess.run([sys.executable, str(self.write(name, code))], capture_output=True, text=True, check=False)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""), code)
        return ended.stdout

    def test_the_code_of_the_page_runs_as_it_stands_in_one_file(self) -> None:
        code = "\n".join(python_blocks("docs/guides/python.md"))
        self.assertEqual(code.count("seeds=10"), 3)
        if importlib.util.find_spec("pandas") is None:  # optional, as the page says
            code = code.replace(".to_pandas()", "")
        self.assertEqual(set(re.findall(r"^class (\w+)", code, re.MULTILINE)), {"Green", "Mine"})
        printed = self.printed_by("my_policy.py", code.replace("seeds=10", "seeds=5"))
        for condition in ("corridor", "green"):
            self.assertRegex(printed, rf"(?mi)^intersection: {condition} - Baseline, emergency_restricted_travel_time_s: [+-][\d.]+ \[.+, .+\] \(5 pairs\)")
        self.assertRegex(printed, r"scenario +condition +replication +emergency_restricted_travel_time_s\n(intersection .*\n){5}\[5 rows, 4 columns\]")
        self.assertIn("'seed': 0", printed)
        self.assertRegex(printed, r"(?m)^predictor +exits +ap +f1\nMine +known +0\.\d+ +0\.\d+$")
        (judged,) = [line for block in blocks("docs/guides/python.md", "A policy") for line in block.splitlines() if "conformance" in line]
        self.assertTrue(type_in(judged, ("python3", sys.executable)).endswith("all rules kept\n"))
        for name, part in (("Green", "--policy"), ("Mine", "--predictor")):
            words = [part, f"my_policy.py:{name}"] + (["--policy", "dissertation", "--failure", "B10"] if name == "Mine" else [])
            type_in(" ".join(["clearway run intersection --seeds 1 --no-solo", *words]))

    def test_from_a_policy_to_a_figure_and_a_table(self) -> None:
        policy = next(block for block in blocks("docs/guides/python.md", "A policy") if "class Green" in block)
        self.write("my_policy.py", policy)
        study, latex = (next(block for block in blocks(GUIDE, HEADING) if begin in block)
                        for begin in ("[factors]", "\\begin{document}"))
        self.assertIn("replications = 30", study)
        self.write("mine.toml", study.replace("replications = 30", "replications = 2"))
        found = commands(GUIDE, HEADING)
        type_in(the("study", found))
        (code,) = python_blocks(GUIDE)
        printed = self.printed_by("read.py", code)
        ours, *each = [line for line in printed.splitlines() if line.startswith("intersection: ")]
        self.assertRegex(ours, r"^intersection: Ours, failing - corridor, failing, emergency_restricted_travel_time_s: [+-]\d")
        self.assertEqual(len(each), 8)
        self.assertIn(ours, each)
        self.assertRegex(printed, r"(?m)^scenario +title +replication +emergency_restricted_travel_time_s$")
        self.assertTrue(printed.endswith("\n[4 rows, 4 columns]\n"), printed)
        runs = clearway.open("runs/mine").runs
        self.assertEqual(len(set(runs["condition.policy"]) - {""}), 5)
        self.assertEqual(set(runs["condition.failure"]) - {""}, {"perfect", "B10,Q50"})
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
            self.assertEqual(len(rows), 6 if name.startswith("figures") else 5, "the head, and a row a policy")
            self.assertEqual(len({row.count("&") + row.count(r"\multicolumn{2}") for row in rows}), 1,
                             "each row has as many cells")
            self.assertTrue(any(row.startswith("Ours") for row in rows))
            self.assertEqual(any(row.startswith("corridor") for row in rows), name.startswith("figures"), "it is not compared with itself")
        self.assertIn("difference to its counterpart with policy corridor, s", table)
        if shutil.which("pdflatex"):
            self.write("paper.tex", latex)
            ended = subprocess.run(["pdflatex", "-halt-on-error", "paper.tex"], capture_output=True, text=True, check=False)
            self.assertEqual(ended.returncode, 0, ended.stdout)


if __name__ == "__main__":
    unittest.main()
