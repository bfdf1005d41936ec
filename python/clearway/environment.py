"""Environments: Gymnasium's API for one agent. ``clearway.env(...)`` makes one; ``parallel`` and ``vector`` build on it."""
from __future__ import annotations

import collections
import math
import numbers
import operator
import os
import shutil
import tempfile
import weakref
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _program, _spaces, _spec
from ._channel import ENDED
from ._worker import Worker
from .running import Part, part_name, policy_names

if _spaces.installed("gymnasium"):
    import gymnasium

    _Base: Any = gymnasium.Env
else:
    _Base = object

#: Warm replications that an environment keeps; each is a process of about 80 MB.
KEPT_WARM = 4
#: Most ways that may be offered; as policy::most_agent_ways.
MOST_WAYS = 8


class Env(_Base):
    """One scenario in which an agent drives signals and automated vehicles for the first emergency vehicle (EV) on the road.

    An episode is a run of ``clearway run`` from the moment at which the first EV enters; between two steps passes one policy
    period (0.5 s). Action: ``MultiDiscrete``: first, for each signal, 0 (leave it alone) or 1 + p (hold the p-th green phase of its
    program); then, for each of 8 automated vehicles ahead of the EV, nearest first, ``lane + 4 * speed``: lane 0 none, 1 hold,
    2 outward, 3 inward; speed 0 none, 1 to 3 half, 0.8 and all of the allowed speed. ``action_mask`` of the observation says which
    are legal; others do nothing and are counted in ``info["illegal_actions"]``. Whether a legal one is carried out is judged as for
    every policy.

    With ``ways`` from 1 to 8, the last number of an action chooses the EV's way: 0 keeps it, 1 to ``ways`` take that row of
    ``ways`` in the observation: the best ways by the times that ``navigate`` believes with its default settings, the fastest first,
    from the last turn that the EV can still make; one of them may be its present way. They are those of this step alone: the next
    observation may have them in another order. A way that was taken stays.

    Observation: what is *believed* around the EV under the chosen faults and predictor, as arrays of fixed size with masks
    (``docs/guides/python.md`` lists their columns). Rows of ``vehicles`` are the 32 nearest; ``edges`` are their believed links.

    Reward: minus the seconds that EVs lost since the last step against the speed that road and vehicle allow, minus
    ``others_weight`` times the same of all other vehicles. It comes from the truth and is not what a study scores.

    Terminated when every EV has come and gone (``until="end"``: when nobody is left), truncated at the scenario's horizon.

    ``action_space``, ``observation_space``; ``signal_ids``, SUMO's names of the signals in the order of actions; ``spec``, whose
    ``make()`` makes another environment like this one; ``render_mode``, ``others_weight`` and ``until`` as given.
    """

    metadata = {"render_modes": ["ansi"], "render_fps": 2}

    def __init__(self, scenario: str | Path, *, seeds: Sequence[int] = range(4), study_seed: int = 1, policy: Part | Sequence[Part] = (),
                 failure: str = "perfect", predictor: Part = "none", set: Mapping[str, Any] | None = None, others_weight: float = 0.01,
                 until: str = "emergency", render_mode: str | None = None, ways: int = 0, **options: Any) -> None:
        if until not in ("emergency", "end"):
            raise _program.InputError(f"until is {until!r} (allowed: emergency, end)")
        if render_mode not in (None, "ansi"):
            raise _program.InputError(f"render_mode is {render_mode!r} (allowed: None, ansi); `clearway run --gui` shows a run")
        if not (isinstance(others_weight, numbers.Real) and math.isfinite(others_weight) and others_weight >= 0.0):
            raise _program.InputError(f"others_weight is {others_weight!r} (allowed: a number of at least 0)")
        if isinstance(ways, bool) or not isinstance(ways, (int, np.integer)) or not 0 <= ways <= MOST_WAYS:
            raise _program.InputError(f"ways is {ways!r} (allowed: a whole number from 0 to {MOST_WAYS})")
        self.render_mode, self.others_weight, self.until = render_mode, float(others_weight), until
        #: How many ways are offered.
        self.ways = int(ways)
        self._seeds = checked_seeds(seeds)
        self._arguments = _arguments(scenario, study_seed, policy, failure, predictor, set or {}, options)
        self._arguments += ["--ways", str(self.ways)] if ways else []
        self.spec: Any = _spec.spec_of({"scenario": scenario, "seeds": self._seeds, "study_seed": study_seed, "policy": policy,
                                        "failure": failure, "predictor": predictor, "set": set, "others_weight": self.others_weight,
                                        "until": until, "render_mode": render_mode, "ways": self.ways, **options})
        self._owner = os.getpid()
        self._folder = Path(tempfile.mkdtemp(prefix="clearway-env-"))
        self._finalizer = weakref.finalize(self, _remove, str(self._folder), self._owner)
        self._workers: collections.OrderedDict[int, Worker] = collections.OrderedDict()
        self._episode, self._state = 0, "new"
        self._worker: Worker | None = None
        self._last: Mapping[str, np.ndarray] | None = None
        self._np_random: np.random.Generator | None = None
        self._np_random_seed: int | None = None
        try:
            self._describe(self._warm(self._seeds[0]).greeting)
        except BaseException as error:
            self._finalizer()
            if isinstance(error, _program.InputError) and options:
                raise _program.unknown_override("clearway.env", error, options, _program.keywords_of(Env.__init__)) from None
            raise

    def _describe(self, sizes: dict[str, Any]) -> None:
        signals, links, automated, ways = len(sizes["signals"]), sizes["links"], sizes["automated"], sizes["ways"]
        self.signal_ids: list[str] = [signal[0] for signal in sizes["signals"]]
        self._choices = [1 + sizes["phases"]] * signals + [sizes["automated_choices"]] * automated + ([1 + ways] if ways else [])
        self._meaning = "one for each signal, then one for each automated vehicle" + (", then one for the way" if ways else "")
        self._nvec = np.array(self._choices, dtype=np.int64)
        self.action_space = _spaces.MultiDiscrete(self._choices)
        box = _spaces.Box
        far, farther = 1e5, 1e7  # a way behind queues takes long
        shapes = {"emergency": ((6,), far), "vehicles": ((sizes["vehicles"], 12), far), "vehicle_mask": ((sizes["vehicles"],), 1),
                  "edges": ((2, links), sizes["vehicles"]), "edge_features": ((links, 2), far), "edge_mask": ((links,), 1),
                  "signals": ((signals, 3), far), "signal_states": ((signals, sizes["signal_links"]), 3),
                  "signal_phases": ((signals, sizes["phases"]), 1), "ways": ((ways, 3), farther), "way_mask": ((ways,), 1),
                  "action_mask": ((int(self._nvec.sum()),), 1)}
        kinds = {name: np.dtype(kind) for name, kind, _, _ in sizes["question"]}
        self._shapes = {name: shape for name, (shape, _) in shapes.items() if 0 not in shape}
        self.observation_space = _spaces.Dict({
            name: box(-shapes[name][1] if kinds[name].kind == "f" else 0, shapes[name][1], shape=shape, dtype=kinds[name].type)
            for name, shape in self._shapes.items()})

    def _warm(self, seed: int) -> Worker:
        worker = self._workers.pop(seed, None)
        if worker is None:
            while len(self._workers) >= KEPT_WARM:
                self._workers.popitem(last=False)[1].close()
            worker = Worker([*self._arguments, "--replication", str(seed)], self._folder / str(seed))
        self._workers[seed] = worker
        return worker

    def _require_owner(self) -> None:
        if os.getpid() != self._owner:
            raise _program.ClearwayError(f"this environment belongs to process {self._owner}; make one in this process ({os.getpid()})")
        if self._state == "closed":
            raise _program.ClearwayError("this environment is closed; make another one")

    def _require_episode(self) -> None:
        self._require_owner()
        if self._last is None:
            raise _program.ClearwayError("call reset() first")

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Begins an episode: the replication ``seed``, or, without one, the next of ``seeds`` in turn.

        Which is next follows from the last ``seed`` alone: the one after it in ``seeds``, or, for any other s, the one at position s
        modulo their number.

        The same seed gives the same episode, to the bit. The first episode of a seed loads and warms up its simulation; later ones
        fork from there. ``options`` are not used.
        """
        self._require_owner()
        if seed is None:
            seed = self._seeds[self._episode % len(self._seeds)]
            self._episode += 1
        else:
            seed = _checked_seed(seed)
            self._seed_generator(seed)
            self._episode = self._seeds.index(seed) + 1 if seed in self._seeds else seed
        if self._np_random is None:
            self._seed_generator(self._seeds[0])
        self._state = "over"
        try:
            self._worker = self._warm(seed)
            if self._worker.reset() == ENDED:
                raise _program.InputError(f"no emergency vehicle entered in replication {seed}: there is nothing to decide")
        except _program.ClearwayError:
            self._drop(seed)
            raise
        self._state, self._seed = "running", seed
        self._last = self._worker.copied(self._shapes)
        return self._last, self._info(*self._worker.numbers())

    def _drop(self, seed: int) -> None:
        worker = self._workers.pop(seed, None)
        if worker is not None:
            worker.close()

    def _seed_generator(self, seed: int) -> None:
        self._np_random, self._np_random_seed = np.random.Generator(np.random.PCG64(seed)), seed

    def step(self, action: Any) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        """Carries out an action until the next decision."""
        self.send(action)
        return self.receive()

    def send(self, action: Any) -> None:
        """The first half of ``step``: vector environments let all simulate at the same time."""
        self._send(self._checked(action))

    def _send(self, actions: np.ndarray) -> None:
        self._worker.send(actions)
        self._state = "sent"

    def _checked(self, action: Any) -> np.ndarray:
        self._require_owner()
        if self._state != "running":
            raise _program.ClearwayError(_NOT_RUNNING[self._state])
        try:
            actions = action if type(action) is np.ndarray else np.asarray(action)
        except ValueError:  # lists of different lengths
            actions = np.asarray(None)
        if actions.shape != self._nvec.shape or actions.dtype.kind not in "iu":
            raise _program.InputError(f"an action of shape {actions.shape} and type {actions.dtype} (allowed: {len(self._nvec)} whole "
                                      f"numbers, {self._meaning})")
        values = actions.tolist()  # some numbers are compared sooner in Python than in numpy
        if any(map(operator.ge, values, self._choices)) or min(values) < 0:
            wrong = int(np.argmax((actions < 0) | (actions >= self._nvec)))
            raise _program.InputError(f"action {wrong} is {actions[wrong]} (allowed: 0 to {self._nvec[wrong] - 1})")
        return actions

    def receive(self) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        """The second half of ``step``."""
        self._require_owner()
        if self._state != "sent":
            raise _program.ClearwayError("no action is under way: call send() before receive()")
        numbers = self._heard()
        if numbers is None:
            return self._last_step(self._worker.end())
        self._last = self._worker.copied(self._shapes)
        _, emergency_s, others_s, _, _ = numbers
        return self._last, self._reward(emergency_s, others_s), self._ends(numbers), False, self._info(*numbers)

    def _heard(self) -> tuple[float, float, float, int, int] | None:
        """What the worker says of a step in numbers (``Worker.numbers``); nothing at the end of the run."""
        try:
            bell = self._worker.receive()
        except _program.ClearwayError:
            self._state = "over"
            self._drop(self._seed)
            raise
        self._state = "running"
        return None if bell == ENDED else self._worker.numbers()

    def _ends(self, numbers: tuple[float, float, float, int, int]) -> bool:
        """Whether an episode is over, which the agent's numbers say; if so, it is."""
        ends = self.until == "emergency" and bool(numbers[3])
        if ends:
            self._state = "over"
        return ends

    def _last_step(self, end: dict[str, Any]) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        self._state = "over"
        info = {"seed": self._seed, "time_s": end["metrics"]["simulated_s"], "emergency_delay_s": end["emergency_delay_s"],
                "others_delay_s": end["others_delay_s"], "illegal_actions": 0, "metrics": end["metrics"],
                "trace_hash": end["trace_hash"]}
        reward = self._reward(end["emergency_delay_s"], end["others_delay_s"])
        assert self._last is not None
        return dict(self._last), reward, not end["truncated"], end["truncated"], info

    def _reward(self, emergency_s: float, others_s: float) -> float:
        return -(emergency_s + self.others_weight * others_s)

    def _info(self, time_s: float, emergency_s: float, others_s: float, _: int, illegal: int) -> dict[str, Any]:
        self._time_s = time_s
        return {"seed": self._seed, "time_s": time_s, "emergency_delay_s": emergency_s, "others_delay_s": others_s,
                "illegal_actions": illegal}

    def action_masks(self) -> tuple[np.ndarray, ...]:
        """Legal choices of each part of the present action, as ``action_space.sample(mask)`` takes it."""
        self._require_episode()
        return tuple(np.split(self._last["action_mask"].astype(np.int8), np.cumsum(self._choices)[:-1]))

    def render(self) -> str | None:
        """One line about the EV, with ``render_mode="ansi"``."""
        if self.render_mode is None or self._last is None or self._state == "closed":
            return None
        present, speed, allowed, lane, _, line = self._last["emergency"].tolist()
        place = f"EV at {speed:.1f} of {allowed:.1f} m/s on lane {lane:.0f}, next stop line in {line:.0f} m" if present else "no EV"
        return f"{self._time_s:.2f} s: {place}, {int(self._last['vehicle_mask'].sum())} vehicles near"

    def close(self) -> None:
        """Ends the processes. May be called again."""
        if os.getpid() == self._owner and self._state != "closed":
            self._state = "closed"
            for worker in self._workers.values():
                worker.close()
            self._workers.clear()
            self._finalizer()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.spec.kwargs['scenario']}>"

    def __enter__(self) -> "Env":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __del__(self) -> None:
        if getattr(self, "_state", "closed") != "closed":
            self.close()


_NOT_RUNNING = {"new": "call reset() first", "over": "the episode is over: call reset() before the next step()",
                "sent": "the last step was not waited for to its end: call receive(), or reset()"}

if _Base is object:
    Env.unwrapped = property(lambda self: self)
    Env.np_random = property(lambda self: self._np_random)
    Env.np_random_seed = property(lambda self: self._np_random_seed)


def _remove(folder: str, owner: int) -> None:
    if os.getpid() == owner:
        shutil.rmtree(folder, ignore_errors=True)


def _checked_seed(seed: Any) -> int:
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or not 0 <= seed <= 4294967295:
        raise _program.InputError(f"seed is {seed!r} (allowed: a whole number from 0 to 4294967295, the replication)")
    return int(seed)


def checked_seeds(seeds: Any) -> list[int]:
    allowed = "(allowed: at least one whole number from 0 to 4294967295, as range(4))"
    try:
        checked = [_checked_seed(seed) for seed in seeds]
    except TypeError:
        raise _program.InputError(f"seeds are {seeds!r} {allowed}") from None
    if not checked:
        raise _program.InputError(f"seeds are empty {allowed}")
    return checked


def _arguments(scenario: str | Path, study_seed: int, policy: Part | Sequence[Part], failure: str, predictor: Part,
               settings: Mapping[str, Any], options: Mapping[str, Any]) -> list[str]:
    if not isinstance(scenario, (str, Path)) or str(scenario).startswith("-"):
        raise _program.InputError(f"scenario is {scenario!r} (allowed: a name of `clearway list`, a folder or a file)")
    if not isinstance(settings, Mapping):
        raise _program.InputError(f"set is {settings!r} (allowed: a dictionary of settings)")
    policies = policy_names(policy)
    words = [str(scenario), "--seed", str(study_seed), "--failure", str(failure), "--predictor", part_name(predictor)]
    words += ["--policy", *policies] if policies else []
    for name, value in settings.items():
        words += ["--set", f"{name}={str(value).lower() if isinstance(value, (bool, np.bool_)) else value}"]
    for name, value in options.items():
        words += ["--override", f"{name}={value}"]
    return words


def env(scenario: str | Path, **arguments: Any) -> Env:
    """An environment with Gymnasium's API; see ``Env`` for arguments, spaces and reward. Other keywords are overrides, the same as
    for ``clearway.run``: ``variant="dense"``, ``step_length_s=0.1``."""
    return Env(scenario, **arguments)
