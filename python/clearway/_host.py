"""The process of one part in Python: `python3 -m clearway._host MEMORY READ WRITE`, started by Clearway's worker, not by hand, or
a copy of the nursery (_nursery.py).

It loads the file, makes the part and answers questions until its pipe ends. Whatever user code prints goes to the worker's log.
"""
from __future__ import annotations

import contextlib
import ctypes
import importlib.util
import inspect
import json
import math
import os
import random
import signal
import sys
import traceback
from collections.abc import Callable, Container
from pathlib import Path
from typing import Any

import numpy as np

from . import _files, _program
from ._channel import ANSWER, DECIDE, FAILED, LOST, Channel, Sheet
from .parts import Belief, Network, Observation, Policy, Predictor, checked_leases, checked_probabilities
from .torchscript import TorchScript, Unusable

METHODS = {"policy": "act", "predictor": "predict"}
PR_SET_CHILD_SUBREAPER = 36


class NoClass(AttributeError):
    """The file has no class of this name. The message says all, so no traceback is shown."""


class SettingError(ValueError):
    """Settings do not fit the class. The message says all, so no traceback is shown."""


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
    if not settings:
        return {}
    parameters = inspect.signature(kind).parameters
    defaults = {name: one.default for name, one in parameters.items() if type(one.default) in (bool, int, float, str)}
    for name in settings:
        if name not in defaults:
            there = ", ".join(f"{one}={default!r}" for one, default in defaults.items())
            raise SettingError(f"{kind.__name__}.{name} is unknown (allowed: arguments of __init__ that have a default: {there or 'none'})")
    return {name: _value(f"{kind.__name__}.{name}", text, defaults[name]) for name, text in settings.items()}


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
    return kind(**keyword_arguments(kind, settings))


def make_part(greeting: dict[str, Any]) -> Any:
    part = load(Path(greeting["file"]), greeting["object"], greeting["settings"])
    method = METHODS[greeting["kind"]]
    bases = (Policy.act, Predictor.predict)  # of which nothing is meant to remain
    if not callable(getattr(part, method, None)) or getattr(type(part), method, None) in bases:
        raise TypeError(f"{type(part).__name__} has no method {method}(), which a {greeting['kind']} needs")
    return part


def answer_policy(part: Any, network: Network, channel: Channel, greeting: dict[str, Any]) -> Callable[[], None]:
    sheet = Sheet(channel.incoming, greeting["question"])
    part.network, part.period_s = network, greeting["period_s"]

    def answer() -> None:
        channel.write_text(json.dumps(checked_leases(part.act(Belief(sheet, network))), allow_nan=False))
    return answer


def answer_predictor(part: Any, network: Network, channel: Channel, greeting: dict[str, Any]) -> Callable[[], None]:
    question, answers = Sheet(channel.incoming, greeting["question"]), Sheet(channel.outgoing, greeting["answer"])
    part.network = network

    def answer() -> None:
        observation = Observation(question, network, greeting["link_radius_m"])
        answers.write("probability", checked_probabilities(part.predict(observation), len(question["pair_left"])))
    return answer


def serve(channel: Channel) -> None:
    if channel.wait() == b"":
        return
    greeting = json.loads(channel.read_text())
    os.environ[_program.PART_VARIABLE] = f"{greeting['file']}:{greeting['object']}"
    part = make_part(greeting)
    answer: Callable[[], None] = lambda: None  # noqa: E731: only checked, never asked
    if greeting["network"] is not None:
        make = answer_policy if greeting["kind"] == "policy" else answer_predictor
        answer = make(part, Network(greeting["network"]), channel, greeting)
    channel.ring(ANSWER)
    while channel.wait() == DECIDE:
        answer()
        channel.ring(ANSWER)


def report(channel: Channel, error: BaseException) -> None:
    try:
        text = told(error)
    except MemoryError:
        text = type(error).__name__
    channel.write_text(text)
    channel.ring(LOST if _files.is_of_machine(error) else FAILED)


def told(error: BaseException) -> str:
    """What was raised, because a console may show no more than the first line, and its traceback from user code on."""
    own = str(Path(__file__).parent)
    trace = error.__traceback__
    while trace is not None and trace.tb_frame.f_code.co_filename.startswith((own, "<frozen importlib")):
        trace = trace.tb_next
    cause = traceback.format_exception_only(error)[-1].strip()
    text = "".join(traceback.format_exception(type(error), error, trace or error.__traceback__)).strip()
    return f"{cause[:1000]}{line_of(trace)}\n{text[-100_000:]}"


def line_of(trace: Any) -> str:
    """The last line of the file of the part that was reached, as ` (FILE.py, line 12)`."""
    frames = traceback.extract_tb(trace) if trace else []
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
    except (NoClass, SettingError, Unusable, _program.LoadedAgain) as error:
        channel.write_text(str(error))
        channel.ring(FAILED)
    except BaseException as error:  # noqa: BLE001: even sys.exit() in user code is this run's failure
        report(channel, error)
    end_group()


if __name__ == "__main__":
    be_part(*map(int, sys.argv[1:4]), os.getppid())
