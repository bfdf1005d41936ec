"""Too few descriptors, too little memory, too small a limit of files, no /proc: each is told, and the same command without the
limit gives the tables of an untroubled run.

    limits.py BIN
"""
import filecmp
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile

TABLES = ("runs.csv", "vehicles.csv")


class Study:
    def __init__(self, clearway, folder, scenario="merge"):
        self.words = [clearway, "run", scenario, "--policy", "none", "--no-solo", "--seeds", "1", "--jobs", "1"]
        self.folder = folder
        self.faults = []
        self.run("clean")

    def run(self, out, prefix=(), options=(), limit=None):
        def limit_child():
            if limit:
                resource.setrlimit(limit[0], (limit[1], limit[1]))
        return subprocess.run([*prefix, *self.words, *options, "--out", out], cwd=self.folder, capture_output=True, text=True,
                              errors="replace", check=False, preexec_fn=limit_child)

    def is_clean(self, out):
        return all((self.folder / out / name).exists() and filecmp.cmp(self.folder / out / name, self.folder / "clean" / name, False)
                   for name in TABLES)

    def check(self, name, said, **limits):
        """Runs within limits, which must fail and say `said` unless it is empty, then without."""
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        first = self.run("out", **limits)
        told = f"{first.returncode}: {first.stderr[-400:]}"
        if first.returncode == 0 and not self.is_clean("out"):
            self.faults.append(f"{name}: exit code 0 and other tables")
        if said and (first.returncode == 0 or said not in first.stderr):
            self.faults.append(f"{name}: does not say '{said}': {told}")
        second = self.run("out")
        if second.returncode or not self.is_clean("out"):
            self.faults.append(f"{name}: stays: {second.stderr[-400:]}\nafter {told}")
        return first.returncode


def try_recording(study):
    """A recording is not blamed for memory that is short; to load the programs takes about 42 MB. Until they begin, a library
    may end them that gets no memory for its own state."""
    study.run("recorded", options=["--record"])
    words = [study.words[0], "replay", "recorded/merge/baseline/0", "--csv", "snapshot"]
    ends = []
    for size_kb in range(38_000, 70_000, 500):
        limit = size_kb * 1000
        ended = subprocess.run(words, cwd=study.folder, capture_output=True, text=True, errors="replace", check=False,
                               preexec_fn=lambda limit=limit: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        begins = any(code in (0, 4) for code in ends)
        ends.append(ended.returncode)
        if ended.returncode == -signal.SIGABRT and not begins:
            continue
        if ended.returncode not in (0, 4, 127) or (ended.returncode == 4 and "give the same command again" not in ended.stderr):
            study.faults.append(f"a recording is read in {size_kb} kB: {ended.returncode}: {ended.stderr[-400:]}")
    if 0 not in ends or 4 not in ends:
        study.faults.append(f"no limit of memory let a replay begin and not end: {ends}")


def try_figures(study):
    """Where memory keeps rsvg-convert from starting, its package is not what is missing."""
    blamed = 0
    for size_mb in range(45, 90, 5):
        limit = size_mb * 1_000_000
        ended = subprocess.run([study.words[0], "export", "figures", "clean", "--out", "figures"], cwd=study.folder, capture_output=True,
                               text=True, errors="replace", check=False,
                               preexec_fn=lambda limit=limit: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        if "rsvg-convert cannot be started" in ended.stderr:
            blamed += 1
            if "ulimit -v" not in ended.stderr:
                study.faults.append(f"rsvg-convert in {size_mb} MB: {ended.stderr[-400:]}")
    if not blamed:
        study.faults.append("no limit of memory kept rsvg-convert from starting")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as name:
        study = Study(pathlib.Path(sys.argv[1]).resolve() / "clearway", pathlib.Path(name))
        ends = [study.check(f"{count} descriptors", "", limit=(resource.RLIMIT_NOFILE, count)) for count in range(4, 24, 2)]
        (study.folder / "longer").mkdir()  # than between two looks at its memory
        longer = Study(study.words[0], study.folder / "longer", "city")
        ends.append(longer.check("little memory", "The command of the study tries again those that a signal, a limit or the machine ended (1)",
                                 options=["--memory-limit", "20"]))
        study.faults += longer.faults
        ends.append(study.check("small files", "ulimit -f", limit=(resource.RLIMIT_FSIZE, 20000)))
        hide = ["unshare", "-rm", "sh", "-c", 'mount -t tmpfs none /proc && exec "$@"', "sh"]
        if subprocess.run([*hide, "true"], check=False, capture_output=True).returncode == 0:
            ends.append(study.check("no /proc", "Mount /proc", prefix=hide))
        try_recording(study)
        try_figures(study)
    print("\n".join(study.faults), ends)
    sys.exit(bool(study.faults) or not any(ends))


if __name__ == "__main__":
    main()
