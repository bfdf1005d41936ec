"""What the suites share: a folder of one's own, the programs, and a small study that is run once."""
from __future__ import annotations

import functools
import io
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import clearway
import numpy as np

SOURCE = Path(__file__).resolve().parents[2]
PROGRAMS = Path(os.environ["CLEARWAY_PROGRAMS"])


def no_action(env: clearway.Env) -> np.ndarray:
    return np.zeros(env.action_space.shape, dtype=np.int64)


class FolderCase(unittest.TestCase):
    """Runs each test in a temporary folder."""

    def setUp(self) -> None:
        holder = tempfile.TemporaryDirectory(prefix="clearway-test-")
        self.addCleanup(holder.cleanup)
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        self.folder = Path(holder.name).resolve()
        os.chdir(self.folder)

    def write(self, name: str, text: str) -> Path:
        file = self.folder / name
        file.write_text(text)
        return file

    def message_of(self, kind: type[BaseException], call) -> str:  # noqa: ANN001
        with self.assertRaises(kind) as raised:
            call()
        return str(raised.exception)


class Terminal(io.StringIO):
    """To stand in for ``sys.stderr``."""

    def isatty(self) -> bool:
        return True


def program(*arguments: str, code: int = 0) -> str:
    """Standard output of ``clearway ARGUMENTS``, which has to end with ``code``."""
    ended = subprocess.run([str(PROGRAMS / "clearway"), *arguments], capture_output=True, text=True, check=False)
    assert ended.returncode == code, f"{arguments}: {ended.returncode}\n{ended.stdout}\n{ended.stderr}"
    return ended.stdout


@functools.cache
def may_trace() -> bool:
    return shutil.which("strace") is not None and subprocess.run(["strace", "-qq", "-o", os.devnull, "true"], check=False).returncode == 0


def told_when(call: str, reason: str, place: str | Path, expression: str, first: int = 1) -> str:
    """What a Python of its own raises for an expression while a system call on a file or folder fails, from its ``first`` on. Skips
    where strace may not trace."""
    if not may_trace():
        raise unittest.SkipTest("strace is not installed or may not trace")
    code = (f"import clearway\ntry:\n    {expression}\n    print('nothing')\n"
            "except Exception as error:\n    print(f'{type(error).__name__}: {error}')\n")
    ended = subprocess.run(["strace", "-qq", "-o", os.devnull, "-P", str(place), "-e", f"trace={call}",
                            "-e", f"inject={call}:error={reason}:when={first}+", sys.executable, "-c", code],
                           capture_output=True, text=True, check=False, timeout=60)
    return ended.stdout.removesuffix("\n")


def python(code: str, executable: str = sys.executable, **environment: str) -> subprocess.CompletedProcess:
    """Runs code in a Python of its own."""
    return subprocess.run([executable, "-c", code], capture_output=True, text=True, check=False,
                          env={**os.environ, **environment})


def hosts_of(folder: Path) -> list[int]:
    """Processes of parts or workers that were started for this folder."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes()
            place = os.readlink(process / "cwd")
        except OSError:
            continue
        if any(word in words for word in (b"clearway._host", b"clearway._nursery", b"bin/clearway")) and place == str(folder):
            found.append(int(process.name))
    return found
