"""A process that has loaded what parts in Python need, and becomes each of them by a fork: `python3 -m clearway._nursery LISTENER`.

Clearway starts one for a study. Its workers connect to the listener and send, with a folder as text, four descriptors: memory, two
pipes, and where the part may print. A part ends when its connection does; how it ended is what the connection says last.
"""
from __future__ import annotations

import contextlib
import ctypes
import gc
import os
import selectors
import signal
import socket
import struct
import sys
import time
from collections.abc import Callable
from typing import Any

from . import _files, _host

PR_SET_PDEATHSIG = 1
#: From SIGTERM to SIGKILL, s.
PATIENCE_S = 1.0


def peer_of(connection: socket.socket) -> tuple[int, int]:
    """Process and user at the other end."""
    process, user, _ = struct.unpack("3i", connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, 12))
    return process, user


class Nursery:
    """The parts that live, by their connection."""

    def __init__(self, listener: socket.socket) -> None:
        self._selector = selectors.DefaultSelector()
        self._listener = listener
        self._prctl: Callable[..., int] = ctypes.CDLL(None).prctl
        self._overdue: dict[int, float] = {}  # when a part that was told to end is killed
        self._parts: dict[int, tuple[int, socket.socket]] = {}  # process -> its descriptor and connection

    def serve(self) -> None:
        self._selector.register(self._listener, selectors.EVENT_READ, self._accept)
        while True:
            wait_s = max(0.0, min(self._overdue.values()) - time.monotonic()) if self._overdue else None
            for key, _ in self._selector.select(wait_s):
                key.data(key.fileobj)
            for process in [one for one, end_s in self._overdue.items() if end_s <= time.monotonic()]:
                del self._overdue[process]
                _host.kill_group(process)

    def end(self) -> None:
        for process in self._parts:
            _host.kill_group(process)
            with contextlib.suppress(ChildProcessError):  # it may have just been waited for
                os.waitpid(process, 0)
        _host.end_children()

    def _accept(self, listener: socket.socket) -> None:
        connection, _ = listener.accept()
        if peer_of(connection)[1] != os.getuid():
            connection.close()
            return
        self._selector.register(connection, selectors.EVENT_READ, self._asked)

    def _asked(self, connection: socket.socket) -> None:
        try:
            folder, descriptors, _, _ = socket.recv_fds(connection, 65536, 4)
        except ConnectionError:
            folder, descriptors = b"", []
        self._selector.unregister(connection)
        if len(descriptors) == 4:
            self._make(os.fsdecode(folder), descriptors, connection)
        else:
            connection.close()
        for descriptor in descriptors:
            os.close(descriptor)

    def _make(self, folder: str, descriptors: list[int], connection: socket.socket) -> None:
        parent = os.getpid()
        process = os.fork()
        if process == 0:
            self._become_part(parent, peer_of(connection)[0], folder, descriptors)
        handle = os.pidfd_open(process)
        self._parts[process] = (handle, connection)
        self._selector.register(handle, selectors.EVENT_READ, lambda _: self._ended(process))
        self._selector.register(connection, selectors.EVENT_READ, lambda _: self._left(process))

    def _become_part(self, parent: int, owner: int, folder: str, descriptors: list[int]) -> None:
        try:
            self._prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
            if os.getppid() != parent:
                os._exit(1)
            signal.signal(signal.SIGINT, signal.default_int_handler)
            memory, read, write, log = descriptors
            os.dup2(log, 2)
            for name in os.listdir("/proc/self/fd"):  # connections of others, which must hear their own ends
                if int(name) > 2 and int(name) not in (memory, read, write):
                    with contextlib.suppress(OSError):
                        os.close(int(name))
            os.chdir(folder)
            sys.path.append(folder)
            _host.be_part(memory, read, write, owner)
        except OSError as error:
            if _files.is_of_machine(error):
                os.kill(os.getpid(), signal.SIGKILL)  # as what the machine did is told
        finally:
            os._exit(1)

    def _left(self, process: int) -> None:
        """Nobody needs a part any more. It may have ended at the same moment and been waited for."""
        if process not in self._parts:
            return
        self._selector.unregister(self._parts[process][1])
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGTERM)
        self._overdue[process] = time.monotonic() + PATIENCE_S

    def _ended(self, process: int) -> None:
        handle, connection = self._parts[process]
        _host.kill_group(process)  # what it started and did not wait for; before its number is free
        _, status = os.waitpid(process, 0)
        del self._parts[process]
        _host.end_children(but=self._parts)
        self._overdue.pop(process, None)
        self._selector.unregister(handle)
        os.close(handle)
        with contextlib.suppress(KeyError):
            self._selector.unregister(connection)
        with contextlib.suppress(OSError):
            connection.send(struct.pack("<i", status))
        connection.close()


def main() -> None:
    os.set_inheritable(int(sys.argv[1]), False)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the program that started this one, which then ends it

    def leave(*_: Any) -> None:
        raise SystemExit(0)

    signal.signal(signal.SIGTERM, leave)
    ctypes.CDLL(None).prctl(_host.PR_SET_CHILD_SUBREAPER, 1)
    nursery = Nursery(socket.socket(fileno=int(sys.argv[1])))
    gc.collect()
    gc.freeze()  # what is shared stays shared
    try:
        nursery.serve()
    finally:
        nursery.end()


if __name__ == "__main__":
    main()
