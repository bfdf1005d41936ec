"""A killed command never blocks the next one: kills each verb at its first renames, the first of which puts the manifest or the result
in place, and asks that the same command then ends well and leaves nothing of the killed one behind.

    killed_at_rename.py BIN [RENAMES]      how many renames of each verb are tried; ends with 77 where strace cannot inject
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from tracing import require_strace

LEFTOVER = re.compile(r"\.\d+\.clearway-part$|\.clearway-import-\d+$")


def killed(words, folder, number):
    """Whether the command met the rename and was killed there."""
    strace = ["strace", "-f", "-qq", "-o", os.devnull, "-e", "trace=rename,renameat,renameat2",
              "-e", f"inject=rename,renameat,renameat2:error=EIO:signal=SIGKILL:when={number}"]
    return subprocess.run([*strace, *words], cwd=folder, capture_output=True, check=False).returncode in (-9, 137)


def faults_of(title, words, folder, made, renames):
    for number in range(1, renames + 1):
        if made:
            target = folder / made
            shutil.rmtree(target, ignore_errors=True)
            target.unlink(missing_ok=True)
        if not killed(words, folder, number):
            return
        again = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        if again.returncode:
            yield f"{title}: killed at rename {number}, then exit code {again.returncode}: {again.stderr[-300:]}"
        left = [str(path.relative_to(folder)) for path in folder.rglob("*") if LEFTOVER.search(path.name)]
        if left:
            yield f"{title}: killed at rename {number}, and {left} stay"


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    clearway, renames = pathlib.Path(sys.argv[1]) / "clearway", int((sys.argv[2:] or ["2"])[0])
    require_strace("-e", "inject=rename:error=EIO:signal=SIGKILL:when=9999")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        small = ["--seeds", "1", "--jobs", "1"]
        (folder / "my.toml").write_text("replications = 1\nscenarios = [\"merge\"]\nconditions = [\"baseline\"]\n", encoding="utf-8")
        subprocess.run([clearway, "run", "merge", "--no-solo", *small, "--out", "done"], cwd=folder, check=True, capture_output=True)
        network = pathlib.Path(os.environ.get("SUMO_HOME", "/usr/share/sumo")) / "tools/game/DRT/osm.net.xml"
        verbs = [("run", ["run", "merge", "--no-solo", *small, "--out", "a"], "a"),
                 ("study", ["study", "my.toml", "--jobs", "1", "--out", "b"], "b"),
                 ("merge", ["study", "merge", "done", "--out", "c"], "c"),
                 ("export", ["export", "figures", "done", "--out", "d"], "d"),
                 ("report", ["report", "done"], ""),
                 ("init", ["scenario", "init", "e"], "e"),
                 ("import", ["scenario", "import", network, "--name", "f"], "f"),
                 ("equip", ["equip", "intersection", "--budget", "1", "--seeds", "2", "--out", "g"], "g"),
                 ("evaluate", ["links", "evaluate", "merge", "--failure", "B10", "--predictor", "route_rule", "--seeds", "1",
                               "--validation-seeds", "1", "--out", "h"], "h")]
        faults = [fault for title, words, made in verbs
                  for fault in faults_of(title, [clearway, *words], folder, made, renames)]
    print("\n".join(faults) or f"{len(verbs)} verbs killed at {renames} renames each: every one went on")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
