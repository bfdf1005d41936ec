"""A file that starts a study whenever it is loaded does not start it again where a run or a new process loads it."""
import os
import subprocess
import sys
import unittest

from support import FolderCase, PROGRAMS, hosts_of

# A policy and what runs it, in one file, as one would write it first.
CLASS = """
import clearway
class G(clearway.Policy):
    def act(self, belief):
        return []
"""
RUN = 'clearway.run("intersection", [clearway.Condition("g", policy=G)], seeds=2)\n'
CURE = 'below `if __name__ == "__main__":`'
#: Stands where the program does and writes down each call; ends the fourth, so that a failing test starts no more.
COUNTING = """#!/bin/sh
echo "$*" >> '{log}'
[ $(wc -l < '{log}') -le 3 ] && exec '{program}' "$@"
echo "started again and again" >&2
exit 1
"""


class StartedAgainTest(FolderCase):
    def setUp(self) -> None:
        super().setUp()
        (self.folder / "bin").mkdir()
        (self.folder / "bin/clearway-run").symlink_to(PROGRAMS / "clearway-run")
        self.write("bin/clearway", COUNTING.format(log=self.folder / "calls", program=PROGRAMS / "clearway")).chmod(0o755)

    def ended(self, *words: str) -> subprocess.CompletedProcess:
        """Python with these words. ``started`` is then the verb of each call of the program."""
        (self.folder / "calls").write_text("")
        ended = subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False, timeout=100,
                               env={**os.environ, "CLEARWAY_PROGRAMS": str(self.folder / "bin")})
        self.assertEqual(hosts_of(self.folder), [])
        self.started = [line.split()[0] for line in (self.folder / "calls").read_text().splitlines()]
        return ended

    def test_a_file_that_starts_a_study_each_time_it_is_loaded_starts_one(self) -> None:
        ended = self.ended(str(self.write("mine.py", CLASS + RUN)))
        self.assertEqual(ended.returncode, 1)
        self.assertIn(f"{self.folder}/mine.py:G: clearway.run() was called while a run had loaded this part", ended.stderr)
        self.assertIn(CURE, ended.stderr)
        self.assertEqual(self.started, ["study"])

    def test_a_file_that_makes_an_environment_each_time_it_is_loaded_makes_one(self) -> None:
        for call in ("env('intersection', policy=G)", "parallel_env('intersection', policy=G)", "vector_env('intersection', 1, policy=G)"):
            ended = self.ended(str(self.write("mine.py", f"{CLASS}clearway.{call}\n")))
            self.assertEqual(ended.returncode, 1)
            self.assertIn("clearway.env() was called while a run had loaded this part", ended.stderr)
            self.assertIn(CURE, ended.stderr)
            self.assertEqual(self.started, ["python"])

    def test_a_study_file_that_names_the_file_that_runs_it_is_run_once(self) -> None:
        self.write("study.toml", "name = 'own'\nreplications = 1\nscenarios = ['intersection']\n[[condition]]\nname = 'g'\n"
                                 "policy = 'mine.py:G'\n")
        ended = self.ended(str(self.write("mine.py", CLASS + "clearway.study('study.toml')\n")))
        self.assertEqual(ended.returncode, 1)
        self.assertIn("clearway.study() was called while a run had loaded this part", ended.stderr)
        self.assertEqual(self.started, ["study"])

    def test_a_process_that_multiprocessing_starts_does_not_start_what_its_parent_did(self) -> None:
        for call in ("study('none.toml')", "env('none')"):
            script = self.write("mine.py", f"import multiprocessing, clearway\ntry:\n    clearway.{call}\n"
                                           "except clearway.ClearwayError as error:\n    print(error, flush=True)\n"
                                           "if __name__ == '__main__':\n    child = multiprocessing.get_context('spawn').Process(target=int)\n"
                                           "    child.start()\n    child.join()\n")
            ended = self.ended(str(script))
            self.assertEqual(ended.returncode, 0, ended.stderr)
            first, second = ended.stdout.splitlines()
            self.assertIn("none", first)
            self.assertIn("() was called while multiprocessing loaded the main file in a new process", second)
            self.assertIn(CURE, second)
            self.assertLessEqual(len(self.started), 1)

    def test_a_class_that_is_in_no_file_is_refused_with_the_cure(self) -> None:
        for call in (RUN, "clearway.env('intersection', policy=G)"):  # -c, like a notebook's cell, is the main module without a file
            ended = self.ended("-c", CLASS + call)
            self.assertEqual(ended.returncode, 1)
            self.assertIn("InputError: G is not at the top of a file", ended.stderr)
            self.assertIn("name it my_policy.py:G", ended.stderr)
            self.assertEqual(self.started, [])

    def test_with_the_guard_it_runs(self) -> None:
        ended = self.ended(str(self.write("mine.py", f"{CLASS}if __name__ == '__main__':\n    print({RUN.strip()}.runs.row_count)\n")))
        self.assertEqual((ended.returncode, ended.stdout), (0, "4\n"), ended.stderr)
        self.assertEqual(self.started.count("study"), 2)  # the plan, whose hash names the folder, then the runs


if __name__ == "__main__":
    unittest.main()
