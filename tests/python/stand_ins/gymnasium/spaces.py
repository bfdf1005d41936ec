from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np


class Space:
    def __init__(self, shape: Any = None, dtype: Any = None) -> None:
        self._shape = None if shape is None else tuple(shape)
        self.dtype = None if dtype is None else np.dtype(dtype)
        self._np_random: np.random.Generator | None = None

    @property
    def shape(self) -> Any:
        return self._shape

    @property
    def np_random(self) -> np.random.Generator:
        if self._np_random is None:
            self.seed()
        assert self._np_random is not None
        return self._np_random

    def seed(self, seed: Any = None) -> Any:
        assert seed is None or (isinstance(seed, int) and seed >= 0)
        self._np_random = np.random.Generator(np.random.PCG64(seed))
        return seed

    def __contains__(self, x: Any) -> bool:
        return self.contains(x)  # type: ignore[attr-defined]


def is_number(value: Any) -> bool:
    return np.issubdtype(type(value), np.integer) or np.issubdtype(type(value), np.floating)


class Box(Space):
    def __init__(self, low: Any, high: Any, shape: Any = None, dtype: Any = np.float32) -> None:
        assert all(np.issubdtype(type(size), np.integer) for size in shape), shape
        assert is_number(low) and is_number(high) and low <= high
        kind = np.dtype(dtype)
        if kind.kind in "iu":
            limits = np.iinfo(kind)
            assert limits.min <= low and high <= limits.max, (low, high, kind)
        super().__init__(shape, kind)
        self.low, self.high = np.full(self.shape, low, dtype=kind), np.full(self.shape, high, dtype=kind)

    def sample(self, mask: Any = None) -> np.ndarray:
        assert mask is None
        if self.dtype.kind == "f":
            return self.np_random.uniform(self.low, self.high).astype(self.dtype)
        return self.np_random.integers(self.low, self.high, endpoint=True, dtype=self.dtype)

    def contains(self, x: Any) -> bool:
        assert isinstance(x, np.ndarray), "gymnasium would warn and convert it"
        return bool(np.can_cast(x.dtype, self.dtype) and x.shape == self.shape and (x >= self.low).all() and (x <= self.high).all())


class Discrete(Space):
    def __init__(self, n: Any, start: int = 0) -> None:
        assert np.issubdtype(type(n), np.integer) and n > 0
        super().__init__((), np.int64)
        self.n, self.start = np.int64(n), np.int64(start)

    def sample(self, mask: Any = None) -> np.int64:
        if mask is None:
            return self.start + self.np_random.integers(self.n)
        check_mask(mask, self.n)
        legal = np.flatnonzero(mask)
        return self.start + (self.np_random.choice(legal) if len(legal) else np.int64(0))

    def contains(self, x: Any) -> bool:
        whole = isinstance(x, int) or (isinstance(x, (np.generic, np.ndarray)) and np.issubdtype(x.dtype, np.integer) and x.shape == ())
        return bool(whole and self.start <= x < self.start + self.n)


class MultiDiscrete(Space):
    def __init__(self, nvec: Any) -> None:
        self.nvec = np.array(nvec, dtype=np.int64)
        assert (self.nvec > 0).all()
        super().__init__(self.nvec.shape, np.int64)

    def sample(self, mask: Any = None) -> np.ndarray:
        if mask is None:
            return (self.np_random.random(self.nvec.shape) * self.nvec).astype(self.dtype)
        assert isinstance(mask, tuple) and len(mask) == len(self.nvec), "a tuple of masks is wanted"
        for one, n in zip(mask, self.nvec):
            check_mask(one, n)
        return np.array([self.np_random.choice(np.flatnonzero(one)) if one.any() else 0 for one in mask], dtype=self.dtype)

    def contains(self, x: Any) -> bool:
        return bool(isinstance(x, np.ndarray) and x.shape == self.shape and np.can_cast(x.dtype, self.dtype) and (x >= 0).all()
                    and (x < self.nvec).all())


def check_mask(mask: Any, n: int) -> None:
    assert isinstance(mask, np.ndarray) and mask.dtype == np.int8 and mask.shape == (n,), "int8, one for each choice"
    assert np.isin(mask, (0, 1)).all()


class Dict(Space, Mapping):
    def __init__(self, spaces: dict[str, Space]) -> None:
        assert all(isinstance(space, Space) for space in spaces.values())
        self.spaces = dict(sorted(spaces.items()))
        super().__init__(None, None)

    def seed(self, seed: Any = None) -> Any:
        super().seed(seed)
        return {name: space.seed(None if seed is None else int(self.np_random.integers(2**31))) for name, space in self.spaces.items()}

    def sample(self, mask: Any = None) -> dict[str, Any]:
        return {name: space.sample() for name, space in self.spaces.items()}  # type: ignore[attr-defined]

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
