"""What a command wrote survives a loss of power: runs commands under strace and asks that every file that they leave was flushed
before it was renamed to its name, and every folder after the last change of its entries.

    flushed.py BIN      ends with 77 where strace cannot trace
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from tracing import require_strace

CALLS = "openat,creat,link,linkat,rename,renameat,renameat2,mkdir,mkdirat,unlink,unlinkat,fsync,fdatasync"
# What may be lost: times of runs, jobs and demand, which are made anew, output of workers, the note of a lock.
MAY_BE_LOST = re.compile(r"/timing\.json$|/(logs|units|demand)(/|$)|/netconvert\.log$|/\.lock$")


def path_of(word, folder):
    return os.path.normpath(os.path.join(folder, word))


class Disk:
    """Which files and folders are on the disk, by the order of the calls."""

    def __init__(self, folder):
        self.folder, self.flushed = folder, set()

    def moved(self, old, new):
        moved = {new + path[len(old):] for path in self.flushed if path == old or path.startswith(old + "/")}
        self.flushed = {path for path in self.flushed if not (path + "/").startswith((new + "/", old + "/"))} | moved

    def changed(self, path):
        self.flushed.discard(os.path.dirname(path))

    def call(self, line):
        name, words = line.split("(", 1)
        words, _, result = words.rpartition(") = ")
        if result.startswith("-1"):
            return
        named = [path_of(word, self.folder) for word in re.findall(r'"((?:[^"\\]|\\.)*)"', words)]
        if name in ("fsync", "fdatasync"):
            self.flushed.add(re.search(r"<(.*)>", words).group(1))
        elif name.startswith("rename"):
            self.moved(*named)
            for path in named:
                self.changed(path)
        elif name.startswith("link"):
            if named[0] in self.flushed or not named[0].startswith(self.folder):
                self.flushed.add(named[1])
            self.changed(named[1])
        elif name.startswith("unlink"):
            self.flushed.discard(named[0])
            self.changed(named[0])
        elif name in ("mkdir", "mkdirat", "creat") or "O_CREAT" in words:
            self.flushed.discard(named[0])
            self.changed(named[0])


def lost(words, folder, made, inject=()):
    """What a loss of power could take of the folder `made` after the command has ended."""
    trace = folder / "trace.txt"
    strace = ["strace", "-f", "-qq", "-y", "-s", "4096", "-o", trace, "-e", f"trace={CALLS}", *inject]
    before = [str(path) for path in folder.rglob("*")]
    ended = subprocess.run([*strace, *words], cwd=folder, capture_output=True, text=True, check=False)
    if ended.returncode:
        sys.exit(f"{words}: {ended.stderr}")
    disk = Disk(str(folder))
    disk.flushed.update(before)
    unfinished = {}
    for line in trace.read_text(encoding="utf-8", errors="replace").splitlines():
        process, call = line.split(None, 1)
        if call.endswith("<unfinished ...>"):
            unfinished[process] = call.removesuffix("<unfinished ...>").rstrip()
            continue
        if resumed := re.match(r"<\.\.\. \w+ resumed>(.*)", call):
            call = unfinished.pop(process) + resumed.group(1)
        if ") = " in re.sub(r"\s+= ", " = ", call):
            disk.call(re.sub(r"\)\s+= ", ") = ", call))
    paths = [folder / made, *(folder / made).rglob("*")]
    return sorted(str(path) for path in paths if str(path) not in disk.flushed and not MAY_BE_LOST.search(str(path)))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    clearway = pathlib.Path(sys.argv[1]) / "clearway"
    require_strace()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        study = [clearway, "run", "merge", "--no-solo", "--seeds", "2", "--jobs", "1", "--record", "--out", "out"]
        merge = [clearway, "study", "merge", "out", "--out"]
        no_links = ["-e", "inject=link,linkat:error=EXDEV"]
        network = pathlib.Path(os.environ.get("SUMO_HOME", "/usr/share/sumo")) / "tools/game/DRT/osm.net.xml"
        commands = [("run", study, "out", ()), ("merge by links", [*merge, "linked"], "linked", ()),
                    ("merge by copies", [*merge, "copied"], "copied", no_links),
                    ("init", [clearway, "scenario", "init", "mine", "--from", "merge"], "mine", ()),
                    ("import", [clearway, "scenario", "import", network, "--name", "town"], "town", ())]
        failed = False
        for title, words, made, inject in commands:
            taken = lost(words, folder, made, inject)
            print(f"{title}: {len(taken)} not flushed", *taken[:20], sep="\n  ")
            failed |= bool(taken)
    sys.exit(failed)


if __name__ == "__main__":
    main()
