"""Damaged files beside a record, and two commands in one folder. Wanted: what is damaged is told and made again, no intact file gives way
to a damaged one, nothing waits at a pipe, and data sets of two commands are not mixed.

    damaged_files.py BIN
"""
import filecmp
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

LIMIT_S = 120
RECORDING = pathlib.Path("recordings/merge/corridor/00000.h5")
EVENTS = pathlib.Path("runs/intersection/corridor/00000/signal_events.csv")
RUN = "--policy corridor --no-solo --seeds 1 --jobs 1 --out".split()


def flip(file):
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)


def make_pipe(file):
    file.unlink()
    os.mkfifo(file)


DAMAGES = {"empty": lambda file: file.write_bytes(b""), "cut short": lambda file: os.truncate(file, file.stat().st_size // 2),
           "one bit": flip, "a pipe": make_pipe}


class Bench:
    def __init__(self, programs, folder):
        self.program, self.folder, self.wrong = programs / "clearway", folder, []

    def run(self, *words, code=0):
        """What the command says; its exit code must be `code`."""
        try:
            ended = subprocess.run([self.program, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=LIMIT_S,
                                   check=False)
        except subprocess.TimeoutExpired:
            self.wrong.append(f"{' '.join(map(str, words))}: still running after {LIMIT_S} s")
            return ""
        if ended.returncode != code:
            self.wrong.append(f"{' '.join(map(str, words))}: exit code {ended.returncode}, not {code}: {ended.stderr[-300:]}")
        return ended.stdout + ended.stderr

    def expect(self, holds, what):
        if not holds:
            self.wrong.append(what)

    def copy(self, name):
        shutil.rmtree(self.folder / name, ignore_errors=True)
        # No links: damage to the copy would be damage to the original.
        shutil.copytree(self.folder / "whole", self.folder / name)
        return self.folder / name / RECORDING

    def is_whole(self, name):
        file = self.folder / name / RECORDING
        return file.is_file() and filecmp.cmp(file, self.folder / "whole" / RECORDING, shallow=False)

    def try_recordings(self):
        self.run("run", "merge", "--record", *RUN, "whole")
        for title, damage in DAMAGES.items():
            damage(self.copy("damaged"))
            self.run("replay", "damaged/merge/corridor/0", "--csv", "snapshot", code=3)
            self.run("verify", "damaged", "--all", code=3)
            if title == "a pipe":
                self.run("study", "merge", "damaged", "--out", "first", code=3)
            else:
                self.run("study", "merge", "whole", "--out", "first")
                self.expect("left out" in self.run("study", "merge", "damaged", "--out", "first"), f"{title}: merge is silent")
                said = self.run("study", "merge", "damaged", "--out", "second", code=5)
                self.expect("left out" in said and "lost: recording" in said, f"{title}: merge is silent: {said[-300:]}")
                self.run("study", "merge", "whole", "--out", "second")
                for name in ("first", "second"):
                    self.expect(self.is_whole(name), f"{title}: the recording of {name} is not that of the whole shard")
                    shutil.rmtree(self.folder / name)
            if title == "a pipe":
                self.run("run", "merge", "--record", *RUN, "damaged", code=3)
                continue
            said = self.run("run", "merge", "--record", *RUN, "damaged")
            self.expect("recording is damaged" in said, f"{title}: a continued run is silent: {said[-300:]}")
            self.expect(self.is_whole("damaged"), f"{title}: the recording was not made again")

    def try_scenarios(self):
        scenario = pathlib.Path("scenarios/merge")
        for name in ("network/network.net.xml", "scenario.toml", "merge.edg.xml"):
            self.run("study", "merge", "whole", "--out", "first")
            file = self.copy("damaged").parents[3] / scenario / name
            os.truncate(file, file.stat().st_size // 2)
            self.run("study", "merge", "damaged", "--out", "first")
            self.run("verify", "first", "--all")
            shutil.rmtree(self.folder / "first")
            said = self.run("study", "merge", "damaged", "whole", "--out", "first")
            self.expect(f"damaged/{scenario}/" in said and "left out" in said, f"{name}: merge is silent: {said[-300:]}")
            self.run("verify", "first", "--all")
            shutil.rmtree(self.folder / "first")

    def try_pipes(self):
        run = "damaged/merge/corridor/0"
        for name, words, code in ((".lock", ["study", "status", "damaged"], 0),
                                  ("scenarios/merge/network/network.net.xml", ["verify", run], 3),
                                  ("scenarios/merge/network/network.net.xml", ["export", "trajectories", run, "--out", "drawn"], 3),
                                  ("runs/merge/corridor/00000/timing.json", ["verify", "damaged", "--all"], 3)):
            self.copy("damaged")
            make_pipe(self.folder / "damaged" / name)
            said = self.run(*words, code=code)
            self.expect(code == 0 or "neither a file nor a folder" in " ".join(said.split()), f"{name}: {words[0]} does not say what it is: {said[-300:]}")

    def try_events(self):
        self.run("run", "intersection", *RUN, "signals")
        os.truncate(self.folder / "signals" / EVENTS, 100)
        self.run("verify", "signals", "--all", code=3)

    def try_edited_scenario(self):
        """`verify` names the file in the run folder and what is wrong in it."""
        self.copy("damaged")
        scenario = self.folder / "damaged/scenarios/merge/scenario.toml"
        scenario.write_text(scenario.read_text(encoding="utf-8") + "\nno_key = 1\n", encoding="utf-8")
        said = self.run("verify", "damaged", "--all", code=3)
        named = "damaged/scenarios/merge/scenario.toml" in said and "no_key" in said
        self.expect(named, f"verify does not say what is wrong with a scenario: {said[-300:]}")

    def try_names(self):
        for name in ("-x", "--"):
            self.run("run", "merge", *RUN[:-1], f"--out={name}")

    def try_two_data_sets(self):
        words = [self.program, *"links dataset merge --samples --seeds 1 --jobs 1".split()]
        started = [subprocess.Popen([*words, "--seed", str(seed), "--out", "both"], cwd=self.folder, stdout=subprocess.DEVNULL,
                                    stderr=subprocess.PIPE, text=True) for seed in (1, 2)]
        ended = [(each.communicate(timeout=LIMIT_S)[1], each.returncode) for each in started]
        self.expect(sorted(code for _, code in ended) in ([0, 3], [0, 4]), f"two data sets in one folder: {ended}")
        seed = 1 + next((at for at, (_, code) in enumerate(ended) if code == 0), 0)
        self.run("links", "dataset", "merge", "--samples", "--seeds", 1, "--jobs", 1, "--seed", seed, "--out", "alone")
        for file in (self.folder / "alone").glob("*.csv"):
            self.expect(filecmp.cmp(file, self.folder / "both" / file.name, shallow=False), f"{file.name} is of another seed")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as name:
        bench = Bench(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(name))
        bench.try_recordings()
        bench.try_scenarios()
        bench.try_pipes()
        bench.try_edited_scenario()
        bench.try_names()
        bench.try_events()
        bench.try_two_data_sets()
    print("\n".join(bench.wrong) or "told, and made again")
    sys.exit(bool(bench.wrong))


if __name__ == "__main__":
    main()
