"""Installs the package `clearway` for one Python: `./clearway python` calls it. Copies the package; downloads nothing.

It is also the build backend of pyproject.toml, so that `pip install ./python` and `pip wheel ./python` need no other package.
"""
from __future__ import annotations

import argparse
import base64
import contextlib
import errno
import fcntl
import hashlib
import importlib.util
import json
import os
import re
import shutil
import site
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path

EXIT_BAD_INPUT, EXIT_ENVIRONMENT = 3, 4
HERE = Path(__file__).resolve().parent
MARK = "_installed.json"  # in the package: where the programs are, and that an installation made it
ENTRY_POINTS = "[gymnasium.envs]\nClearway = clearway._spec:register\n"


def metadata(version: str) -> str:
    """What pip shows and resolves. Extras are what parts of the package import when they are used."""
    return (f"Metadata-Version: 2.1\nName: clearway\nVersion: {version}\n"
            "Summary: How much time an emergency vehicle gains in mixed traffic, and at what cost to the others\n"
            "Author: The Clearway maintainers\nLicense: Apache-2.0\n"
            "Keywords: emergency vehicles,traffic simulation,SUMO,signal priority,reinforcement learning\n"
            "Classifier: License :: OSI Approved :: Apache Software License\n"
            "Classifier: Operating System :: POSIX :: Linux\n"
            "Classifier: Programming Language :: Python :: 3.11\n"
            "Classifier: Topic :: Scientific/Engineering\n"
            "Classifier: Typing :: Typed\n"
            "Requires-Python: >=3.11\nRequires-Dist: numpy\n"
            "Provides-Extra: tables\nRequires-Dist: pandas; extra == 'tables'\n"
            "Provides-Extra: recordings\nRequires-Dist: h5py; extra == 'recordings'\n"
            "Provides-Extra: learning\nRequires-Dist: gymnasium; extra == 'learning'\n"
            "Requires-Dist: pettingzoo; extra == 'learning'\n"
            "Description-Content-Type: text/markdown\n\n"
            "Runs and reads studies of Clearway, and lets you write policies, predictors and agents for them. It needs Clearway's\n"
            "programs: build them with `./clearway` in the source tree, or set `CLEARWAY_PROGRAMS` to their folder.\n")


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


def is_ours(package: Path) -> bool:
    """Whether this is a folder that an installation of Clearway made, not a link to one."""
    return not package.is_symlink() and (package / MARK).is_file()


def is_our_record(info: Path) -> bool:
    record = info / "RECORD"
    return not info.is_symlink() and record.is_file() and f"clearway/{MARK}," in record.read_text(encoding="utf-8", errors="replace")


def is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        pass
    return True


def remove_leftovers(target: Path) -> None:
    """What installations left here that were killed. Those of running ones stay."""
    for path in target.iterdir():
        leftover = re.fullmatch(r"\.clearway\.([0-9]+)\.part", path.name)
        if leftover and not path.is_symlink() and not is_running(int(leftover[1])):
            shutil.rmtree(path, ignore_errors=True)


@contextlib.contextmanager
def alone_in(target: Path) -> Iterator[None]:
    """Lets one installation after another into the folder, where its file system has locks."""
    descriptor = os.open(target, os.O_RDONLY | os.O_DIRECTORY)
    try:
        with contextlib.suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def copy(source: Path, target: Path) -> None:
    """As shutil.copytree, which collects errors; this raises the first."""
    target.mkdir()
    for path in sorted(source.iterdir()):
        if path.is_dir():
            if path.name != "__pycache__":
                copy(path, target / path.name)
        else:
            shutil.copyfile(path, target / path.name)


def prepare(source: Path, programs: Path, part: Path, version: str) -> Path:
    """Fills a folder with the package and what pip reads of it, whose folder is returned."""
    copy(source, part / "clearway")
    (part / "clearway" / MARK).write_text(json.dumps({"programs": str(programs)}) + "\n")
    info = part / f"clearway-{version}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(metadata(version))
    (info / "entry_points.txt").write_text(ENTRY_POINTS)
    (info / "INSTALLER").write_text("clearway\n")
    files = sorted(file.relative_to(part).as_posix() for file in part.rglob("*"))
    (info / "RECORD").write_text("".join(f"{file},,\n" for file in files) + f"{info.name}/RECORD,,\n")
    return info


def swap_in(part: Path, info: Path, target: Path) -> None:
    """Puts the prepared folders in place of an earlier installation, which comes back if that fails."""
    old = part / "old"
    old.mkdir()
    try:
        for earlier in [target / "clearway", *target.glob("clearway-*.dist-info")]:
            if is_ours(earlier) or is_our_record(earlier):
                earlier.rename(old / earlier.name)
        (part / "clearway").rename(target / "clearway")
    except BaseException:
        for earlier in old.iterdir():
            earlier.rename(target / earlier.name)
        raise
    info.rename(target / info.name)


def install(source: Path, programs: Path, target: Path, version: str) -> None:
    """Fills a folder beside the package's place and swaps it in, so that no import ever sees half of it. What is there is replaced
    only if it is an earlier installation."""
    if target.exists() and not target.is_dir():
        fail(EXIT_ENVIRONMENT, f"{target}: cannot be written: it is not a folder. Choose another with --to or --venv")
    target.mkdir(parents=True, exist_ok=True)
    with alone_in(target):
        remove_leftovers(target)
        for place, is_known in ((target / "clearway", is_ours), (target / f"clearway-{version}.dist-info", is_our_record)):
            if os.path.lexists(place) and not is_known(place):
                fail(EXIT_BAD_INPUT, f"{place}: is not an installation of Clearway and stays as it is (allowed: a folder that "
                                     "`clearway python` made, or none). Choose another folder with --to or --venv, or rename it")
        part = target / f".clearway.{os.getpid()}.part"
        part.mkdir()
        try:
            swap_in(part, prepare(source, programs, part, version), target)
        finally:
            shutil.rmtree(part, ignore_errors=True)


def told(error: OSError, target: Path) -> str:
    """What failed, where, and what to do."""
    cures = {errno.EFBIG: "Raise the limit of `ulimit -f` and give the same command again",
             errno.ENOSPC: "Free some space there and give the same command again",
             errno.EDQUOT: "Free some space there and give the same command again"}
    cure = cures.get(error.errno or 0, "Choose another folder with --to or --venv, or change its permissions")
    return f"{target}: cannot be written: {error.strerror or error}. {cure}"


def build_wheel(wheel_directory: str, config_settings: dict | None = None, metadata_directory: str | None = None) -> str:
    """PEP 517: writes the wheel and returns its name. Its programs are CLEARWAY_PROGRAMS, else those that this tree builds."""
    found = re.search(r'^__version__ = "(.+)"$', (HERE / "clearway" / "__init__.py").read_text(encoding="utf-8"), re.MULTILINE)
    assert found is not None
    version = found.group(1)
    programs = os.environ.get("CLEARWAY_PROGRAMS") or str(HERE.parent / "build" / "release" / "bin")
    info = f"clearway-{version}.dist-info"
    content = {f"clearway/{file.relative_to(HERE / 'clearway').as_posix()}": file.read_bytes()
               for file in sorted((HERE / "clearway").rglob("*")) if file.is_file() and "__pycache__" not in file.parts}
    texts = {f"clearway/{MARK}": json.dumps({"programs": programs}) + "\n", f"{info}/METADATA": metadata(version),
             f"{info}/WHEEL": "Wheel-Version: 1.0\nGenerator: clearway\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
             f"{info}/entry_points.txt": ENTRY_POINTS}
    content.update((name, text.encode()) for name, text in texts.items())
    digests = {name: base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode() for name, data in content.items()}
    record = "".join(f"{name},sha256={digests[name]},{len(data)}\n" for name, data in content.items())
    content[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    wheel = f"clearway-{version}-py3-none-any.whl"
    with zipfile.ZipFile(Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in content.items():
            archive.writestr(zipfile.ZipInfo(name), data)
    return wheel


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
        install(HERE / "clearway", Path(arguments.programs).resolve(), target, arguments.version)
    except OSError as error:
        fail(EXIT_ENVIRONMENT, told(error, target))
    print(f"clearway {arguments.version} is installed in {target}")
    if arguments.venv:
        print(f"    {arguments.venv}/bin/python3 -c 'import clearway; help(clearway)'")
    elif arguments.to:
        print(f"    PYTHONPATH={os.path.abspath(target)} {sys.executable} -c 'import clearway; help(clearway)'")
    else:
        print(f"    {sys.executable} -c 'import clearway; help(clearway)'")


if __name__ == "__main__":
    main()
