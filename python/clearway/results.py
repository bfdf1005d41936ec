"""What stands in a run folder: tables, paired differences, recordings."""
from __future__ import annotations

import dataclasses
import errno
import html
import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _files, _program

if TYPE_CHECKING:
    import pandas

    from .recording import Recording


#: Rows of a table in a notebook.
SHOWN_ROWS = 10
#: What verdicts judge.
PRIMARY_METRIC = "emergency_restricted_travel_time_s"
#: Replications of a study.
MOST_SEEDS = 100000
_SQLITE_OF_MACHINE = {sqlite3.SQLITE_IOERR: errno.EIO, sqlite3.SQLITE_NOMEM: errno.ENOMEM, sqlite3.SQLITE_CANTOPEN: errno.EMFILE}


class Table(Mapping[str, np.ndarray]):
    """A table as numpy arrays by column. Read-only; columns carry their units in their names (``emergency_travel_time_s``).

    Numbers are ``float64`` or, where all are whole and none is missing, ``int64``; a missing number is NaN. Texts are arrays of
    ``str``, a missing text is ``""``.
    """

    def __init__(self, columns: Mapping[str, np.ndarray], names: Mapping[str, list[str]] | None = None) -> None:
        """``names`` are all that a column can hold, such as the conditions of a study."""
        self._columns = dict(columns)
        self._names = names or {}
        self.row_count = len(next(iter(self._columns.values()))) if self._columns else 0

    def __getitem__(self, column: str) -> np.ndarray:
        try:
            return self._columns[column]
        except KeyError:
            raise _program.InputError(f"there is no column {column!r}; columns are {', '.join(self._columns)}"
                                      f"{_program.did_you_mean(column, self._columns)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        """Rows, as in pandas; iterating yields the columns."""
        return self.row_count

    def where(self, **values: Any) -> "Table":
        """The rows whose columns have these values: ``runs.where(scenario="city", condition="corridor")``. Raises InputError for
        a scenario or condition that the study does not have.
        """
        chosen = np.ones(self.row_count, dtype=bool)
        for column, value in values.items():
            array = self[column]
            if np.ndim(value) != 0 or isinstance(value, str) != (array.dtype.kind == "U"):
                kind = "a text" if array.dtype.kind == "U" else "a number"
                raise _program.InputError(f"column {column!r} is compared with {value!r} (allowed: {kind})")
            if column in self._names and value not in self._names[column]:
                raise _program.InputError(f"the study has no {column} {value!r}; it has {', '.join(filter(None, self._names[column]))}"
                                          f"{self._factor_with(value) or _program.did_you_mean(value, self._names[column])}")
            chosen &= array == value
        return Table({name: array[chosen] for name, array in self._columns.items()}, self._names)

    def _factor_with(self, value: str) -> str:
        """How to choose by the factor that has this value; empty if none has."""
        factors = (name for name, array in self._columns.items() if "." in name and value in array.tolist())
        return next((f". where(**{{{name!r}: {value!r}}}) chooses by factor" for name in factors), "")

    def to_pandas(self) -> "pandas.DataFrame":
        """The same as a DataFrame. Needs pandas (Debian: python3-pandas)."""
        try:
            import pandas
        except ImportError as error:
            raise _program.EnvironmentFault("pandas is not installed (Debian: python3-pandas); tables are numpy arrays without it"
                                            ) from error
        return pandas.DataFrame(self._columns)

    def head(self, count: int = 5) -> "Table":
        """The first rows."""
        if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < 0:
            raise _program.InputError(f"head: {count!r} (allowed: a number of rows from 0)")
        return Table({name: array[:count] for name, array in self._columns.items()}, self._names)

    def __repr__(self) -> str:
        return f"<Table of {_program.counted(self.row_count, 'row')}: {', '.join(self._columns)}>"

    def _repr_html_(self) -> str:
        """What a notebook shows: the first rows, all columns."""
        def row(tag: str, texts: Iterable[str]) -> str:
            return "<tr>" + "".join(f"<{tag}>{html.escape(text)}</{tag}>" for text in texts) + "</tr>"
        shown = self.head(SHOWN_ROWS)
        rows = zip(*([_cell(value) for value in array] for array in shown.values()))
        return (f"<table><thead>{row('th', self)}</thead><tbody>{''.join(row('td', one) for one in rows)}</tbody></table>"
                f"<p>{_program.counted(self.row_count, 'row')}, {_program.counted(len(self._columns), 'column')}"
                f"{f'; the first {SHOWN_ROWS} rows are shown' if self.row_count > SHOWN_ROWS else ''}</p>")


def _cell(value: Any) -> str:
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else f"{value:.6g}"
    return str(value)


@dataclasses.dataclass(frozen=True)
class Difference:
    """A condition minus its baseline, paired by replication, as the console and ``clearway compare`` print it."""

    scenario: str
    condition: str
    compared_with: str
    metric: str
    #: Mean of the paired differences, in the metric's unit; None without a complete pair.
    difference: float | None
    #: 95 % interval by Student's t; None with too few seeds.
    interval_95: tuple[float, float] | None
    #: Difference divided by the baseline's mean.
    relative_1: float | None
    #: 95 % interval by the bias-corrected and accelerated bootstrap.
    bca_95: tuple[float, float] | None
    median: float | None
    median_95: tuple[float, float] | None
    effect_size_dz: float | None
    t_p: float | None
    #: p of the t test, corrected for all comparisons of the scenario (Holm).
    holm_p: float | None
    wilcoxon_p: float | None
    complete_pairs: int
    incomplete_pairs: int
    vehicles_left_out: int
    #: Pairs in which vehicles locked each other in either run; where there are any, the mean of the other pairs with its 95 %
    #: interval, else None.
    locked_pairs: int
    difference_without_locks: float | None
    interval_95_without_locks: tuple[float, float] | None
    #: Why the mean must not be believed as it stands (vehicles that did not arrive); empty where nothing is wrong.
    objections: str

    def __str__(self) -> str:
        if self.difference is None:
            return f"{self.scenario}: {self.condition} - {self.compared_with}, {self.metric}: no complete pair"
        interval = "too few seeds" if self.interval_95 is None else "[{:+.2f}, {:+.2f}]".format(*self.interval_95)
        text = (f"{self.scenario}: {self.condition} - {self.compared_with}, {self.metric}: {self.difference:+.2f} {interval} "
                f"({_program.counted(self.complete_pairs, 'pair')})")
        return text + (f"; {self.objections}" if self.objections else "")


def _pair(bounds: list[float] | None) -> tuple[float, float] | None:
    return None if bounds is None else (bounds[0], bounds[1])


class Results:
    """A run folder (``clearway.open``). Its tables are read once, when they are first asked for."""

    def __init__(self, folder: str | Path) -> None:
        self.folder = _files.path_of("folder", folder)
        #: Names of the tables.
        self.tables: list[str] = _program.call(["export", "results", str(self.folder.absolute()), "--list"])[1].split()
        self._read: dict[str, Table] = {}

    def table(self, name: str) -> Table:
        """A table by name; ``tables`` lists them, docs/reference/columns.md says what the columns mean."""
        if name not in self.tables:
            raise _program.InputError(f"{self.folder} has no table {name!r}; it has {', '.join(self.tables)}"
                                      f"{_program.did_you_mean(name, self.tables)}")
        if name not in self._read:
            database = self.folder / "results.sqlite"
            try:
                columns = _read_table(database, name)
                # Levels of factors are names, too.
                factors = {column: sorted(set(values.tolist())) for column, values in columns.items()
                           if "." in column and values.dtype.kind == "U"}
                self._read[name] = Table(columns, self._names() | factors)
            except sqlite3.Error as error:
                if reason := _SQLITE_OF_MACHINE.get(getattr(error, "sqlite_errorcode", 0) & 0xff):
                    raise _files.refusal(database, reason) from None
                raise _program.InputError(f"{database}: cannot be read: {error}. Give the same call again, in case the machine "
                                         "failed to read it; otherwise remove it: `clearway report` on the folder writes it again") from None
        return self._read[name]

    def _names(self) -> dict[str, list[str]]:
        file = self.folder / "manifest.json"
        content = _files.content(file)
        try:
            manifest = json.loads(content)
            return {kind: [one["name"] for one in manifest[f"{kind}s"]] for kind in ("scenario", "condition")}
        except (ValueError, LookupError, TypeError) as error:
            raise _program.InputError(f"{file}: is damaged ({error!r}). Take it from a backup, or run the study into another folder"
                                      ) from None

    def _require_names(self, **names: str) -> None:
        for kind, known in self._names().items():
            if kind in names and names[kind] not in known:
                raise _program.InputError(f"the study has no {kind} {names[kind]!r}; it has {', '.join(known)}"
                                          f"{_program.did_you_mean(names[kind], known)}")

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
        return Table({name: np.concatenate([table[name] for table in tables]) for name in tables[0]})

    def recording(self, scenario: str, condition: str, replication: int = 0) -> "Recording":
        """The recording of a run; see ``clearway.trace``."""
        from .recording import Recording
        self._require_names(scenario=scenario, condition=condition)
        _program.require_whole("replication", replication, 0, MOST_SEEDS - 1)
        return Recording(self.folder / "recordings" / scenario / condition / f"{replication:05d}.h5")

    def paired_difference(self, metric: str, condition: str, scenario: str | None = None, against: str | None = None) -> Difference:
        """The paired difference of a condition and its baseline, with the console's intervals (the program works it out).

        ``metric`` is a column of ``runs``, ``scenario`` may be left out where there is one, ``against`` names another condition
        in place of the baseline. Raises InputError for names that the folder does not have.
        """
        there = self.paired_differences(metric, against)
        if scenario is not None:
            self._require_names(scenario=scenario)
        found = [one for one in there if one.condition == condition]
        if scenario is not None:
            found = [one for one in found if one.scenario == scenario]
        if len(found) == 1:
            return found[0]
        compared = ", ".join(f"{one.scenario}/{one.condition}" for one in there)
        what = "several scenarios have it: name one" if found else f"is not compared with {against or 'a baseline'} here"
        near = "" if found else _program.did_you_mean(condition, [one.condition for one in there])
        raise _program.InputError(f"condition {condition!r}: {what}; there are {compared}{near}")

    def paired_differences(self, metric: str, against: str | None = None) -> list[Difference]:
        """All conditions of the folder against their baselines, or against the condition ``against``."""
        chosen = [] if against is None else ["--against", against]
        rows = _program.call_json(["compare", str(self.folder.absolute()), "--metric", str(metric), *chosen])["comparisons"]
        differences = []
        for row in rows:
            numbers = row["metrics"][metric]
            pairs = {key: _pair(numbers.pop(key)) for key in ("interval_95", "bca_95", "median_95", "interval_95_without_locks")}
            differences.append(Difference(scenario=row["scenario"], condition=row["condition"], compared_with=row["compared_with"],
                                          metric=metric, objections=row["objections"], **pairs, **numbers))
        return differences

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


def _column(values: tuple[Any, ...], declared: str) -> np.ndarray:
    if declared == "TEXT" or any(isinstance(value, str) for value in values):
        return np.array(["" if value is None else str(value) for value in values], dtype=str)
    array = np.array([np.nan if value is None else value for value in values], dtype=object)
    if len(array) > 0 and all(isinstance(value, int) for value in values):
        return array.astype(np.int64)
    return array.astype(np.float64)
