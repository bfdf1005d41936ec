"""A stand-in for gymnasium where it is not installed, so that tests can derive from its classes: what environments of Clearway use.

It is as strict as the original where that matters: spaces check their arguments and their members' types, names of a Dict are sorted.
"""
from typing import Any, Generic, TypeVar

import numpy as np

from . import spaces, vector  # noqa: F401
from .spaces import Space  # noqa: F401

STAND_IN = True

ObsType = TypeVar("ObsType")
ActType = TypeVar("ActType")


class Env(Generic[ObsType, ActType]):
    metadata: dict[str, Any] = {"render_modes": []}
    render_mode: str | None = None
    spec: Any = None
    action_space: Space
    observation_space: Space
    _np_random: np.random.Generator | None = None
    _np_random_seed: int | None = None

    def close(self) -> None:
        pass

    @property
    def unwrapped(self) -> "Env":
        return self

    @property
    def np_random(self) -> np.random.Generator:
        if self._np_random is None:
            self._np_random, self._np_random_seed = np.random.default_rng(), -1
        return self._np_random

    @property
    def np_random_seed(self) -> int | None:
        return self._np_random_seed

    def __enter__(self) -> "Env":
        return self

    def __exit__(self, *_: Any) -> bool:
        self.close()
        return False
