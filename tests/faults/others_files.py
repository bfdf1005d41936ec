"""A folder that holds files of the user is refused, and such a file as well, and stays as it is, also where the machine fails while a
command looks into it:
the n-th call that concerns the folder or the file fails, for each n.

    others_files.py BIN       ends with 77 where strace cannot inject
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from tracing import require_strace

FAILURES = {"openat": "EMFILE", "getdents64": "EIO", "newfstatat": "EIO", "mkdir": "EIO", "read": "EIO"}
FILE = "thesis.txt"
THEIRS = {FILE: "years", "photos/first": "one", ".git/config": "hidden"}
#: As downloads and parts of films are named, with a number that is no process.
PARTS = {"photos.99998.part/first": "one", "film.1080.part": "two", ".photos.importing-99998/first": "three"}
#: A data set of five vehicles, on which a net can be trained.
PAIRS = {"edge_list.csv": "0,0,1,1,2,2,3,4\n1,2,2,3,3,4,4,0\n", "vehicle_features.csv": "0,0\n0.5,0.25\n1,0\n1.5,0.25\n2,1\n",
         "target_y.csv": "1,0,1,1,0,1,0,1\n"}


def put(folder, files):
    shutil.rmtree(folder, ignore_errors=True)
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def files_in(folder):
    paths = [path for path in folder.rglob("*") if path.is_file()]
    return {str(path.relative_to(folder)): path.read_text(encoding="utf-8", errors="replace") for path in paths}


def faults_of(title, words, folder):
    theirs, trace = folder / "theirs", folder / "trace"
    paths = [word for path in (theirs, theirs / FILE) for word in ("-P", path)]

    def tried(name, options, files=THEIRS):
        put(theirs, files)
        trace.unlink(missing_ok=True)
        ended = subprocess.run(["strace", "-f", "-qq", "-o", trace, *paths, *options, *words], cwd=folder, check=False,
                               capture_output=True, text=True, errors="replace")
        if files_in(theirs) != files:
            yield f"{title}, {name}: {sorted(files_in(theirs))} are left: {ended.stderr[-300:]}"
        if ended.returncode == 0:
            yield f"{title}, {name}: exit code 0"

    yield from tried("no fault", ["-e", "trace=openat"])
    if str(theirs / FILE) not in words:
        yield from tried("names like those of parts", ["-e", "trace=openat"], PARTS)
    for call, error in FAILURES.items():
        for number in range(1, 10):
            yield from tried(f"{call} {number}", ["-e", f"trace={call}", "-e", f"inject={call}:error={error}:when={number}"])
            if "INJECTED" not in trace.read_text(encoding="utf-8", errors="replace"):
                break


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    clearway = pathlib.Path(sys.argv[1]).resolve() / "clearway"
    require_strace("-P", "/", "-e", "inject=getdents64:error=EIO:when=9999")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        theirs, file = str(folder / "theirs"), str(folder / "theirs" / FILE)  # by the names that strace compares with
        small = ["--seeds", "1", "--jobs", "1"]
        (folder / "my.toml").write_text("replications = 1\nscenarios = [\"merge\"]\nconditions = [\"baseline\"]\n", encoding="utf-8")
        subprocess.run([clearway, "run", "merge", "--no-solo", "--record", *small, "--out", "done"], cwd=folder, check=True, capture_output=True)
        network = pathlib.Path(os.environ.get("SUMO_HOME", "/usr/share/sumo")) / "tools/game/DRT/osm.net.xml"
        verbs = [("run", ["run", "merge", "--no-solo", *small, "--out", theirs]),
                 ("study", ["study", "my.toml", "--jobs", "1", "--out", theirs]),
                 ("merge", ["study", "merge", "done", "--out", theirs]),
                 ("export", ["export", "figures", "done", "--out", theirs]),
                 ("init", ["scenario", "init", theirs]),
                 ("import", ["scenario", "import", network, "--name", "theirs"]),
                 ("equip", ["equip", "intersection", "--budget", "1", "--seeds", "2", "--out", theirs]),
                 ("trajectories", ["export", "trajectories", "done/merge/baseline/0", "--out", theirs]),
                 ("submit", ["study", "submit", "my.toml", "--shards", "1", "--out", theirs]),
                 ("evaluate", ["links", "evaluate", "merge", "--failure", "B10", "--predictor", "last_seen", "--out", theirs]),
                 ("mean times", ["scenario", "mean-times", "merge", *small, "--out", file]),
                 ("page", ["replay", "done/merge/baseline/0", "--view", "--out", file]),
                 ("signals", ["scenario", "signals", "intersection", "--svg", file])]
        if (clearway.parent / "clearway-train").exists():
            (folder / "data").mkdir()
            for name, text in PAIRS.items():
                (folder / "data" / name).write_text(text, encoding="utf-8")
            verbs.append(("train", ["links", "train", "graphsage_as_published", "--data", "data", "--epochs", "1", "--out", theirs]))
        faults = [fault for title, words in verbs for fault in faults_of(title, [clearway, *words], folder)]
    print("\n".join(faults) or f"{len(verbs)} verbs left other files alone, whatever call failed")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
