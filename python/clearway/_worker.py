"""The process that simulates for an environment: one replication, warmed up, which forks an episode at every reset."""
from __future__ import annotations

import json
import math
import os
import re
import struct
import subprocess
import tempfile
import weakref
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _program
from ._channel import ANSWER, CAPACITY, DECIDE, ENDED, FAILED, HELLO, RESET, Channel, Sheet

_workers: "weakref.WeakSet[Worker]" = weakref.WeakSet()


def _forget_in_child() -> None:
    """A forked child holds no pipe of its parent's environments, so that their workers hear the parent end."""
    for worker in list(_workers):
        worker.abandon()


os.register_at_fork(after_in_child=_forget_in_child)


class Worker:
    """Starts the process and waits until it is warm. Ends with it: its pipe closes, whatever becomes of this process."""

    def __init__(self, arguments: Sequence[str], folder: Path) -> None:
        _program.require_first_load("clearway.env")
        memory = os.memfd_create("clearway", os.MFD_CLOEXEC)
        os.ftruncate(memory, 2 * CAPACITY)
        their_read, our_write = os.pipe()
        our_read, their_write = os.pipe()
        theirs = (memory, their_read, their_write)
        folder.mkdir(parents=True, exist_ok=True)
        self._log = tempfile.TemporaryFile(dir=folder)
        try:
            self._process = subprocess.Popen(
                _program.command(["python", "environment", *arguments, "--out", str(folder), "--channel", *map(str, theirs)]),
                stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log, pass_fds=theirs, env=_program.environment())
        except BaseException:
            for descriptor in (*theirs, our_read, our_write):
                os.close(descriptor)
            self._log.close()
            raise
        # What this side writes is the second half of what it would be for a part: the worker writes the first.
        self._channel: Channel | None = Channel(os.dup(memory), our_read, our_write)
        for descriptor in theirs:
            os.close(descriptor)
        #: Whether an answer is under way: one that nobody waited for (Ctrl-C) must not be taken for the next one.
        self._owes_answer = False
        _workers.add(self)
        try:
            self._hear(HELLO)
        except BaseException:
            self.close()
            raise
        self.greeting: dict[str, Any] = json.loads(self._channel.read_text())
        self._question = Sheet(self._channel.incoming, self.greeting["question"])
        self._answer = Sheet(self._channel.outgoing, self.greeting["answer"])
        self._layout: list[tuple[str, tuple[int, ...], np.dtype, int]] = []
        self._block = slice(0, 0)
        self._numbers: list[tuple[struct.Struct, int]] = []
        self._actions: np.ndarray | None = None

    def _hear(self, *expected: bytes) -> bytes:
        assert self._channel is not None
        bell = self._channel.wait()
        self._owes_answer = False
        if bell in expected:
            return bell
        message = self._channel.read_text() if bell == FAILED else self._last_words()
        self.close()
        raise _program.error_of(self._process.returncode or 1, message)

    def _last_words(self) -> str:
        self._process.wait()
        self._log.seek(0)
        log = self._log.read().decode("utf-8", "replace").strip()
        said = re.split(r"^clearway: ", log, flags=re.MULTILINE)[-1]  # what SUMO warned of before is not the cause
        return said or f"the simulating process ended with {self._process.returncode}"

    def reset(self) -> bytes:
        """Begins an episode, ending a running one; returns DECIDE, or ENDED when no emergency vehicle ever came."""
        assert self._channel is not None
        if self._owes_answer:
            self._hear(DECIDE, ENDED)
        self._owes_answer = True
        self._channel.ring(RESET)
        return self._hear(DECIDE, ENDED)

    def send(self, actions: np.ndarray) -> None:
        """Hands actions over; ``receive`` waits for what came of them."""
        assert self._channel is not None
        if self._actions is None:
            self._answer.write("actions", actions)
            self._actions = np.frombuffer(self._channel.outgoing, np.int32, len(actions), 64)
        else:
            self._actions[:] = actions
        self._owes_answer = True
        self._channel.ring(ANSWER)

    def receive(self) -> bytes:
        return self._hear(DECIDE, ENDED)

    def layout(self, shapes: Mapping[str, tuple[int, ...]]) -> tuple[list[tuple[str, tuple[int, ...], np.dtype, int]], int]:
        """Where the arrays of a decision lie in the block of memory that holds them all (name, shape, type, offset), and its bytes.

        They stay in their places, because their sizes do, so these are looked up once.
        """
        if not self._layout:
            places = {name: self._question.place(name)[0] for name in shapes}
            first = min(places.values())
            kinds = {name: self._question.columns[name][0] for name in shapes}
            last = max(places[name] + kinds[name].itemsize * math.prod(shape) for name, shape in shapes.items())
            self._block = slice(first, last)
            self._layout = [(name, shape, kinds[name], places[name] - first) for name, shape in shapes.items()]
        return self._layout, self._block.stop - self._block.start

    def copied(self, shapes: Mapping[str, tuple[int, ...]]) -> dict[str, np.ndarray]:
        """Arrays of the present decision, the caller's to keep: one copy of the memory that holds them, and a view for each."""
        layout, _ = self.layout(shapes)
        assert self._channel is not None
        block = bytearray(self._channel.incoming[self._block])
        return {name: np.ndarray(shape, kind, block, offset) for name, shape, kind, offset in layout}

    def copy_block(self, target: memoryview) -> None:
        """Copies the memory of the arrays of the present decision (``layout``) into ``target``."""
        assert self._channel is not None
        target[:] = self._channel.incoming[self._block]

    def numbers(self) -> tuple[float, float, float, int, int]:
        """Time, s; delay of emergency vehicles and of others since the last decision, s; whether all emergency vehicles have
        come and gone; illegal actions of the last decision."""
        if not self._numbers:
            self._numbers = [(struct.Struct(form), self._question.place(name)[0])
                             for name, form in (("time_s", "<d"), ("score_s", "<2d"), ("flags", "<2I"))]
        assert self._channel is not None
        memory = self._channel.incoming
        (time, time_at), (score, score_at), (flags, flags_at) = self._numbers
        return time.unpack_from(memory, time_at) + score.unpack_from(memory, score_at) + flags.unpack_from(memory, flags_at)

    def end(self) -> dict[str, Any]:
        """What the worker says at the end of a run."""
        assert self._channel is not None
        return json.loads(self._channel.read_text())

    def abandon(self) -> None:
        """Closes the pipes of a worker that belongs to another process."""
        if self._channel is not None:
            self._channel.close()
            self._channel = None

    def close(self) -> None:
        """Ends the process; does nothing the second time."""
        if self._channel is None:
            return
        self._channel.close()
        self._channel = None
        try:
            self._process.wait(timeout=5.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._log.close()
