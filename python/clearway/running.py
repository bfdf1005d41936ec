"""Runs and studies."""
from __future__ import annotations

import dataclasses
import inspect
import json
import os
import re
import tempfile
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np

from . import _files, _program
from .results import MOST_SEEDS, Results

#: A name of ``clearway list``, ``FILE.py:Class``, or a class that is written in a file.
Part = Union[str, type]


@dataclasses.dataclass
class Condition(_program.Told):
    """A condition of one's own. Names are those of ``clearway list``; parts in Python are classes or ``FILE.py:Class``.

    ``name``; ``policy``, one or several; ``failure``; ``predictor``; ``set``, settings that differ from their defaults:
    ``{"preempt_signals.lead_s": 12}`` (``clearway list settings``); ``model``, a file for a learned predictor: of ``clearway links
    train``, or a ``.pth`` of the dissertation's net; ``title``, what tables and figures call it. The others are keys of a condition in a study file
    (docs/reference/study-file.md), or None for their default: ``dispatch``, ``traffic_model``, ``bluelight``, ``safety_checks``,
    ``rerouting_s``, ``rerouting_signal_penalty``.
    """

    name: str
    policy: Part | Sequence[Part] = ()
    failure: str = "perfect"
    predictor: Part = "none"
    set: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    model: str | Path | None = None
    title: str | None = None
    dispatch: str | None = None
    traffic_model: str | None = None
    bluelight: bool | None = None
    safety_checks: bool | None = None
    rerouting_s: float | None = None
    rerouting_signal_penalty: float | None = None


Condition.__init__ = _program.tells_keywords("clearway.Condition")(Condition.__init__)  # type: ignore[method-assign]

#: Those that go into a study file as they are.
_PLAIN_KEYS = ("dispatch", "traffic_model", "bluelight", "safety_checks", "rerouting_s", "rerouting_signal_penalty")


def part_name(part: Part) -> str:
    """``FILE.py:Class`` of a class, absolute; names stay as they are, files become absolute."""
    if isinstance(part, type):
        try:
            file = inspect.getsourcefile(part)
        except (TypeError, OSError):  # built in; or of `-c`, of a notebook's cell, of the prompt
            file = None
        if file is None or not Path(file).exists() or "." in part.__qualname__:
            raise _program.InputError(f"{part.__qualname__} is not at the top of a file: a run loads it in a process of its own, so "
                                      "write it into a file (in a notebook: %%writefile my_policy.py) and name it "
                                      f"my_policy.py:{part.__name__}")
        return f"{Path(file).resolve()}:{part.__qualname__}"
    if not isinstance(part, (str, Path)) or "\0" in str(part):
        raise _program.InputError(f"a policy or predictor is {part!r} (allowed: a name of `clearway list`, FILE.py:Class, or a class)")
    file, colon, name = str(part).rpartition(":")
    if file.endswith(".py") or str(part).endswith((".pt", ".pth")):
        return f"{Path(file).resolve()}{colon}{name}" if colon else str(Path(part).resolve())
    return str(part)


def policy_names(policy: Part | Sequence[Part]) -> list[str]:
    """Names of one policy or of several."""
    several = isinstance(policy, Iterable) and not isinstance(policy, (str, type))
    return [part_name(one) for one in (policy if several else [policy])]


def run(scenario: str | Path, conditions: Sequence[str | Condition] = ("corridor",), seeds: int | range = 10, *, seed: int = 1,
        out: str | Path | None = None, jobs: int = 0, record: bool = False, baseline: bool = True, progress: bool | None = None,
        run_time_limit: float | None = None, memory_limit: int | None = None, **overrides: Any) -> Results:
    """Runs a scenario under conditions over paired seeds and opens the results.

    ``conditions`` are names of ``clearway list`` or ``Condition``; ``baseline`` adds the one that they are compared with. ``seeds``
    is the number of replications, from 0 on: 10, or ``range(10)``. ``overrides`` are those of a study file: ``variant="dense"``,
    ``step_length_s=0.1``, ... ``out`` is the run folder; without it, one below ``runs/`` that follows from what is run, code
    included, as the command ``clearway run`` names it: edited code gets a new one. ``progress``: on standard error; None: if that is
    a terminal. Runs that are there already are not repeated; one that takes longer than ``run_time_limit``, s, or more than
    ``memory_limit``, MiB, is ended (None: as ``clearway run``). Runs that failed are a warning, and rows of ``results.errors``.
    """
    _program.require_first_load("clearway.run")
    if isinstance(conditions, (str, Condition)):
        conditions = [conditions]
    if not isinstance(conditions, Iterable):
        raise _program.InputError(f"conditions: {conditions!r} is neither a name nor a clearway.Condition, nor a list of them")
    conditions = list(conditions)
    names = [condition for condition in conditions if isinstance(condition, str)]
    if baseline and "baseline" not in names:
        names.insert(0, "baseline")
    own = [condition for condition in conditions if not isinstance(condition, str)]
    wrong = [condition for condition in own if not isinstance(condition, Condition)]
    if wrong:
        raise _program.InputError(f"conditions: {wrong[0]!r} is neither a name nor a clearway.Condition")
    if not isinstance(scenario, (str, Path)) or not str(scenario):
        raise _program.InputError(f"scenario is {scenario!r} (allowed: a name of `clearway list`, a folder or a file)")
    incident = overrides.get("incident", "none")
    if not isinstance(incident, str):
        raise _program.InputError(f"incident is {incident!r} (allowed: a text such as 'edge=B1C1,from_s=100', several separated by "
                                  "semicolons, or 'none')")
    seeds = _seed_count(seeds)
    _program.require_whole("seed", seed, 0, 2**63 - 1)
    place = _files.path_of("scenario", scenario)
    scenario_word = str(place.resolve()) if os.path.exists(place) else str(scenario)
    text = _study_text(scenario_word, place.stem, names, own, seeds, seed, overrides)
    with tempfile.TemporaryDirectory(prefix="clearway-") as folder:
        file = Path(folder) / "study.toml"
        file.write_text(text + _titles_text(own), encoding="utf-8")  # other titles are no other study
        try:
            if out is None:
                out = _folder_of(file, re.sub(r"[^A-Za-z0-9_-]+", "-", place.stem))
            return study(file, out=out, jobs=jobs, record=record, progress=progress, run_time_limit=run_time_limit,
                         memory_limit=memory_limit)
        except _program.ClearwayError as error:
            # Nobody wrote that file, and it is gone: its name and lines tell nothing.
            said = re.sub(re.escape(str(file)) + r"(:\d+)*: ", "", str(error))
            of_condition = {key.name: f"conditions=[clearway.Condition(NAME, {key.name}=...)]" for key in dataclasses.fields(Condition)}
            error = _program.in_python(type(error)(said, error.exit_code), _program.keywords_of(run))
            raise _program.unknown_override("clearway.run", error, overrides, _program.keywords_of(run),
                                            **of_condition) from None


def _folder_of(study: Path, name: str) -> Path:
    """``runs/NAME-xxxxxx``, a hash of what is run, wherever the user's files are: as ``clearway run`` names it."""
    plan = _program.call_json(["study", str(study), "--dry-run", "--out", str(study.with_name("none"))])
    return Path("runs") / f"{name}-{plan['study_hash'][:6]}"


def _seed_count(seeds: Any) -> int:
    if isinstance(seeds, range) and seeds == range(len(seeds)):
        seeds = len(seeds)
    try:
        _program.require_whole("seeds", seeds, 1, MOST_SEEDS)
    except _program.InputError as error:
        several = isinstance(seeds, Iterable) and not isinstance(seeds, str)
        cure = ", or range(N): a run takes the replications from 0 on; clearway.env takes chosen ones" if several else ""
        raise _program.InputError(str(error).removesuffix(")") + cure + ")") from None
    return int(seeds)


@_program.tells_keywords("clearway.study", cure="The file says what is run, and how often")
def study(file: str | Path, *, out: str | Path | None = None, jobs: int = 0, record: bool = False, quick: bool = False,
          progress: bool | None = None, run_time_limit: float | None = None, memory_limit: int | None = None) -> Results:
    """Runs a study file (docs/reference/study-file.md), or what of it is missing, and opens the results. Limits are those of ``run``."""
    _program.require_first_load("clearway.study")
    file = _files.path_of("file", file)
    words = ["study", str(file), "--json"]
    if out is None:
        out = Path("runs") / (_study_name(file) + ("-quick" if quick else ""))
    out = _files.path_of("out", out)
    words += ["--out", str(out)]
    words += ["--jobs", str(jobs)] if jobs else []
    words += ["--record"] if record else []
    words += ["--quick"] if quick else []
    words += [] if run_time_limit is None else ["--run-time-limit", str(run_time_limit)]
    words += [] if memory_limit is None else ["--memory-limit", str(memory_limit)]
    try:
        code, _ = _program.call(words, progress=progress, accept=(_program.RUNS_FAILED,), kept=out)
    except _program.ClearwayError as error:
        raise _program.in_python(error, _STUDY_KEYWORDS) from None
    results = Results(out)
    if code == _program.RUNS_FAILED:
        _program.warn(_failures_of(results))
    return results


def _failures_of(results: Results) -> str:
    """How many runs failed, and by what most of them did."""
    errors = results.errors
    causes = zip(errors["condition"].tolist(), (message.partition("\n")[0] for message in errors["message"].tolist()))
    (condition, message), count = Counter(causes).most_common(1)[0]
    of_all = sum(int((table["condition"] == condition).sum()) for table in (errors, results.runs))
    return (f"{_program.counted(errors.row_count, 'run')} failed; {condition} in {count} of {of_all} runs: {message}; see `errors` of these "
            "results")


_STUDY_KEYWORDS = _program.keywords_of(study)


def _study_name(file: Path) -> str:
    content = _files.content(file, "A study file is TOML, docs/reference/study-file.md")
    try:
        text = content.decode()
    except UnicodeDecodeError as error:
        raise _program.InputError(f"{file}: is not UTF-8 text (byte {error.start}). A study file is TOML, docs/reference/study-file.md"
                                  ) from None
    import tomllib
    try:
        return str(tomllib.loads(text).get("name", file.stem))
    except tomllib.TOMLDecodeError:
        return file.stem  # the program says what is wrong, with line and column


def _toml(value: Any) -> str:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, (str, Path)):
        return json.dumps(_program.without_null(str(value)), ensure_ascii=False)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(one) for one in value) + "]"
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(str(key))} = {_toml(one)}" for key, one in value.items()) + " }"
    if not isinstance(value, (int, float)):
        raise _program.InputError(f"{value!r} cannot be part of a study (allowed: numbers, truth values, texts, lists and dictionaries)")
    return repr(value)


def _titles_text(own: list[Condition]) -> str:
    titles = [f"{json.dumps(condition.name)} = {_toml(condition.title)}" for condition in own if condition.title is not None]
    return "\n".join(["[titles]", *titles, ""]) if titles else ""


def _study_text(scenario: str, name: str, names: list[str], own: list[Condition], seeds: int, seed: int,
                overrides: Mapping[str, Any]) -> str:
    lines = [f"name = {_toml(name)}", f"seed = {_toml(seed)}", f"replications = {_toml(seeds)}",
             f"scenarios = [{_toml(scenario)}]", f"conditions = {_toml(names)}"]
    if overrides:
        lines += ["[overrides]", *(f"{json.dumps(key)} = {_toml(value)}" for key, value in overrides.items())]
    for condition in own:
        if not isinstance(condition.set, Mapping):
            raise _program.InputError(f"condition {condition.name}: set is {condition.set!r} (allowed: a dictionary of settings)")
        for setting, value in condition.set.items():
            if not isinstance(value, (bool, int, float, str, np.generic)):
                raise _program.InputError(f"condition {condition.name}: set: {setting} is {value!r} (allowed: a number, a truth value or a "
                                          "text)")
        lines += ["[[condition]]", f"name = {_toml(condition.name)}", f"failure = {_toml(condition.failure)}",
                  f"predictor = {_toml(part_name(condition.predictor))}",
                  f"policy = {_toml(policy_names(condition.policy))}"]
        if condition.set:
            lines.append(f"set = {_toml(dict(condition.set))}")
        if condition.model is not None:
            model = _files.path_of(f"condition {condition.name}: model", condition.model)
            lines.append(f"model = {_toml(model.resolve())}")
        for key in _PLAIN_KEYS:
            value = getattr(condition, key)
            if value is not None:
                lines.append(f"{key} = {_toml({True: 'on', False: 'off'}[value] if isinstance(value, bool) else value)}")
    return "\n".join(lines) + "\n"
