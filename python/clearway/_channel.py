"""The Python end of the protocol of src/python: memory that two processes share, and a pipe in each direction as a bell.

Decision 7 (docs/decisions) says why it is this and not pybind11.
"""
from __future__ import annotations

import mmap
import os
import struct
from typing import Any

import numpy as np

from ._program import ClearwayError

#: Bytes in each direction; as python::Channel::capacity.
CAPACITY = 1 << 26

HELLO, DECIDE, ANSWER, FAILED, LOST, RESET, ENDED = b"H", b"D", b"A", b"F", b"L", b"R", b"E"


class Channel:
    """Joins the memory and the pipes whose descriptors it is given, and owns them."""

    def __init__(self, memory: int, read: int, write: int) -> None:
        self._descriptors = [memory, read, write]
        self._read, self._write = read, write
        #: What the other process writes; arrays on it cannot be written.
        self.incoming = mmap.mmap(memory, CAPACITY, prot=mmap.PROT_READ)
        self.outgoing = mmap.mmap(memory, CAPACITY, prot=mmap.PROT_READ | mmap.PROT_WRITE, offset=CAPACITY)

    def wait(self) -> bytes:
        """The next bell; b"" when the other process has gone."""
        return os.read(self._read, 1)

    def ring(self, bell: bytes) -> bool:
        """Hands the memory over; False when nobody is there to hear it."""
        try:
            return os.write(self._write, bell) == 1
        except BrokenPipeError:
            return False

    def read_text(self) -> str:
        (length,) = struct.unpack_from("<Q", self.incoming)
        return self.incoming[8:8 + length].decode("utf-8", "replace")

    def write_text(self, text: str) -> None:
        content = text.encode("utf-8", "replace")
        if len(content) > CAPACITY - 8:
            raise ValueError(f"an answer of {len(content)} bytes (allowed: {CAPACITY - 8})")
        struct.pack_into("<Q", self.outgoing, 0, len(content))
        self.outgoing[8:8 + len(content)] = content

    def close(self) -> None:
        """Closes the pipes, which the other process hears. The memory goes when the last array on it does."""
        for descriptor in self._descriptors:
            os.close(descriptor)
        self._descriptors = []


class Sheet:
    """Arrays in shared memory by name: views, not copies, valid until the bell is rung again."""

    def __init__(self, memory: mmap.mmap, columns: list[list[str]]) -> None:
        self._memory = memory
        # Not an array: a number is read ten times as fast like this.
        self._directory = memoryview(memory)[:16 * len(columns)].cast("Q")
        #: numpy type, unit and meaning of each array.
        self.columns = {name: (np.dtype(kind), unit, doc) for name, kind, unit, doc in columns}
        self._place = {name: 2 * number for number, name in enumerate(self.columns)}
        self._views: dict[str, np.ndarray] = {}

    def renew(self) -> None:
        """To be called when the bell has rung: arrays may have other places and sizes."""
        self._views.clear()

    def place(self, name: str) -> tuple[int, int]:
        """Offset and number of elements of an array."""
        at = self._place[name]
        return self._directory[at], self._directory[at + 1]

    def __getitem__(self, name: str) -> np.ndarray:
        view = self._views.get(name)
        if view is None:
            offset, count = self.place(name)
            view = self._views[name] = np.frombuffer(self._memory, self.columns[name][0], count, offset)
        return view

    def write(self, name: str, values: np.ndarray) -> None:
        """Writes the one array of a sheet of answers behind its directory."""
        kind = self.columns[name][0]
        offset = (16 * len(self.columns) + 63) // 64 * 64
        target: Any = np.frombuffer(self._memory, kind, len(values), offset)
        target[:] = values
        at = self._place[name]
        self._directory[at], self._directory[at + 1] = offset, len(values)


class Moment:
    """The arrays of a sheet until the answer to them was given. Who asks later, when the memory holds others, is told."""

    __slots__ = ("_arrays",)

    def __init__(self, sheet: Sheet) -> None:
        self._arrays: Any = sheet

    def __getitem__(self, name: str) -> np.ndarray:
        return self._arrays[name]

    def end(self) -> None:
        self._arrays = _Past()


class _Past:
    def __getitem__(self, name: str) -> np.ndarray:
        raise ClearwayError(f"{name} of an earlier decision was asked for, whose memory holds the present one. Keep copies of what is needed "
                            "later: belief.vehicles.x_m.copy()")
