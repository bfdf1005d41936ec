"""Recordings (docs/reference/recording.md) as arrays, one step at a time. Needs h5py (Debian: python3-h5py)."""
from __future__ import annotations

import errno
import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from . import _files, _program
from .tables import Table

NONE = 4294967295
#: As src/trace/detail/seal.cpp.
_FIRST_WORDS, _FORMAT, _SEAL_LENGTH = "CLEARWAY recording, format ", 6, 512
_CURE = "Record the run again, or take the file from a backup"
#: What h5py raises; HDF5's words stand in it.
_H5PY_ERRORS = (OSError, KeyError, RuntimeError, TypeError, ValueError, AttributeError)

T = TypeVar("T")


class Step(_program.Told):
    """One step of a recording: the truth as arrays by vehicle, and what was observed, believed and asked for in it.

    ``number`` counts from 0 within the recording, ``time_s`` is the simulation time. ``x_m``, ``y_m``, ``heading_rad``, ``speed_mps``,
    ``acceleration_mps2``, ``lane``, ``lane_position_m``, ``route_edge`` and ``vehicle_class`` have one element for each vehicle on
    the road, ``id`` its name in SUMO. ``lane`` numbers lanes of the network; ``clearway.recording.NONE`` is none.
    """

    def __init__(self, recording: "Recording", number: int) -> None:
        self._recording = recording
        self.number = number
        self.time_s = float(recording._steps["time_s"][number])

    def _rows(self, group: str, column: str) -> np.ndarray:
        begin = self._recording._begin(group)
        return self._recording._array(f"{group}/{column}")[begin[self.number]:begin[self.number + 1]]

    def __getattr__(self, column: str) -> np.ndarray:
        if column.startswith("_") or hasattr(type(self), column):
            return super().__getattr__(column)
        try:
            return self._rows("snapshot", "class" if column == "vehicle_class" else column)
        except KeyError:
            return super().__getattr__(column)

    def __dir__(self) -> list[str]:
        columns = self._recording._read("snapshot", list)
        return [*("vehicle_class" if name == "class" else name for name in columns if name != "vehicle"), *super().__dir__()]

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
        """What the policy asked for in this step; columns that do not belong to an action are empty."""
        recording = self._recording
        columns = {name: _in_words(self._rows("leases", name), recording._read(f"leases/{name}", _words))
                   for name in recording._read("leases", list)}
        for names, of in ((recording._texts, ("policy", "reason", "links", "own_links")), (recording.ids, ("vehicle", "beneficiary"))):
            columns |= {name: _named(columns[name], names) for name in of}
        action, has_stretch = columns["action"], columns["stretch_lane"] != NONE
        belongs = {"speed_mps": action == "drive_at", "lane_number": action == "change_lane", "side": action == "pull_aside",
                   "signal": columns["signal"] != NONE, **{name: has_stretch for name in columns if name.startswith("stretch_")}}
        return Table({name: _only_where(belongs[name], values) if name in belongs else values for name, values in columns.items()})

    def __repr__(self) -> str:
        return f"<Step {self.number} at {self.time_s} s: {len(self._rows('snapshot', 'vehicle'))} vehicles>"


def _named(rows: np.ndarray, names: np.ndarray) -> np.ndarray:
    padded = np.append(names, "")
    return padded[np.where(rows == NONE, len(names), rows)]


def _only_where(belongs: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The values, and where none belongs there what tables have for a missing one: NaN, or an empty text."""
    if values.dtype.kind == "U":
        return np.where(belongs, values, "")
    if values.dtype.kind in "iu":
        return values.astype(np.int64) if belongs.all() else np.where(belongs, values, np.nan)
    return np.where(belongs, values, np.array(np.nan, values.dtype))


class Recording(_program.Told):
    """A recording that is open; iterate it for its steps. Use it in a ``with`` block, or close it.

    ``file`` is its path, ``scenario``, ``condition`` and ``replication`` say of which run it is, ``ids`` are SUMO's names of the
    vehicles.
    """

    def __init__(self, file: str | Path) -> None:
        self.file = _files.path_of("file", file)
        try:
            import h5py
        except ImportError as error:
            raise _program.EnvironmentFault("h5py is not installed (Debian: python3-h5py); recordings are HDF5 files") from error
        _check_seal(self.file)
        try:
            self._file = h5py.File(self.file, "r")
        except _H5PY_ERRORS as error:
            raise self._told("the file", error) from None
        try:
            self._steps = {"time_s": self._file["steps/time_s"][:]}
            self.ids: np.ndarray = self._file["vehicles/id"].asstr()[:].astype(str)
            self._texts = self._file[_texts_path(self._file)].asstr()[:].astype(str)
            attributes = self._file.attrs
            self.scenario, self.condition = (attributes[name].decode() for name in ("scenario", "condition"))
            self.replication = int(attributes["replication"])
        except (*_H5PY_ERRORS, StopIteration) as error:
            self._file.close()
            raise self._told("the file", error) from None
        self._loaded: dict[str, np.ndarray] = {}

    def _told(self, what: str, error: Exception) -> _program.ClearwayError:
        """What h5py raised. HDF5 writes the ``errno`` of the system among its words; where it lacks memory, it has none."""
        words = " ".join(str(error).split())
        reason = re.search(r"errno = (\d+)", words)
        if reason or re.search("alloc|inflateInit", words):
            return _files.refusal(self.file, int(reason[1]) if reason else errno.ENOMEM)
        return _program.InputError(f"{self.file}: {what} is damaged ({words}). {_CURE}")

    def _read(self, path: str, read: Callable[[Any], T]) -> T:
        """What ``read`` makes of the group or data set. Raises KeyError where there is none."""
        if not self._file:
            raise _program.ClearwayError(f"{self.file} is closed; read what you need before")
        try:
            return read(self._file[path])
        except _H5PY_ERRORS as error:
            if isinstance(error, KeyError) and "doesn't exist" in str(error):
                raise
            raise self._told(path, error) from None

    def _array(self, path: str) -> np.ndarray:
        if path not in self._loaded:
            self._loaded[path] = self._read(path, lambda data_set: data_set[:])
        return self._loaded[path]

    def _begin(self, group: str) -> np.ndarray:
        return self._array(f"steps/{group.replace('/', '_')}_begin")

    @property
    def events(self) -> Table:
        """Departures, arrivals, teleports, collisions, emergency brakings: one row each, with its time.

        ``other``, ``lane`` and ``place`` are those of a collision, ``deceleration_mps2`` that of a braking; else they are empty.
        """
        begin = self._begin("events")
        columns: dict[str, np.ndarray] = {"time_s": np.repeat(self._steps["time_s"], np.diff(begin.astype(np.int64)))}
        for name in self._read("events", list):
            path = f"events/{name}"
            columns[name] = _in_words(self._array(path), self._read(path, _words))
        for name in ("vehicle", "other"):
            columns[name] = _named(columns[name], self.ids)
        belongs = {"lane": columns["lane"] != NONE, "place": columns["kind"] == "collision",
                   "deceleration_mps2": columns["kind"] == "emergency_braking"}
        return Table({name: _only_where(belongs[name], values) if name in belongs else values for name, values in columns.items()})

    def __fspath__(self) -> str:
        """Wherever a path is taken, it stands for its file."""
        return str(self.file)

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


def _check_seal(file: Path) -> None:
    """Raises InputError for what is no recording of this format, and for one that is not as it was written: HDF5 would not always see."""
    with _files.reading(file, f"{_files.CURE}: record=True (--record) keeps recordings in a run folder") as stream:
        head = stream.read(_SEAL_LENGTH).decode("latin-1")
        found = _files.content_hash(iter(lambda: stream.read(1 << 20), b""))
        length = stream.tell() - _SEAL_LENGTH
    if not head.startswith(_FIRST_WORDS):
        raise _program.InputError(f"{file}: is not a recording (allowed: a file written with --record, in recordings/ of a run folder). "
                                  "Give the file as Clearway wrote it: tools that rewrite HDF5 drop its seal")
    format_number = head[len(_FIRST_WORDS):].partition("\n")[0]
    if format_number != str(_FORMAT):
        raise _program.InputError(f"{file}: is a recording of format {format_number[:20]!r} (allowed: {_FORMAT}). Read it with the version "
                                  "of Clearway that wrote it, or record the run again")
    seal = f"{_FIRST_WORDS}{_FORMAT}\nHDF5 follows this block.\nlength {length:020}\nhash {found}\n"
    if head != seal.ljust(_SEAL_LENGTH, "\0"):
        raise _program.InputError(f"{file}: is cut short or damaged: it does not fit its hash. {_CURE}")


def _words(data_set: Any) -> dict[str, int] | None:
    """The words that its numbers stand for."""
    import h5py
    return h5py.check_enum_dtype(data_set.dtype)


def _in_words(values: np.ndarray, words: dict[str, int] | None) -> np.ndarray:
    if not words or values.dtype == bool:
        return values
    by_value = np.array([word for word, _ in sorted(words.items(), key=lambda item: item[1])])
    return by_value[values]


def file_of(folder: Path, scenario: str, condition: str, replication: int) -> Path:
    """Where the recording of a run stands in its run folder."""
    return folder / "recordings" / scenario / condition / f"{replication:05d}.h5"


def trace(file: str | os.PathLike[str]) -> Recording:
    """Opens a recording: ``for step in clearway.trace(file): step.x_m``. Of one that is open, this opens its file again. A run is taken as other programs name it, too:
    ``"runs/mine/intersection/corridor/0"``.

    Its arrays are numpy; columns are read when they are first asked for, and kept. ``len(recording)`` is the number of steps,
    ``recording.events`` what happened. Raises InputError for what is no recording, or not as Clearway wrote it: the whole file is
    read once for its hash.
    """
    run = _files.path_of("file", file)
    if run.is_dir():
        raise _program.InputError(f"{run} is a folder (allowed: the file of a recording, or a run: FOLDER/SCENARIO/CONDITION/REPLICATION). "
                                  "clearway.open(FOLDER).recording(SCENARIO, CONDITION) opens one of a run folder")
    if run.suffix != ".h5" and run.name.isdigit() and len(run.parts) > 3:
        file = file_of(run.parents[2], *run.parts[-3:-1], int(run.name))
    return Recording(file)
