"""Several environments at a time: each simulates in a process of its own."""
from __future__ import annotations

import numbers
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Sequence

import numpy as np

from . import _program, _spaces
from .environment import Env, checked_seeds

if _spaces.installed("gymnasium"):
    import gymnasium

    _Base: Any = gymnasium.vector.VectorEnv
else:
    _Base = object


class VectorEnv(_Base):
    """``count`` environments of one scenario that simulate at the same time, with Gymnasium's vector API.

    Environment i takes every count-th of ``seeds`` from the i-th on. An environment whose episode has ended is reset by the next
    ``step``, which ignores its action and gives it reward 0 (Gymnasium's ``NEXT_STEP``).

    ``envs`` are the environments, ``num_envs`` their number; ``action_space`` and ``observation_space`` are those of all,
    ``single_action_space`` and ``single_observation_space`` those of one; ``metadata`` names the mode of restarting; ``closed``
    says whether they are.
    """

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode = None

    def __init__(self, scenario: str | Path, count: int, *, seeds: Sequence[int] = range(8), **arguments: Any) -> None:
        self.envs: list[Env] = []
        self.closed = False
        each = checked_seeds(seeds)
        if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or not 1 <= count <= len(each):
            raise _program.InputError(f"count is {count!r} (allowed: 1 to {len(each)}, the number of seeds)")
        count = int(count)
        self.metadata = {**self.metadata, "autoreset_mode": _next_step()}
        self.num_envs = count
        try:
            for number in range(count):
                self.envs.append(Env(scenario, seeds=each[number::count], **arguments))
        except BaseException:
            self.close()
            raise
        self.single_observation_space = self.envs[0].observation_space
        self.single_action_space = self.envs[0].action_space
        self.observation_space = _batched(self.single_observation_space, count)
        self.action_space = _spaces.MultiDiscrete(np.tile(self.envs[0]._nvec, (count, 1)))
        self._over = np.zeros(count, dtype=bool)
        self._layout: list[tuple[str, tuple[int, ...], np.dtype, int, tuple[int, ...]]] = []
        self._block = self._size = 0

    def reset(self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
              ) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Resets all; a single seed s gives environment i the seed s + i."""
        pairs = [one.reset(seed=own) for one, own in zip(self.envs, self._seeds_of(seed))]
        self._over[:] = False
        observations, _ = self._batch()
        for number, (observation, _) in enumerate(pairs):
            self._keep(observations, number, observation)
        return observations, _infos([info for _, info in pairs])

    def _seeds_of(self, seed: Any) -> list[int | None]:
        """A seed for each environment, all of them checked before any begins anew."""
        if seed is None:
            return [None] * self.num_envs
        if isinstance(seed, numbers.Real) or isinstance(seed, str):
            (first,) = checked_seeds([seed])
            return list(checked_seeds(range(first, first + self.num_envs)))
        seeds = list(seed)
        if len(seeds) != self.num_envs:
            raise _program.InputError(f"{len(seeds)} seeds for {self.num_envs} environments")
        return [None if one is None else checked_seeds([one])[0] for one in seeds]

    def step(self, actions: Any) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Steps all: first every environment gets its action, then each is waited for."""
        count = len(actions) if hasattr(actions, "__len__") else 0
        if count != self.num_envs:
            raise _program.InputError(f"{count} actions for {self.num_envs} environments")
        over = self._over.tolist()
        # All are checked before any is sent: a wrong one must not leave the others a step ahead.
        checked = [None if is_over else one._checked(action) for one, action, is_over in zip(self.envs, actions, over)]
        for one, action in zip(self.envs, checked):
            if action is not None:
                one._send(action)
        observations, rows = self._batch()  # while they simulate
        steps = [self._restarted(one, number, observations) if is_over else self._stepped(one, number, observations, rows[number])
                 for number, (one, is_over) in enumerate(zip(self.envs, over))]
        rewards, terminated, truncated, infos = zip(*steps)
        self._over = np.logical_or(terminated, truncated)
        return observations, np.array(rewards), np.array(terminated), np.array(truncated), _infos(infos)

    def _batch(self) -> tuple[dict[str, np.ndarray], list[memoryview]]:
        """Arrays for the observations of all, not yet filled, and the memory of each environment's row of all of them.

        One block of memory holds what one environment sees, as it is in the memory that is shared with its worker. So it is copied
        at once, and the arrays of all are views with the block as their first stride.
        """
        if not self._layout:
            layout, size = self.envs[0]._worker.layout(self.envs[0]._shapes)
            self._block = (size + 63) // 64 * 64
            for name, shape, kind, offset in layout:
                inner = np.empty(shape, kind).strides
                self._layout.append((name, (self.num_envs, *shape), kind, offset, (self._block, *inner)))
            self._size = size
        memory = np.empty(self.num_envs * self._block, dtype=np.uint8)
        whole = memoryview(memory)
        rows = [whole[number * self._block:number * self._block + self._size] for number in range(self.num_envs)]
        return {name: np.ndarray(shape, kind, memory, offset, strides) for name, shape, kind, offset, strides in self._layout}, rows

    def _keep(self, observations: dict[str, np.ndarray], number: int, observation: Mapping[str, np.ndarray]) -> None:
        for name, array in observation.items():
            observations[name][number] = array

    def _restarted(self, one: Env, number: int, observations: dict[str, np.ndarray]) -> tuple[float, bool, bool, dict[str, Any]]:
        observation, info = one.reset()
        self._keep(observations, number, observation)
        return 0.0, False, False, info

    def _stepped(self, one: Env, number: int, observations: dict[str, np.ndarray], row: memoryview
                 ) -> tuple[float, bool, bool, dict[str, Any]]:
        numbers = one._heard()
        if numbers is None:
            observation, reward, terminated, truncated, info = one._last_step(one._worker.end())
            self._keep(observations, number, observation)
            return reward, terminated, truncated, info
        one._worker.copy_block(row)
        one._last = _Row(observations, number)
        return one._reward(numbers[1], numbers[2]), one._ends(numbers), False, one._info(*numbers)

    def close(self, **_: Any) -> None:
        """Closes all. May be called again."""
        for one in self.envs:
            one.close()
        self.closed = True

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.num_envs} times {self.envs[0].spec.kwargs['scenario']}>"

    def __enter__(self) -> "VectorEnv":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


def _next_step() -> Any:
    """How Gymnasium says that an ended episode begins anew at the next step: a word before 1.1, an enumeration since."""
    modes = None if _Base is object else getattr(gymnasium.vector, "AutoresetMode", None)
    return "NextStep" if modes is None else modes.NEXT_STEP


class _Row(Mapping):
    """What one environment sees of the arrays of all."""

    def __init__(self, observations: dict[str, np.ndarray], number: int) -> None:
        self._observations, self._number = observations, number

    def __getitem__(self, name: str) -> np.ndarray:
        return self._observations[name][self._number]

    def __iter__(self) -> Iterator[str]:
        return iter(self._observations)

    def __len__(self) -> int:
        return len(self._observations)


def _infos(infos: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """As Gymnasium does: an array for each key, and `_key` for who has it."""
    batch: dict[str, Any] = {}
    if all(info.keys() == infos[0].keys() for info in infos) and "metrics" not in infos[0]:  # nearly always; numbers alone
        everybody = np.ones((len(infos[0]), len(infos)), dtype=bool)
        for key, has in zip(infos[0], everybody):
            batch[key] = np.array([info[key] for info in infos])
            batch["_" + key] = has
        return batch
    for key in {key: None for info in infos for key in info}:
        has = np.array([key in info for info in infos])
        values = [info.get(key) for info in infos]
        is_number = all(isinstance(value, (int, float)) for value, there in zip(values, has) if there)
        batch[key] = np.array([value if there else 0 for value, there in zip(values, has)], dtype=None if is_number else object)
        batch["_" + key] = has
    return batch


def _batched(space: Any, count: int) -> Any:
    return _spaces.Dict({name: _spaces.Box(np.min(one.low), np.max(one.high), shape=(count, *one.shape), dtype=one.dtype.type)
                         for name, one in space.spaces.items()})


def vector_env(scenario: str | Path, count: int, **arguments: Any) -> VectorEnv:
    """``count`` environments at a time, with Gymnasium's vector API; arguments are those of ``clearway.env``."""
    return VectorEnv(scenario, count, **arguments)
