"""Nothing is lost that a command called done, and nothing blocks the next: cuts the power of a file system at a change of a command,
lets it return without what was not flushed, and asks that the same command then ends well with the tables of a machine that never
lost power.

    power_loss.py BIN FILE_SYSTEM [CUTS]      cuts of each command; ends with 77 where nothing may be mounted
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
TABLES = ("runs.csv", "vehicles.csv", "leases.csv")


class Disk:
    """The mounted file system of power_loss_fs.cpp."""

    def __init__(self, program, place):
        self.place = place
        place.mkdir()
        self.process = subprocess.Popen([program, place], stderr=subprocess.DEVNULL)
        for _ in range(100):
            if os.path.ismount(place) or self.process.poll() is not None:
                break
            time.sleep(0.05)

    def works(self):
        return os.path.ismount(self.place)

    def tell(self, words):
        (self.place / ".power").write_text(words, encoding="ascii")

    def changes(self):
        return int((self.place / ".power").read_text(encoding="ascii"))

    def close(self):
        subprocess.run(["fusermount3", "-u", "-z", self.place], check=False)
        self.process.wait()


def contents(folder, names):
    return {name: (folder / name).read_bytes() for name in names}


class Command:
    def __init__(self, title, words, made, results, is_done_once=False):
        """`is_done_once`: what it makes is there as a whole or not at all, and the command refuses to make it twice."""
        self.title, self.words, self.made, self.results, self.is_done_once = title, words, made, results, is_done_once

    def run(self, folder):
        return subprocess.run(self.words, cwd=folder, capture_output=True, text=True, errors="replace", check=False)

    def faults(self, disk, cuts):
        """Messages of what went wrong after a cut."""
        target, before = disk.place / self.made, disk.changes()
        ended = self.run(disk.place)
        if ended.returncode:
            return [f"{self.title}: fails without a cut: {ended.stderr[-500:]}"]
        changes, wanted, faults = disk.changes() - before, contents(target, self.results), []
        disk.tell("cut 0 1")
        disk.tell("on")
        if not self.is_there(target) or contents(target, self.results) != wanted:
            faults.append(f"{self.title}: lost after it was done")
        for cut in range(cuts):
            at = 1 + cut * changes // cuts
            shutil.rmtree(target, ignore_errors=True)
            disk.tell("sync")
            disk.tell(f"cut {at} {cut}")
            self.run(disk.place)
            disk.tell("on")
            is_done = self.is_done_once and target.exists()
            again = self.run(disk.place)
            if again.returncode and not is_done:
                faults.append(f"{self.title}: cut at change {at} of {changes}, then exit code {again.returncode}: {again.stderr[-300:]}")
            elif not self.is_there(target) or contents(target, self.results) != wanted:
                faults.append(f"{self.title}: cut at change {at} of {changes}: other results")
        print(f"{self.title}: {cuts} cuts among {changes} changes, {len(faults)} badly ended", flush=True)
        return faults

    def is_there(self, target):
        return all((target / name).exists() for name in self.results)


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    clearway, cuts = pathlib.Path(sys.argv[1]) / "clearway", int((sys.argv[3:] or ["100"])[0])
    with tempfile.TemporaryDirectory() as name:
        disk = Disk(sys.argv[2], pathlib.Path(name) / "disk")
        if not disk.works():
            print("FUSE cannot mount a file system here: skipped")
            sys.exit(SKIPPED)
        try:
            study = pathlib.Path(name) / "my.toml"
            study.write_text("replications = 2\nscenarios = [\"merge\"]\nconditions = [\"baseline\"]\n", encoding="utf-8")
            shards = []
            for number in (1, 2):
                shards.append(pathlib.Path(name) / f"shard{number}")
                subprocess.run([clearway, "study", study, "--shard", f"{number}/2", "--jobs", "1", "--out", shards[-1]], check=True,
                               capture_output=True)
            network = pathlib.Path(os.environ.get("SUMO_HOME", "/usr/share/sumo")) / "tools/sumolib/scenario/scenarios"
            network = next(network.rglob("*.net.xml"), None)
            scenario = [f"scenarios/merge/{file}" for file in ("scenario.toml", "network.svg", "network/network.net.xml")]
            recordings = [f"recordings/merge/baseline/{number:05}.h5" for number in range(2)]
            commands = [Command("merge", [clearway, "study", "merge", *shards, "--out", "merged"], "merged", (*TABLES, *scenario)),
                        Command("study", [clearway, "study", study, "--jobs", "1", "--out", "out"], "out", TABLES),
                        Command("record", [clearway, "study", study, "--jobs", "1", "--record", "--out", "rec"], "rec", (*TABLES, *recordings)),
                        Command("import", [clearway, "scenario", "import", network, "--name", "town"], "town",
                                ("scenario.toml", "network.net.xml"), True)]
            faults = [fault for command in commands for fault in command.faults(disk, cuts)]
        finally:
            disk.close()
    print("\n".join(faults))
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
