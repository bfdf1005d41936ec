"""Clearway from Python: how much time does an emergency vehicle gain, from which measure, at what cost to the others?

Run and read:

    import clearway

    results = clearway.run("intersection", ["corridor"], seeds=10)    # baseline and corridor, ten paired seeds
    print(results.paired_difference("emergency_travel_time_s", "corridor"))
    results.runs["emergency_travel_time_s"]                           # a numpy array; results.runs.to_pandas()

    results = clearway.study("my-study.toml")                         # a whole study file
    results = clearway.open("runs/mine")                              # what is there already
    for step in clearway.trace("runs/mine/recordings/city/corridor/00000.h5"):
        print(step.time_s, step.x_m.mean())
    scores = clearway.links.evaluate("city", ["kalman", "graphsage"], failures=["B10"])  # how well links are predicted
    samples = clearway.dataset("data/many")                           # edge lists and features, as PyTorch Geometric takes them

Write a part:

    class Yield(clearway.Policy):             # clearway run city --policy my_policy.py:Yield
        def act(self, belief):
            ...
    class Mine(clearway.Predictor):           # clearway run city --failure B10 --predictor my_net.py:Mine
        def predict(self, observation):
            ...

Learn one:

    env = clearway.env("intersection")        # Gymnasium's API; clearway.parallel_env: PettingZoo's; clearway.vector_env: many
    env = gymnasium.make("Clearway/intersection-v0")

Only numpy is imported here. pandas, h5py, torch and gymnasium are imported where something needs them.
"""
from __future__ import annotations

import importlib
import os
import sys

if sys.version_info < (3, 11):
    raise ImportError(f"clearway needs Python 3.11 or newer; {sys.executable} is {sys.version.split()[0]} (Debian 12: /usr/bin/python3)")


def _hiding() -> str:
    """The file in the folder that Python searches first that hides a module which numpy needs; or nothing."""
    names = ("numpy", *sorted(sys.stdlib_module_names))
    return next(filter(os.path.isfile, (os.path.join(sys.path[0] or ".", f"{name}.py") for name in names)), "")


try:
    from typing import TYPE_CHECKING, Any
    import numpy as _numpy  # noqa: F401
except Exception as error:
    if file := _hiding():
        raise ImportError(f"{file} hides the module of Python's of that name. Rename it") from error
    if not isinstance(error, ImportError):
        raise
    raise ImportError(f"clearway needs numpy, which {sys.executable} does not have. Install it there (Debian: apt-get install "
                      "python3-numpy), or use /usr/bin/python3") from error

__version__ = "0.1.0"

#: Where each public name lives. Modules are loaded at the first use of one of their names.
_HOMES = {
    "_program": ["ClearwayError", "InputError", "EnvironmentFault"],
    "results": ["Results", "Difference", "open"],
    "tables": ["Table"],
    "running": ["Condition", "run", "study"],
    "recording": ["Recording", "Step", "trace"],
    "datasets": ["Sample", "dataset"],
    "environment": ["Env", "env"],
    "parallel": ["ParallelEnv", "parallel_env"],
    "vector": ["VectorEnv", "vector_env"],
    "parts": ["Policy", "Predictor", "Belief", "Observation", "Vehicles", "Links", "EmergencyVehicle", "Approach", "Lease", "Network"],
}
#: Modules that are asked for by name: scoring of links, what a TorchScript predictor is given, and those whose constants help()
#: names.
_MODULES = ("links", "torchscript", "parts", "recording")
_MODULE_OF = {name: module for module, names in _HOMES.items() for name in names}
__all__ = sorted(_MODULE_OF) + ["__version__"]

if TYPE_CHECKING:
    from ._program import ClearwayError, EnvironmentFault, InputError
    from .datasets import Sample, dataset
    from .environment import Env, env
    from .parallel import ParallelEnv, parallel_env
    from .vector import VectorEnv, vector_env
    from .parts import Approach, Belief, EmergencyVehicle, Lease, Links, Network, Observation, Policy, Predictor, Vehicles
    from .recording import Recording, Step, trace
    from .results import Difference, Results, open
    from .running import Condition, run, study
    from .tables import Table
    from . import links, torchscript


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return importlib.import_module("." + name, __name__)
    if name not in _MODULE_OF:
        from ._program import no_attribute
        raise no_attribute(__name__, name, [*__all__, *_MODULES])
    value = getattr(importlib.import_module("." + _MODULE_OF[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__


if "gymnasium" in sys.modules:
    importlib.import_module("._spec", __name__).register()
