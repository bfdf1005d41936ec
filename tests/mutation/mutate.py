"""Whether the tests of the pure modules notice a change: makes small mistakes in their sources, one at a time, and runs the tests.

    mutate.py BUILD [MODULE ...] [--sample N] [--seed S] [--jobs J]

BUILD: a build folder with tests, such as build/ci. A mistake turns a comparison, adds one to a number, swaps + and -, * and /,
&& and ||, or drops a call; of each module N of all that can be made are tried. One that does not compile does not count, nor one
of which survivors.txt says why it changes nothing. The others that no test finds are printed, each of which asks for a test or
a reason there. Ends with 1 where fewer than 85 % are found. Takes 2 to 10 s of processor time for each mistake.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import re
import resource
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SURVIVORS = pathlib.Path(__file__).resolve().parent / "survivors.txt"
# Of actuation only what times signals.
MODULES = {"analysis": "**/*.cpp", "graph": "**/*.cpp", "metrics": "**/*.cpp", "actuation": "detail/[!v]*.cpp"}
TESTS = {"analysis": ["analysis_test", "analysis_replications_test"], "graph": ["graph_test"],
         "metrics": ["metrics_link_quality_test", "metrics_recorder_test"], "actuation": ["actuation_test"]}
LEAST_FOUND = 0.85
LIMIT_S = 120  # of processor time, whatever else the machine does
PATIENCE_S = 3600
SLOW_MS = 150
MOST_BYTES = 4 << 30  # of memory for each process: a loop that no longer ends may allocate in each turn

TURNED = {" < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > ", " == ": " != ", " != ": " == ", " && ": " || ", " || ": " && ",
          " + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= "}
OPERATOR = re.compile("|".join(re.escape(sign) for sign in sorted(TURNED, key=len, reverse=True)))
NUMBER = re.compile(r"(?<![\w.\"'])(\d+)(\.\d+)?(?![\w.'])")
CALL = re.compile(r"^(\s+)(?!return\b|throw\b|delete\b|case\b)[a-z][\w.:\[\]>-]*\([^{}]*\);$")
LEFT_ALONE = re.compile(r"^\s*(#|//|/\*|\*|static_assert|assert\(|using |namespace |template|throw )|\boperator")
TEXT = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|//.*$')


class Mistake:
    def __init__(self, module, file, number, line, changed):
        self.module, self.file, self.number, self.line, self.changed = module, file, number, line, changed

    def name(self):
        return f"{self.file.relative_to(ROOT / 'src')} | {self.line.strip()} | {self.changed.strip()}"

    def text(self):
        lines = self.file.read_text(encoding="utf-8").splitlines()
        lines[self.number] = self.changed
        return "\n".join(lines) + "\n"


def mistakes_of(module, file):
    """All that can be made in a file."""
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines()):
        if LEFT_ALONE.search(line):
            continue
        bare = TEXT.sub(lambda found: "_" * len(found[0]), line)  # texts and comments stay as they are
        changes = [(found.span(), TURNED[found[0]]) for found in OPERATOR.finditer(bare)]
        changes += [(found.span(1), str(int(found[1]) + 1)) for found in NUMBER.finditer(bare)]
        for (begin, end), new in changes:
            yield Mistake(module, file, number, line, line[:begin] + new + line[end:])
        if found := CALL.match(bare):
            yield Mistake(module, file, number, line, f"{found[1]};")


class Bench:
    """Compiles a mistake, links the tests of its module and runs them."""

    def __init__(self, build, modules, jobs):
        self.build, self.files = build, build / "mutation"
        subprocess.run(["cmake", "--preset", "ci", "-B", self.files, "-DCMAKE_UNITY_BUILD=OFF",
                        "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"], cwd=ROOT, check=True,
                       stdout=subprocess.DEVNULL)
        commands = json.loads((self.files / "compile_commands.json").read_text(encoding="utf-8"))
        self.compile = {pathlib.Path(entry["file"]).resolve(): shlex.split(entry["command"]) for entry in commands}
        self.link = {test: self.link_command(test) for module in modules for test in TESTS[module]}
        self.slow = {test: self.slow_tests(test) for test in self.link}
        sources = [file for file in self.compile for module in modules if file.is_relative_to(ROOT / "src" / module)]
        self.objects = {file: self.files / f"{number}.o" for number, file in enumerate(sources)}
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            if not all(pool.map(self.make, sources, sources, self.objects.values())):
                sys.exit("a source does not compile without a mistake")

    def link_command(self, test):
        listed = subprocess.run(["ninja", "-C", self.build, "-t", "commands", f"tests/{test}"], check=True, capture_output=True, text=True)
        words = shlex.split(listed.stdout.splitlines()[-1])
        first = words.index("&&") + 1
        return words[first:words.index("&&", first)]

    def slow_tests(self, test):
        """Names of those that take long, which run last."""
        ran = subprocess.run([self.build / "tests" / test], capture_output=True, text=True, check=False, cwd=self.build)
        if ran.returncode:
            sys.exit(f"{test} fails without a mistake:\n{ran.stdout[-2000:]}")
        return [name for name, took in re.findall(r"\[       OK \] (\S+) \((\d+) ms\)", ran.stdout) if int(took) > SLOW_MS]

    def make(self, file, source, made):
        """Compiles `source` as `file` is compiled; whether that succeeds."""
        words = [str(source) if word == str(file) else word for word in self.compile[file] if word != "-Werror"]
        words[words.index("-o") + 1] = str(made)
        return subprocess.run([*words, "-w", "-O0"], cwd=self.files, capture_output=True, check=False).returncode == 0

    def is_found(self, mistake):
        """None where it does not compile."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            source, made = folder / mistake.file.name, folder / "mistake.o"
            source.write_text(mistake.text(), encoding="utf-8")
            if not self.make(mistake.file, source, made):
                return None
            return any(self.fails(test, mistake, folder, made) for test in TESTS[mistake.module])

    def fails(self, test, mistake, folder, made):
        archive = f"src/{mistake.module}/libclearway_{mistake.module}.a"
        others = [str(at) for file, at in self.objects.items()
                  if file != mistake.file and file.is_relative_to(ROOT / "src" / mistake.module)]
        program = folder / test
        words = []
        for word in self.link[test]:
            words += [str(made), *others] if word == archive else [word]
        words[words.index("-o") + 1] = str(program)
        linked = subprocess.run(words, cwd=self.build, capture_output=True, text=True, check=False)
        if linked.returncode:
            sys.exit(f"cannot link {test}: {linked.stderr[-2000:]}")
        slow = ":".join(self.slow[test])
        for only in [f"--gtest_filter=-{slow}", *([f"--gtest_filter={slow}"] if slow else [])]:
            try:
                ran = subprocess.run([program, "--gtest_fail_fast", "--gtest_brief=1", only], cwd=folder, capture_output=True, check=False,
                                     timeout=PATIENCE_S, preexec_fn=limit_processor)
            except subprocess.TimeoutExpired:
                return True
            if ran.returncode:
                return True
        return False


def limit_processor():
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT_S, LIMIT_S))


def reasons():
    """Why a mistake changes nothing, by its name."""
    known = {}
    for line in SURVIVORS.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            name, reason = line.rsplit(" | ", 1)
            known[name] = reason
    return known


def judge(module, bench, asked, known):
    """Prints what survived; whether that is few enough."""
    files = sorted((ROOT / "src" / module).glob(MODULES[module]))
    tried = [mistake for file in files for mistake in mistakes_of(module, file)]
    possible = len(tried)
    tried = random.Random(f"{asked.seed} {module}").sample(tried, min(asked.sample, possible))
    found, listed = [], 0
    with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        for mistake, is_found in zip(tried, pool.map(bench.is_found, tried)):
            found.append(is_found)
            if is_found is not False:
                continue
            if mistake.name() in known:
                listed += 1
            else:
                print(f"  line {mistake.number + 1}: {mistake.name()}", flush=True)
    compiled = sum(is_found is not None for is_found in found) - listed
    share = found.count(True) / max(compiled, 1)
    print(f"{module}: {len(tried)} of {possible} mistakes, {compiled + listed} compile, {found.count(True)} found ({share:.0%}), "
          f"{listed} change nothing", flush=True)
    return share >= LEAST_FOUND


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", metavar="BUILD", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("modules", metavar="MODULE", nargs="*", help=", ".join(MODULES))
    parser.add_argument("--sample", type=int, default=10**6)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    asked = parser.parse_args()
    if unknown := set(asked.modules) - set(MODULES):
        parser.error(f"{', '.join(sorted(unknown))}: unknown; one of {', '.join(MODULES)}")
    resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
    modules = asked.modules or list(MODULES)
    bench = Bench(asked.build, modules, asked.jobs)
    known = reasons()
    ends = [judge(module, bench, asked, known) for module in modules]
    sys.exit(not all(ends))


if __name__ == "__main__":
    main()
