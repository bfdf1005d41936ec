"""What the suites share: a folder of one's own, the programs, and a small study that is run once."""
from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
PROGRAMS = Path(os.environ["CLEARWAY_PROGRAMS"])


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


def program(*arguments: str, code: int = 0) -> str:
    """Standard output of ``clearway ARGUMENTS``, which has to end with ``code``."""
    ended = subprocess.run([str(PROGRAMS / "clearway"), *arguments], capture_output=True, text=True, check=False)
    assert ended.returncode == code, f"{arguments}: {ended.returncode}\n{ended.stdout}\n{ended.stderr}"
    return ended.stdout


def python(code: str, executable: str = sys.executable, **environment: str) -> subprocess.CompletedProcess:
    """Runs code in a Python of its own."""
    return subprocess.run([executable, "-c", code], capture_output=True, text=True, check=False,
                          env={**os.environ, **environment})
