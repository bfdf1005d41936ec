"""Finds Clearway's programs and calls them; turns their exit codes into exceptions."""
from __future__ import annotations

import collections
import contextlib
import difflib
import functools
import inspect
import json
import numbers
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import warnings
from pathlib import Path
from typing import IO, Any, Callable, Iterable, Iterator, Sequence, TypeVar

F = TypeVar("F", bound=Callable[..., Any])


class ClearwayError(Exception):
    """Whatever Clearway could not do. ``exit_code`` is that of the program (docs/reference/command-line.md)."""

    def __init__(self, message: str, exit_code: int | None = None) -> None:
        super().__init__(message)
        self.exit_code = exit_code


class InputError(ClearwayError, ValueError):
    """Something that was given is wrong: the message says what, where, its value and what is allowed."""


class EnvironmentFault(ClearwayError, OSError):
    """Something is wrong with the machine: programs that are not built, no SUMO, a disk that is full or fails, another Python.

    ``errno`` is the system's where a file could not be read.
    """

    def __str__(self) -> str:
        return str(self.args[0])


class LoadedAgain(InputError):
    """A file starts runs while another process loads it: each process would start them again, without end."""


#: Set in the process of a part in Python, and so in all that it starts: the part's name.
PART_VARIABLE = "CLEARWAY_PART"


def require_first_load(call_name: str) -> None:
    """Raises ``LoadedAgain`` in the process of a part in Python, and while multiprocessing loads the main file in a new process."""
    cure = "Put what starts runs below `if __name__ == \"__main__\":`, or into another file"
    part = os.environ.get(PART_VARIABLE)
    if part is not None:
        file = part.rpartition(":")[0]
        raise LoadedAgain(f"{part}: {call_name}() was called while a run had loaded this part (allowed: outside of parts only, because "
                          f"those runs would load {file} again, without end). {cure}")
    process = sys.modules.get("multiprocessing.process")
    # multiprocessing itself refuses by this mark to start processes from there.
    if process is not None and getattr(process.current_process(), "_inheriting", False):
        raise LoadedAgain(f"{call_name}() was called while multiprocessing loaded the main file in a new process (allowed: in the first "
                          f"process only, because each process would start the same runs again). {cure}")


_ERROR_OF = {2: InputError, 3: InputError, 4: EnvironmentFault}
#: The study went on, and the runs that failed are in its tables.
RUNS_FAILED = 1


def require_whole(what: str, value: Any, least: int, most: int) -> None:
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or not least <= value <= most:
        raise InputError(f"{what}: {value!r} (allowed: a whole number from {least} to {most})")


def without_null(text: str) -> str:
    if "\0" in text:
        raise InputError(f"{text!r} has the character U+0000 (allowed: names and paths without it)")
    return text


def warn(message: str) -> None:
    """Warns, with the line of the user's that called this package."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        level, frame = level + 1, frame.f_back
    warnings.warn(message, RuntimeWarning, stacklevel=level)


def counted(count: int, noun: str) -> str:
    """``1 run``, ``2 runs``."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


#: So many names are listed where another one is unknown; of more, the nearest alone.
MOST_LISTED = 6


def nearest(word: Any, known: Iterable[str], most: int = 1) -> list[str]:
    """The known words that are meant, the likeliest first: those whose last part it is (``condition.policy``), those that are spelt
    alike, and those that contain it."""
    word, known = str(word), list(known)
    folded = word.casefold()
    found = [name for name in known if name.rpartition(".")[2] == word]
    found += difflib.get_close_matches(word, known, most)
    if len(folded) > 2:
        found += sorted((name for name in known if folded in name.casefold()), key=len)
    return list(dict.fromkeys(found))[:most]


def did_you_mean(word: Any, known: Iterable[str], most: int = 1) -> str:
    """``. Did you mean 'WORD'?`` with the nearest of the known words, as the programs ask; empty if none is near."""
    near = nearest(word, known, most)
    return f". Did you mean {' or '.join(map(repr, near))}?" if near else ""


def there_are(word: Any, known: Sequence[str], noun: str, all_by: str, count: int | None = None) -> str:
    """What follows ``there is no WORD``: few names all, of many the nearest and how to see all."""
    if len(known) <= MOST_LISTED:
        return f"; it has {', '.join(known) or 'none'}{did_you_mean(word, known)}"
    near = did_you_mean(word, known, 3) or f". It has {', '.join(known[:3])} and others."
    return f"{near} {all_by} names all {counted(len(known) if count is None else count, noun)}"


#: What keywords mean that others use.
_MEANT = {"dense": 'variant="dense"', "replications": "seeds", "replication": "seeds", "n_seeds": "seeds", "num_seeds": "seeds",
          **dict.fromkeys(("duration", "duration_s", "seconds", "time_s", "for_s", "expiry", "until_s"), "lasting_s"),
          **dict.fromkeys(("ev", "beneficiary", "emergency_vehicle"), "serves"), "lane": "lane_number", "speed": "speed_mps"}


def no_keyword(call_name: str, unknown: str, own: Iterable[str], overrides: Iterable[str] = (), meant: str | None = None) -> InputError:
    """What is raised for a keyword that a call does not have: the one that is meant, or those that there are."""
    own, overrides = list(own), list(overrides)
    usual = _MEANT.get(unknown)
    meant = meant or (usual if usual in own or (overrides and "=" in (usual or "")) else None)
    near = f". Did you mean {repr(meant) if meant in own else meant}?" if meant else did_you_mean(unknown, [*own, *overrides], 2)
    there = f"; it has {', '.join(own)}"
    there += f", and overrides (docs/reference/study-file.md): {', '.join(overrides[:3])}, ..." if overrides else ""
    return InputError(f"{call_name}() has no keyword {unknown!r}{near or there}")


def unknown_override(call_name: str, error: InputError, given: Iterable[str], own: Iterable[str], **meant: str) -> InputError:
    """The error of a program that does not know an override, as one about the keyword of this call; another error as it is."""
    said = re.search(r"(?:is unknown|unknown key) \(allowed: ([\w, ]+)\)", str(error))
    overrides = said[1].split(", ") if said else []
    unknown = next((name for name in given if said and name not in overrides), None)
    if unknown is None or not re.search(rf"\b{re.escape(unknown)}\b", str(error)):
        return error
    return no_keyword(call_name, unknown, own, overrides, meant.get(unknown))


def keywords_of(function: Callable[..., Any]) -> list[str]:
    """Names of its arguments."""
    parameters = inspect.signature(function).parameters.values()
    return [one.name for one in parameters if one.kind is not one.VAR_KEYWORD and one.name != "self"]


def tells_keywords(call_name: str, *, cure: str = "") -> Callable[[F], F]:
    """Lets a function tell a keyword that it does not have as ``no_keyword`` does."""
    def decorate(function: F) -> F:
        known = keywords_of(function)

        @functools.wraps(function)
        def call(*words: Any, **given: Any) -> Any:
            for name in given:
                if name not in known:
                    said = str(no_keyword(call_name, name, known))
                    raise InputError(said + (cure and f"{'' if said.endswith('?') else '.'} {cure}"))
            return function(*words, **given)
        return call  # type: ignore[return-value]
    return decorate


def no_attribute(owner: str, name: str, names: Iterable[str]) -> AttributeError:
    """What is told where ``owner`` has no ``name``, but ``names`` of which those with an underscore are not for users."""
    if name.startswith("_"):
        return AttributeError(f"{owner} has no {name!r}")
    there = sorted({one for one in names if not one.startswith("_")})
    return AttributeError(f"{owner} has no {name!r}{did_you_mean(name, there, 2) or '.'} It has {', '.join(there)}")


class Told:
    """Base of what users look into: an attribute that is not there is told with the nearest, and those that are."""

    def __getattr__(self, name: str) -> Any:
        if hasattr(type(self), name):  # a property in which another attribute was missing: that one is told
            return object.__getattribute__(self, name)
        raise no_attribute(type(self).__name__, name, dir(self))

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {', '.join(sorted({one for one in dir(self) if not one.startswith('_')}))}>"


#: An option in a message of the program; in a command, between backticks, it stays.
_OPTION = re.compile(r"(`[^`]*`)|--([a-z][a-z-]*)")


def in_python(error: ClearwayError, keywords: Iterable[str]) -> ClearwayError:
    """The error of a program with the keywords of a call in place of options: ``out=`` for ``--out``."""
    known = set(keywords)

    def keyword(found: re.Match[str]) -> str:
        name = (found[2] or "").replace("-", "_")
        return f"{name}=" if name in known else found[0]
    return type(error)(_OPTION.sub(keyword, str(error)), error.exit_code)


def error_of(exit_code: int, message: str) -> ClearwayError:
    return _ERROR_OF.get(exit_code, ClearwayError)(message, exit_code)


def programs() -> Path:
    """The folder with ``clearway`` and ``clearway-run``: CLEARWAY_PROGRAMS, or that of the installation, or of this tree."""
    here = Path(__file__).resolve().parent
    places = []
    if os.environ.get("CLEARWAY_PROGRAMS"):
        places.append(Path(os.environ["CLEARWAY_PROGRAMS"]))
    else:
        installed = here / "_installed.json"
        if installed.exists():
            places.append(Path(json.loads(installed.read_text())["programs"]))
        places.append(here.parent.parent / "build" / "release" / "bin")
    for place in places:
        if os.access(place / "clearway", os.X_OK) and os.access(place / "clearway-run", os.X_OK):
            return place
    raise EnvironmentFault(
        f"Clearway's programs are not in {' or '.join(str(place) for place in places)}. Build and install them with "
        "`./clearway python` in Clearway's tree, or set CLEARWAY_PROGRAMS to their folder")


def shipped(name: str) -> Path | None:
    """A file or folder that comes with Clearway: below CLEARWAY_HOME, or beside a folder above the programs, as the programs find it."""
    home = os.environ.get("CLEARWAY_HOME")
    folders = [Path(home)] if home else [place for folder in programs().resolve().parents for place in (folder, folder / "share" / "clearway")]
    return next((folder / name for folder in folders if (folder / name).exists()), None)


def environment() -> dict[str, str]:
    """The environment for Clearway's programs: parts in Python run in this very Python."""
    values = dict(os.environ)
    values.setdefault("SUMO_HOME", "/usr/share/sumo")
    values.setdefault("CLEARWAY_PYTHON", sys.executable)
    return values


def _owned() -> list[str]:
    """Words before a command that ends it (SIGTERM) when this process is killed, so that no study goes on without it.

    The signal comes at the end of the *thread* that started the command; ``call`` waits for the command in that thread.
    """
    setpriv = shutil.which("setpriv")
    if setpriv is None:
        raise EnvironmentFault("setpriv is not in PATH (Debian: util-linux); without it, a study would continue after this process is killed")
    return [setpriv, "--pdeathsig", "TERM", "--"]


#: What a program says first when it was interrupted; how it continues on a command line follows.
_INTERRUPTED = "clearway: interrupted"


def _listen(stream: IO[str], said: collections.deque[str], progress: bool) -> None:
    with contextlib.suppress(ValueError):  # what a handler of the user's raises a second time closes the stream
        for line in stream:
            said.append(line)
            progress = progress and not line.startswith(_INTERRUPTED)  # what follows is told by what is raised
            if progress:
                sys.stderr.write(line)


def _interruption(said: Iterable[str], kept: str | Path | None) -> KeyboardInterrupt:
    """What a program said of its interruption, with how to go on in Python in place of its command."""
    told = next((line for line in said if line.startswith(_INTERRUPTED)), "")
    told = told.removeprefix("clearway: ").partition(" To continue:")[0] or "interrupted."
    if kept is None:
        return KeyboardInterrupt(f"{told} The same call starts again")
    there = "" if str(kept) in told else f" What is complete is kept in {kept}."
    return KeyboardInterrupt(f"{told}{there} The same call continues")


def command(arguments: Iterable[str]) -> list[str]:
    """``clearway ARGUMENTS``. Raises InputError for what no program can be given."""
    return [str(programs() / "clearway"), *map(without_null, arguments)]


@contextlib.contextmanager
def _running(words: list[str]) -> Iterator[tuple[subprocess.Popen[str], list[int]]]:
    """A program, and the signals of Ctrl-C that came since, each of which ends it: raised, a second one would meet the lines that tell
    the first. Where the user handles them, and outside of the main thread, that stays as it is."""
    process: subprocess.Popen[str] | None = None
    came: list[int] = []

    def note(number: int, _: Any) -> None:
        came.append(number)
        if process is not None:
            process.terminate()
    is_ours = threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if is_ours:
        signal.signal(signal.SIGINT, note)
    try:
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, env=environment(),
                              encoding="utf-8", errors="replace") as process:
            if came:
                process.terminate()
            yield process, came
    finally:
        if is_ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)


def call(arguments: Sequence[str], *, progress: bool | None = False, accept: Sequence[int] = (),
         kept: str | Path | None = None) -> tuple[int, str]:
    """Calls ``clearway ARGUMENTS``; returns exit code and standard output.

    ``progress`` passes its progress on to this process's standard error; None: if that is a terminal. Exit codes other than 0 that
    are not accepted are raised with what the program said. An interruption (Ctrl-C) ends the program, too: it closes its files and
    can continue. So does the end of this process, however it comes.
    """
    said: collections.deque[str] = collections.deque(maxlen=60)
    if progress is None:
        progress = sys.stderr is not None and sys.stderr.isatty()
    with _running([*_owned(), *command(arguments)]) as (process, came):
        assert process.stdout is not None and process.stderr is not None
        listener = threading.Thread(target=_listen, args=(process.stderr, said, progress), daemon=True)
        listener.start()
        try:
            output = process.stdout.read()
        except BaseException as error:
            process.terminate()
            listener.join()  # before its stream is closed
            if isinstance(error, KeyboardInterrupt):  # of a handler of the user's
                raise _interruption(said, kept) from None
            raise
        listener.join()
        code = process.wait()
    if came:
        raise _interruption(said, kept)
    if code != 0 and code not in accept:
        message = "".join(said).strip().removeprefix("clearway: ")
        raise error_of(code, message or f"clearway {arguments[0]} ended with {code}")
    return code, output


def call_json(arguments: Sequence[str]) -> Any:
    """The same for a verb that prints JSON."""
    return json.loads(call([*arguments, "--json"])[1])
