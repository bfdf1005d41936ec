"""A stand-in for pettingzoo where it is not installed: the base class of its parallel API."""
from typing import Any, Generic, TypeVar

STAND_IN = True

AgentID = TypeVar("AgentID")
ObsType = TypeVar("ObsType")
ActionType = TypeVar("ActionType")


class ParallelEnv(Generic[AgentID, ObsType, ActionType]):
    metadata: dict[str, Any]
    agents: list
    possible_agents: list

    def reset(self, seed: int | None = None, options: dict | None = None) -> Any:
        raise NotImplementedError

    def step(self, actions: dict) -> Any:
        raise NotImplementedError

    def close(self) -> None:
        pass

    @property
    def num_agents(self) -> int:
        return len(self.agents)

    @property
    def max_num_agents(self) -> int:
        return len(self.possible_agents)

    @property
    def unwrapped(self) -> "ParallelEnv":
        return self
