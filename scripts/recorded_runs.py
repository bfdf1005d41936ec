"""Trajectories of the recorded runs of one condition, for the scripts that look at them."""
import os
import pathlib
import subprocess
import sys
import tempfile

import script_help

PROGRAM = os.environ.get("CLEARWAY", str(pathlib.Path(__file__).resolve().parent.parent / "clearway"))


def trajectories(usage, every_s, reach_m):
    """(replication, folder that `clearway export trajectories` wrote) of every run of the condition that the only argument names."""
    condition = pathlib.Path(script_help.words(usage, 1, 1)[0])
    study, scenario = condition.parent.parent, condition.parent.name
    recordings = sorted((study / "recordings" / scenario / condition.name).glob("*.h5"))
    if not recordings:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {condition}: no recordings; make the runs with --record")
    with tempfile.TemporaryDirectory() as work:
        for recording in recordings:
            replication = int(recording.stem)
            out = pathlib.Path(work) / str(replication)
            subprocess.run([PROGRAM, "export", "trajectories", str(condition / str(replication)), "--every", str(every_s),
                            "--reach", str(reach_m), "--out", str(out)], check=True, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
            yield replication, out
