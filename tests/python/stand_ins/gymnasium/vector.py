import enum
from typing import Any, Generic, TypeVar

ObsType = TypeVar("ObsType")


class AutoresetMode(enum.Enum):
    NEXT_STEP = "NextStep"
    SAME_STEP = "SameStep"
    DISABLED = "Disabled"


class VectorEnv(Generic[ObsType]):
    metadata: dict[str, Any] = {}
    spec: Any = None
    render_mode: str | None = None
    closed = False
    num_envs: int

    @property
    def unwrapped(self) -> "VectorEnv":
        return self

    def __del__(self) -> None:
        if not getattr(self, "closed", True):
            self.close()  # type: ignore[attr-defined]
