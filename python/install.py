"""Installs the package `clearway` for one Python: `./clearway python` calls it. Copies the package; downloads nothing."""
from __future__ import annotations

import argparse
import importlib.util
import json
import os
import shutil
import site
import subprocess
import sys
from pathlib import Path

EXIT_BAD_INPUT, EXIT_ENVIRONMENT = 3, 4


def fail(code: int, message: str) -> None:
    print(f"clearway: {message}", file=sys.stderr)
    sys.exit(code)


def target_of(arguments: argparse.Namespace) -> Path:
    """The folder into which the package goes."""
    if arguments.venv is None:
        return Path(arguments.to) if arguments.to else Path(site.getusersitepackages())
    venv = Path(arguments.venv)
    python = venv / "bin" / "python3"
    if not python.exists():
        made = subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", str(venv)],
                              capture_output=True, text=True, check=False)
        if made.returncode != 0:
            fail(EXIT_ENVIRONMENT, f"{venv}: a virtual environment cannot be made: {(made.stderr or made.stdout).strip()}")
    told = subprocess.run([str(python), "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"],
                          capture_output=True, text=True, check=False)
    if told.returncode != 0:
        fail(EXIT_BAD_INPUT, f"--venv {venv}: its Python does not start: {told.stderr.strip()}")
    return Path(told.stdout.strip())


def install(source: Path, programs: Path, target: Path, version: str) -> None:
    """Copies the package beside its place and swaps it in, so that no import ever sees half of it."""
    package, fresh, old = target / "clearway", target / ".clearway.new", target / ".clearway.old"
    for leftover in (fresh, old):
        shutil.rmtree(leftover, ignore_errors=True)
    target.mkdir(parents=True, exist_ok=True)
    shutil.copytree(source, fresh, ignore=shutil.ignore_patterns("__pycache__"))
    (fresh / "_installed.json").write_text(json.dumps({"programs": str(programs)}) + "\n")
    if package.exists():
        package.rename(old)
    fresh.rename(package)
    shutil.rmtree(old, ignore_errors=True)
    for info in target.glob("clearway-*.dist-info"):
        shutil.rmtree(info)
    info = target / f"clearway-{version}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: clearway\nVersion: {version}\nRequires-Python: >=3.11\n"
                                   "Requires-Dist: numpy\n")
    (info / "entry_points.txt").write_text("[gymnasium.envs]\nClearway = clearway._spec:register\n")
    (info / "INSTALLER").write_text("clearway\n")
    files = sorted(file.relative_to(target).as_posix() for folder in (package, info) for file in folder.rglob("*"))
    (info / "RECORD").write_text("".join(f"{file},,\n" for file in files) + f"{info.name}/RECORD,,\n")


def main() -> None:
    parser = argparse.ArgumentParser(prog="clearway python", description="Installs the Python package clearway.")
    places = parser.add_mutually_exclusive_group()
    places.add_argument("--venv", metavar="DIR", help="into this virtual environment, which is made if it is not there")
    places.add_argument("--to", metavar="DIR", help="into this folder, for PYTHONPATH [the user's site-packages]")
    parser.add_argument("--programs", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--version", required=True, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if importlib.util.find_spec("numpy") is None:
        fail(EXIT_ENVIRONMENT, f"{sys.executable} has no numpy. Install it: apt-get install python3-numpy")
    target = target_of(arguments)
    try:
        install(Path(__file__).resolve().parent / "clearway", Path(arguments.programs).resolve(), target, arguments.version)
    except OSError as error:
        fail(EXIT_ENVIRONMENT, f"{target}: cannot be written: {error}")
    print(f"clearway {arguments.version} is installed in {target}")
    if arguments.venv:
        print(f"    {arguments.venv}/bin/python3 -c 'import clearway; help(clearway)'")
    elif arguments.to:
        print(f"    PYTHONPATH={os.path.abspath(target)} {sys.executable} -c 'import clearway; help(clearway)'")
    else:
        print(f"    {sys.executable} -c 'import clearway; help(clearway)'")


if __name__ == "__main__":
    main()
