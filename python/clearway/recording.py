"""Recordings (docs/reference/recording.md) as arrays, one step at a time. Needs h5py (Debian: python3-h5py)."""
from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from . import _program
from .results import Table

NONE = 4294967295


class Step:
    """One step of a recording: the truth as arrays by vehicle, and what was observed, believed and asked for in it.

    ``x_m``, ``y_m``, ``heading_rad``, ``speed_mps``, ``acceleration_mps2``, ``lane``, ``lane_position_m``, ``route_edge`` and
    ``vehicle_class`` have one element for each vehicle on the road, ``id`` its name in SUMO.
    """

    def __init__(self, recording: "Recording", number: int) -> None:
        self._recording = recording
        #: Counts from 0 within the recording.
        self.number = number
        self.time_s = float(recording._steps["time_s"][number])

    def _rows(self, group: str, column: str) -> np.ndarray:
        begin = self._recording._begin(group)
        return self._recording._array(f"{group}/{column}")[begin[self.number]:begin[self.number + 1]]

    def __getattr__(self, column: str) -> np.ndarray:
        if column.startswith("_"):
            raise AttributeError(column)
        try:
            return self._rows("snapshot", "class" if column == "vehicle_class" else column)
        except KeyError:
            raise AttributeError(f"a step has no {column!r}") from None

    @property
    def id(self) -> np.ndarray:
        """Names of the vehicles in SUMO."""
        return self._recording.ids[self._rows("snapshot", "vehicle")]

    @property
    def links(self) -> np.ndarray:
        """Believed links as an edge list, ``int64[2, n]``, of rows of ``recording.ids``; empty where no decision was made."""
        return np.stack([self._rows("links", "from"), self._rows("links", "to")]).astype(np.int64)

    @property
    def link_probability(self) -> np.ndarray:
        """Probability of each of ``links``."""
        return self._rows("links", "probability")

    @property
    def leases(self) -> Table:
        """What the policy asked for in this step."""
        texts, names = self._recording._texts, self._recording.ids
        columns: dict[str, np.ndarray] = {}
        for name in self._recording._file["leases"]:
            values = self._rows("leases", name)
            if name in ("policy", "reason"):
                values = _named(values, texts)
            elif name in ("vehicle", "beneficiary"):
                values = _named(values, names)
            columns[name] = values
        return Table(columns)

    def __repr__(self) -> str:
        return f"<Step {self.number} at {self.time_s} s: {len(self._rows('snapshot', 'vehicle'))} vehicles>"


def _named(rows: np.ndarray, names: np.ndarray) -> np.ndarray:
    padded = np.append(names, "")
    return padded[np.where(rows == NONE, len(names), rows)]


class Recording:
    """A recording that is open; iterate it for its steps. Use it in a ``with`` block, or close it."""

    def __init__(self, file: str | Path) -> None:
        self.file = Path(file)
        try:
            import h5py
        except ImportError as error:
            raise _program.EnvironmentFault("h5py is not installed (Debian: python3-h5py); recordings are HDF5 files") from error
        if not self.file.is_file():
            raise _program.InputError(f"{self.file} is not a file; `record=True` (--record) keeps recordings in a run folder")
        try:
            self._file = h5py.File(self.file, "r")
        except OSError as error:
            raise self._damaged(error) from None
        try:
            self._steps = {"time_s": self._file["steps/time_s"][:]}
            self.ids: np.ndarray = self._file["vehicles/id"].asstr()[:].astype(str)
            self._texts = self._file[_texts_path(self._file)].asstr()[:].astype(str)
            attributes = self._file.attrs
            self.scenario, self.condition = str(attributes["scenario"]), str(attributes["condition"])
            self.replication = int(attributes["replication"])
        except (OSError, KeyError, StopIteration) as error:
            self._file.close()
            raise self._damaged(error) from None
        self._loaded: dict[str, np.ndarray] = {}

    def _damaged(self, error: Exception) -> _program.InputError:
        return _program.InputError(f"{self.file}: is not a recording of Clearway, or is damaged ({error}); record the run again")

    def _array(self, path: str) -> np.ndarray:
        if path not in self._loaded:
            if not self._file:
                raise _program.ClearwayError(f"{self.file} is closed; read what you need before")
            try:
                self._loaded[path] = self._file[path][:]
            except OSError as error:
                raise _program.InputError(f"{self.file}: {path} is damaged ({error}); record the run again") from None
        return self._loaded[path]

    def _begin(self, group: str) -> np.ndarray:
        return self._array(f"steps/{group.replace('/', '_')}_begin")

    @property
    def events(self) -> Table:
        """Departures, arrivals, teleports, collisions, emergency brakings: one row each, with its time."""
        group = self._file["events"]
        begin = self._begin("events")
        columns: dict[str, np.ndarray] = {"time_s": np.repeat(self._steps["time_s"], np.diff(begin.astype(np.int64)))}
        for name in group:
            values = self._array(f"events/{name}")
            columns[name] = _words(group[name], values)
        for name in ("vehicle", "other"):
            columns[name] = _named(columns[name], self.ids)
        return Table(columns)

    def __len__(self) -> int:
        return len(self._steps["time_s"])

    def __getitem__(self, number: int) -> Step:
        if not -len(self) <= number < len(self):
            raise IndexError(f"step {number} of {len(self)}")
        return Step(self, number % len(self))

    def __iter__(self) -> Iterator[Step]:
        for number in range(len(self)):
            yield Step(self, number)

    def close(self) -> None:
        """Closes the file; columns that were not read yet can no longer be."""
        self._file.close()

    def __enter__(self) -> "Recording":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Recording {self.scenario}/{self.condition}/{self.replication}: {len(self)} steps>"


def _texts_path(file: Any) -> str:
    return next(f"texts/{name}" for name in file["texts"])


def _words(data_set: Any, values: np.ndarray) -> np.ndarray:
    import h5py
    words = h5py.check_enum_dtype(data_set.dtype)
    if not words or values.dtype == bool:
        return values
    by_value = np.array([word for word, _ in sorted(words.items(), key=lambda item: item[1])])
    return by_value[values]


def trace(file: str | Path) -> Recording:
    """Opens a recording: ``for step in clearway.trace(file): step.x_m``.

    Its arrays are numpy; columns are read when they are first asked for, and kept. ``len(recording)`` is the number of steps,
    ``recording.events`` what happened.
    """
    return Recording(file)
