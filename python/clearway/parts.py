"""Policies and predictors in Python: what they get, and what they answer."""
from __future__ import annotations

import dataclasses
import functools
import math
import numbers
import os
import reprlib
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from ._channel import Moment, Sheet
from ._program import ClearwayError, Told, keywords_of, no_attribute, no_keyword

F = TypeVar("F", bound=Callable[..., Any])

#: Lane of a vehicle whose lane is not known.
NO_LANE = 4294967295
HUMAN, AUTOMATED, EMERGENCY = 0, 1, 2


#: What is shown of vehicles.
_PLACE = ("key", "speed_mps", "lane", "lane_position_m", "x_m", "y_m")


def _shown(owner: Told, names: Iterable[str]) -> str:
    """``NAME(key=3, speed_mps=4.2)``, of arrays a few elements; names alone where the memory holds another decision."""
    try:
        values = {name: getattr(owner, name) for name in names}
    except ClearwayError:
        return Told.__repr__(owner)
    texts = (np.array2string(value, precision=1, threshold=6, separator=", ") if isinstance(value, np.ndarray)
             else f"{value:.1f}" if isinstance(value, float) else repr(value) for value in values.values())
    return f"{type(owner).__name__}({', '.join(map('='.join, zip(values, texts)))})"


class Network(Told):
    """The map, as everybody knows it. Lanes, edges and signals are numbers here, by which these are ordered:

    * ``lane_ids``, ``edge_ids``, ``signal_ids``: SUMO's names;
    * ``edge_lane_count``: number of lanes of each edge; ``edge_is_internal``: whether it is inside a junction;
    * ``edge_free_s``: time along each edge at the limit of its fastest lane, s; permissions are those of ``onward``;
    * ``onward``: for each edge, those that an emergency vehicle may turn into;
    * ``lane_edge``: edge of each lane; ``lane_number``: its number there, 0 the outermost; ``lane_length_m``,
      ``lane_speed_limit_mps``;
    * ``signal_phases``: phases of each signal's own program: a letter for each link, SUMO's.
    """

    def __init__(self, description: dict[str, Any]) -> None:
        self.lane_ids: list[str] = description["lane_ids"]
        self.edge_ids: list[str] = [edge[0] for edge in description["edges"]]
        self.edge_lane_count = np.array([edge[1] for edge in description["edges"]], dtype=np.uint32)
        self.edge_is_internal = np.array([edge[2] for edge in description["edges"]], dtype=bool)
        self.onward: list[list[int]] = description["onward"]
        lanes = description["lanes"]
        self.lane_edge = np.array(lanes["edge"], dtype=np.uint32)
        self.edge_free_s = np.full(len(self.edge_ids), np.inf)
        np.minimum.at(self.edge_free_s, self.lane_edge, np.array(lanes["length_m"]) / np.maximum(lanes["speed_limit_mps"], 0.01))
        self.lane_number = np.array(lanes["number"], dtype=np.uint32)
        self.lane_length_m = np.array(lanes["length_m"], dtype=np.float32)
        self.lane_speed_limit_mps = np.array(lanes["speed_limit_mps"], dtype=np.float32)
        self.signal_ids: list[str] = [signal[0] for signal in description["signals"]]
        self.signal_phases: list[list[str]] = [signal[1] for signal in description["signals"]]


class _Rows(Told):
    """Arrays by name, each made when it is first asked for."""

    _prefix = ""
    _names: tuple[str, ...] = ()

    def __init__(self, sheet: Moment) -> None:
        self._sheet = sheet

    def __getattr__(self, name: str) -> np.ndarray:
        if name not in self._names:
            return super().__getattr__(name)
        array = self._sheet[self._prefix + name]
        self.__dict__[name] = array
        return array

    def __dir__(self) -> list[str]:
        return list({*self._names, *super().__dir__()})  # an array that was asked for is an attribute, too

    def _forget(self) -> None:
        """Lets arrays be asked for anew."""
        for name in self._names:
            self.__dict__.pop(name, None)


class Vehicles(_Rows):
    """Believed vehicles, an element each, ordered by ``key``; the arrays cannot be written.

    * ``key``: identity during the run, which leases take; ``vehicle_class``: 0 human, 1 automated, 2 emergency;
    * ``x_m``, ``y_m``: front bumper in the network's plane; ``heading_rad``: counter-clockwise from the x axis; ``speed_mps``;
    * ``lane``: its row in ``network.lane_ids``, over all edges; its number on the edge, 0 the outermost, as ``Lease.change_lane`` takes
      it, is ``lane_number``, its edge ``network.lane_edge[lane]``. Not known: ``clearway.parts.NO_LANE``;
    * ``lane_position_m``: of the front bumper, from the start of the lane;
    * ``route_edge``: how many edges of its route lie before the one that it entered last;
    * ``sigma_m``: standard deviation of the position; ``age_s``: of the report.
    """

    _names = ("key", "vehicle_class", "x_m", "y_m", "heading_rad", "speed_mps", "lane", "lane_position_m", "route_edge", "sigma_m",
              "age_s")

    def __init__(self, sheet: Moment, network: Network) -> None:
        super().__init__(sheet)
        self._network = network

    def __len__(self) -> int:
        return len(self.key)

    def __repr__(self) -> str:
        return _shown(self, _PLACE)

    @property
    def lane_number(self) -> np.ndarray:
        """The number of each vehicle's lane on its edge, 0 the outermost; ``NO_LANE`` where it is not known."""
        numbers = np.append(self._network.lane_number, np.uint32(NO_LANE))
        return numbers[np.minimum(self.lane, len(numbers) - 1)]

    @property
    def is_automated(self) -> np.ndarray:
        """Whether each vehicle takes leases."""
        return self.vehicle_class == AUTOMATED


class Links(_Rows):
    """Believed links, each from both ends: ``index`` as an edge list, ``distance_m``, ``probability``.

    By vehicle: those of row i are elements ``first[i]`` to ``first[i + 1] - 1`` of ``neighbour``, which ``of`` gives.
    """

    _prefix = "link_"
    _names = ("first", "neighbour", "distance_m", "probability")

    def __len__(self) -> int:
        return len(self.neighbour)

    @functools.cached_property
    def index(self) -> np.ndarray:
        """``int64[2, n]``: rows of ``vehicles``, as PyTorch Geometric takes it."""
        first = self.first.astype(np.int64)
        return np.stack([np.repeat(np.arange(len(first) - 1), np.diff(first)), self.neighbour.astype(np.int64)])

    def of(self, row: int) -> np.ndarray:
        """Rows of the vehicles linked with that of ``row``."""
        return self.neighbour[self.first[row]:self.first[row + 1]]


@dataclasses.dataclass(frozen=True)
class Approach(Told):
    """A signal that an emergency vehicle will pass.

    ``signal`` (its number in the network), ``distance_m`` (to the stop line), ``own_links`` (links of the signal that the
    emergency vehicle itself may take), ``links`` (these and all other links of its approaches that do not conflict with them:
    what to hold green).
    """

    signal: int
    distance_m: float
    own_links: list[int]
    links: list[int]


class EmergencyVehicle(Told):
    """An emergency vehicle on the road, as it knows itself, or else as it is believed to be. ``key`` is its identity."""

    def __init__(self, belief: "Belief", number: int) -> None:
        self._sheet, self._number, self._belief = belief._sheet, number, belief
        self.key = int(self._sheet["emergency_key"][number])

    def _one(self, name: str) -> Any:
        return self._sheet["emergency_" + name][self._number].item()

    x_m = property(lambda self: self._one("x_m"), doc="Front bumper, m.")
    y_m = property(lambda self: self._one("y_m"), doc="Front bumper, m.")
    heading_rad = property(lambda self: self._one("heading_rad"), doc="Counter-clockwise from the x axis.")
    speed_mps = property(lambda self: self._one("speed_mps"), doc="Present speed.")
    allowed_speed_mps = property(lambda self: self._one("allowed_speed_mps"), doc="Highest that road and vehicle allow.")
    lane = property(lambda self: self._one("lane"), doc="Row in ``network.lane_ids``, as ``Vehicles.lane``.")
    lane_position_m = property(lambda self: self._one("lane_position_m"), doc="From the start of the lane.")

    def __repr__(self) -> str:
        return _shown(self, _PLACE)

    def _bounds(self, name: str) -> slice:
        first = self._sheet[name]
        return slice(int(first[self._number]), int(first[self._number + 1]))

    def ahead(self, within_m: float = 300.0) -> np.ndarray:
        """Rows of ``belief.vehicles`` ahead on its way, on any lane of it, nearest first, up to 300 m; ``ahead_lanes`` tells where each
        may move."""
        part = self._bounds("ahead_first")
        return self._sheet["ahead_row"][part][self._sheet["ahead_distance_m"][part] <= within_m]

    @property
    def ahead_distance_m(self) -> np.ndarray:
        """Distance of each of ``ahead()``, front to front along the route, m."""
        return self._sheet["ahead_distance_m"][self._bounds("ahead_first")]

    @property
    def ahead_lanes(self) -> np.ndarray:
        """``uint8[n, 2]`` for ``ahead()``: whether the lane next to the vehicle's own outward (``lane_number - 1``) and inward
        (``lane_number + 1``) is open to the automated vehicle and goes on."""
        part = self._bounds("ahead_first")
        return np.stack([self._sheet["ahead_usable_lower"][part], self._sheet["ahead_usable_higher"][part]], axis=1)

    @property
    def route(self) -> np.ndarray:
        """Edges of its way, from the one that it entered last to its destination: what ``Lease.take_route`` changes."""
        return self._sheet["route"][self._bounds("route_first")]

    @property
    def approaches(self) -> list[Approach]:
        """Signals that it will pass within 600 m, nearest first."""
        part = self._bounds("approach_first")
        sheet = self._sheet
        own, served = sheet["own_link_first"], sheet["served_link_first"]
        signal, distance_m, own_links, links = (sheet[name] for name in ("approach_signal", "approach_distance_m", "own_link",
                                                                        "served_link"))
        return [Approach(int(signal[at]), float(distance_m[at]), own_links[own[at]:own[at + 1]].tolist(),
                         links[served[at]:served[at + 1]].tolist())
                for at in range(part.start, part.stop)]


class Belief(Told):
    """What is believed now: all that a policy sees. Besides what is below: ``time_s`` (simulation time), ``network`` (``Network``),
    ``vehicles`` (``Vehicles``), ``links`` (``Links``).

    Arrays are views of shared memory, valid until ``act`` returns: copy what is needed later (``belief.vehicles.x_m.copy()``). A
    belief that is asked for arrays after that raises ClearwayError; an array that was kept holds other numbers.
    """

    def __init__(self, sheet: Sheet, network: Network) -> None:
        sheet.renew()
        self._sheet = Moment(sheet)
        self.network = network
        self.time_s = float(sheet["time_s"][0])
        self.vehicles = Vehicles(self._sheet, network)
        self.links = Links(self._sheet)

    def __repr__(self) -> str:
        return _shown(self, ("time_s", "vehicles", "emergency_vehicles"))

    def _end(self) -> None:
        """To be called when ``act`` has answered."""
        self._sheet.end()
        self.vehicles._forget()
        self.links._forget()

    @property
    def emergency_vehicles(self) -> list[EmergencyVehicle]:
        """Those on the road, ordered by key."""
        return [EmergencyVehicle(self, number) for number in range(len(self._sheet["emergency_key"]))]

    @property
    def incidents(self) -> dict[int, bool]:
        """Edges with incidents that last and are known, and whether the road is closed to emergency vehicles."""
        return dict(zip(self._sheet["incident_edge"].tolist(), self._sheet["incident_closed"].astype(bool).tolist()))

    @property
    def edge_times_s(self) -> np.ndarray:
        """For each edge, the time that is believed for an emergency vehicle that enters it now and drives at the limit where the road
        is free, s; inf where none may drive, inside junctions, and where a known incident closes it to them.

        What ``navigate`` believes with its default settings: the vehicles seen on the edge since the run began, fading; where none
        were, the limit and the mean wait of the signal's program.
        """
        return self._sheet["edge_times_s"]

    def signal_state(self, signal: int) -> str:
        """What a signal shows now, SUMO's letter for each link; empty where that is not known."""
        first = self._sheet["signal_first"]
        if signal + 1 >= len(first):
            return ""
        return self._sheet["signal_letters"][first[signal]:first[signal + 1]].tobytes().decode("ascii")


def _number(what: str, value: Any, least: float, most: float) -> float:
    if not isinstance(value, numbers.Real) or isinstance(value, bool):
        raise TypeError(f"{what} is {value!r}, not a number")
    if not math.isfinite(value) or not least <= value <= most:
        raise ValueError(f"{what} is {value} (allowed: {least:g} to {most:g})")
    return float(value)


def _whole(what: str, value: Any, most: int) -> int:
    number = _number(what, value, 0, most)
    if number != int(number):
        raise ValueError(f"{what} is {value}, not a whole number")
    return int(value)


def _row(what: str, value: Any, names: str) -> int:
    """The number of an edge or signal: a row of ``belief.network.NAMES``, whose length a lease does not know."""
    try:
        return _whole(what, value, NO_LANE - 1)
    except (TypeError, ValueError) as error:
        cure = f". belief.network.{names}.index({value!r}) is its row" if isinstance(value, str) else ""
        raise type(error)(f"{what} is {value!r} (allowed: a row of belief.network.{names}, from 0 on){cure}") from None


def _several(what: str, values: Any, of: str) -> Iterable[Any]:
    try:
        if isinstance(values, (str, bytes)):
            raise TypeError
        return iter(values)
    except TypeError:
        raise TypeError(f"{what} is {values!r} (allowed: a list of {of})") from None


def _links(what: str, links: Iterable[int]) -> list[int]:
    return sorted(_whole(f"a link of {what}", link, 65535) for link in _several(what, links, "numbers of links of the signal"))


def _key(what: str, vehicle: Any) -> int:
    return _whole(what, getattr(vehicle, "key", vehicle), 2**64 - 1)


class _Fields(dict):
    """Fields of a lease that a class method has checked."""


class _Actions(type):
    """An action that no lease has is told with the nearest, and those that are."""

    def __getattr__(cls, name: str) -> Any:
        raise no_attribute(cls.__name__, name, vars(cls))


def _action(make: F) -> F:
    """A class method of ``Lease``: it tells a keyword that it does not have, and keeps the line that called it for errors that
    show later."""
    known = keywords_of(make)

    @functools.wraps(make)
    def call(*words: Any, **given: Any) -> "Lease":
        for name in given:
            if name not in known:
                raise TypeError(str(no_keyword(f"Lease.{make.__name__}", name, known)))
        lease: Lease = make(*words, **given)
        caller = sys._getframe(1)
        object.__setattr__(lease, "_place", f"{os.path.basename(caller.f_code.co_filename)}, line {caller.f_lineno}")
        return lease
    return call  # type: ignore[return-value]


@dataclasses.dataclass(frozen=True)
class Lease(Told, metaclass=_Actions):
    """One action for one vehicle or signal. It ends by itself after ``lasting_s`` unless the next decision renews it.

    Make one with the class methods; ``vehicle`` is a key (``belief.vehicles.key[row]``) or an ``EmergencyVehicle``, ``serves`` the
    emergency vehicle for which it is, ``reason`` a few words for tables. Whether it can be carried out is judged as for every
    policy: what cannot is counted under its reason in ``results.leases`` (a vehicle that is gone: ``vehicle_gone``). What no lease
    can ever be, as a speed of NaN, raises here. ``fields`` holds what was asked for.
    """

    fields: dict[str, Any]
    _place: str = dataclasses.field(default="", compare=False, repr=False)

    def __post_init__(self) -> None:
        if type(self.fields) is not _Fields:
            raise TypeError("a lease is made by its class methods, as Lease.drive_at(vehicle, speed_mps): they check what it asks for")

    @staticmethod
    def _make(action: str, target: dict[str, int], serves: Any, lasting_s: float, priority: int, reason: str,
              **parameters: Any) -> "Lease":
        if isinstance(priority, bool) or not isinstance(priority, (int, np.integer)):
            raise TypeError(f"priority is {priority!r}, not a whole number")
        if not -2**31 <= priority < 2**31:
            raise ValueError(f"priority is {priority} (allowed: {-2**31} to {2**31 - 1})")
        return Lease(_Fields({"action": action, **target, **parameters, "beneficiary": 0 if serves is None else _key("serves", serves),
                      "lasting_s": _number("lasting_s", lasting_s, 1e-3, 3600.0), "priority": int(priority),
                              "reason": str(reason).encode("utf-8", "replace").decode() or "not said"}))

    @staticmethod
    @_action
    def drive_at(vehicle: Any, speed_mps: float, *, serves: Any = None, lasting_s: float = 2.0, priority: int = 0,
                 reason: str = "") -> "Lease":
        """Drive at this speed as far as safety allows."""
        return Lease._make("drive_at", {"vehicle": _key("vehicle", vehicle)}, serves, lasting_s, priority, reason,
                           speed_mps=_number("speed_mps", speed_mps, 0.0, 200.0))

    @staticmethod
    @_action
    def change_lane(vehicle: Any, lane_number: int, *, serves: Any = None, lasting_s: float = 2.0, priority: int = 0,
                    reason: str = "") -> "Lease":
        """Move to the lane with this number on the present edge, 0 the outermost, and stay there while the lease lasts."""
        return Lease._make("change_lane", {"vehicle": _key("vehicle", vehicle)}, serves, lasting_s, priority, reason,
                           lane_number=_whole("lane_number", lane_number, 255))

    @staticmethod
    @_action
    def hold_lane(vehicle: Any, *, serves: Any = None, lasting_s: float = 2.0, priority: int = 0, reason: str = "") -> "Lease":
        """Do not change lanes except where the route demands it."""
        return Lease._make("hold_lane", {"vehicle": _key("vehicle", vehicle)}, serves, lasting_s, priority, reason)

    @staticmethod
    @_action
    def pull_aside(vehicle: Any, side: str = "right", *, serves: Any = None, lasting_s: float = 2.0, priority: int = 0,
                   reason: str = "") -> "Lease":
        """Drive at one edge of the lane, ``right`` or ``left``; without the sublane model, stop beside the road while it lasts."""
        if side not in ("right", "left"):
            raise ValueError(f"side is {side!r} (allowed: right, left)")
        return Lease._make("pull_aside", {"vehicle": _key("vehicle", vehicle)}, serves, lasting_s, priority, reason, side=side)

    @staticmethod
    @_action
    def stop_at_line(vehicle: Any, *, serves: Any = None, lasting_s: float = 2.0, priority: int = 0, reason: str = "") -> "Lease":
        """Give way at the stop line of the present lane."""
        return Lease._make("stop_at_line", {"vehicle": _key("vehicle", vehicle)}, serves, lasting_s, priority, reason)

    @staticmethod
    @_action
    def pass_red(vehicle: Any, *, serves: Any = None, lasting_s: float = 2.0, priority: int = 0, reason: str = "") -> "Lease":
        """Pass red slowly and yielding; emergency vehicles only."""
        return Lease._make("pass_red", {"vehicle": _key("vehicle", vehicle)}, serves, lasting_s, priority, reason)

    @staticmethod
    @_action
    def take_route(vehicle: Any, edges: Sequence[int], *, serves: Any = None, lasting_s: float = 2.0, priority: int = 0,
                   reason: str = "") -> "Lease":
        """Drive over these edges (numbers of the network) to the destination; emergency vehicles only. A way that was taken stays.

        The first edge is where the vehicle is or was since; edges that do not follow each other (``belief.network.onward``) fail the
        run. Refused are another destination (``route_elsewhere``), a turn for which it is too late (``past_decision``) and a road that
        is known to be closed (``closed``).
        """
        way = [_row("an edge of edges", edge, "edge_ids") for edge in _several("edges", edges, "rows of belief.network.edge_ids")]
        if not way:
            raise ValueError("edges is empty (allowed: at least the edge where the vehicle is)")
        return Lease._make("take_route", {"vehicle": _key("vehicle", vehicle)}, serves, lasting_s, priority, reason, edges=way)

    @staticmethod
    @_action
    def hold_green(signal: int, links: Sequence[int], own_links: Sequence[int] = (), *, serves: Any = None, lasting_s: float = 2.0,
                   priority: int = 0, reason: str = "") -> "Lease":
        """Show green for these links and red for those that conflict with them; of two of these that conflict, the later one yields.
        ``own_links`` are those of the one it serves."""
        return Lease._make("hold_green", {"signal": _row("signal", signal, "signal_ids")}, serves, lasting_s, priority, reason,
                           links=_links("links", links), own_links=_links("own_links", own_links))

    @staticmethod
    @_action
    def adjust_green(signal: int, links: Sequence[int], *, serves: Any = None, lasting_s: float = 2.0, priority: int = 0,
                     reason: str = "") -> "Lease":
        """Lead the signal's own plan to these links sooner."""
        return Lease._make("adjust_green", {"signal": _row("signal", signal, "signal_ids")}, serves, lasting_s, priority, reason,
                           links=_links("links", links))


class Policy:
    """Base of policies in Python: ``--policy my_policy.py:Mine``. Deriving from it is not required; ``act`` is.

    One object serves one run, in a process of its own: it may keep copies of what it likes between calls
    (``self.before = belief.vehicles.x_m.copy()``; the arrays themselves are overwritten), and shares nothing with other runs. The
    same belief must give the same leases (draw random numbers from a generator with a fixed seed).

    ``period_s`` (time between two decisions, s) and ``network`` (the map, ``Network``) are set before the first call of ``act``.
    """

    period_s: float
    network: Network

    def act(self, belief: Belief) -> Iterable[Lease]:
        """Called at every decision; returns leases (a list, or any iterable)."""
        raise NotImplementedError


class Observation(_Rows):
    """What was reported, for a predictor. Rows of vehicles are ordered by ``key``; arrays are views, valid until ``predict`` returns:
    copy what is needed later.

    ``time_s`` (simulation time), ``network`` (``Network``), ``link_radius_m`` (vehicles nearer than this are linked).
    Of vehicles: ``key``, ``vehicle_class``, ``age_s``, ``known`` (1: nothing to predict), ``sensor_sigma_m``; dead-reckoned to now:
    ``x_m``, ``y_m``, ``heading_rad``, ``speed_mps``, ``lane``, ``lane_position_m``; as reported: ``last_x_m``, ``last_y_m``.
    Of observed links: ``link_left``, ``link_right`` (rows; ``edge_index`` has both ways). Of candidates: ``pair_left``,
    ``pair_right`` (rows; ``pairs`` has both), ``pair_last_seen_m``, ``pair_dead_reckoned_m``.

    Predictors of Clearway may also see routes with their ends and the states of signals. Here, of routes only the dead-reckoned
    places tell, and of signals ``network`` where they stand.
    """

    _names = ("key", "vehicle_class", "age_s", "known", "sensor_sigma_m", "x_m", "y_m", "heading_rad", "speed_mps", "lane",
              "lane_position_m", "last_x_m", "last_y_m", "link_left", "link_right", "pair_left", "pair_right", "pair_last_seen_m",
              "pair_dead_reckoned_m")

    def __init__(self, sheet: Sheet, network: Network, link_radius_m: float) -> None:
        sheet.renew()
        super().__init__(Moment(sheet))
        self.network = network
        self.link_radius_m = link_radius_m
        self.time_s = float(sheet["time_s"][0])

    def _end(self) -> None:
        """To be called when ``predict`` has answered."""
        self._sheet.end()
        self._forget()

    @functools.cached_property
    def edge_index(self) -> np.ndarray:
        """Observed links both ways, ``int64[2, n]``: along them messages may go."""
        one_way = np.stack([self.link_left, self.link_right]).astype(np.int64)
        return np.concatenate([one_way, one_way[::-1]], axis=1)

    @functools.cached_property
    def pairs(self) -> np.ndarray:
        """Candidates, ``int64[2, n]``: for each of them a probability is wanted."""
        return np.stack([self.pair_left, self.pair_right]).astype(np.int64)


class Predictor:
    """Base of predictors in Python: ``--predictor my_net.py:Mine``. Deriving from it is not required; ``predict`` is.

    ``network`` (the map, ``Network``) is set before the first call of ``predict``.
    """

    network: Network

    def predict(self, observation: Observation) -> np.ndarray:
        """Returns, for each of ``observation.pairs``, the probability that the two are nearer than the link radius."""
        raise NotImplementedError


def checked_leases(answer: Any) -> list[dict[str, Any]]:
    """The fields of leases that ``act`` returned."""
    if answer is None:
        raise TypeError("act returned None: return a list of leases, empty if there is nothing to ask for")
    if isinstance(answer, Lease):
        raise TypeError("act returned one lease: return a list, [lease]")
    if isinstance(answer, (str, bytes, Mapping)):
        raise TypeError(f"act returned a {type(answer).__name__}, not a list of clearway.Lease: {reprlib.repr(answer)}")
    try:
        leases = list(answer)
    except TypeError:
        if isinstance(answer, Iterable):
            raise
        raise TypeError(f"act returned {answer!r}, which is not a list of leases") from None
    for lease in leases:
        if not isinstance(lease, Lease):
            raise TypeError(f"act returned {lease!r} in its list, which is not a clearway.Lease")
    return [{**lease.fields, "place": lease._place} for lease in leases]


def checked_probabilities(answer: Any, count: int) -> np.ndarray:
    """The array that ``predict`` returned."""
    if answer is None:
        raise TypeError(f"predict returned None: return an array of {count} probabilities, one for each of observation.pairs")
    values = np.asarray(answer)
    if values.shape != (count,) or values.dtype.kind not in "fiub":
        raise ValueError(f"predict returned an array of shape {values.shape} and type {values.dtype}; one number for each of the "
                         f"{count} pairs is wanted, shape ({count},)")
    values = values.astype(np.float32)
    wrong = ~((values >= 0.0) & (values <= 1.0))
    if wrong.any():
        raise ValueError(f"predict returned the probability {values[wrong][0]} for pair {int(np.argmax(wrong))} (allowed: 0 to 1)")
    return values
