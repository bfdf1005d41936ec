"""Tests of scripts/check-skips on what CTest writes of small suites of its own."""
import importlib.machinery
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
UNITTEST = """
import unittest
class One(unittest.TestCase):
    def test_a(self): self.skipTest("it's not here")
    @unittest.skip("gymnasium is not installed (it is in no Debian package)")
    def test_b(self): pass
class Two(unittest.TestCase):
    @classmethod
    def setUpClass(cls): raise unittest.SkipTest("no whole class")
    def test_c(self): pass
"""


class Skips(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def check(self, command, properties=""):
        """What check-skips says of one test: its exit code, its lines but for the cure."""
        (self.folder / "CMakeLists.txt").write_text(
            f"cmake_minimum_required(VERSION 3.25)\nproject(one LANGUAGES NONE)\nenable_testing()\nadd_test(NAME one COMMAND {command})\n"
            f"set_tests_properties(one PROPERTIES TIMEOUT 30 {properties})\n")
        subprocess.run(["cmake", "-S", self.folder, "-B", self.folder / "build"], check=True, capture_output=True)
        subprocess.run(["ctest", "--test-dir", self.folder / "build", "--output-junit", self.folder / "one.xml",
                        "--test-output-size-passed", "100000000"], check=False, capture_output=True)
        done = subprocess.run([sys.executable, ROOT / "scripts/check-skips", self.folder / "one.xml"], capture_output=True, text=True,
                              check=False)
        lines = done.stdout.splitlines()
        if done.returncode == 1:
            self.assertIn("packaging/packages.txt", lines.pop(), done.stderr)
        return done.returncode, lines

    def says(self, text, code=0):
        (self.folder / "said").write_text(text)
        return f"sh -c \"cat {self.folder}/said; exit {code}\""

    def test_one_that_runs_passes(self):
        self.assertEqual(self.check(self.says("a vehicle is skipped\n")), (0, []))

    def test_exit_code_77_counts_where_it_means_that(self):
        skips = "SKIP_RETURN_CODE 77"
        self.assertEqual(self.check(self.says("skipped: slurmd is not installed\n", 77), skips),
                         (1, ["check-skips: one: skipped: slurmd is not installed"]))
        self.assertEqual(self.check(self.says("page: skipped: node and npm are not installed\n", 77), skips), (0, []))
        self.assertEqual(self.check(self.says("", 77), skips)[0], 1)

    def test_a_part_that_googletest_skips_is_found_far_up_in_what_a_program_says(self):
        said = "/src/a_test.cpp:7: Skipped\npython3-h5py is not installed\n\n" + "more\n" * 10000
        self.assertEqual(self.check(self.says(said)), (1, ["check-skips: one: python3-h5py is not installed"]))
        self.assertEqual(self.check(self.says(said.replace("python3-h5py is not installed", "it reads links"))), (0, []))

    def test_parts_that_unittest_skips_are_found(self):
        (self.folder / "parts.py").write_text(UNITTEST)
        found = ["check-skips: one: it's not here", "check-skips: one: no whole class"]
        run = f"{sys.executable} -m unittest {{}} parts"
        here = f"WORKING_DIRECTORY {self.folder}"
        self.assertEqual(self.check(run.format("-v"), here), (1, found))
        self.assertEqual(self.check(run.format(""), here),
                         (1, ["check-skips: one: 3 of its parts, for a reason that only unittest -v prints"]))

    def test_every_reason_that_is_allowed_is_one_that_a_test_gives(self):
        sources = "".join(file.read_text(errors="replace") for folder in ("tests", "scripts", "benchmarks")
                          for file in (ROOT / folder).rglob("*") if file.suffix in (".cpp", ".py", ".sh", "") and file.is_file()
                          and file.name not in ("skips_test.py", "check-skips"))
        script = importlib.machinery.SourceFileLoader("check_skips", str(ROOT / "scripts/check-skips")).load_module()
        for pattern in script.ALLOWED:
            for alternative in re.split(r"\|(?![^(]*\))", pattern):
                self.assertTrue(re.search(alternative, sources), alternative)


if __name__ == "__main__":
    unittest.main()
