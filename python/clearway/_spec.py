"""What an environment is made of, so that another one like it can be made: Gymnasium's EnvSpec where there is one, or as much of it."""
from __future__ import annotations

import dataclasses
import importlib
from typing import Any

#: Name and version of the environment: another number when the same words would make another one.
ID = "clearway/Emergency-v0"
ENTRY_POINT = "clearway.environment:Env"


@dataclasses.dataclass
class Spec:
    """As gymnasium.envs.registration.EnvSpec, where gymnasium is not installed."""

    id: str
    entry_point: str
    reward_threshold: float | None = None
    nondeterministic: bool = False
    max_episode_steps: int | None = None
    kwargs: dict[str, Any] = dataclasses.field(default_factory=dict)

    def make(self, **kwargs: Any) -> Any:
        """Another environment with the same arguments, but for these."""
        module, _, name = self.entry_point.partition(":")
        return getattr(importlib.import_module(module), name)(**{**self.kwargs, **kwargs})


def spec_of(arguments: dict[str, Any]) -> Any:
    """The spec of an environment that was made with these arguments. An episode ends by itself, so it has no limit of steps."""
    try:
        kind = importlib.import_module("gymnasium.envs.registration").EnvSpec
    except ImportError:
        kind = Spec
    return kind(id=ID, entry_point=ENTRY_POINT, kwargs=arguments)
