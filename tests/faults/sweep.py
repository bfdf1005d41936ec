"""The machine fails at the n-th system call of a command. Wanted: no false "done", a message otherwise, and the same command again
gives what an untroubled one gives.

    sweep.py BIN [--cases N] [--kills N] [--part K/M] [--slow SHARE] [--verb NAME] [--messages]

Tries N of all faults, spread evenly over verbs, programs, calls and numbers: each call of CALLS fails with each error of ERRORS
(--cases) or kills the process that makes it (--kills). --part tries every M-th of the N, from the K-th on: M calls, at any time and
on any machine, try all. Ends with 77 where strace cannot inject faults. --messages prints what the commands said.
"""
import argparse
import collections
import concurrent.futures
import filecmp
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from tracing import require_strace

CALLS = ("openat", "getdents64", "read", "pread64", "write", "pwrite64", "fsync", "rename", "mkdir", "clone", "mmap", "ftruncate", "newfstatat")
ERRORS = ("EIO", "ENOSPC", "EMFILE", "ENOMEM")
LIMIT_S = 120
# What two equal commands write differently: times, process numbers. What evaluation.csv says beside times is in runs/*.links.
CHANGING = re.compile(r"[/.]timing\.json$|^units/|/jobs/|^logs/|^\.lock$|\.pdf$|/netconvert\.log$|^evaluation\.(csv|json)$|^links\.html$")
# What a killed process leaves under a name that the next one does not take, jobs of links, the log of a second attempt, and the times
# that only a study which was made in one go notes.
LEFT = re.compile(r"\.\d+\.clearway-part$|^jobs/.*-\d+\.(json|log)$|^logs/.*\.\d+\.log$|^run-costs\.json$")
# Whoever exits with 3 blames the input; of a machine that failed in passing it has to say so beside that.
BLAMELESS = re.compile(r"give the same command again|in case the machine failed", re.IGNORECASE)
# A message ends with what to do; the system's loader knows nothing better.
CURE = re.compile(r"(again|[Cc]hoose|[Cc]heck|Free|Set|[Ii]nstall|[Rr]emove)\b[^.:]*$|error while loading shared libraries|Fatal glibc error|cannot allocate TLS|To continue:|Mount /proc:", re.M)
SILENCED = re.compile(r"write\(2, .*INJECTED")
LOADED = re.compile(r'"[^"]*(\.so\b|/ld\.so\.cache)')
STUDY = """name = "study"
scenarios = ["intersection"]
conditions = ["baseline", "corridor"]
replications = 1
"""


class Verb:
    def __init__(self, name, words, made="", given=(), programs=("clearway",), counts=False, once=False, judges=False):
        """`made`: the folder that the command writes, below the working folder; `given`: folders that it finds there; `programs`:
        whose system calls fail, in turn; `counts`: it prints how much was left to do, so that a repetition prints something else; `once`: it
        refuses a folder that is there; `judges`: what it finds wrong is its output."""
        self.name, self.words, self.made, self.given, self.programs, self.counts, self.once = name, words.split(), made, given, programs, counts, once
        self.judges = judges
        self.is_slow = (bool(made) and name not in ("merge", "report", "trajectories")) or name == "verify"


VERBS = [
    Verb("run", "run merge --policy corridor --no-solo --seeds 1 --jobs 1 --record --out out", "out",
         programs=("clearway", "clearway-run", "netconvert")),
    Verb("study", "study study.toml --jobs 1 --out out", "out", programs=("clearway", "clearway-run")),
    Verb("dataset", "links dataset merge --out out", "out", programs=("clearway", "clearway-run")),
    Verb("evaluate", "links evaluate merge --predictor none last_seen --failure B10 --exits known --seeds 1 --validation-seeds 1 --jobs 1 "
         "--out out", "out", programs=("clearway", "clearway-run")),
    Verb("import of a map", "scenario import town.osm --name town", "town", programs=("clearway", "netconvert"), once=True),
    Verb("import of a SUMO scenario", "scenario import line.sumocfg --name line", "line", once=True),
    Verb("merge", "study merge one two --out out", "out", given=("one", "two"), counts=True),
    Verb("report", "report whole", "whole", given=("whole",)),
    Verb("export", "export figures whole --out out", "out", given=("whole",)),
    Verb("results", "export results whole vehicles", given=("whole",)),
    Verb("compare", "compare one two", given=("one", "two")),
    Verb("status", "study status one", given=("one",)),
    Verb("signals", "scenario signals intersection"),
    Verb("replay", "replay recorded/merge/corridor/0 --csv belief", given=("recorded",)),
    Verb("trajectories", "export trajectories recorded/merge/corridor/0 --out out", "out", given=("recorded",)),
    Verb("verify", "verify recorded --all --jobs 1", given=("recorded",), programs=("clearway", "clearway-run"), judges=True),
]

# One crossing of two streets with a signal, a hospital and a fire station, of which Overpass says that more is missing.
MAP = """<?xml version='1.0' encoding='UTF-8'?>
<osm version='0.6'>
<node id='1' version='1' lat='51.000' lon='13.004'/><node id='2' version='1' lat='51.004' lon='13.000'/>
<node id='3' version='1' lat='51.004' lon='13.004'><tag k='highway' v='traffic_signals'/></node>
<node id='4' version='1' lat='51.004' lon='13.008'/><node id='5' version='1' lat='51.008' lon='13.004'/>
<node id='6' version='1' lat='51.0001' lon='13.0041'><tag k='amenity' v='hospital'/></node>
<node id='7' version='1' lat='51.0079' lon='13.0041'><tag k='amenity' v='fire_station'/></node>
<way id='10' version='1'><nd ref='1'/><nd ref='3'/><nd ref='5'/><tag k='highway' v='secondary'/></way>
<way id='11' version='1'><nd ref='2'/><nd ref='3'/><nd ref='4'/><tag k='highway' v='secondary'/></way>
<remark>runtime error: the query timed out</remark>
</osm>
"""
LINE = {
    "line.nod.xml": "<nodes><node id='a' x='0' y='0'/><node id='b' x='600' y='0'/><node id='c' x='1200' y='0'/></nodes>",
    "line.edg.xml": "<edges><edge id='first' from='a' to='b' numLanes='2'/><edge id='second' from='b' to='c' numLanes='2'/></edges>",
    "line.rou.xml": "<routes><vType id='car'/><flow id='f' type='car' begin='0' end='600' number='40' from='first' to='second'/>"
                    "</routes>",
    "line.sumocfg": "<configuration><input><net-file value='line.net.xml'/><route-files value='line.rou.xml'/></input>"
                    "<time><begin value='0'/><end value='900'/></time></configuration>",
}


class Tried:
    """What came of one command."""

    def __init__(self, code, out, said, met):
        self.code, self.out, self.said, self.met = code, out, said, met


class Bench:
    """A folder in which a command runs, with programs that can be made to fail."""

    def __init__(self, folder, programs, pristine):
        self.folder, self.pristine = folder, pristine
        self.work, self.temporary, self.trace = folder / "work", folder / "temporary", folder / "trace"
        bin_folder = folder / "bin"
        for made in (folder, self.temporary, bin_folder):
            made.mkdir()
        shutil.copy2(programs / "clearway", bin_folder)
        for name, real in (("clearway-run", programs / "clearway-run"), ("netconvert", shutil.which("netconvert"))):
            (bin_folder / name).write_text(f'#!/bin/sh\nif [ "$1" = --version ]; then exec {real} "$@"; fi\n'
                                           f'if [ "$SWEEP_PROGRAM" = {name} ]; then exec $SWEEP_STRACE {real} "$@"; fi\n'
                                           f'exec {real} "$@"\n', encoding="utf-8")
            (bin_folder / name).chmod(0o755)
        self.program = bin_folder / "clearway"
        self.environment = {**os.environ, "TMPDIR": str(self.temporary), "PATH": f"{bin_folder}:{os.environ['PATH']}"}

    def prepare(self, verb):
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir()
        for path in self.pristine.iterdir():
            if path.is_file():
                shutil.copy2(path, self.work)
            elif path.name in verb.given:
                shutil.copytree(path, self.work / path.name)

    def run(self, verb, program="", inject=""):
        """`inject`: strace's words for the fault; empty: `program` is only traced."""
        self.trace.unlink(missing_ok=True)
        words, environment = [self.program, *verb.words], self.environment
        traced = f"strace -f -qq -A -o {self.trace} -e trace={','.join(CALLS)} {inject}"
        if program == "clearway":
            words = [*f"{traced} -b execve".split(), *words]
        elif program:
            fast = "" if "signal=" in inject else "--seccomp-bpf"  # with which strace 6.1 sends no signal
            environment = {**environment, "SWEEP_PROGRAM": program, "SWEEP_STRACE": f"{traced} {fast}"}
        with subprocess.Popen(words, cwd=self.work, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              errors="replace", start_new_session=True) as running:
            try:
                out, said = running.communicate(timeout=LIMIT_S)
            except subprocess.TimeoutExpired:
                os.killpg(running.pid, 9)
                out, said = running.communicate()
                said += f"\nstill running after {LIMIT_S} s"
                return Tried(999, out, said, True)
        met = "+++ killed by SIGKILL +++" if "signal=SIGKILL" in inject else "INJECTED"
        return Tried(running.returncode, out, said, met in self.traced())

    def traced(self):
        return self.trace.read_text(encoding="utf-8", errors="replace") if self.trace.exists() else ""

    def left(self):
        """Names left in the folder for temporary files, which is emptied."""
        names = sorted(path.name for path in self.temporary.iterdir())
        shutil.rmtree(self.temporary)
        self.temporary.mkdir()
        return names


def files_of(folder):
    """All but LEFT."""
    names = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file() or path.is_symlink()}
    return {name for name in names if not LEFT.search(name)}


def difference(made, wanted):
    """In words; empty when all that two equal commands write alike is alike."""
    if not made.exists():
        return f"no {made.name}"
    ours, theirs = files_of(made), files_of(wanted)
    if ours != theirs:
        return "other files: " + ", ".join(sorted(ours ^ theirs)[:4])
    for name in sorted(theirs):
        if not CHANGING.search(name) and not filecmp.cmp(made / name, wanted / name, shallow=False):
            return f"another {name}"
    return ""


def numbers_of_calls(trace):
    """How often each call can fail: numbers of calls of any one process, without those by which the system loads its libraries."""
    processes = collections.defaultdict(list)
    for line in trace.splitlines():
        if found := re.match(r"(\d+) +(\w+)\(", line):
            processes[found[1]].append((found[2], line))
    numbers = collections.defaultdict(set)
    for calls in processes.values():
        loaded = max((at for at, (call, line) in enumerate(calls) if call == "openat" and LOADED.search(line)), default=-1)
        counts = collections.Counter()
        for at, (call, _) in enumerate(calls):
            counts[call] += 1
            if at > loaded:
                numbers[call].add(counts[call])
    return {call: sorted(numbers[call]) for call in CALLS if numbers[call]}


def spread(things, count):
    """`count` of them, evenly."""
    if count >= len(things):
        return list(things)
    return [things[int((at + 0.5) * len(things) / count)] for at in range(count)]


def chosen(strata, total):
    """`total` cases, as many of each stratum as of any other, as far as it has them."""
    if total < len(strata):
        return [spread(stratum, 1)[0] for stratum in spread(strata, total)]
    left, picked = total, []
    for at, stratum in enumerate(sorted(strata, key=len)):
        cases = spread(stratum, left // (len(strata) - at))
        left -= len(cases)
        picked += cases
    return picked


def divided(strata, total, slow_share):
    """`total` cases, of which the share `slow_share` are of verbs that take a second."""
    slow = [stratum for stratum in strata if stratum[0][0].is_slow]
    if len(slow) in (0, len(strata)):
        return chosen(strata, total)
    return chosen(slow, round(slow_share * total)) + chosen([one for one in strata if one not in slow], round((1 - slow_share) * total))


class Sweep:
    def __init__(self, benches, verbs):
        self.benches, self.wanted, self.messages = benches, {}, collections.Counter()
        self.faults, self.kills = [], []
        for verb in verbs:
            self.know(verb, benches[0])

    def know(self, verb, bench):
        """Runs the verb untroubled, and lists the faults that it can meet."""
        for program in verb.programs:
            bench.prepare(verb)
            tried = bench.run(verb, program)
            if tried.code or bench.left():
                sys.exit(f"{verb.name} fails untroubled, or leaves temporary files: {tried.said}")
            numbers = numbers_of_calls(bench.traced())
            for call, ns in numbers.items():
                self.faults.append([(verb, program, call, error, n) for n in ns for error in ERRORS])
                self.kills.append([(verb, program, call, "SIGKILL", n) for n in ns])
        kept = bench.folder.parent / f"wanted {verb.name}"
        if verb.made:
            (bench.work / verb.made).rename(kept)
        self.wanted[verb.name] = (tried.out, kept)

    def judge(self, bench, case):
        """What is wrong with how the case ended, in words; None: there was no such call."""
        verb, program, call, fault, n = case
        killed = fault == "SIGKILL"
        out, kept = self.wanted[verb.name]
        bench.prepare(verb)
        inject = f"-e inject={call}:{'signal' if killed else 'error'}={fault}:when={n}"
        tried = bench.run(verb, program, inject)
        wrong = []
        if not tried.met:
            return None
        if verb.judges and tried.code:
            tried.said += tried.out
        if tried.code == 0:
            if tried.out != out:
                wrong.append("exit code 0 and another output")
            if verb.made and (other := difference(bench.work / verb.made, kept)):
                wrong.append(f"exit code 0 and {other}")
        elif killed and program == "clearway":
            pass
        elif tried.code < 0 or tried.code >= 128:
            wrong.append(f"ended with {tried.code}: {tried.said[-200:]}")
        elif not (tried.said.strip() or SILENCED.search(bench.traced())):
            wrong.append(f"exit code {tried.code} without a word")
        elif tried.code == 3 and not BLAMELESS.search(tried.said):
            wrong.append(f"blames the input: {tried.said.strip()[-300:]}")
        elif tried.code == 4 and not (CURE.search(tried.said) or SILENCED.search(bench.traced())):
            wrong.append(f"names no cure: {tried.said.strip()[-300:]}")
        self.messages[f"{tried.code}: {tried.said.strip()[-300:]}"] += 1
        if not killed and (left := bench.left()):
            wrong.append(f"left in the folder for temporary files: {', '.join(left)}")
        if verb.made and tried.code:
            wrong += self.again(bench, verb, out, kept)
        bench.left()
        return wrong

    def again(self, bench, verb, out, kept):
        """What is wrong after the same command again."""
        if verb.once and (bench.work / verb.made).exists():
            return [f"not done, but {other}"] if (other := difference(bench.work / verb.made, kept)) else []
        tried = bench.run(verb)
        if tried.code:
            return [f"fails when repeated, {tried.code}: {tried.said.strip()[-300:]}"]
        wrong = ["repeated: another output"] if tried.out != out and not verb.counts else []
        if other := difference(bench.work / verb.made, kept):
            wrong.append(f"repeated: {other}")
        known = {verb.made, *verb.given, *(path.name for path in bench.pristine.iterdir() if path.is_file())}
        if left := [path.name for path in bench.work.iterdir() if path.name not in known and not LEFT.search(path.name)]:
            wrong.append(f"repeated: left beside it: {', '.join(left)}")
        return wrong

    def all(self, cases):
        """How many met a call, and lines about those that ended badly, which are printed at once."""
        free, lines, met = list(self.benches), [], 0

        def one(case):
            bench = free.pop()
            try:
                return case, self.judge(bench, case)
            finally:
                free.append(bench)

        with concurrent.futures.ThreadPoolExecutor(len(self.benches)) as pool:
            for (verb, program, call, fault, n), wrong in pool.map(one, cases):
                met += wrong is not None
                for what in wrong or ():
                    lines.append(f"{verb.name}, {program}, {call} {n}, {fault}: {what}")
                    print(lines[-1], flush=True)
        return met, lines


def part(text):
    """(K, M) of K/M."""
    number, count = map(int, text.split("/"))
    if not 1 <= number <= count:
        raise ValueError
    return number, count


def make_pristine(folder, programs):
    """What the verbs find in their folder."""
    folder.mkdir()
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    (folder / "town.osm").write_text(MAP, encoding="utf-8")
    for name, text in LINE.items():
        (folder / name).write_text(text, encoding="utf-8")
    command = ["netconvert", "-n", "line.nod.xml", "-e", "line.edg.xml", "-o", "line.net.xml"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    two = STUDY.replace("replications = 1", "replications = 2")
    (folder / "two.toml").write_text(two, encoding="utf-8")
    for words in ("run merge --policy corridor --no-solo --seeds 1 --jobs 1 --record --out recorded", "study two.toml --shard 1/2 --jobs 1 --out one", "study two.toml --shard 2/2 --jobs 1 --out two",
                  "study merge one two --out whole", "report whole"):
        subprocess.run([programs / "clearway", *words.split()], cwd=folder, check=True, capture_output=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", metavar="BIN", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--cases", type=int, default=0)
    parser.add_argument("--kills", type=int, default=0)
    parser.add_argument("--part", type=part, default=(1, 1), metavar="K/M")
    parser.add_argument("--slow", type=float, default=0.6, metavar="SHARE", help="of the cases, of verbs that take a second")
    parser.add_argument("--verb", action="append", choices=[verb.name for verb in VERBS])
    parser.add_argument("--messages", action="store_true")
    parser.add_argument("--jobs", type=int, default=1)
    asked = parser.parse_args()
    require_strace("-f", "--seccomp-bpf", "-e", "inject=read:error=EIO:when=9999")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_pristine(folder / "pristine", asked.programs)
        benches = [Bench(folder / str(at), asked.programs, folder / "pristine") for at in range(asked.jobs)]
        sweep = Sweep(benches, [verb for verb in VERBS if not asked.verb or verb.name in asked.verb])
        wrong = []
        for kind, strata, total in (("faults", sweep.faults, asked.cases), ("kills", sweep.kills, asked.kills)):
            if total:
                number, count = asked.part
                met, lines = sweep.all(divided(strata, total, asked.slow)[number - 1::count])
                print(f"{kind}: {met} of {sum(map(len, strata))} tried, {len(lines)} badly ended", flush=True)
                wrong += lines
    if asked.messages:
        print("\n".join(f"{count} x {said}" for said, count in sweep.messages.most_common()))
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
