"""PettingZoo's parallel API: an agent for each signal, and for each automated vehicle ahead of the emergency vehicle."""
from __future__ import annotations

import operator
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from . import _program, _spaces
from .environment import Env

if _spaces.installed("pettingzoo"):
    import pettingzoo

    _Base: Any = pettingzoo.ParallelEnv
else:
    _Base = object


class ParallelEnv(_Base):
    """The environment of ``clearway.env`` with an agent for each part of its action.

    Agents are ``signal:ID`` and ``automated:0`` ... ``automated:7``, the places ahead of the emergency vehicle, nearest first: a place
    without a vehicle has one legal action, 0. With ``ways`` there is one more agent, ``way``, that chooses the emergency vehicle's way.
    All live until the episode ends. Every agent sees what the single agent sees (``observation``) with its own ``action_mask``, and
    gets the same reward.

    ``possible_agents`` are all, ``agents`` those of the running episode; ``action_spaces`` and ``observation_spaces`` are theirs;
    ``render_mode`` is as given.
    """

    metadata = {"render_modes": ["ansi"], "name": "clearway_v0", "is_parallelizable": True, "render_fps": 2}

    def __init__(self, scenario: str | Path, **arguments: Any) -> None:
        self._env = Env(scenario, **arguments)
        self.render_mode = self._env.render_mode
        choices = self._env._choices
        way = ["way"] if self._env.ways else []
        automated = len(choices) - len(self._env.signal_ids) - len(way)
        self.possible_agents: list[str] = [f"signal:{name}" for name in self._env.signal_ids] + [
            f"automated:{place}" for place in range(automated)] + way
        self.agents: list[str] = []
        ends = np.cumsum(choices)
        self._choices = dict(zip(self.possible_agents, choices))
        self._parts = {agent: slice(int(end - count), int(end)) for agent, end, count in zip(self.possible_agents, ends, choices)}
        shared = {name: space for name, space in self._env.observation_space.spaces.items() if name != "action_mask"}
        self.action_spaces = {agent: _spaces.Discrete(count) for agent, count in zip(self.possible_agents, choices)}
        self.observation_spaces = {
            agent: _spaces.Dict({"observation": _spaces.Dict(shared),
                                 "action_mask": _spaces.Box(0, 1, shape=(count,), dtype=np.int8)})
            for agent, count in zip(self.possible_agents, choices)}

    def observation_space(self, agent: str) -> Any:
        """What an agent sees."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> Any:
        """What an agent may do."""
        return self.action_spaces[agent]

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begins an episode; see ``Env.reset``."""
        observation, info = self._env.reset(seed=seed, options=options)
        self.agents = list(self.possible_agents)
        return self._each(observation), {agent: dict(info) for agent in self.agents}

    def step(self, actions: dict[str, Any]) -> tuple[dict[str, Any], ...]:
        """Carries out an action for each agent; one that is left out does nothing."""
        if not self.agents:
            raise _program.ClearwayError("the episode is over or has not begun: call reset()")
        if not isinstance(actions, Mapping):
            raise _program.InputError(f"actions are {actions!r} (allowed: a dictionary with an action for each agent)")
        unknown = [agent for agent in actions if agent not in self._parts]
        if unknown:
            there = _program.there_are(unknown[0], self.possible_agents, "agent", "possible_agents")
            raise _program.InputError(f"the environment has no agent {unknown[0]!r}{there}")
        all_actions = np.array([self._action_of(agent, actions.get(agent, 0)) for agent in self.possible_agents], dtype=np.int64)
        observation, reward, terminated, truncated, info = self._env.step(all_actions)
        live = self.agents
        if terminated or truncated:
            self.agents = []
        return (self._each(observation), dict.fromkeys(live, reward), dict.fromkeys(live, terminated), dict.fromkeys(live, truncated),
                {agent: dict(info) for agent in live})

    def _action_of(self, agent: str, action: Any) -> int:
        count = self._choices[agent]
        try:
            value = operator.index(action)
        except TypeError:
            value = -1
        if not 0 <= value < count:
            raise _program.InputError(f"the action of {agent} is {action!r} (allowed: a whole number from 0 to {count - 1})")
        return value

    def _each(self, observation: dict[str, np.ndarray]) -> dict[str, Any]:
        shared = {name: array for name, array in observation.items() if name != "action_mask"}
        mask = observation["action_mask"].astype(np.int8)
        return {agent: {"observation": shared, "action_mask": mask[part]} for agent, part in self._parts.items()}

    def state(self) -> np.ndarray:
        """Everything that is observed, flat."""
        self._env._require_episode()
        return np.concatenate([array.reshape(-1).astype(np.float32) for array in self._env._last.values()])

    def render(self) -> str | None:
        """One line about the EV, with ``render_mode="ansi"``."""
        return self._env.render()

    def close(self) -> None:
        """Ends the processes. May be called again."""
        self.agents = []
        self._env.close()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self._env.spec.kwargs['scenario']}: {self.max_num_agents} agents>"

    def __enter__(self) -> "ParallelEnv":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    @property
    def unwrapped(self) -> "ParallelEnv":
        return self

    @property
    def num_agents(self) -> int:
        return len(self.agents)

    @property
    def max_num_agents(self) -> int:
        return len(self.possible_agents)


def parallel_env(scenario: str | Path, **arguments: Any) -> ParallelEnv:
    """An environment with PettingZoo's parallel API; arguments are those of ``clearway.env``."""
    return ParallelEnv(scenario, **arguments)
