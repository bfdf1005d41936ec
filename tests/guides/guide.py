"""What pages of this tree tell their readers to type."""
from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

from support import PROGRAMS, SOURCE


def section(page: str, heading: str) -> str:
    """The text below a heading, up to the next one of its level or above."""
    text = (SOURCE / page).read_text(encoding="utf-8")
    found = re.search(rf"^(#+) {re.escape(heading)}\n(.*?)(?=^#{{1,6}} |\Z)", text, re.MULTILINE | re.DOTALL)
    assert found is not None, f"{page} has no heading {heading!r}"
    return found.group(2)


def blocks(page: str, heading: str) -> list[str]:
    """The indented blocks of a section, without their indent."""
    found = re.findall(r"(?:^    .*\n|^\n(?=    ))+", section(page, heading), re.MULTILINE)
    return [re.sub(r"^    ", "", block, flags=re.MULTILINE).strip("\n") + "\n" for block in found]


def commands(page: str, heading: str) -> list[str]:
    """Lines of these blocks that call Clearway."""
    lines = [line for block in blocks(page, heading) for line in block.splitlines()]
    return [line.removeprefix("./").split("  #")[0].strip() for line in lines if re.match(r"(\./)?clearway ", line)]


def type_in(command: str, *replaced: tuple[str, str]) -> str:
    """Runs a command of a page in the current folder, with pieces of it replaced that a page must have; returns its output."""
    for piece, other in replaced:
        assert piece in command, f"`{command}` has no {piece!r}"
        command = command.replace(piece, other)
    ended = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False,
                           env={**os.environ, "PATH": f"{PROGRAMS}:{os.environ['PATH']}"})
    assert ended.returncode == 0, f"`{command}` ended with {ended.returncode}\n{ended.stdout}\n{ended.stderr}"
    return ended.stdout


def the(kind: str, found: list[str]) -> str:
    """The only command that begins so."""
    fitting = [one for one in found if one.startswith(f"clearway {kind}")]
    assert len(fitting) == 1, f"commands that begin with `clearway {kind}`: {fitting}"
    return fitting[0]


def run_folder(name: str) -> Path:
    """The only run folder of this scenario or study."""
    found = list(Path("runs").glob(f"{name}*/manifest.json"))
    assert len(found) == 1, found
    return found[0].parent
