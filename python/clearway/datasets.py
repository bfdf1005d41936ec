"""Data sets of ``clearway links dataset`` as edge lists and feature arrays."""
from __future__ import annotations

import dataclasses
import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from . import _files, _program

_GRAPH_LINE = b"clearway graph samples 1\n"
_REPAIR_LINE = b"clearway repair samples "
_CURE = "Record it again with `clearway links dataset SCENARIO --samples --out DIR`"


@dataclasses.dataclass
class Sample(_program.Told):
    """One graph: what a predictor is given, and the answers. Names and shapes are those of PyTorch Geometric::

        data = torch_geometric.data.Data(**{name: torch.from_numpy(array) for name, array in sample.arrays().items()})

    * ``x``: node features, ``float32[vehicles, features]``. Of ``--samples``: 3 cos kx, 3 sin kx, 3 cos ky, 3 sin ky with
      k = 2 pi / 400 m, and exp(-age / 10 s), of the dead-reckoned place. Published: x and y, m; with 5 features also speed, m/s,
      lane, and class (0 human, 1 automated, 2 emergency). `clearway.torchscript` gives a module marked ``dataset`` the same;
    * ``edge_index``: edges along which messages may go, both ways, ``int64[2, edges]``: the observed links;
    * ``edge_label_index``: pairs to decide, each once, ``int64[2, pairs]``;
    * ``edge_label``: whether the pair is linked, ``float32[pairs]``: 0 or 1;
    * ``edge_label_attr``: features of the pairs, ``float32[pairs, features]``: the dead-reckoned distance, m; empty for published
      data sets;
    * ``origin``: where it comes from: scenario, failure, replication, time_s, ...
    """

    x: np.ndarray
    edge_index: np.ndarray
    edge_label_index: np.ndarray
    edge_label: np.ndarray
    edge_label_attr: np.ndarray
    origin: dict[str, Any] = dataclasses.field(default_factory=dict)

    def arrays(self) -> dict[str, np.ndarray]:
        """Everything but the origin."""
        return {name: getattr(self, name) for name in ("x", "edge_index", "edge_label_index", "edge_label", "edge_label_attr")}


def dataset(folder: str | Path) -> list[Sample]:
    """Reads a data set: of ``--samples`` (many graphs, with the failures that hid vehicles), or as published (one graph).

    A published data set has no observed links, so its messages go along the listed pairs, as the dissertation's training does.
    Raises InputError for a folder without either and for files that are cut short, changed or of another version.
    """
    folder = _files.path_of("folder", folder)
    found = _files.below(folder, (".samples", ".csv"))
    files = [file for file in found if file.name.endswith(".samples")]
    if files:
        return [sample for file in files for sample in _graph_samples(file)]
    if folder / "edge_list.csv" in found:
        return [_published(folder)]
    raise _program.InputError(f"{folder} holds neither *.samples nor edge_list.csv. {_CURE}, or without --samples")


def _numbers(file: Path, dtype: type) -> np.ndarray:
    content = _files.content(file)
    try:
        return np.loadtxt(io.StringIO(content.decode()), delimiter=",", dtype=dtype, ndmin=2)
    except ValueError as error:
        raise _program.InputError(f"{file}: {error}. Record it again with `clearway links dataset SCENARIO --out DIR`") from None


def _published(folder: Path) -> Sample:
    pairs = _numbers(folder / "edge_list.csv", np.int64)
    features = _numbers(folder / "vehicle_features.csv", np.float32)
    labels = _numbers(folder / "target_y.csv", np.float32).reshape(-1)
    if pairs.shape != (2, len(labels)) or pairs.min(initial=0) < 0 or pairs.max(initial=-1) >= len(features):
        raise _program.InputError(f"{folder}: {pairs.shape} pairs, {len(labels)} labels and {len(features)} vehicles do not fit "
                                  "together. Record it again with `clearway links dataset SCENARIO --out DIR`")
    return Sample(features, np.concatenate([pairs, pairs[::-1]], axis=1), pairs, labels, np.zeros((len(labels), 0), np.float32),
                  {"folder": str(folder)})


def _graph_samples(file: Path) -> list[Sample]:
    content = _files.content(file)
    if content.startswith(_REPAIR_LINE):
        raise _program.InputError(f"{file}: holds the inputs of the net graphsage, whose tables are its own "
                                  "(docs/reference/formats.md). Record without `--net graphsage` for edge lists")
    if not content.startswith(_GRAPH_LINE):
        raise _program.InputError(f"{file}: is not a file of graph samples of version 1. {_CURE}")
    start = content.rfind(b"\nend ", 0, len(content))
    last = content[start + 1:].split()
    if start < 0 or not content.endswith(b"\n") or len(last) != 3 or len(content) - start > 60:
        raise _program.InputError(f"{file}: its last line is missing: it is cut short. {_CURE}")
    found = _files.content_hash([content[:start]])
    if found.encode() != last[2]:
        raise _program.InputError(f"{file}: its content hash is {found}, but its last line says {last[2].decode('ascii', 'replace')}. It "
                                  f"was changed or damaged. {_CURE}")
    header_end = content.index(b"\n", len(_GRAPH_LINE))
    try:
        origin = json.loads(content[len(_GRAPH_LINE):header_end])
        fits = isinstance(origin, dict) and type(origin["feature_count"]) is int and origin["feature_count"] >= 0 and int(last[1]) >= 0
    except (ValueError, KeyError):
        fits = False
    if not fits:
        raise _program.InputError(f"{file}: its second or last line is damaged. {_CURE}")
    reader = _Reader(content, header_end + 1, start, file)
    samples = []
    while reader.at < start:
        samples.append(reader.sample(origin))
    if len(samples) != int(last[1]):
        raise _program.InputError(f"{file}: {len(samples)} samples, but its last line says {last[1].decode()}. {_CURE}")
    return samples


class _Reader:
    """Takes little-endian numbers from the front of a file's samples."""

    _CANDIDATE = np.dtype([("left", "<u4"), ("right", "<u4"), ("dead_reckoned_m", "<f4"), ("linked", "u1")])

    def __init__(self, content: bytes, at: int, end: int, file: Path) -> None:
        self.content, self.at, self.end, self.file = content, at, end, file

    def take(self, dtype: Any, count: int) -> np.ndarray:
        size = np.dtype(dtype).itemsize * count
        if self.at + size > self.end:
            raise _program.InputError(f"{self.file}: a sample ends before its data. {_CURE}")
        array = np.frombuffer(self.content, dtype, count, self.at)
        self.at += size
        return array

    def sample(self, origin: dict[str, Any]) -> Sample:
        time_s, vehicles, edges, candidates = struct.unpack("<dIII", self.take(np.uint8, 20).tobytes())
        width = origin["feature_count"]
        features = self.take("<f4", vehicles * width).reshape(vehicles, width).copy()
        observed = self.take("<u4", 2 * edges).reshape(edges, 2).T.astype(np.int64)
        pairs = self.take(self._CANDIDATE, candidates)
        index = np.stack([pairs["left"], pairs["right"]]).astype(np.int64)
        if max(observed.max(initial=-1), index.max(initial=-1)) >= vehicles:
            raise _program.InputError(f"{self.file}: a pair of vehicles that do not exist. {_CURE}")
        return Sample(features, np.concatenate([observed, observed[::-1]], axis=1), index, pairs["linked"].astype(np.float32),
                      pairs["dead_reckoned_m"].astype(np.float32).reshape(-1, 1), {**origin, "time_s": time_s})
