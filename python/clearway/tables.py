"""Tables of results as numpy arrays by column."""
from __future__ import annotations

import html
import re
import shutil
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _program

if TYPE_CHECKING:
    import pandas

    from ._conditions import Conditions

#: Rows of a table that are shown.
SHOWN_ROWS = 10
#: Columns that say which run, or which score of links, a row is of.
_KEYS = ("scenario", "condition", "replication", "id", "failure", "predictor", "against")
#: Columns for which a table is looked at: they are shown before others, and before what else says which run a row is of.
_TELLING = ("cause", "message", "outcome", "reason", "leases", "action", "policy")
#: What a condition is made of, which is no column where it is no factor.
_OF_CONDITIONS = ("policy", "failure", "predictor", "model", "dispatch")


class Table(_program.Told, Mapping[str, np.ndarray]):
    """A table as numpy arrays by column. Read-only; columns carry their units in their names (``emergency_travel_time_s``).

    ``table["collisions"]`` is a column, ``table[["condition", "collisions"]]`` a table of some,
    ``table[table["collisions"] > 0]`` one of some rows, ``row_count`` the number of rows. ``table["title"]`` is what tables call
    the conditions.
    Numbers are ``float64`` or, where all are whole and none is missing, ``int64``; a missing number is NaN. Texts are arrays of
    ``str``, a missing text is ``""``. Printed, it shows the first rows and as many columns as the terminal is wide.
    """

    def __init__(self, columns: Mapping[str, np.ndarray], names: Mapping[str, list[str]] | None = None,
                 conditions: "Conditions | None" = None) -> None:
        """``names`` are all that a column can hold, such as the scenarios of a study; ``conditions`` knows those of the column
        ``condition``."""
        self._columns = dict(columns)
        self._names = names or {}
        self._conditions = conditions
        self._asked: tuple[str, ...] = ()  # columns that are shown however wide they are
        self.row_count = len(next(iter(self._columns.values()))) if self._columns else 0

    def _like(self, columns: Mapping[str, np.ndarray], asked: Iterable[str] = ()) -> "Table":
        table = Table(columns, self._names, self._conditions)
        table._asked = tuple(asked) or tuple(name for name in self._asked if name in columns)
        return table

    def __getitem__(self, column: Any) -> Any:
        if isinstance(column, list):
            return self._like({name: self[name] for name in column}, column)
        if isinstance(column, np.ndarray):
            return self._like({name: array[self._mask(column)] for name, array in self._columns.items()})
        if column == "title" and (titles := self._titles()) is not None:
            return titles
        try:
            return self._columns[column]
        except (KeyError, TypeError):
            raise _program.InputError(self._without(column)) from None

    def _titles(self) -> np.ndarray | None:
        """What tables call the condition of each row, where it is no column already; none in a table without conditions."""
        if "title" in self._columns or "condition" not in self._columns or self._conditions is None:
            return None
        names = self._columns["condition"].tolist()
        titles = {name: self._conditions.title_of(name) for name in set(names)}
        return np.array([titles[name] for name in names], dtype=str)

    def _mask(self, mask: np.ndarray) -> np.ndarray:
        if mask.dtype != bool or mask.shape != (self.row_count,):
            raise _program.InputError(f"a table is indexed with an array of {mask.dtype}, shape {mask.shape} (allowed: a truth value "
                                      f"for each of {_program.counted(self.row_count, 'row')}; where(COLUMN=VALUE) chooses rows, too)")
        return mask

    def _without(self, column: Any, value: Any = None) -> str:
        """That there is no such column, and which one is meant, by its name or by the value that is looked for in it."""
        said = f"there is no column {column!r}"
        meant = _program.nearest(column, self._columns) if value is not None else []
        meant += [name for name in ("condition", *(name for name in self._columns if "." in name))
                  if isinstance(value, str) and name in self._columns and value in self._columns[name].tolist()]
        if not meant and value is not None and column in _OF_CONDITIONS and "condition" in self._columns:
            meant = ["condition"]
        if meant:
            return f"{said}. Did you mean {meant[0]!r}? {_call_of(meant[0], value)} chooses by it"
        return said + _program.there_are(column, list(self._columns), "column", "list(table)")

    def __getattr__(self, name: str) -> Any:
        if name in self.__dict__.get("_columns", ()):
            raise AttributeError(f"Table has no {name!r}: a column is table[{name!r}]")
        return super().__getattr__(name)

    def __contains__(self, column: object) -> bool:
        return column in self._columns

    def get(self, column: str, default: Any = None) -> Any:
        """The column, or the default where there is none."""
        return self._columns.get(column, default)

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        """Rows, as in pandas; iterating yields the columns."""
        return self.row_count

    def where(self, **values: Any) -> "Table":
        """The rows whose columns have these values: ``runs.where(scenario="city", condition="corridor")``, with a factor of
        conditions, in every table, ``leases.where(**{"condition.failure": "B10"})``. A condition is given by its name or by the
        title that tables show, ``title="Ours"`` too.

        Raises InputError for a scenario or condition that the study does not have.
        """
        chosen = np.ones(self.row_count, dtype=bool)
        for column, value in values.items():
            if column == "title" and column not in self._columns and "condition" in self._columns:
                column = "condition"
            if column not in self._columns and self._conditions is not None and "condition" in self._columns:
                named = self._conditions.with_level(column, value)
                if named is not None:
                    chosen &= np.isin(self._columns["condition"], named)
                    continue
            if column not in self._columns:
                raise _program.InputError(self._without(column, value))
            array = self._columns[column]
            if np.ndim(value) != 0 or isinstance(value, str) != (array.dtype.kind == "U"):
                kind = "a text" if array.dtype.kind == "U" else "a number"
                raise _program.InputError(f"column {column!r} is compared with {value!r} (allowed: {kind})")
            if "." in column and self._conditions is not None and value not in array:
                value = self._conditions.level_of(value, array.tolist())
            if column == "condition" and self._conditions is not None:
                value = self._conditions.name_of(value, hint=self._factor_with(value))
            elif column in self._names and value not in self._names[column]:
                known = list(filter(None, self._names[column]))
                there = self._factor_with(value) or _program.there_are(value, known, "value", f"set(table[{column!r}])")
                raise _program.InputError(f"the study has no {column} {value!r}{there}")
            chosen &= array == value
        return self._like({name: array[chosen] for name, array in self._columns.items()})

    def _factor_with(self, value: str) -> str:
        """How to choose by the factor that has this value; empty if none has."""
        factors = (name for name, array in self._columns.items() if "." in name and value in array.tolist())
        return next((f". {_call_of(name, value)} chooses by factor" for name in factors), "")

    def to_pandas(self) -> "pandas.DataFrame":
        """The same as a DataFrame, with a column ``title`` beside ``condition``: what tables call it. Needs pandas (Debian:
        python3-pandas)."""
        try:
            import pandas
        except ImportError as error:
            raise _program.EnvironmentFault("pandas is not installed (Debian: python3-pandas); tables are numpy arrays without it"
                                            ) from error
        frame = pandas.DataFrame(self._columns)
        if (titles := self._titles()) is not None:
            frame.insert(frame.columns.get_loc("condition") + 1, "title", titles)
        return frame

    def head(self, count: int = 5, *columns: str) -> "Table":
        """The first rows; with names of columns, of these and of those that say which run a row is of."""
        if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < 0:
            raise _program.InputError(f"head: {count!r} (allowed: a number of rows from 0)")
        asked = [*self._keys(), *columns] if columns else list(self._columns)
        return self._like({name: self[name][:count] for name in asked}, columns)

    def _keys(self) -> list[str]:
        return [name for name in _KEYS if name in self._columns]

    def _by_weight(self) -> list[str]:
        """The columns, those first that are to be shown first: keys, then what differs between rows. A factor is part of the
        condition's name."""
        keys = self._keys()
        others = [name for name in self._columns if name not in keys]
        telling = [name for name in _TELLING if name in others] if {"reason", "message"} & set(others) else []
        if telling:
            others = [name for name in others if name not in telling]
            first = [name for name in ("condition", "replication") if name in keys]
            keys = [*first, *telling, *(name for name in keys if name not in first)]
        tells = {name: self._differs(name) and not ("." in name and "condition" in keys) for name in others}
        return [*keys, *(name for name in others if tells[name]), *(name for name in others if not tells[name])]

    def _differs(self, name: str) -> bool:
        return len(set(map(_cell, self._columns[name][:1000]))) > 1

    def __repr__(self) -> str:
        """The first rows: keys, then as many columns as the terminal is wide, and how many are left out. Conditions that factors
        made are shown by their titles, which ``where`` takes, too."""
        if not self._columns:
            return "<Table without columns>"
        order = [*self._keys(), *(name for name in self._asked if name not in _KEYS)] if self._asked else self._by_weight()
        shown = self._fitting(order)
        if set(order[:len(self._keys()) + 1]) - set(shown):  # room for more than keys, by those that say nothing
            shown = self._fitting([name for name in order if name not in _KEYS or self._differs(name)])
        lines = ["  ".join(row).rstrip() for row in zip(*shown.values())]
        return "\n".join([*lines, self._left_out(len(shown))])

    def _fitting(self, order: list[str]) -> dict[str, list[str]]:
        """Lines of columns that fit into a line of the terminal, the first of ``order`` first."""
        left = width = shutil.get_terminal_size().columns
        shown: dict[str, list[str]] = {}
        for name in order:
            array = self._columns[name][:SHOWN_ROWS]
            heading = name
            if name == "condition" and "title" not in order and self._conditions is not None and any("+" in value for value in array.tolist()):
                heading = "title"
                array = np.array([self._conditions.title_of(value) if "+" in value else value for value in array.tolist()], dtype=str)
            gap = 2 * bool(shown)
            cells = _lined(heading, array, max(12, width // 2 - 6))
            if len(cells[0]) + gap > left >= 24 and array.dtype.kind == "U":  # enough for the end of a message
                cells = _lined(heading, array, left - gap)
            needed = len(cells[0]) + gap
            if needed <= left or name in self._asked or not shown:
                shown[name] = cells
                left -= needed
            elif set(shown) - set(_KEYS):
                break
        return shown

    def _left_out(self, shown: int) -> str:
        rows = _program.counted(self.row_count, "row")
        columns = _program.counted(len(self._columns), "column")
        if self.row_count > SHOWN_ROWS:
            rows = f"{SHOWN_ROWS} of {rows}"
        if shown == len(self._columns):
            return f"[{rows}, {columns}]"
        return f"[{rows}, {shown} of {columns}: list(table) names all, table.head(5, NAME, ...) shows one]"

    def _repr_html_(self) -> str:
        """What a notebook shows: the first rows, all columns."""
        def row(tag: str, texts: Iterable[str]) -> str:
            return "<tr>" + "".join(f"<{tag}>{html.escape(text)}</{tag}>" for text in texts) + "</tr>"
        shown = {name: array[:SHOWN_ROWS] for name, array in self._columns.items()}
        rows = zip(*([_cell(value) for value in array] for array in shown.values()))
        return (f"<table><thead>{row('th', self)}</thead><tbody>{''.join(row('td', one) for one in rows)}</tbody></table>"
                f"<p>{_program.counted(self.row_count, 'row')}, {_program.counted(len(self._columns), 'column')}"
                f"{f'; the first {SHOWN_ROWS} rows are shown' if self.row_count > SHOWN_ROWS else ''}</p>")


def _call_of(column: str, value: Any) -> str:
    return f"where({column}={value!r})" if column.isidentifier() else f"where(**{{{column!r}: {value!r}}})"


def _cell(value: Any) -> str:
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else f"{value:.6g}"
    return str(value)


def _lined(name: str, array: np.ndarray, most: int) -> list[str]:
    """The name and the values as texts of one width: numbers to the right, texts to the left and shortened to ``most`` characters."""
    if array.dtype.kind in "fiu":
        cells = [name, *map(_cell, array)]
        width = max(map(len, cells))
        return [cell.rjust(width) for cell in cells]
    texts = [" ".join(_cell(value).split()) for value in array]
    if max(map(len, texts), default=0) > most:  # names of conditions first without those of factors
        texts = [re.sub(r"\+[^+=]+=", "+..", text) for text in texts]
    cells = [name, *(_cut(text, most) for text in texts)]
    width = max(map(len, cells))
    return [cell.ljust(width) for cell in cells]


def _cut(text: str, most: int) -> str:
    """Without its middle where it is too long."""
    first = most // 2 - 1
    return text if len(text) <= most else f"{text[:first]}..{text[len(text) - most + first + 2:]}"
