"""Shows a part in Python drawn scenes, in a process of its own as a run has one: what conformance.py judges."""
from __future__ import annotations

import dataclasses
import json
import os
import socket
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import IO, Any

import numpy as np

from . import _program
from ._channel import ANSWER, CAPACITY, DECIDE, HELLO
from .parts import Network

#: In which a part answers here, s: scenes are small.
ANSWER_LIMIT_S = 10.0
ANSWERS = [["probability", "f4", "", ""]]


@dataclasses.dataclass
class Scene:
    """What a part is shown, decision by decision: arrays by name."""

    name: str
    greeting: dict[str, Any]
    shown: list[dict[str, np.ndarray]]

    @property
    def network(self) -> Network:
        return Network(self.greeting["network"])


@dataclasses.dataclass
class Told:
    """What a part answered in a scene: leases or probabilities for each decision, and how long it took; what ended it, and whether
    by the time that an answer may take."""

    answers: list[Any] = dataclasses.field(default_factory=list)
    took_s: list[float] = dataclasses.field(default_factory=list)
    failure: str = ""
    is_late: bool = False


def scenes_of(kind: str) -> list[Scene]:
    scenes: list[Scene] = []
    greeting: dict[str, Any] = {}
    now: dict[str, np.ndarray] = {}
    for line in (Path(__file__).parent / f"{kind}_scenes.jsonl").read_text(encoding="utf-8").splitlines():
        row = json.loads(line)
        if "network" in row:
            greeting = {"period_s": 0.0, "link_radius_m": 0.0, **row}
        elif "scene" in row:
            scenes.append(Scene(row["scene"], greeting, []))
            now = {}
        else:
            kinds = {name: kind for name, kind, _, _ in greeting["question"]}
            now = {**now, **{name: np.array(values, dtype=kinds[name]) for name, values in row.items()}}
            scenes[-1].shown.append(now)
    return scenes


class Nursery:
    """A Python of which the processes of parts are copies, as a study has one: the other end of _nursery.py. ``printed`` is where they
    may print."""

    def __init__(self, printed: IO[Any]) -> None:
        self._printed = printed

    def __enter__(self) -> "Nursery":
        listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        listener.bind("")  # a name that the system chooses
        listener.listen()
        self._address = listener.getsockname()
        path = os.pathsep.join(filter(None, [str(Path(__file__).resolve().parents[1]), os.environ.get("PYTHONPATH")]))
        with listener:
            self._process = subprocess.Popen([sys.executable, "-P", "-m", "clearway._nursery", str(listener.fileno())],
                                             pass_fds=(listener.fileno(),), stdin=subprocess.DEVNULL,
                                             env={**os.environ, "PYTHONPATH": path, "PYTHONHASHSEED": "0"})
        return self

    def __exit__(self, *_: object) -> None:
        self._process.terminate()
        self._process.wait()

    def process(self, *descriptors: int) -> socket.socket:
        """A new process; the connection says at last how it ended."""
        connection = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        connection.connect(self._address)
        socket.send_fds(connection, [os.fsencode(os.getcwd())], [*descriptors, self._printed.fileno()])
        return connection


class Process:
    """The process of a part, as a run has one: the other end of _host.py."""

    def __init__(self, nursery: Nursery, greeting: dict[str, Any]) -> None:
        memory = os.memfd_create("clearway")
        os.ftruncate(memory, 2 * CAPACITY)
        to_part, from_part = os.pipe(), os.pipe()
        self._memory = os.fdopen(memory, "r+b", buffering=0)
        self._read, self._write = from_part[0], to_part[1]
        self._columns = greeting["question"]
        try:
            self._connection = nursery.process(memory, to_part[0], from_part[1])
        finally:
            os.close(to_part[0])
            os.close(from_part[1])
        text = json.dumps(greeting).encode()
        self._put(0, struct.pack("<Q", len(text)) + text)
        self.failure = self._ring(HELLO)

    def __enter__(self) -> "Process":
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._write)
        os.close(self._read)
        self._memory.close()
        self._connection.shutdown(socket.SHUT_WR)
        self._connection.recv(4)
        self._connection.close()

    def ask(self, arrays: dict[str, np.ndarray]) -> bool:
        """Whether it answered; otherwise ``failure`` says why not."""
        offset = _aligned(16 * len(self._columns))
        directory = b""
        for name, *_ in self._columns:
            directory += struct.pack("<QQ", offset, len(arrays[name]))
            self._put(offset, arrays[name].tobytes())
            offset = _aligned(offset + arrays[name].nbytes)
        self._put(0, directory)
        self.failure = self._ring(DECIDE)
        return not self.failure

    def leases(self) -> list[dict[str, Any]]:
        return json.loads(self._text())

    def probabilities(self) -> list[float]:
        offset, count = struct.unpack("<QQ", os.pread(self._memory.fileno(), 16, CAPACITY))
        return np.frombuffer(os.pread(self._memory.fileno(), 4 * count, CAPACITY + offset), "f4").tolist()

    def _put(self, offset: int, content: bytes) -> None:
        os.pwrite(self._memory.fileno(), content, offset)

    def _text(self) -> str:
        (length,) = struct.unpack("<Q", os.pread(self._memory.fileno(), 8, CAPACITY))
        return os.pread(self._memory.fileno(), length, CAPACITY + 8).decode("utf-8", "replace")

    def _ring(self, bell: bytes) -> str:
        """Waits for the answer; empty, or why there is none."""
        try:
            os.write(self._write, bell)
        except BrokenPipeError:
            pass
        heard = os.read(self._read, 1)
        if heard == ANSWER:
            return ""
        if heard:
            return self._text()
        status = self._connection.recv(4)
        ended = f" ({os.waitstatus_to_exitcode(*struct.unpack('<i', status))})" if len(status) == 4 else ""
        return f"its process ended{ended} instead of answering"


def _aligned(offset: int) -> int:
    return (offset + 63) // 64 * 64


def shown_to(nursery: Nursery, part: dict[str, Any], scene: Scene) -> Told:
    told = Told()
    greeting = {**scene.greeting, **part, "answer": ANSWERS if part["kind"] == "predictor" else [], "answer_limit_s": ANSWER_LIMIT_S}
    with Process(nursery, greeting) as process:
        for arrays in scene.shown:
            before = time.perf_counter()
            if process.failure or not process.ask(arrays):
                told.failure = process.failure
                told.is_late = time.perf_counter() - before >= ANSWER_LIMIT_S
                break
            told.took_s.append(time.perf_counter() - before)
            told.answers.append(process.leases() if part["kind"] == "policy" else process.probabilities())
    return told


def require_loadable(part: dict[str, Any]) -> None:
    """Raises InputError for what no run takes either."""
    greeting = {**part, "question": [], "answer": [], "network": None, "period_s": 0.0, "link_radius_m": 0.0}
    with tempfile.TemporaryFile() as printed, Nursery(printed) as nursery, Process(nursery, greeting) as process:
        if process.failure:
            end = "\n " if "\n" in process.failure else "" if process.failure.endswith("?") else "."
            cure = ", or say --predictor" if "has no method act()" in process.failure else ""
            raise _program.InputError(f"{part['kind']}: {part['object'] or 'module'} of {part['file']}: {process.failure}{end} Correct the file "
                                      f"or the settings{cure}")
