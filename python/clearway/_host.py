"""The process of one part in Python: `python3 -m clearway._host MEMORY READ WRITE`, started by Clearway's worker, not by hand, or
a copy of the nursery (_nursery.py).

It loads the file, makes the part and answers questions until its pipe ends. Whatever user code prints goes to the worker's log.
"""
from __future__ import annotations

import bdb
import contextlib
import ctypes
import importlib.util
import inspect
import io
import json
import math
import os
import random
import signal
import sys
import sysconfig
import traceback
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from . import _files, _program
from ._channel import ANSWER, DECIDE, FAILED, LOST, Channel, Sheet
from .parts import Belief, Network, Observation, Policy, Predictor, checked_leases, checked_probabilities
from .torchscript import TorchScript, Unusable

METHODS = {"policy": "act", "predictor": "predict"}
#: What each method is given.
GIVEN = {"act": "belief", "predict": "observation"}
#: In which a part answers, s of wall time. A loop without end is told, with its place, and not waited for until the run's own limit.
ANSWER_LIMIT_S = 60.0
PR_SET_CHILD_SUBREAPER = 36
NO_TERMINAL = (": a part runs in a process of its own, without a terminal, where no debugger can ask. print(belief) there goes to the run's "
               "log; step through clearway.env, whose loop is in your own process")


#: Types of defaults that make an argument of ``__init__`` a setting.
SETTING_TYPES = (bool, int, float, str)


class NoClass(AttributeError):
    """The file has no class of this name, or the class no such method, or one that cannot be called as a run does. The message says all,
    so no traceback is shown."""


class SettingError(ValueError):
    """Settings do not fit the class. The message says all, so no traceback is shown."""


class WrongAnswer(ValueError):
    """What a method returned. No line of user code is running any more: the message says which method, and no traceback is shown."""


class Printed(io.TextIOWrapper):
    """What user code prints, each line with the part's name and `| `: by that a log's other lines are told apart
    (src/campaign/stored_folder.cpp)."""

    def __init__(self, part: str) -> None:
        super().__init__(open(2, "wb", closefd=False), encoding="utf-8", errors="replace", line_buffering=True)  # noqa: SIM115
        self._mark, self._begins = f"{part}| ", True

    def write(self, text: str) -> int:
        if text:
            super().write(self._mark * self._begins + text[:-1].replace("\n", "\n" + self._mark) + text[-1])
            self._begins = text.endswith("\n")
        return len(text)


def _value(setting: str, text: str, default: Any) -> Any:
    """The text of a setting as a value of its default's type."""
    kind = type(default)
    try:
        if kind is bool:
            return {"true": True, "false": False}[text]
        value = kind(text)
        if kind is float and not math.isfinite(value):
            raise ValueError(text)
        return value
    except (KeyError, ValueError):
        allowed = {bool: "true, false", int: "a whole number", float: "a finite number"}[kind]
        raise SettingError(f"{setting} is {text!r} (allowed: {allowed}, as its default {default!r})") from None


def keyword_arguments(kind: type, settings: dict[str, str]) -> dict[str, Any]:
    """Settings as arguments of a class: those whose default is a truth value, a number or a text can be set."""
    try:
        parameters = inspect.signature(kind).parameters
    except (TypeError, ValueError):  # of a class that is written in C, or that says something else
        parameters = {}
    needed = [name for name, one in parameters.items() if one.default is one.empty and one.kind not in (one.VAR_POSITIONAL, one.VAR_KEYWORD)]
    if needed:
        raise SettingError(f"{place_of(kind, '__init__')}: {', '.join(needed)} of __init__ has no default (allowed: arguments with one, "
                           "because a run makes the part without any)")
    defaults = {name: one.default for name, one in parameters.items() if type(one.default) in SETTING_TYPES}
    for name in settings:
        if name not in defaults:
            raise SettingError(f"{kind.__name__}.{name} {_why_no_setting(name, parameters, defaults)}")
    return {name: _value(f"{kind.__name__}.{name}", text, defaults[name]) for name, text in settings.items()}


def _why_no_setting(name: str, parameters: Mapping[str, inspect.Parameter], defaults: dict[str, Any]) -> str:
    one = parameters.get(name)
    there = ", ".join(f"{setting}={default!r}" for setting, default in defaults.items()) or "none"
    if one is not None and one.default is not one.empty:
        return (f"cannot be set: its default is {one.default!r} (allowed: arguments of __init__ whose default is a number, a truth value "
                f"or a text: {there}). Give each number an argument of its own, or take a text and split it")
    return f"is unknown (allowed: arguments of __init__ that have a default: {there}){_program.did_you_mean(name, defaults)}"


def load(file: Path, name: str, settings: dict[str, str]) -> Any:
    """Makes the object that a part is named by."""
    if not name:
        if settings:
            raise SettingError(f"{file.stem}.{next(iter(settings))} is unknown: a TorchScript module has no settings of its own")
        return TorchScript(str(file))
    sys.path.insert(0, str(file.parent))  # so that it can import its neighbours
    spec = importlib.util.spec_from_file_location(file.stem, file)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    kind = getattr(module, name, None)
    if not isinstance(kind, type):
        classes = [word for word, value in vars(module).items() if isinstance(value, type) and value.__module__ == file.stem]
        raise NoClass(f"{file} has no class {name!r}; it has {', '.join(classes) or 'none'}{_program.did_you_mean(name, classes)}")
    arguments = keyword_arguments(kind, settings)
    if not arguments:
        require_signature(kind, "__init__", ())
    return kind(**arguments)


def require_signature(kind: type, method: str, given: tuple[str, ...]) -> None:
    """Raises NoClass where a function of a class that is written in Python does not take what it is called with."""
    function = inspect.getattr_static(kind, method, None)
    if not inspect.isfunction(function) or hasattr(function, "__wrapped__"):
        return
    own = inspect.signature(function)
    try:
        own.bind("self", *given)
    except TypeError:
        wanted = ", ".join(["self", *given])
        raise NoClass(f"{place_of(kind, method)}: def {method}{own} (allowed: def {method}({wanted}))") from None


def make_part(greeting: dict[str, Any]) -> Any:
    part = load(Path(greeting["file"]), greeting["object"], greeting["settings"])
    method = METHODS[greeting["kind"]]
    bases = (Policy.act, Predictor.predict)  # of which nothing is meant to remain
    if not callable(getattr(part, method, None)) or getattr(type(part), method, None) in bases:
        own = [name for name in dir(part) if callable(getattr(type(part), name, None)) and not name.startswith("_") and name != method]
        raise NoClass(f"{type(part).__name__} has no method {method}(), which a {greeting['kind']} needs{_program.did_you_mean(method, own)}")
    require_signature(type(part), method, (GIVEN[method],))
    return part


def place_of(kind: type, method: str) -> str:
    """`my_policy.py, line 4, Green.act`: where a method is written, as far as that can be seen."""
    name = f"{kind.__name__}.{method}"
    try:
        code = inspect.unwrap(getattr(kind, method)).__code__
        return f"{Path(code.co_filename).name}, line {code.co_firstlineno}, {name}"
    except (AttributeError, ValueError):  # a callable of another kind
        return name


@contextlib.contextmanager
def answer_of(part: Any, method: str) -> Iterator[None]:
    """Tells what is wrong with an answer with the method that gave it. What user code raises while it is read passes."""
    try:
        yield
    except (TypeError, ValueError) as error:
        if frames_of_part(traceback.extract_tb(error.__traceback__)):
            raise
        raise WrongAnswer(f"{type(error).__name__}: {error} ({place_of(type(part), method)})") from None


@contextlib.contextmanager
def in_time(limit_s: float) -> Iterator[None]:
    """Raises TimeoutError where user code is when the limit is over. Library code in C is not interrupted."""
    def end(*_: Any) -> None:
        raise TimeoutError(f"no answer after {limit_s:g} s")
    signal.signal(signal.SIGALRM, end)
    signal.setitimer(signal.ITIMER_REAL, limit_s)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def answer_policy(part: Any, network: Network, channel: Channel, greeting: dict[str, Any]) -> Callable[[], None]:
    sheet = Sheet(channel.incoming, greeting["question"])
    part.network, part.period_s = network, greeting["period_s"]

    def answer() -> None:
        belief = Belief(sheet, network)
        leases = part.act(belief)
        with answer_of(part, "act"):
            channel.write_text(json.dumps(checked_leases(leases), allow_nan=False))
        belief._end()
    return answer


def answer_predictor(part: Any, network: Network, channel: Channel, greeting: dict[str, Any]) -> Callable[[], None]:
    question, answers = Sheet(channel.incoming, greeting["question"]), Sheet(channel.outgoing, greeting["answer"])
    part.network = network

    def answer() -> None:
        observation = Observation(question, network, greeting["link_radius_m"])
        probabilities = part.predict(observation)
        with answer_of(part, "predict"):
            answers.write("probability", checked_probabilities(probabilities, len(question["pair_left"])))
        observation._end()
    return answer


def serve(channel: Channel) -> None:
    if channel.wait() == b"":
        return
    greeting = json.loads(channel.read_text())
    os.environ[_program.PART_VARIABLE] = f"{greeting['file']}:{greeting['object']}"
    sys.stdout = sys.stderr = Printed(greeting["object"] or Path(greeting["file"]).stem)
    part = make_part(greeting)
    answer: Callable[[], None] = lambda: None  # noqa: E731: only checked, never asked
    if greeting["network"] is not None:
        make = answer_policy if greeting["kind"] == "policy" else answer_predictor
        answer = make(part, Network(greeting["network"]), channel, greeting)
    channel.ring(ANSWER)
    while channel.wait() == DECIDE:
        with in_time(greeting.get("answer_limit_s", ANSWER_LIMIT_S)):
            answer()
        channel.ring(ANSWER)


def report(channel: Channel, error: BaseException) -> None:
    try:
        text = told(error)
    except MemoryError:
        text = type(error).__name__
    channel.write_text(text)
    channel.ring(LOST if _files.is_of_machine(error) else FAILED)


def frames_of_part(frames: Iterable[traceback.FrameSummary]) -> list[traceback.FrameSummary]:
    """These without those of this package and of what dataclasses generates, which tell nobody what to change. Where the part called a
    library, its own frames are enough."""
    own = (str(Path(__file__).parent) + os.sep, "<frozen importlib", "<frozen runpy")
    others = [frame for frame in frames if not frame.filename.startswith(own) and (frame.filename, frame.name) != ("<string>", "__init__")]
    return [frame for frame in others if not is_of_library(frame.filename)] or others


def is_of_library(file: str) -> bool:
    return file.startswith(sysconfig.get_path("stdlib") + os.sep) or any(f"/{name}/" in file for name in ("site-packages", "dist-packages"))


def told(error: BaseException) -> str:
    """What was raised and the frames of user code on the way there. A console may show no more than the first line and the last, which
    is the line of code.

    Errors that were caught before follow in full. Where no user code ran, this package is at fault, and its frames are shown.
    """
    frames = frames_of_part(traceback.extract_tb(error.__traceback__))
    only = traceback.format_exception_only(error)
    notes = "\n".join(map(str, getattr(error, "__notes__", ()))).splitlines()
    cause = only.pop(-1 - len(notes))  # of a syntax error, its place stands before
    place = line_of(frames)
    if isinstance(error, SyntaxError) and error.filename and not frames:
        place = f" ({Path(error.filename).name}, line {error.lineno})"
    is_chained = error.__cause__ or (error.__context__ and not error.__suppress_context__)
    if place and not is_chained and len(cause) <= 1000:
        without_marks = [(frame.filename, frame.lineno, frame.name, frame.line) for frame in frames]
        text = "".join([*["Traceback (most recent call last):\n"][:len(frames)], *traceback.format_list(without_marks), *only])
    else:
        text = in_full(error)
    first, _, others = cause.strip()[:1000].partition("\n")
    first += NO_TERMINAL if isinstance(error, bdb.BdbQuit) else ""
    return "\n".join([first + place, *filter(None, [others, text.rstrip()[-100_000:]])])


def in_full(error: BaseException) -> str:
    """As Python prints it, with the errors before it, of each the frames of user code if there are any."""
    whole = traceback.TracebackException.from_exception(error)
    waiting = [whole]
    while waiting:
        one = waiting.pop()
        one.stack = traceback.StackSummary.from_list(frames_of_part(one.stack) or one.stack)
        waiting += [before for before in (one.__cause__, one.__context__) if before is not None]
    return "".join(whole.format())


def line_of(frames: list[traceback.FrameSummary]) -> str:
    """The last line of the file of the part that was reached, as ` (FILE.py, line 12)`."""
    if not frames:
        return ""
    last = [frame for frame in frames if frame.filename == frames[0].filename][-1]
    return f" ({Path(last.filename).name}, line {last.lineno})"


def kill_group(process: int) -> None:
    for kill in (os.killpg, os.kill):  # it may not have a group yet
        with contextlib.suppress(ProcessLookupError, PermissionError):
            kill(process, signal.SIGKILL)


def children_of(parent: int) -> list[int]:
    children = []
    for name in os.listdir("/proc"):
        if name.isdigit():
            with contextlib.suppress(OSError), open(f"/proc/{name}/stat", "rb") as stat:
                if int(stat.read().rpartition(b")")[2].split()[1]) == parent:
                    children.append(int(name))
    return children


def end_children(but: Container[int] = ()) -> None:
    """Kills the children of this process, also those in groups and sessions of their own, and, because the system makes them
    children of a process with PR_SET_CHILD_SUBREAPER, theirs."""
    with contextlib.suppress(OSError):  # /proc may be unreadable
        while children := [process for process in children_of(os.getpid()) if process not in but]:
            for process in children:
                kill_group(process)
            for process in children:
                with contextlib.suppress(ChildProcessError):  # another thread has waited for it
                    os.waitpid(process, 0)


def end_group(*_: Any) -> None:
    """Ends this process and all that user code has started."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(Exception):
            stream.flush()
    end_children()
    os.killpg(0, signal.SIGKILL)


def be_part(memory: int, read: int, write: int, owner: int) -> None:
    """All that this process does from now on, for the process `owner`. Never returns."""
    os.setpgid(0, 0)
    with contextlib.suppress(OSError):  # its memory counts as that of its run, which finds it by this name (src/loop/watch.cpp)
        Path("/proc/self/comm").write_text(f"part-{owner}", encoding="ascii")
    signal.signal(signal.SIGTERM, end_group)
    for descriptor in (memory, read, write):
        os.set_inheritable(descriptor, False)  # what user code starts must not hold the pipes open
    os.dup2(2, 1)  # standard output belongs to the program that started this process
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)  # what it starts stays below it, and below the nursery when it ends
    random.seed(0)  # who draws without a seed of their own gets the same numbers in every run, so that a run can be made again
    np.random.seed(0)
    try:
        channel = Channel(memory, read, write)
    except OSError:  # no memory to share; to be killed is what the machine does
        end_group()
    try:
        serve(channel)
    except (NoClass, SettingError, WrongAnswer, Unusable, _program.LoadedAgain) as error:
        channel.write_text(str(error))
        channel.ring(FAILED)
    except BaseException as error:  # noqa: BLE001: even sys.exit() in user code is this run's failure
        report(channel, error)
    end_group()


if __name__ == "__main__":
    sys.path.append(os.getcwd())
    be_part(*map(int, sys.argv[1:4]), os.getppid())
