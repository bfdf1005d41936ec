"""A read error is never taken for the end of a file: lets the n-th read of a command fail, for each n until none is left, and
asks that it either ends as if nothing had failed, with the same output and files, or says what could not be read.

    read_errors.py BIN [EVERY]      every read, or one in EVERY; ends with 77 where strace cannot inject faults
"""
import filecmp
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SYSTEM_CALLS = ("read", "pread64")
SKIPPED = 77


def run(words, folder, fault=None):
    """Ends of a command: exit code, what it printed and said, and whether the fault was met."""
    trace = folder / "trace.txt"
    strace = []
    if fault:
        call, number = fault
        strace = ["strace", "-f", "-qq", "-o", trace, "-e", f"trace={call}", "-e", f"inject={call}:error=EIO:when={number}"]
    ended = subprocess.run([*strace, *words], cwd=folder, capture_output=True, text=True, errors="replace", check=False)
    met = bool(fault) and "INJECTED" in trace.read_text(encoding="utf-8", errors="replace")
    return ended, met


def files_of(folder):
    return sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file()) if folder.exists() else []


def equal(left, right, only):
    names = only or files_of(left)
    return (only or names == files_of(right)) and all(filecmp.cmp(left / name, right / name, shallow=False) for name in names)


class Sweep:
    def __init__(self, name, words, folder, made=None, only=()):
        """`made`: the folder that the command writes below `folder`, removed before each try; `only`: what must be the same in
        it, otherwise every file."""
        self.name, self.words, self.folder, self.made, self.only = name, words, folder, made, only
        self.faults = []
        self.wanted, _ = run(words, folder)
        if self.wanted.returncode:
            sys.exit(f"{name} fails without a fault: {self.wanted.stderr}")
        if made:
            (folder / made).rename(folder / f"{made}.wanted")

    def try_fault(self, call, number):
        """Whether there was such a call."""
        if self.made:
            shutil.rmtree(self.folder / self.made, ignore_errors=True)
        ended, met = run(self.words, self.folder, (call, number))
        if not met:
            return False
        where = f"{self.name}, {call} {number}"
        if ended.returncode == 0:
            if not self.only and ended.stdout != self.wanted.stdout:
                self.faults.append(f"{where}: exit code 0 and another output")
            if self.made and not equal(self.folder / self.made, self.folder / f"{self.made}.wanted", self.only):
                self.faults.append(f"{where}: exit code 0 and other files")
        elif ended.returncode < 0 or ended.returncode >= 128:
            self.faults.append(f"{where}: killed ({ended.returncode}): {ended.stderr[-200:]}")
        elif not ended.stderr.strip():
            self.faults.append(f"{where}: exit code {ended.returncode} without a word")
        return True

    def all(self, every):
        tried = 0
        for call in SYSTEM_CALLS:
            number = 1
            while self.try_fault(call, number):
                tried += 1
                number += every
        print(f"{self.name}: {tried} faults, {len(self.faults)} badly ended")
        return self.faults


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    clearway, every = pathlib.Path(sys.argv[1]) / "clearway", int((sys.argv[2:] or ["1"])[0])
    probe = ["strace", "-qq", "-o", os.devnull, "-e", "inject=read:error=EIO:when=9999", "true"]
    if shutil.which("strace") is None or subprocess.run(probe, check=False, capture_output=True).returncode:
        print("strace is not installed or may not trace: skipped")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        study = [clearway, "run", "merge", "--policy", "none", "--no-solo", "--seeds", "2", "--jobs", "1", "--out", "out"]
        subprocess.run(study, cwd=folder, check=True, capture_output=True)
        shutil.copytree(folder / "out", folder / "other")
        sweeps = [Sweep("study status", [clearway, "study", "status", "out"], folder),
                  Sweep("compare", [clearway, "compare", "out", "other"], folder),
                  Sweep("export results", [clearway, "export", "results", "out", "vehicles"], folder),
                  Sweep("scenario signals", [clearway, "scenario", "signals", "intersection"], folder),
                  Sweep("run", [*study[:-3], "1", "--out", "again"], folder, "again", ["runs.csv", "vehicles.csv"]),
                  Sweep("study merge", [clearway, "study", "merge", "out", "--out", "merged"], folder, "merged")]
        faults = [fault for sweep in sweeps for fault in sweep.all(every)]
    print("\n".join(faults))
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
