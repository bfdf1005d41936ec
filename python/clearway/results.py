"""What stands in a run folder: tables, paired differences, recordings."""
from __future__ import annotations

import dataclasses
import errno
import html
import sqlite3
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _files, _program
from ._conditions import Conditions, Given
from .tables import Table

if TYPE_CHECKING:
    from .recording import Recording

#: What verdicts judge.
PRIMARY_METRIC = "emergency_restricted_travel_time_s"
#: Replications of a study.
MOST_SEEDS = 100000
_SQLITE_OF_MACHINE = {sqlite3.SQLITE_IOERR: errno.EIO, sqlite3.SQLITE_NOMEM: errno.ENOMEM, sqlite3.SQLITE_CANTOPEN: errno.EMFILE}
#: Tables that are made of event logs when they are asked for.
_DERIVED = ("signals", "signal_events")


@dataclasses.dataclass(frozen=True)
class Difference(_program.Told):
    """A condition minus its baseline, paired by replication, as the console and ``clearway compare`` print it.

    * ``scenario``, ``condition``, ``compared_with``, ``metric``: what is compared with what;
    * ``difference``: mean of the paired differences, in the metric's unit; None without a complete pair;
    * ``interval_95``: its 95 % interval by Student's t; ``bca_95``: by the bias-corrected and accelerated bootstrap; None with too
      few seeds;
    * ``relative_1``: difference divided by the baseline's mean; ``median``, ``median_95``: of the differences;
    * ``effect_size_dz``, ``t_p``, ``wilcoxon_p``; ``holm_p``: p of the t test, for counts of Wilcoxon's test, corrected (Holm) for
      ``holm_over`` comparisons of the scenario;
    * ``complete_pairs``, ``incomplete_pairs``, ``vehicles_left_out``: how many;
    * ``locked_pairs``: in which vehicles locked each other in either run; where there are any, ``difference_without_locks`` and
      ``interval_95_without_locks`` are those of the other pairs, else None;
    * ``title``, ``compared_title``: of the two conditions, as tables show them;
    * ``objections``: why the mean must not be believed as it stands (vehicles that did not arrive); empty where nothing is wrong.
    """

    scenario: str
    condition: str
    compared_with: str
    metric: str
    difference: float | None
    interval_95: tuple[float, float] | None
    relative_1: float | None
    bca_95: tuple[float, float] | None
    median: float | None
    median_95: tuple[float, float] | None
    effect_size_dz: float | None
    t_p: float | None
    holm_p: float | None
    holm_over: int
    wilcoxon_p: float | None
    complete_pairs: int
    incomplete_pairs: int
    vehicles_left_out: int
    locked_pairs: int
    difference_without_locks: float | None
    interval_95_without_locks: tuple[float, float] | None
    objections: str
    title: str
    compared_title: str

    def __str__(self) -> str:
        pair = f"{self.scenario}: {self.title} - {self.compared_title}"
        if self.difference is None:
            return f"{pair}, {self.metric}: no complete pair"
        interval = "too few seeds" if self.interval_95 is None else "[{:+.2f}, {:+.2f}]".format(*self.interval_95)
        text = (f"{pair}, {self.metric}: {self.difference:+.2f} {interval} "
                f"({_program.counted(self.complete_pairs, 'pair')})")
        return text + (f"; {self.objections}" if self.objections else "")


def _pair(bounds: list[float] | None) -> tuple[float, float] | None:
    return None if bounds is None else (bounds[0], bounds[1])


class Results(_program.Told):
    """A run folder (``clearway.open``). Its tables are read once, when they are first asked for. ``folder`` is its path, ``tables``
    the names of its tables, each of which is an attribute, too: ``results.signal_events``.

    Where a condition is asked for, it is given by its name, by the title that tables show (``"Ours, B10"``), or by factors that
    choose one: ``{"condition.policy": "corridor", "condition.failure": "B10"}``.
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = _files.path_of("folder", folder)
        self.tables: list[str] = _program.call(["export", "results", str(self.folder.absolute()), "--list"])[1].split()
        self._read: dict[str, Table] = {}
        self._conditions = Conditions(self.folder)

    def table(self, name: str) -> Table:
        """A table by name; ``tables`` lists them, docs/reference/columns.md says what the columns mean."""
        if name not in self.tables:
            raise _program.InputError(f"{self.folder} has no table {name!r}; it has {', '.join(self.tables)}"
                                      f"{_program.did_you_mean(name, self.tables)}")
        if name not in self._read:
            database = self.folder / "results.sqlite"
            try:
                columns = _derived_table(self.folder, name) if name in _DERIVED else _read_table(database, name)
                # Levels of factors are names, too.
                factors = {column: sorted(set(values.tolist())) for column, values in columns.items()
                           if "." in column and values.dtype.kind == "U"}
                self._read[name] = Table(columns, {"scenario": self._conditions.scenarios, **factors}, self._conditions)
            except sqlite3.Error as error:
                if reason := _SQLITE_OF_MACHINE.get(getattr(error, "sqlite_errorcode", 0) & 0xff):
                    raise _files.refusal(database, reason) from None
                raise _program.InputError(f"{database}: cannot be read: {error}. Give the same call again, in case the machine "
                                         "failed to read it; otherwise remove it: `clearway report` on the folder writes it again") from None
        return self._read[name]

    def __getattr__(self, name: str) -> Any:
        if name in self.__dict__.get("tables", ()):
            return self.table(name)
        return super().__getattr__(name)

    @property
    def study(self) -> dict[str, Any]:
        """What the study is, as its manifest.json says: ``study`` is its name, then ``study_seed``, ``replications``, ``plan``, and
        ``conditions`` and ``scenarios`` with all their settings."""
        return self._conditions.study

    @property
    def runs(self) -> Table:
        """One row for each run."""
        return self.table("runs")

    @property
    def vehicles(self) -> Table:
        """One row for each vehicle of each run."""
        return self.table("vehicles")

    @property
    def leases(self) -> Table:
        """What became of the leases, by policy, action and outcome."""
        return self.table("leases")

    @property
    def errors(self) -> Table:
        """Runs without a result, with their cause and message; for code in Python the message holds its traceback."""
        return self.table("errors")

    @property
    def events(self) -> Table:
        """Departures, arrivals, teleports, collisions, ... of every recorded run. Needs ``--record`` (``record=True``)."""
        found = [file for scenario in _files.listed(self.folder / "recordings") for condition in _files.listed(scenario)
                 for file in _files.listed(condition) if file.suffix == ".h5"]
        if not found:
            raise _program.InputError(f"{self.folder} holds no recordings, which contain the events; run it with record=True (--record)")
        from .recording import Recording
        tables = []
        for file in found:
            with Recording(file) as recording:
                events = recording.events
                of = {"scenario": recording.scenario, "condition": recording.condition, "replication": recording.replication}
            tables.append({**{name: np.full(events.row_count, value) for name, value in of.items()}, **events})
        return Table({name: np.concatenate([table[name] for table in tables]) for name in tables[0]},
                     {"scenario": self._conditions.scenarios}, self._conditions)

    def recording(self, scenario: str, condition: Given, replication: int = 0) -> "Recording":
        """The recording of a run; see ``clearway.trace``."""
        from .recording import Recording, file_of
        self._conditions.require_scenario(scenario)
        name = self._conditions.name_of(condition)
        _program.require_whole("replication", replication, 0, MOST_SEEDS - 1)
        return Recording(file_of(self.folder, scenario, name, replication))

    def paired_difference(self, metric: str, condition: Given, scenario: str | None = None, against: Given | None = None) -> Difference:
        """The paired difference of a condition and its baseline, with the console's intervals (the program works it out).

        ``metric`` is a column of ``runs``, ``scenario`` may be left out where there is one, ``against`` is another condition in
        place of the baseline, or ``"best"``; factors that it leaves out are those of ``condition``, as here the failure::

            results.paired_difference("emergency_travel_time_s", {"condition.policy": "my_policy.py:Green", "condition.failure": "B10"},
                                      against={"condition.policy": "corridor"})

        Raises InputError for names that the folder does not have.
        """
        scenario = self._conditions.scenario_with(condition) if scenario is None else scenario
        name = self._conditions.name_of(condition)
        other = against if against is None or self._is_best(against) else self._conditions.name_of(against, like=name)
        there = self.paired_differences(metric, against)
        if scenario is not None:
            self._conditions.require_scenario(scenario)
        found = [one for one in there if one.condition == name and scenario in (None, one.scenario)]
        if len(found) == 1:
            return found[0]
        if found:
            raise _program.InputError(f"condition {name!r}: several scenarios have it (allowed: scenario= one of "
                                      f"{', '.join(one.scenario for one in found)})")
        known = ", ".join(dict.fromkeys(one.condition for one in there))
        raise _program.InputError(f"condition {name!r}: is not compared with {other or 'a baseline'}: one of the two is a reference, or "
                                  "they differ in traffic" + (f" (allowed: {known})" if known else ""))

    def paired_differences(self, metric: str, against: Given | None = None) -> list[Difference]:
        """All conditions of the folder against their baselines, or against the condition ``against``.

        With factors, each is compared with the condition that has these and is otherwise the same:
        ``against={"condition.policy": "corridor"}`` compares every policy with ``corridor`` under the same failure, ``against="best"``
        each with the best of the others there (``compared_with``), which the same runs chose and so favour. ``holm_p`` corrects
        for all comparisons of a scenario in this list, as ``clearway compare`` does.
        """
        if isinstance(against, Mapping):
            return self._compared(metric, self._conditions.levels(against))
        if self._is_best(against):
            return self._compared(metric, "best")
        return self._compared(metric, None if against is None else self._conditions.name_of(against))

    def _is_best(self, against: Given | None) -> bool:
        return against == "best" and "best" not in self._conditions.names

    def _compared(self, metric: str, against: str | None) -> list[Difference]:
        chosen = [] if against is None else ["--against", against]
        compared = _program.call_json(["compare", str(self.folder.absolute()), "--metric", str(metric), *chosen])
        titles = {one["condition"]: one["title"] for one in compared["conditions"]}
        differences = []
        tested = Counter(row["scenario"] for row in compared["comparisons"] if row["metrics"][metric]["holm_p"] is not None)
        for row in compared["comparisons"]:
            numbers = row["metrics"][metric]
            pairs = {key: _pair(numbers.pop(key)) for key in ("interval_95", "bca_95", "median_95", "interval_95_without_locks")}
            differences.append(Difference(scenario=row["scenario"], condition=row["condition"], compared_with=row["compared_with"],
                                          metric=metric, holm_over=tested[row["scenario"]], objections=row["objections"], title=row["title"],
                                          compared_title=titles[row["compared_with"]], **pairs, **numbers))
        return differences

    def __fspath__(self) -> str:
        """Wherever a path is taken, they stand for their folder."""
        return str(self.folder)

    def __repr__(self) -> str:
        return f"<Results in {self.folder}: {', '.join(self.tables)}>"

    def _repr_html_(self) -> str:
        """What a notebook shows: the paired differences of the primary measure, then the runs."""
        differences = "".join(f"<li>{html.escape(str(one))}</li>" for one in self.paired_differences(PRIMARY_METRIC))
        return f"<p>{html.escape(str(self.folder))}</p><ul>{differences}</ul>{self.runs._repr_html_()}"


def open(folder: str | Path) -> Results:
    """Opens a run folder, complete or not: ``clearway.open("runs/mine").runs``."""
    return Results(folder)


def _read_table(database: Path, name: str) -> dict[str, np.ndarray]:
    with _files.reading(database):  # tells what SQLite does not: no file, no right, no descriptor
        pass
    connection = sqlite3.connect(database.resolve().as_uri() + "?mode=ro", uri=True)
    try:
        cursor = connection.execute(f'SELECT * FROM "{name}"')
        names = [column[0] for column in cursor.description]
        types = {row[1]: row[2] for row in connection.execute(f'PRAGMA table_info("{name}")')}
        rows = cursor.fetchall()
    finally:
        connection.close()
    columns = list(zip(*rows)) if rows else [()] * len(names)
    return {name: _column(values, types.get(name, "")) for name, values in zip(names, columns)}


def _derived_table(folder: Path, name: str) -> dict[str, np.ndarray]:
    return _columns_of(_program.call_json(["export", "results", str(folder.absolute()), name]))


def _columns_of(rows: list[dict[str, Any]]) -> dict[str, np.ndarray]:
    return {column: _column(tuple(row[column] for row in rows), "") for column in (rows[0] if rows else ())}


def table_of(rows: list[dict[str, Any]]) -> Table:
    """Rows of a program's JSON."""
    return Table(_columns_of(rows))


def _column(values: tuple[Any, ...], declared: str) -> np.ndarray:
    if declared == "TEXT" or any(isinstance(value, str) for value in values):
        return np.array(["" if value is None else str(value) for value in values], dtype=str)
    array = np.array([np.nan if value is None else value for value in values], dtype=object)
    if len(array) > 0 and all(isinstance(value, int) for value in values):
        return array.astype(np.int64)
    return array.astype(np.float64)
