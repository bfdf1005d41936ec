"""Scores of link prediction: ``clearway.links.evaluate`` measures what ``clearway links evaluate`` does.

    scores = clearway.links.evaluate("intersection", ["my_net.py:Mine", "dead_reckoning"], failures=["B10"], seeds=10)
    scores.results[["predictor", "failure", "exits", "ap", "f1"]]
    scores.gains.where(predictor="Mine")["ap_difference"]

docs/reference/link-prediction.md says what is measured, and on what.
"""
from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from . import _files, _program
from .results import MOST_SEEDS, table_of
from .running import Part, part_name
from .tables import Table

#: Of the keywords of ``evaluate``, options that a value follows.
_OPTIONS = {"benchmark": "--benchmark", "exits": "--exits", "against": "--against", "split": "--split", "seed": "--seed",
            "link_radius_m": "--link-radius", "jobs": "--jobs"}


class LinkScores(_program.Told):
    """What ``clearway.links.evaluate`` measured. Columns are those of ``clearway links evaluate --json``.

    * ``results``: a row for each scenario, failure, rule of exits and predictor: ``ap``, ``f1``, ``place_error_median_m``, ... and their
      95 % intervals over seeds (``ap_low_95``, ``ap_high_95``), NaN with too few;
    * ``gains``: differences from the predictor ``against``, over all scenarios; ``comparisons``: those that a benchmark names;
    * ``seeds``: the replications, in words; ``folder``: of the runs, with ``links.html`` and ``evaluation.csv``.
    """

    def __init__(self, folder: Path, measured: Mapping[str, Any]) -> None:
        self.folder = folder
        self.against: str = measured["against"]
        self.seeds: str = measured["seeds"]
        self.results: Table = table_of(measured["results"])
        self.gains: Table = table_of(measured["gains"])
        self.comparisons: Table = table_of(measured.get("comparisons", []))

    def __fspath__(self) -> str:
        """Wherever a path is taken, they stand for their folder."""
        return str(self.folder)

    def __repr__(self) -> str:
        return f"{self.results[['scenario', 'failure', 'exits', 'predictor', 'ap', 'f1']]!r}\n<LinkScores in {self.folder}: {self.seeds}>"


def evaluate(scenarios: str | Path | Sequence[str | Path] = (), predictors: Part | Sequence[Part] = (), *,
             failures: str | Sequence[str] = (), benchmark: str | Path | None = None, seeds: int | range | None = None,
             validation_seeds: int | range | None = None, seed: int | None = None, quick: bool = False, split: str | None = None,
             exits: str | None = None, against: Part | None = None, set: Mapping[str, Any] | None = None,
             models: Mapping[str, str | Path] | None = None, link_radius_m: float | None = None, automated_links: bool = False,
             out: str | Path | None = None, jobs: int = 0, progress: bool | None = None, **overrides: Any) -> LinkScores:
    """Scores predictors by their links, on seeds kept for this purpose; what is None is as ``clearway links evaluate`` has it.

    ``predictors`` are names of ``clearway list``, classes, ``FILE.py:Class`` or ``FILE.pt``. ``seeds`` and ``validation_seeds`` (on
    which F1 thresholds are chosen) are numbers of replications, or ``range(20, 30)``; tune settings on ``split="validation"``. A
    ``benchmark`` brings scenarios, failures and seeds of its own. ``set`` holds settings (``{"kalman.link_threshold": 0.4}``),
    ``models`` files by predictor, ``overrides`` are those of ``clearway.run``. Runs that ``out`` holds are not repeated. ``progress`` is
    that of ``clearway.run``.
    """
    _program.require_first_load("clearway.links.evaluate")
    benchmark = None if benchmark is None else _files.path_of("benchmark", benchmark)
    given = dict(benchmark=benchmark, exits=exits, against=None if against is None else part_name(against), split=split, seed=seed,
                 link_radius_m=link_radius_m, jobs=jobs or None)
    words = ["links", "evaluate", *(_scenario(one) for one in _several(scenarios))]
    words += [word for name, value in given.items() if value is not None for word in (_OPTIONS[name], str(value))]
    words += _seeds("seeds", "seed", seeds) + _seeds("validation_seeds", "validation-seed", validation_seeds)
    words += _listed("--predictor", map(part_name, _several(predictors))) + _listed("--failure", map(str, _several(failures)))
    words += _listed("--set", (f"{name}={value}" for name, value in (set or {}).items()))
    words += _listed("--model", (f"{name}={_files.path_of('models', file).resolve()}" for name, file in (models or {}).items()))
    words += _listed("--override", (f"{name}={value}" for name, value in overrides.items()))
    words += ["--quick"] * quick + ["--automated-links"] * automated_links
    out = _files.path_of("out", out or Path("runs") / (benchmark.stem if benchmark else "links"))
    try:
        _, said = _program.call([*words, "--out", str(out), "--json"], progress=progress, kept=out)
    except _program.ClearwayError as error:
        error = _program.in_python(error, _program.keywords_of(evaluate))
        raise _program.unknown_override("clearway.links.evaluate", error, overrides, _program.keywords_of(evaluate)) from None
    return LinkScores(out, json.loads(said))


def _several(given: Any) -> list[Any]:
    return list(given) if isinstance(given, Iterable) and not isinstance(given, (str, type, Path)) else [given]


def _listed(option: str, words: Iterable[str]) -> list[str]:
    words = list(words)
    return [option, *words] if words else []


def _scenario(given: Any) -> str:
    place = _files.path_of("scenarios", given)
    return str(place.resolve()) if os.path.exists(place) else str(given)


def _seeds(keyword: str, option: str, given: int | range | None) -> list[str]:
    if given is None:
        return []
    first, count = 0, given
    if isinstance(given, range):
        if given.step != 1:
            raise _program.InputError(f"{keyword}: {given!r} (allowed: a number, or a range without gaps)")
        first, count = given.start, len(given)
    _program.require_whole(keyword, count, 0, MOST_SEEDS)
    return [f"--{option}s", str(count)] + ([f"--first-{option}", str(first)] if isinstance(given, range) else [])
