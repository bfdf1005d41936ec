"""What an environment is made of, so that another one like it can be made: Gymnasium's EnvSpec where there is one, or as much of it."""
from __future__ import annotations

import dataclasses
import importlib
import sys
from typing import Any

from . import _program

#: Name and version of the environment: another number when the same words would make another one.
ID = "clearway/Emergency-v0"
ENTRY_POINT = "clearway.environment:Env"


def register() -> None:
    """Gives Gymnasium a name for each scenario that comes with Clearway: ``gymnasium.make("Clearway/intersection-v0")``.

    Does nothing before Gymnasium is imported. Then it is called by ``import clearway``, or, where the package is installed, by
    Gymnasium, which calls the entry points ``gymnasium.envs`` (python/install.py).
    """
    registration = sys.modules.get("gymnasium.envs.registration")
    if registration is None:
        return
    try:
        scenarios = _program.shipped("scenarios")
    except _program.EnvironmentFault:  # programs that are not built are told where one is needed
        return
    for file in sorted(scenarios.glob("*/scenario.toml")) if scenarios else []:
        name = f"Clearway/{file.parent.name}-v0"
        if name not in registration.registry:
            registration.register(id=name, entry_point=ENTRY_POINT, kwargs={"scenario": file.parent.name})


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
