"""Does a part in Python do what every part must? To be asked before the first run:

    python3 -m clearway.conformance my_policy.py:Green
    python3 -m clearway.conformance my_net.py:Mine --predictor

The part is shown drawn scenes, as a run shows it the road, twice in processes of its own. Exit code: 0 if it keeps all rules, 1 if not,
3 for a file, class or setting that no run takes either.
"""
from __future__ import annotations

import argparse
import dataclasses
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from . import _program
from ._trial import Nursery, Scene, Told, require_loadable, scenes_of, shown_to
from .parts import EMERGENCY, HUMAN, NO_LANE, Network
from .running import part_name

#: Problems of a rule that are told without --all.
MOST_TOLD = 3
#: What policies may ask for lasts no longer, s: who needs more renews it.
LONGEST_LEASE_S = 60.0
#: Of actions for vehicles, those that only emergency vehicles take.
_OF_EMERGENCY = ("pass_red", "take_route")


class Road:
    """What may be asked of a scene at a decision."""

    def __init__(self, network: Network, shown: list[dict[str, np.ndarray]]) -> None:
        self.network, self.now = network, shown[-1]
        #: Class and lane, a row of the network's, of every vehicle that was believed so far, the last ones.
        self.known: dict[int, tuple[int, int]] = {}
        for arrays in shown:
            self.known.update(_vehicles(arrays, "key", "lane", arrays["vehicle_class"].tolist()))
            self.known.update(_vehicles(arrays, "emergency_key", "emergency_lane", [EMERGENCY] * len(arrays["emergency_key"])))

    def problems(self, lease: dict[str, Any]) -> Iterator[str]:
        """What no vehicle or signal here can do."""
        if lease["lasting_s"] > LONGEST_LEASE_S:
            yield f"lasting_s {lease['lasting_s']:g} (allowed: up to {LONGEST_LEASE_S:g}); renew a shorter one instead"
        beneficiary = lease["beneficiary"]
        if beneficiary and self.known.get(beneficiary, (None,))[0] != EMERGENCY:
            yield f"serves {beneficiary} (allowed: an EV of the belief)"
        if "signal" in lease:
            yield from self._of_signal(lease)
        elif lease["vehicle"] not in self.known:
            yield f"vehicle {lease['vehicle']} was never in a belief (allowed: belief.vehicles.key[row]; a row is no key)"
        else:
            yield from self._of_vehicle(lease, *self.known[lease["vehicle"]])

    def _of_signal(self, lease: dict[str, Any]) -> Iterator[str]:
        signals = len(self.network.signal_ids)
        if lease["signal"] >= signals:
            yield f"signal {lease['signal']} (allowed: 0 to {signals - 1}, those of ev.approaches)"
            return
        count = len(self.network.signal_phases[lease["signal"]][0])
        links, own = lease["links"], lease.get("own_links", [])
        if not links:
            yield "links is empty (allowed: those that are to be green)"
        if wrong := [link for link in [*links, *own] if link >= count]:
            yield f"link {wrong[0]} of signal {lease['signal']} (allowed: 0 to {count - 1})"
        if len(set(links)) != len(links):
            yield f"links {links} (allowed: each once)"
        if not set(own) <= set(links):
            yield f"own_links {own} (allowed: those of links {links})"

    def _of_vehicle(self, lease: dict[str, Any], kind: int, lane: int) -> Iterator[str]:
        action = lease["action"]
        if action in _OF_EMERGENCY and kind != EMERGENCY:
            yield f"{action} for a vehicle that is no EV"
        elif action == "take_route":
            yield from self._of_way(lease["edges"], lease["vehicle"])
        if lane == NO_LANE:
            return
        if action == "drive_at":
            limit = float(self.network.lane_speed_limit_mps[lane])
            if kind == EMERGENCY:
                limit = max(limit, *self.now["emergency_allowed_speed_mps"].tolist(), 0.0)
            if lease["speed_mps"] > limit + 1e-4:
                yield f"speed_mps {lease['speed_mps']:g} (allowed: up to {limit:.4g}, the limit of its lane {self.network.lane_ids[lane]})"
        if action == "change_lane":
            count = int(self.network.edge_lane_count[self.network.lane_edge[lane]])
            if lease["lane_number"] >= count:
                yield f"lane_number {lease['lane_number']} (allowed: 0 to {count - 1}, the lanes of its edge)"

    def _of_way(self, edges: list[int], vehicle: int) -> Iterator[str]:
        ids = self.network.edge_ids
        if wrong := [edge for edge in edges if edge >= len(ids)]:
            yield f"edge {wrong[0]} (allowed: 0 to {len(ids) - 1})"
        elif gap := [pair for pair in zip(edges, edges[1:]) if pair[1] not in self.network.onward[pair[0]]]:
            yield f"edges: {ids[gap[0][1]]} does not follow {ids[gap[0][0]]} (allowed: those of belief.network.onward)"
        elif vehicle in self.now["emergency_key"].tolist():
            number, first = self.now["emergency_key"].tolist().index(vehicle), self.now["route_first"]
            end = int(self.now["route"][first[number + 1] - 1])
            if edges[-1] != end:
                yield f"edges end with {ids[edges[-1]]} (allowed: {ids[end]}, its destination)"


def _vehicles(arrays: dict[str, np.ndarray], key: str, lane: str, kinds: list[int]) -> dict[int, tuple[int, int]]:
    return dict(zip(arrays[key].tolist(), zip(kinds, arrays[lane].tolist())))


def _said(lease: dict[str, Any]) -> str:
    target = f"signal {lease['signal']}" if "signal" in lease else f"vehicle {lease['vehicle']}"
    return f"{lease['action']} for {target}"


@dataclasses.dataclass
class Judgement:
    """What a part did in all scenes, and in those once more."""

    scenes: list[Scene]
    first: list[Told]
    second: list[Told]
    printed: list[str]  #: Lines that it printed the first time.

    def decisions(self) -> Iterator[tuple[Scene, list[dict[str, np.ndarray]], Any]]:
        """Each answer, with what was shown up to it."""
        for scene, told in zip(self.scenes, self.first):
            for number, answer in enumerate(told.answers):
                yield scene, scene.shown[:number + 1], answer

    def leases(self) -> Iterator[tuple[str, Road, dict[str, Any]]]:
        for scene, shown, leases in self.decisions():
            road = Road(scene.network, shown) if leases else None
            for lease in leases:
                yield _place(scene, shown), road, lease  # type: ignore[misc]

    def asks_in(self, beginning: str) -> bool:
        return any(leases for scene, _, leases in self.decisions() if scene.name.startswith(beginning))

    def tells_of(self, rule: "Rule") -> bool:
        """Whether there is anything to judge by: an answer, and for most rules of policies one that asks for something."""
        if rule is ANSWERS_RULE:
            return True
        if rule.needs_all_scenes and any(told.failure for told in self.first):
            return False  # that it asked for nothing there follows from its failure
        return self.asks() if rule.judges_leases else any(told.answers for told in self.first)

    def asks(self) -> bool:
        return any(leases for _, _, leases in self.decisions())


def _place(scene: Scene, shown: list[dict[str, np.ndarray]]) -> str:
    return f"{scene.name}, {float(shown[-1]['time_s'][0]):g} s"


def does_not_answer(judgement: Judgement) -> Iterator[str]:
    places: dict[str, list[str]] = {}  # the same failure is told once
    for scene, told in zip(judgement.scenes, judgement.first):
        if told.failure:
            places.setdefault(told.failure, []).append(_place(scene, scene.shown[:len(told.answers) + 1]))
    for failure, where in places.items():
        others = f" and {_program.counted(len(where) - 1, 'other scene')}" if len(where) > 1 else ""
        yield f"{where[0]}{others}: {failure}"


def asks_what_is_not(judgement: Judgement) -> Iterator[str]:
    told = set()
    for place, road, lease in judgement.leases():
        for problem in road.problems(lease):
            kind = (lease["action"], problem.partition(" ")[0])
            if kind not in told:  # a policy makes the same mistake at each decision
                told.add(kind)
                yield f"{place}: {_said(lease)}: {problem}"


def asks_humans(judgement: Judgement) -> Iterator[str]:
    for place, road, lease in judgement.leases():
        if road.known.get(lease.get("vehicle", -1), (None,))[0] == HUMAN:
            yield f"{place}: {_said(lease)}, a human driver"


def asks_for_own_lanes(judgement: Judgement) -> Iterator[str]:
    own = ""
    for place, road, lease in judgement.leases():
        lane = road.known.get(lease.get("vehicle", -1), (None, NO_LANE))[1]
        if lease["action"] != "change_lane" or lane == NO_LANE:
            continue
        if lease["lane_number"] != road.network.lane_number[lane]:
            return
        own = own or f"{place}: {_said(lease)}: lane_number {lease['lane_number']}, and so each that it asks for"
    if own:
        yield own


def asks_without_emergency(judgement: Judgement) -> Iterator[str]:
    for place, road, lease in judgement.leases():
        if len(road.now["emergency_key"]) == 0:
            yield f"{place}: {_said(lease)}"


def asks_without_need(judgement: Judgement) -> Iterator[str]:
    for place, _, lease in judgement.leases():
        if place.startswith("the EV is past the last signal"):
            yield f"{place}: {_said(lease)}"


def never_asks(judgement: Judgement) -> Iterator[str]:
    if not judgement.asks():
        yield "it asked for nothing in any scene, so the other rules judge nothing"


def forgets_the_unreported(judgement: Judgement) -> Iterator[str]:
    if judgement.asks_in("an EV drives") and not judgement.asks_in("the same, and the reports"):
        yield "it asked for something where the EV reports, and for nothing where its reports are lost"


def forgets_one_of_two(judgement: Judgement) -> Iterator[str]:
    if judgement.asks_in("an EV drives") and not judgement.asks_in("two EVs cross"):
        yield "it asked for something for one EV, and for nothing where another crosses"


def tells_no_pair(judgement: Judgement) -> Iterator[str]:
    told = [probability for _, _, answer in judgement.decisions() for probability in answer]
    if told and len({probability >= 0.5 for probability in told}) == 1:
        yield f"its probabilities are from {min(told):g} to {max(told):g} for all pairs of all scenes"


def answers_otherwise(judgement: Judgement) -> Iterator[str]:
    for scene, first, second in zip(judgement.scenes, judgement.first, judgement.second):
        for number, (one, other) in enumerate(zip(first.answers, second.answers)):
            if one != other:
                yield f"{_place(scene, scene.shown[:number + 1])}: {_difference(one, other)}"
                break


def _difference(one: list[Any], other: list[Any]) -> str:
    """Of two answers to the same."""
    for row, (first, second) in enumerate(zip(one, other)):
        if isinstance(first, float) and first != second:
            return f"probability {first:g} for pair {row}, then {second:g}"
        if first != second:
            name = next((name for name in first if first[name] != second.get(name)), "action")
            return f"{_said(first)}: {name} {first[name]!r}, then {_said(second)}: {name} {second.get(name)!r}"
    return f"{len(one)} answers, then {len(other)}"


@dataclasses.dataclass(frozen=True)
class Rule:
    name: str
    says: str
    problems: Callable[[Judgement], Iterator[str]]
    cure: str
    judges_leases: bool = True  #: says nothing of a policy that asked for nothing
    needs_all_scenes: bool = False  #: says nothing of a part that failed in one


ANSWERS_RULE = Rule("answers", "answers in every scene", does_not_answer,
                    "the belief may lack everything: vehicles, links, lanes, letters of signals", judges_leases=False)
SAME_RULE = Rule("same", "answers the same to the same", answers_otherwise,
                 "no clock or address, chance only from a generator with a fixed seed, state only from what it was shown",
                 judges_leases=False)
RULES = {
    "policy": [
        ANSWERS_RULE,
        Rule("possible", "asks only for what vehicles and signals can do", asks_what_is_not, "help(clearway.Lease) says what is allowed"),
        Rule("lanes", "asks some vehicle for a lane that it is not on", asks_for_own_lanes,
             "belief.vehicles.lane_number is the number of a lane; belief.vehicles.lane is a row of all lanes of the network"),
        Rule("humans", "asks no human driver", asks_humans, "belief.vehicles.is_automated tells who takes leases"),
        Rule("no_ev", "asks for nothing while no EV is there", asks_without_emergency, "act for each of belief.emergency_vehicles"),
        Rule("no_need", "asks for nothing where nothing is in an EV's way", asks_without_need, "look at ev.ahead() and ev.approaches"),
        Rule("acts", "acts in a scene made for policies", never_asks, "print what it is shown, or leave this rule out and try a run",
             judges_leases=False, needs_all_scenes=True),
        Rule("lost", "serves an EV whose reports are lost", forgets_the_unreported,
             "find EVs by belief.emergency_vehicles: belief.vehicles lacks those whose reports are lost", needs_all_scenes=True),
        Rule("two", "serves an EV that another one crosses", forgets_one_of_two, "serve each of belief.emergency_vehicles",
             needs_all_scenes=True),
        SAME_RULE],
    "predictor": [
        ANSWERS_RULE,
        Rule("links", "takes some pairs for links (0.5 or more) and others for none", tells_no_pair, "run it, and look at links evaluate",
             judges_leases=False, needs_all_scenes=True),
        SAME_RULE],
}


def judge(part: dict[str, Any]) -> Judgement:
    scenes = scenes_of(part["kind"])

    def told(nursery: Nursery) -> list[Told]:
        all_told: list[Told] = []
        for scene in scenes:
            all_told.append(shown_to(nursery, part, scene))
            if all_told[-1].is_late:
                break  # it would be waited for in each
        return all_told
    # Two, so that its objects lie elsewhere each time. They end first, also when interrupted: by that the threads do.
    with tempfile.TemporaryFile() as printed, tempfile.TemporaryFile() as again, \
            ThreadPoolExecutor(2) as pool, Nursery(printed) as first, Nursery(again) as second:
        answers = list(pool.map(told, (first, second)))
        printed.seek(0)
        return Judgement(scenes, *answers, printed.read().decode("utf-8", "replace").splitlines())


def report(part: dict[str, Any], judgement: Judgement, left_out: list[str], most_told: int | None) -> bool:
    """Prints what became of each rule and returns whether all are kept."""
    print(f"{Path(part['file']).name}:{part['object']}, {len(judgement.scenes)} scenes, "
          f"{sum(len(told.answers) for told in judgement.first)} decisions")
    broken = 0
    for rule in RULES[part["kind"]]:
        silent = "left out" if rule.name in left_out else "" if judgement.tells_of(rule) else "not judged"
        problems = [] if silent else list(rule.problems(judgement))
        print(f"  {'-' if silent else 'FAIL' if problems else 'pass':6}{rule.name:10}{rule.says}{f' ({silent})' if silent else ''}")
        for problem in problems[:most_told]:
            print("          " + problem.replace("\n", "\n          "))
        if most_told is not None and len(problems) > most_told:
            print(f"          and {len(problems) - most_told} more: --all")
        if problems:
            print(f"          {rule.cure}")
            broken += 1
    times = [(took_s, scene) for scene, told in zip(judgement.scenes, judgement.first) for took_s in told.took_s]
    if times:
        longest_s, scene = max(times, key=lambda one: one[0])
        print(f"  time a decision: {1e3 * float(np.median([one for one, _ in times])):.2f} ms, at most {1e3 * longest_s:.1f} ms "
              f"({scene.name})")
    if judgement.printed:
        print(f"  printed: {_program.counted(len(judgement.printed), 'line')}{'; --all shows them' if most_told is not None else ''}")
    for line in judgement.printed if most_told is None else []:
        print("    " + line)
    print(f"{broken} of {len(RULES[part['kind']])} rules broken" if broken else "all rules kept")
    return broken == 0


def _settings(words: list[str], owner: str) -> dict[str, str]:
    settings = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals or not name.startswith(f"{owner}."):
            raise _program.InputError(f"--set {word} (allowed: {owner}.NAME=VALUE)")
        settings[name.removeprefix(f"{owner}.")] = value
    return settings


def _part(word: str, kind: str, settings: list[str]) -> dict[str, Any]:
    file, colon, name = part_name(word).rpartition(":")
    if not colon and word.endswith((".pt", ".pth")):
        file, name = part_name(word), ""
    elif not file.endswith(".py") or not name:
        raise _program.InputError(f"{kind}: `{word}` does not name a class (allowed: FILE.py:CLASS). Add a colon and the class")
    if not Path(file).is_file():
        raise _program.InputError(f"{kind}: {file} is not a file (allowed: FILE.py:CLASS). File names are relative to the current folder")
    return {"file": file, "object": name, "kind": kind, "settings": _settings(settings, name or Path(file).stem)}


def main(words: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python3 -m clearway.conformance", description="Judges a policy or predictor in Python.")
    parser.add_argument("part", metavar="FILE.py:CLASS")
    parser.add_argument("--predictor", action="store_true", help="it is a predictor [a policy]")
    parser.add_argument("--set", metavar="CLASS.NAME=VALUE", nargs="+", default=[], help="its settings [defaults]")
    parser.add_argument("--all", action="store_true", help=f"tell all problems of each rule [{MOST_TOLD}], and what the part prints")
    parser.add_argument("--leave-out", metavar="RULE", nargs="+", default=[], help="rules that it breaks on purpose [none]")
    arguments = parser.parse_args(words)
    kind = "predictor" if arguments.predictor else "policy"
    try:
        known = [rule.name for rule in RULES[kind]]
        for name in arguments.leave_out:
            if name not in known:
                raise _program.InputError(f"--leave-out {name} (allowed: {', '.join(known)}){_program.did_you_mean(name, known)}")
        part = _part(arguments.part, kind, arguments.set)
        require_loadable(part)
        return 0 if report(part, judge(part), arguments.leave_out, None if arguments.all else MOST_TOLD) else 1
    except _program.ClearwayError as error:
        print(f"clearway: {error}", file=sys.stderr)
        return 4 if isinstance(error, _program.EnvironmentFault) else 3
    except KeyboardInterrupt:
        print("clearway: interrupted; nothing was judged", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
