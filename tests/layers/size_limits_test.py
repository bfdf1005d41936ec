"""Tests of scripts/count-house --check and of what scripts/count-docs shares with it, in small trees."""
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LIMIT = "tests/layers/lines_of_src.txt"


class House(unittest.TestCase):
    """A tree of one module with three lines of code, which are allowed, and one test."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for script in ("count-house", "size_limits.py", "source_tree.py"):
            self.write(f"scripts/{script}", (ROOT / "scripts" / script).read_text())
        self.write("src/core/a.cpp", "int a() {\n    return 1;  // no blank lines\n\n    // comments alone\n}\n")
        self.write("src/core/CMakeLists.txt", "clearway_module(core)\n")
        self.write("tests/core/a_test.cpp", "")
        self.write("tests/core/CMakeLists.txt", "clearway_test(core_test SOURCES a_test.cpp USES core)\n")
        self.write(LIMIT, "# why\n3\n")

    def write(self, file, text):
        (self.root / file).parent.mkdir(parents=True, exist_ok=True)
        (self.root / file).write_text(text)

    def check(self, option="--check"):
        done = subprocess.run([sys.executable, self.root / "scripts/count-house", option], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def refused(self, *words, option="--check"):
        code, said = self.check(option)
        self.assertEqual(code, 1, said)
        for word in words:
            self.assertIn(word, said)
        return said

    def test_a_tree_within_its_limit_passes(self):
        self.assertEqual(self.check(), (0, ""))

    def test_the_line_that_is_printed_allows_more_once_it_has_a_reason(self):
        self.write("src/core/b.cpp", "int b() {\n    return 2;\n}\n")
        line = re.search(r"(?m)^    (\+3 .*)$", self.refused("src has 6 lines of code, more than the 3 of " + LIMIT))[1]
        self.write(LIMIT, f"3\n{line}\n")
        self.refused(f"{LIMIT}:2: ", "write why in place of REASON")
        self.write(LIMIT, f"3\n{line.replace('REASON', 'b is two')}\n")
        self.assertEqual(self.check(), (0, ""))

    def test_a_line_that_would_be_lost_is_told(self):
        self.write(LIMIT, "3\n+1 2026-11-27: no line feed")
        self.refused(f"{LIMIT}:2: has no line feed at its end")
        self.write(LIMIT, "3\n+1 2026-11-27: one+2 2026-11-28: glued to it\n")
        self.refused(f"{LIMIT}:2: ", "two lines in one")

    def test_lines_of_two_branches_add_up(self):
        self.write("src/core/b.cpp", "int b() {\n    return 2;\n}\n")
        self.write(LIMIT, "3\n+1 2026-11-27: one branch\n+2 2026-11-28: another\n")
        self.assertEqual(self.check(), (0, ""))

    def test_what_is_no_limit_is_refused(self):
        for text, what in (("3\n4\n", "a second limit, beside 3"), ("3\nfour\n", "neither a comment, nor a limit"),
                           ("3\n+1\n", "neither a comment, nor a limit"), ("3\nwords +1 2026-11-27: why\n", "no line above has"),
                           ("# none\n", "no number")):
            self.write(LIMIT, text)
            self.refused(what)

    def test_a_wall_is_told_from_a_missing_arrow(self):
        for module, uses in (("truth", ""), ("policy", " USES core")):
            self.write(f"src/{module}/CMakeLists.txt", f"clearway_module({module}{uses})\n")
        self.write("src/truth/t.hpp", "")
        self.write("src/core/c.hpp", "")
        self.write("src/policy/registry.cpp", '#include "core/c.hpp"\n#include "truth/t.hpp"\n')
        self.write("tests/layers/allowed.txt", "core:\ntruth: core\npolicy: core\n")
        self.write(LIMIT, "9\n")
        self.refused("src/policy/registry.cpp includes truth/t.hpp: policy uses truth and does not declare it: policy must not see truth (tests/layers/allowed.txt)")
        self.write("tests/layers/allowed.txt", "core:\ntruth: core\npolicy: core truth\n")
        self.refused("policy uses truth and does not declare it: declare it in src/policy/CMakeLists.txt")

    def test_a_policy_that_nothing_registers_is_found(self):
        self.write("src/policy/CMakeLists.txt", "clearway_module(policy)\n")
        self.write("src/policy/slow.hpp", "")
        self.write("src/policy/slow.cpp", '#include "policy/slow.hpp"\n')
        self.write(LIMIT, "9\n")
        self.refused("src/policy/slow.hpp is included by nothing but its own source: register the part in src/policy/registry.cpp")
        self.write("src/policy/registry.cpp", '#include "policy/slow.hpp"\n')
        self.assertEqual(self.check(), (0, ""))

    def test_a_policy_without_a_test_of_its_own_is_found(self):
        self.write("src/policy/CMakeLists.txt", "clearway_module(policy)\n")
        self.write("src/policy/slow.hpp", "")
        self.write("src/policy/registry.cpp", '#include "policy/slow.hpp"\nentry<Slow, SlowConfig>(\n    "slow", "Drives slowly");\n')
        self.write("tests/policy/CMakeLists.txt", "clearway_test(policy_test SOURCES conformance_test.cpp slow_test.cpp USES policy)\n")
        self.write("tests/policy/conformance_test.cpp", '"slow"')
        self.write(LIMIT, "9\n")
        self.refused("the policy `slow` has no test: write tests/policy/slow_test.cpp")
        self.write("tests/policy/slow_test.cpp", '#include "policy/slow.hpp"\n')
        self.write("docs/reference/policies.md", "| `slow` | drives slowly | anywhere |\n")
        self.write("studies/harm/roads.toml", 'condition = [{name = "slow", policy = ["slow"]}]\n')
        self.write("studies/harm/motorways.toml", "# Nothing to do there: slow\n")
        self.write("CHANGELOG.md", "- Policy `slow`: drives slowly.\n")
        self.assertEqual(self.check(), (0, ""))
        for file, what in (("docs/reference/policies.md", "the policy `slow` has no row of three columns in docs/reference/policies.md"),
                           ("studies/harm/roads.toml", "the policy `slow` has no condition in studies/harm"),
                           ("studies/harm/motorways.toml", "studies/harm/motorways.toml does not name the policy `slow`"),
                           ("CHANGELOG.md", "CHANGELOG.md does not name the policy `slow`: add a line below its first `### Added`")):
            text = (self.root / file).read_text()
            self.write(file, "")
            self.assertEqual(self.refused(what).count("\n"), 1)
            self.write(file, text)
        self.write("studies/harm/motorways.toml", 'condition = [\n    {name = "slow", policy = ["slow"]},\n]\n')
        self.refused('studies/harm/motorways.toml: the condition `slow` lacks traffic_model = "sublane"')
        self.write("studies/harm/motorways.toml", '{name = "slow", policy = ["slow"], traffic_model = "sublane"}\n')
        self.write("studies/harm/roads.toml", 'policy = ["slow"]\npolicy = ["slwo"]\n')
        self.refused("studies/harm tries the policy `slwo`, which is not registered")
        self.write("studies/harm/roads.toml", 'policy = ["slow"]\n')
        self.write("docs/reference/policies.md", "| policy | a | b |\n|---|---|---|\n| `slow` | a | b |\n| `slwo` | a | b |\n\n| `other` | a | b |\n")
        self.assertEqual(self.refused("docs/reference/policies.md has a line for the policy `slwo`, which is not registered").count("\n"), 1)
        self.write("docs/reference/policies.md", "| `slow` | drives slowly | anywhere |\n")
        self.write("docs/limits.md", "## Policies that harm\n\n- **`slwo`**: EVs in `city`.\n\n## More\n\n- **`other`**: none.\n")
        self.assertEqual(self.refused("docs/limits.md has a line for the policy `slwo`, which is not registered").count("\n"), 1)

    def test_a_policy_that_combines_one_that_is_not_there_is_found(self):
        registry = 'entry<Slow, SlowConfig>("slow", "Drives slowly"),\ncombination<Both>("both",\n    "slow and fast", {"slow", "slwo"})\n'
        self.write("src/policy/CMakeLists.txt", "clearway_module(policy)\n")
        self.write("src/policy/registry.cpp", registry)
        for option in ("--check", "--names"):
            self.refused("src/policy/registry.cpp: `both` combines `slwo`, which is no policy (allowed: slow, both). Write `slow`, or", option=option)
        self.write("src/policy/registry.cpp", registry.replace("slwo", "x"))
        self.refused("`both` combines `x`, which is no policy (allowed: slow, both). Register it", option="--names")
        self.write("src/policy/registry.cpp", registry.replace('"slwo"', '"both"'))
        self.assertEqual(self.check("--names"), (0, ""))

    def test_a_predictor_that_the_changelog_does_not_name_is_found(self):
        self.write("src/prediction/CMakeLists.txt", "clearway_module(prediction)\n")
        self.write("src/prediction/oracle.hpp", 'inline constexpr const char* oracle_name = "oracle";\n')
        self.write("src/prediction/predictor.cpp", '#include "prediction/oracle.hpp"\nregistered<make_last, Config>(\n    "last", "l"),\n'
                   'registered<make_oracle>(oracle_name, "o")\n')
        self.write(LIMIT, "9\n")
        self.write("CHANGELOG.md", "- Predictor `last_seen`, an oracle.\n")
        self.refused("CHANGELOG.md does not name the predictor `last`: ", "CHANGELOG.md does not name the predictor `oracle`: add a line")
        self.write("CHANGELOG.md", "- Predictors `last` and `oracle`.\n")
        self.assertEqual(self.check(), (0, ""))

    def test_a_test_that_no_list_names_is_found(self):
        self.write("tests/core/core_test.cpp", "")  # is the name of the program
        self.write("tests/core/deep/b_test.cpp", "")
        self.write("tests/core/CMakeLists.txt", "# deep/b_test.cpp\nclearway_test(core_test SOURCES a_test.cpp USES core)\n")
        said = self.refused("tests/core/core_test.cpp is in no CMakeLists.txt", "tests/core/deep/b_test.cpp is in no")
        self.assertNotIn("a_test.cpp", said)

    def test_a_name_that_a_function_puts_together_counts(self):
        self.write("tests/core/page_test.py", "")
        self.refused("tests/core/page_test.py")
        self.write("tests/core/CMakeLists.txt", "clearway_test(core_test SOURCES a_test.cpp USES core)\nadd(${name}_test)\nadd(page)\n")
        self.assertEqual(self.check(), (0, ""))

    def test_lines_that_were_too_many_before_are_told_from_those_of_a_change(self):
        git = shutil.which("git")
        if git is None:
            self.skipTest("git is not installed")
        self.write(LIMIT, "2\n")
        for words in (["init", "-q"], ["add", "."], ["commit", "-qm", "begin"], ["commit", "-q", "--allow-empty", "-m", "go on"]):
            subprocess.run([git, "-c", "user.name=test", "-c", "user.email=test@invalid", *words], cwd=self.root, check=True)
        self.write("src/core/b.cpp", "int b() {\n    return 2;\n}\n")
        self.assertRegex(self.refused("src has 6 lines of code"), r"\+4 .*REASON\nYour change begins at \w{12} with 3 lines, of at most 2 there\.")

    def test_merges_keep_the_lines_of_both(self):
        git = shutil.which("git")
        if git is None:
            self.skipTest("git is not installed")
        self.write(".gitattributes", (ROOT / ".gitattributes").read_text())

        def run(*words):
            subprocess.run([git, "-c", "user.name=test", "-c", "user.email=test@invalid", *words], cwd=self.root, check=True,
                           capture_output=True)

        run("init", "-q", "-b", "main")
        for branch, line in (("main", ""), ("one", "+1 2026-11-27: one branch\n"), ("two", "+2 2026-11-28: another\n")):
            run("checkout", "-q", *(["-b", branch, "main"] if line else ["--orphan", "start"]))
            self.write(LIMIT, f"3\n{line}")
            run("add", "-A")
            run("commit", "-qm", branch)
            if not line:
                run("branch", "-M", "main")
        run("merge", "-q", "one")
        self.assertEqual((self.root / LIMIT).read_text().count("+"), 2)


if __name__ == "__main__":
    unittest.main()
