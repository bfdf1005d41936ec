"""Where SUMO's own programs abort, the run or the import is ended and named, and everything else goes on: each row is an input
that makes SUMO 1.15 of Debian abort, found with its program.

    aborts.py BIN
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

# Beside the measured traffic drive vehicles with a value that is no number. (name, attributes of the type, of the vehicles,
# words of the assertion, whether some seeds have no such vehicle)
ROWS = (("type without a speed, while loading", 'maxSpeed="nan"', "", "getMaxSpeed() > 0", False),
        ("type without a length, while loading", 'length="nan"', "", "getLength() > 0", False),
        ("braking that is no number, in a step", 'decel="nan"', "", "Assertion", True),
        ("speed after a step below what is possible", 'accel="nan"', "", "vNext >= vMin", True),
        ("headway that is no number", 'tau="nan"', "", "Assertion", True),
        ("gap that is no number", 'minGap="nan"', "", "Assertion", True),
        ("follower that waits for no time", 'carFollowModel="IDM" delta="nan"', "", "vWait >= 0", True),
        ("insertion behind the end of the lane", "", 'departPos="nan"', "pos <= myLength", True),
        ("insertion without a speed", "", 'departSpeed="nan"', "mySpeed >= 0", True))
SEEDS = 4


def additional(of_type, of_vehicle):
    return (f'<additional><vType id="wild" {of_type}/><route id="way" edges="main_in merge main_out"/>'
            f'<flow id="wild" type="wild" route="way" begin="70" end="71" probability="0.5" {of_vehicle}/></additional>')


class Aborts:
    def __init__(self, binaries, folder):
        self.clearway, self.folder, self.faults = binaries / "clearway", folder, []
        self.run("scenario", "init", "wild", "--from", "merge")
        scenario = folder / "wild" / "scenario.toml"
        text = scenario.read_text(encoding="utf-8").replace("[network]\n", '[network]\nadditional = ["wild.add.xml"]\n', 1)
        scenario.write_text(text, encoding="utf-8")
        (folder / "both.toml").write_text(f'scenarios = ["./wild", "merge"]\nconditions = ["baseline"]\nreplications = {SEEDS}\n',
                                          encoding="utf-8")

    def run(self, *words, **environment):
        return subprocess.run([self.clearway, *words], cwd=self.folder, capture_output=True, text=True, errors="replace",
                              check=False, env={**os.environ, **environment})

    def require(self, holds, what, ended):
        if not holds:
            self.faults.append(f"{what}: {ended.returncode}\n{ended.stdout[-500:]}\n{ended.stderr[-700:]}")

    def try_run(self, row, number):
        name, of_type, of_vehicle, words, has_sound_seeds = row
        (self.folder / "wild" / "wild.add.xml").write_text(additional(of_type, of_vehicle), encoding="utf-8")
        out = self.folder / f"out-{number}"
        ended = self.run("study", "both.toml", "--out", str(out))
        complete = {scenario: len(list((out / "runs" / scenario).rglob("run.json"))) for scenario in ("wild", "merge")}
        errors = [json.loads(file.read_text(encoding="utf-8")) for file in (out / "errors" / "wild").rglob("*.json")]
        self.require(ended.returncode == 1, f"{name}: does not end with failed runs", ended)
        self.require(complete["merge"] == SEEDS, f"{name}: the other scenario does not go on: {complete}", ended)
        self.require(len(errors) + complete["wild"] == SEEDS and errors, f"{name}: {len(errors)} failed, {complete}", ended)
        self.require(bool(complete["wild"]) == has_sound_seeds, f"{name}: other seeds do not go on: {complete}", ended)
        self.require(all(error["cause"] == "signal" and error["signal"] == 6 and words in error["log_tail"] for error in errors),
                     f"{name}: not named: {errors}", ended)
        self.require(words in ended.stderr and "SUMO itself aborted" in ended.stderr, f"{name}: not told", ended)
        self.require((out / "report.html").exists(), f"{name}: no report", ended)

    def try_import(self, program):
        """A program that aborts on some maps."""
        programs = self.folder / f"programs-{program}"
        programs.mkdir()
        (programs / program).write_text("#!/bin/sh\necho 'Assertion failed in the map' >&2\nkill -ABRT $$\n", encoding="utf-8")
        (programs / program).chmod(0o755)
        (self.folder / "map.osm").write_text(town(), encoding="utf-8")
        ended = self.run("scenario", "import", "map.osm", "--name", "town", PATH=f"{programs}:{os.environ['PATH']}")
        self.require(ended.returncode == 3, f"{program} aborts: the import does not fail", ended)
        self.require("Assertion failed in the map" in ended.stderr, f"{program} aborts: not named", ended)
        self.require(not list(self.folder.glob("*town*")), f"{program} aborts: something is left", ended)


def town():
    """A map of three streets that meet."""
    nodes = "".join(f'<node id="{number}" version="1" lat="{51 + y / 1000}" lon="{13 + x / 1000}"/>'
                    for number, (x, y) in enumerate([(0, 0), (4, 0), (4, 4), (0, 4)], 1))
    ways = "".join(f'<way id="{number}" version="1"><nd ref="{number}"/><nd ref="{number % 4 + 1}"/><tag k="highway" v="primary"/></way>'
                   for number in range(1, 5))
    return f'<osm version="0.6">{nodes}{ways}</osm>'


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as name:
        aborts = Aborts(pathlib.Path(sys.argv[1]), pathlib.Path(name))
        for number, row in enumerate(ROWS):
            aborts.try_run(row, number)
        for program in ("netconvert", "sumo"):
            aborts.try_import(program)
    print("\n".join(aborts.faults))
    sys.exit(bool(aborts.faults))


if __name__ == "__main__":
    main()
