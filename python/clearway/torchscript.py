"""A TorchScript module as a predictor: ``--predictor net.pt``. Needs torch (Debian: python3-torch).

The module is called as ``module(x, edge_index, pairs, pair_features)`` and returns a probability for each pair:

* ``x``: ``float32[vehicles, 8]``: dead-reckoned x and y relative to their mean, divided by 100 m; cosine and sine of the heading;
  speed divided by 20 m/s; age of the report divided by 10 s; 1 for automated; 1 for emergency vehicles;
* ``edge_index``: ``int64[2, links]``, observed links both ways;
* ``pairs``: ``int64[2, n]``; ``pair_features``: ``float32[n, 2]``: last seen and dead-reckoned distance divided by the link radius.
"""
from __future__ import annotations

import numpy as np

from .parts import AUTOMATED, EMERGENCY, Observation, Predictor


def node_features(observation: Observation) -> np.ndarray:
    """``x`` of the module, ``float32[vehicles, 8]``."""
    x_m, y_m = observation.x_m, observation.y_m
    if len(x_m) == 0:
        return np.zeros((0, 8), dtype=np.float32)
    columns = [(x_m - x_m.mean()) / 100.0, (y_m - y_m.mean()) / 100.0, np.cos(observation.heading_rad),
               np.sin(observation.heading_rad), observation.speed_mps / 20.0, observation.age_s / 10.0,
               observation.vehicle_class == AUTOMATED, observation.vehicle_class == EMERGENCY]
    return np.stack(columns, axis=1).astype(np.float32)


def pair_features(observation: Observation) -> np.ndarray:
    """``pair_features`` of the module, ``float32[n, 2]``."""
    distances = np.stack([observation.pair_last_seen_m, observation.pair_dead_reckoned_m], axis=1)
    return (distances / observation.link_radius_m).astype(np.float32)


class Unusable(ValueError):
    """Why a file cannot be a predictor. The message says all, so no traceback is shown."""


class TorchScript(Predictor):
    """Loads the module of a file, once a run, on one thread."""

    def __init__(self, file: str) -> None:
        weights = f"weights of the dissertation's net go with `--predictor graphsage_corrected --model {file}`"
        try:
            import torch
        except ImportError:
            raise Unusable(f"torch is not installed (Debian: python3-torch), and a TorchScript file needs it; {weights}, which "
                           "does not") from None
        torch.set_num_threads(1)
        try:
            self._module = torch.jit.load(file, map_location="cpu").eval()
        except RuntimeError as error:
            raise Unusable(f"{file} is not a TorchScript file (torch.jit.save writes one; {weights}): "
                           f"{str(error).splitlines()[0]}") from None
        self._torch = torch

    def predict(self, observation: Observation) -> np.ndarray:
        torch = self._torch
        inputs = (node_features(observation), observation.edge_index, observation.pairs, pair_features(observation))
        with torch.no_grad():
            return self._module(*(torch.from_numpy(array) for array in inputs)).numpy().reshape(-1)
