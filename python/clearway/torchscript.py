"""A TorchScript module as a predictor: ``--predictor net.pt``. Needs torch (Debian: python3-torch).

The module is called as ``module(x, edge_index, pairs, pair_features)`` and returns a probability for each pair:

* ``x``: ``float32[vehicles, 8]``: dead-reckoned x and y relative to their mean, divided by 100 m; cosine and sine of the heading;
  speed divided by 20 m/s; age of the report divided by 10 s; 1 for automated; 1 for emergency vehicles;
* ``edge_index``: ``int64[2, links]``, observed links both ways;
* ``pairs``: ``int64[2, n]``; ``pair_features``: ``float32[n, 2]``: last seen and dead-reckoned distance divided by the link radius.

A module that was trained on `clearway.dataset` is saved with a mark, and then gets ``x``, ``edge_index``, ``edge_label_index`` and
``edge_label_attr`` as a `clearway.datasets.Sample` of ``--samples`` has them::

    torch.jit.save(torch.jit.script(module), "net.pt", _extra_files={"inputs": "dataset"})
"""
from __future__ import annotations

import io
from pathlib import Path

import numpy as np

from . import _files
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


def dataset_node_features(observation: Observation) -> np.ndarray:
    """``x`` of a `clearway.datasets.Sample`, ``float32[vehicles, 5]``."""
    waves = [3.0 * wave(2.0 * np.pi / 400.0 * place) for place in (observation.x_m, observation.y_m) for wave in (np.cos, np.sin)]
    return np.stack([*waves, np.exp(-observation.age_s / 10.0)], axis=1).astype(np.float32)


def dataset_pair_features(observation: Observation) -> np.ndarray:
    """``edge_label_attr`` of a `clearway.datasets.Sample`, ``float32[n, 1]``."""
    return observation.pair_dead_reckoned_m.astype(np.float32).reshape(-1, 1)


class Unusable(ValueError):
    """Why a file cannot be a predictor. The message says all, so no traceback is shown."""


_INPUTS = {"observation": (node_features, pair_features), "dataset": (dataset_node_features, dataset_pair_features)}


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
        content = io.BytesIO(_files.content(Path(file)))  # torch would call any file damaged that the machine cannot read
        try:
            marks = {"inputs": b""}
            self._module = torch.jit.load(content, map_location="cpu", _extra_files=marks).eval()
        except RuntimeError as error:
            if _files.is_of_machine(error):
                raise
            raise Unusable(f"{file} is not a TorchScript file (torch.jit.save writes one; {weights}): "
                           f"{str(error).splitlines()[0]}") from None
        inputs = marks["inputs"].decode() or "observation"
        if inputs not in _INPUTS:
            raise Unusable(f"{file}: inputs \"{inputs}\" are not known (allowed: {', '.join(_INPUTS)}). Save it with one of them in "
                           "_extra_files, or without")
        self._of_nodes, self._of_pairs = _INPUTS[inputs]
        self._torch = torch

    def predict(self, observation: Observation) -> np.ndarray:
        torch = self._torch
        inputs = (self._of_nodes(observation), observation.edge_index, observation.pairs, self._of_pairs(observation))
        with torch.no_grad():
            return self._module(*(torch.from_numpy(array) for array in inputs)).numpy().reshape(-1)
