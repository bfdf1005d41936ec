"""What check-tidy and check-alone share: how each source is compiled, what it includes, what changed, what was clean before."""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "clearway/checked"
BUILD = ROOT / "build/commands"  # configured as `dev`, never built
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def digest(*parts):
    """One name for all of the parts, which are texts or bytes."""
    total = hashlib.sha256()
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        total.update(len(data).to_bytes(8, "big"))
        total.update(data)
    return total.hexdigest()


def git(*words):
    """Lines that git prints, or nothing when it fails: no git, no repository, no such commit."""
    try:
        ended = subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True, check=False)
    except OSError:
        return None
    return ended.stdout.splitlines() if ended.returncode == 0 else None


def clean_commit(check):
    """The file with the last commit up to which a check has found all changes clean."""
    return CACHE.parent / f"clean-{check}"


def base(check):
    """The commit to compare with, or None: CLEARWAY_BASE, else where this branch left origin/main, else the last commit below
    this one that the check found clean on this machine, else the commit before. This commit itself, where the branch has not
    left it and files differ from it."""
    chosen = os.environ.get("CLEARWAY_BASE")
    if chosen:
        found = git("rev-parse", "--verify", "--quiet", f"{chosen}^{{commit}}")
        if not found:
            sys.exit(f"{check}: CLEARWAY_BASE={chosen} is no commit of this repository (allowed: what git rev-parse knows). "
                     "Correct or unset it")
        return found[0]
    here = git("rev-parse", "HEAD")
    candidates = git("merge-base", "HEAD", "origin/main") or []
    if clean_commit(check).exists():
        candidates += git("merge-base", "HEAD", clean_commit(check).read_text().strip()) or []
    committed = not git("status", "--porcelain")
    for commit in [*candidates, "HEAD~1"]:
        found = git("rev-parse", "--verify", "--quiet", f"{commit}^{{commit}}")
        if found and (found != here or not committed):
            return found[0]
    return None


def remember_clean(check):
    """Notes that all changes up to this commit are clean, unless there are some that are not committed."""
    here = git("rev-parse", "HEAD")
    if here and not git("status", "--porcelain"):
        CACHE.parent.mkdir(parents=True, exist_ok=True)
        clean_commit(check).write_text(here[0])


def changed_files(check):
    """Paths that differ from the base, new ones included; None when there is no base."""
    commit = base(check)
    if commit is None:
        return None
    files = set(git("diff", "--name-only", "--diff-filter=d", commit) or []) | set(
        git("ls-files", "--others", "--exclude-standard") or [])
    print(f"{check}: files that differ from the base {commit[:12]}: {len(files)}; CLEARWAY_BASE=COMMIT names another", file=sys.stderr, flush=True)
    return files


def configure():
    """Commands that compile file by file, all of today's files."""
    ended = subprocess.run(["cmake", "--preset", "dev", "-B", BUILD, "-DCLEARWAY_BENCHMARKS=ON"], cwd=ROOT, capture_output=True,
                           text=True, check=False)
    if ended.returncode != 0:
        sys.exit(f"cmake --preset dev -B {BUILD} failed:\n{ended.stderr}")


class Tree:
    """Sources with a compile command, and what they include of this tree."""

    def __init__(self):
        configure()
        self.commands = {}
        for entry in json.loads((BUILD / "compile_commands.json").read_text()):
            path = os.path.relpath(os.path.join(entry["directory"], entry["file"]), ROOT)
            if not path.startswith(("..", "build/")):
                self.commands[path] = entry
        self._contents, self._includes, self._reached = {}, {}, {}

    def content(self, path):
        if path not in self._contents:
            self._contents[path] = (ROOT / path).read_bytes()
        return self._contents[path]

    def includes(self, path):
        """What a file includes, in its order: paths of this tree, or the words as they are written."""
        if path not in self._includes:
            self._includes[path] = [self._resolved(path, word) for word in INCLUDE.findall(self.content(path).decode())]
        return self._includes[path]

    def _resolved(self, path, word):
        for candidate in (f"src/{word}", f"tests/{word}", os.path.join(os.path.dirname(path), word)):
            candidate = os.path.normpath(candidate)
            if (ROOT / candidate).is_file():
                return candidate
        return word

    def reached(self, path):
        """The file and all that it includes, however indirectly; words of libraries among them."""
        if path not in self._reached:
            seen, open_files = {path}, [path]
            while open_files:
                for part in self.includes(open_files.pop()):
                    if part not in seen:
                        seen.add(part)
                        if (ROOT / part).is_file():
                            open_files.append(part)
            self._reached[path] = seen
        return self._reached[path]

    def key(self, path, *more):
        """Names the state of a source: its text, that of what it includes, its command, wherever the tree is."""
        return self._key(path, self.commands[path], more)

    def header_key(self, header, *more):
        """The same of a header, compiled as its stand-in is."""
        return self._key(header, self.commands[self.stand_in(header)[0]], more)

    def _key(self, path, entry, more):
        parts = sorted(part for part in self.reached(path) if (ROOT / part).is_file())
        command = entry["command"].replace(str(ROOT), "")
        return digest(command, *more, *(part for file in parts for part in (file, self.content(file))))

    def stand_in(self, header):
        """A source that shows how a header is compiled: one that includes it first, or its neighbour, or any that includes it;
        None when there is none. Second: whether it includes the header first."""
        includers = [path for path in self.commands if header in self.includes(path)]
        for path in includers:
            if self.includes(path)[:1] == [header]:
                return path, True
        folder = header.split("/")[:2]
        near = [path for path in includers if path.split("/")[:2] == folder]
        near += [path for path in self.commands if path.split("/")[:2] == folder] + includers
        return (near[0] if near else None), False


def packages():
    """Names and versions of the packages, on which a result depends."""
    ended = subprocess.run(["dpkg-query", "-W", "-f", "${Package} ${Version}\n"], capture_output=True, check=False)
    return digest(*sorted(ended.stdout.splitlines()))


def arguments(description, of_prefixes):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="files at once (default: one per core)")
    parser.add_argument("--changed", action="store_true", help="only what differs from the base: CLEARWAY_BASE, else where this "
                        "branch left origin/main, else the last commit below this one that was clean here, else the commit before")
    parser.add_argument("prefixes", nargs="*", metavar="PATH_PREFIX", help=of_prefixes)
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # who reads may stop, as head does
    return parser.parse_args()


def refuse_unknown(name, prefixes, paths):
    """Ends with 2 where a prefix that was given is that of no path."""
    for prefix in prefixes:
        if not any(path.startswith(prefix) for path in paths):
            print(f"{name}: {prefix}: no path that it looks at begins so (allowed: paths from the top folder, such as src/graph)",
                  file=sys.stderr)
            sys.exit(2)


def flags(entry):
    """The words of a compile command but for the compiler, its launcher, source and output."""
    words = shlex.split(entry["command"])
    while "=" in words[0] or os.path.basename(words[0]) == "ccache":
        del words[0]
    at = words.index("-o")
    del words[at:at + 2]
    return tuple(word for word in words[1:] if word not in ("-c", entry["file"]))


def is_clean(key):
    return (CACHE / key).exists()


def note_clean(key):
    CACHE.mkdir(parents=True, exist_ok=True)
    (CACHE / key).touch()


def check_all(name, tasks, options):
    """Runs tasks (key of the state, function that returns what is wrong) side by side, prints what is wrong, remembers the
    clean ones. Returns the exit code."""
    todo = [(key, task) for key, task in tasks if not is_clean(key)]
    start = last = time.monotonic()
    dirty = done = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        running = {pool.submit(task): key for key, task in todo}
        for job in concurrent.futures.as_completed(running):
            done += 1
            if job.result():
                dirty += 1
                print(job.result(), flush=True)
            else:
                note_clean(running[job])
            if time.monotonic() - last >= 10:
                last = time.monotonic()
                print(f"{name}: {done} of {len(todo)}", file=sys.stderr, flush=True)
    print(f"{name}: {len(tasks)} files, {len(tasks) - len(todo)} known to be clean, {dirty} with findings; "
          f"{time.monotonic() - start:.0f} s", file=sys.stderr)
    if not dirty and not options.prefixes:
        remember_clean(name)
    return 1 if dirty else 0
