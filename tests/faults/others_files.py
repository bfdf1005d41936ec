"""A folder that holds files of the user is refused, and stays as it is, also where the machine fails while a command looks into it:
the n-th call that concerns the folder fails, for each n.

    others_files.py BIN       ends with 77 where strace cannot inject
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from tracing import require_strace

FAILURES = {"openat": "EMFILE", "getdents64": "EIO", "newfstatat": "EIO", "mkdir": "EIO"}
THEIRS = {"thesis.txt": "years", "photos/first": "one", ".git/config": "hidden"}


def put(folder):
    shutil.rmtree(folder, ignore_errors=True)
    for name, text in THEIRS.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def files_in(folder):
    paths = [path for path in folder.rglob("*") if path.is_file()]
    return {str(path.relative_to(folder)): path.read_text(encoding="utf-8", errors="replace") for path in paths}


def faults_of(title, words, folder):
    theirs, trace = folder / "theirs", folder / "trace"

    def tried(name, options):
        put(theirs)
        trace.unlink(missing_ok=True)
        ended = subprocess.run(["strace", "-f", "-qq", "-o", trace, "-P", theirs, *options, *words], cwd=folder, check=False,
                               capture_output=True, text=True, errors="replace")
        if files_in(theirs) != THEIRS:
            yield f"{title}, {name}: {sorted(files_in(theirs))} are left: {ended.stderr[-300:]}"
        if ended.returncode == 0:
            yield f"{title}, {name}: exit code 0"

    yield from tried("no fault", ["-e", "trace=openat"])
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
        theirs = str(folder / "theirs")  # by the name that strace compares with
        small = ["--seeds", "1", "--jobs", "1"]
        (folder / "my.toml").write_text("replications = 1\nscenarios = [\"merge\"]\nconditions = [\"baseline\"]\n", encoding="utf-8")
        subprocess.run([clearway, "run", "merge", "--no-solo", *small, "--out", "done"], cwd=folder, check=True, capture_output=True)
        network = pathlib.Path(os.environ.get("SUMO_HOME", "/usr/share/sumo")) / "tools/game/DRT/osm.net.xml"
        verbs = [("run", ["run", "merge", "--no-solo", *small, "--out", theirs]),
                 ("study", ["study", "my.toml", "--jobs", "1", "--out", theirs]),
                 ("merge", ["study", "merge", "done", "--out", theirs]),
                 ("export", ["export", "figures", "done", "--out", theirs]),
                 ("init", ["scenario", "init", theirs]),
                 ("import", ["scenario", "import", network, "--name", "theirs"]),
                 ("equip", ["equip", "intersection", "--budget", "1", "--seeds", "2", "--out", theirs])]
        faults = [fault for title, words in verbs for fault in faults_of(title, [clearway, *words], folder)]
    print("\n".join(faults) or f"{len(verbs)} verbs left a folder with other files alone, whatever call failed")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
