"""Gymnasium's spaces, or, where it is not installed, the few that environments need, with the same behaviour."""
from __future__ import annotations

import importlib.util
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np


class Space:
    """A set of values that can be sampled and asked whether it contains one."""

    def __init__(self, shape: tuple[int, ...] | None, dtype: Any) -> None:
        self.shape, self.dtype = shape, None if dtype is None else np.dtype(dtype)
        self._np_random: np.random.Generator | None = None

    @property
    def np_random(self) -> np.random.Generator:
        if self._np_random is None:
            self.seed()
        assert self._np_random is not None
        return self._np_random

    def seed(self, seed: int | None = None) -> Any:
        self._np_random = np.random.Generator(np.random.PCG64(seed))
        return seed

    def sample(self, mask: Any = None) -> Any:
        raise NotImplementedError

    def contains(self, x: Any) -> bool:
        raise NotImplementedError

    def __contains__(self, x: Any) -> bool:
        return self.contains(x)


class _Box(Space):
    def __init__(self, low: Any, high: Any, shape: tuple[int, ...], dtype: Any) -> None:
        super().__init__(shape, dtype)
        self.low, self.high = np.full(shape, low, dtype=dtype), np.full(shape, high, dtype=dtype)

    def sample(self, mask: Any = None) -> np.ndarray:
        if self.dtype.kind == "f":
            return self.np_random.uniform(self.low, self.high).astype(self.dtype)
        return self.np_random.integers(self.low, self.high, endpoint=True, dtype=self.dtype)

    def __repr__(self) -> str:
        return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"

    def contains(self, x: Any) -> bool:
        return bool(isinstance(x, np.ndarray) and np.can_cast(x.dtype, self.dtype) and x.shape == self.shape
                    and np.all(x >= self.low) and np.all(x <= self.high))


class _Discrete(Space):
    def __init__(self, n: int) -> None:
        super().__init__((), np.int64)
        self.n, self.start = np.int64(n), np.int64(0)

    def sample(self, mask: Any = None) -> np.int64:
        if mask is None:
            return np.int64(self.np_random.integers(self.n))
        legal = np.flatnonzero(mask)
        return np.int64(self.np_random.choice(legal)) if len(legal) else np.int64(0)

    def __repr__(self) -> str:
        return f"Discrete({self.n})"

    def contains(self, x: Any) -> bool:
        is_whole = isinstance(x, (int, np.integer)) or (isinstance(x, np.ndarray) and x.shape == () and x.dtype.kind in "iu")
        return bool(is_whole and 0 <= int(x) < self.n)


class _MultiDiscrete(Space):
    def __init__(self, nvec: Any) -> None:
        self.nvec = np.asarray(nvec, dtype=np.int64)
        super().__init__(self.nvec.shape, np.int64)

    def sample(self, mask: Any = None) -> np.ndarray:
        if mask is None:
            return (self.np_random.random(self.nvec.shape) * self.nvec).astype(np.int64)
        return np.array([self.np_random.choice(np.flatnonzero(one)) if np.any(one) else 0 for one in mask], dtype=np.int64)

    def __repr__(self) -> str:
        return f"MultiDiscrete({self.nvec})"

    def contains(self, x: Any) -> bool:
        return bool(isinstance(x, np.ndarray) and x.shape == self.shape and x.dtype.kind in "iu" and np.all(x >= 0)
                    and np.all(x < self.nvec))


class _Dict(Space, Mapping):
    def __init__(self, spaces: dict[str, Space]) -> None:
        self.spaces = dict(spaces)
        super().__init__(None, None)

    def seed(self, seed: int | None = None) -> Any:
        super().seed(seed)
        for number, space in enumerate(self.spaces.values()):
            space.seed(None if seed is None else seed + number)
        return seed

    def sample(self, mask: Any = None) -> dict[str, Any]:
        return {name: space.sample(mask[name] if mask else None) for name, space in self.spaces.items()}

    def __repr__(self) -> str:
        return f"Dict({', '.join(f'{name!r}: {space!r}' for name, space in self.spaces.items())})"

    def contains(self, x: Any) -> bool:
        return isinstance(x, dict) and x.keys() == self.spaces.keys() and all(x[name] in space for name, space in self.spaces.items())

    def __getitem__(self, name: str) -> Space:
        return self.spaces[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.spaces)

    def __len__(self) -> int:
        return len(self.spaces)

    def __hash__(self) -> int:
        return id(self)


def installed(package: str) -> bool:
    """Whether a package can be imported, without importing it."""
    return importlib.util.find_spec(package) is not None


if installed("gymnasium"):
    from gymnasium import spaces as _theirs

    Box, Discrete, MultiDiscrete, Dict = _theirs.Box, _theirs.Discrete, _theirs.MultiDiscrete, _theirs.Dict
else:
    Box, Discrete, MultiDiscrete, Dict = _Box, _Discrete, _MultiDiscrete, _Dict
