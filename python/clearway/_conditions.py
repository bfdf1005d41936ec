"""The conditions of a run folder: by name, by the title that tables show, or by factors."""
from __future__ import annotations

import functools
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Union

from . import _files, _program

#: A name, a title, or values of factors: ``{"condition.policy": "corridor", "condition.failure": "B10"}``.
Given = Union[str, Mapping[str, Any]]
#: What tables add to a title.
_MARKS = (" (knows the truth)", " (!)")


class Conditions:
    """Those of the manifest, which is read when it is first asked for."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    @functools.cached_property
    def _manifest(self) -> tuple[dict[str, Any], dict[str, dict[str, dict[str, str]]]]:
        """All of it, and the factors of each scenario and each condition by name."""
        file = self._folder / "manifest.json"
        content = _files.content(file)
        try:
            manifest = json.loads(content)
            return manifest, {kind: {one["name"]: dict(one.get("factors") or {}) for one in manifest[f"{kind}s"]} for kind in ("scenario", "condition")}
        except (ValueError, LookupError, TypeError, AttributeError) as error:
            raise _damaged(file, error) from None

    @property
    def study(self) -> dict[str, Any]:
        return self._manifest[0]

    @property
    def _factors(self) -> dict[str, dict[str, dict[str, str]]]:
        return self._manifest[1]

    @property
    def scenarios(self) -> list[str]:
        return list(self._factors["scenario"])

    @property
    def names(self) -> list[str]:
        return list(self._factors["condition"])

    @functools.cached_property
    def titles(self) -> dict[str, set[str]]:
        """Names by the titles that tables show, as ``clearway compare`` says them."""
        titles: dict[str, set[str]] = {}
        for one in _program.call_json(["compare", str(self._folder.absolute())])["conditions"]:
            titles.setdefault(one["title"], set()).add(one["condition"])
        return titles

    @functools.cached_property
    def _given(self) -> dict[str, str]:
        """The titles that the study gives names and values of factors."""
        file = self._folder / "titles.json"
        if not file.exists():
            return {}  # the study gives none
        try:
            return dict(json.loads(_files.content(file)))
        except (ValueError, TypeError) as error:
            raise _damaged(file, error) from None

    def level_of(self, value: Any, levels: Iterable[Any]) -> Any:
        """The value of a factor of which ``value`` is the title; ``value`` itself, where it is none."""
        return next((level for level in levels if self._given.get(str(level)) == value), value)

    def title_of(self, name: str) -> str:
        """What tables call a condition; its name where there is no title of its own."""
        try:
            return next((title for title, names in self.titles.items() if names == {name}), name)
        except _program.ClearwayError:  # nothing to compare yet
            return name

    def require_scenario(self, name: Any) -> None:
        if name not in self.scenarios:
            there = _program.there_are(name, self.scenarios, "scenario", 'set(results.runs["scenario"])')
            raise _program.InputError(f"the study has no scenario {name!r}{there}")

    def name_of(self, given: Given, *, like: str | None = None, hint: str = "") -> str:
        """The name of the condition that is meant. Factors that ``given`` leaves out are those of the condition ``like``, if one is
        named. ``hint`` is told in place of the nearest names where there is none."""
        if isinstance(given, Mapping):
            return self._with_factors(given, like)
        if given in self.names:
            return given
        found = self._titled(str(given))
        if len(found) > 1:
            raise _program.InputError(f"several conditions have the title {given!r}: {', '.join(sorted(found))}. Give the name of one")
        if found:
            return found.pop()
        known = self.names if len(self.names) <= _program.MOST_LISTED else [*self.names, *self.titles]
        there = hint or _program.there_are(given, known, "title", 'set(results.runs["title"])', len(self.names))
        raise _program.InputError(f"the study has no condition {given!r}{there}")

    def _titled(self, title: str) -> set[str]:
        for mark in _MARKS:
            title = title.removesuffix(mark)
        return set(self.titles.get(title, ()))

    def scenario_with(self, given: Given) -> str | None:
        """The scenario that factors choose, if any of them is one of scenarios."""
        chosen = {name: value for name, value in given.items() if name in self._known("scenario")} if isinstance(given, Mapping) else {}
        if not chosen:
            return None
        found = [name for name, factors in self._factors["scenario"].items() if _have(factors, chosen)]
        return self._only(found, "scenario", chosen)

    def levels(self, against: Mapping[str, Any]) -> str:
        """What ``clearway compare --against`` takes for these factors."""
        known = self._known("condition")
        return ",".join(f"{name}={next(level for level in known[name] if _is(level, value))}"
                        for name, value in self._checked(against).items())

    def with_level(self, factor: str, value: Any) -> list[str] | None:
        """The conditions that have this level of a factor; None where it is no factor of conditions."""
        if factor not in self._known("condition"):
            return None
        given = self._checked({factor: value})
        return [name for name, factors in self._factors["condition"].items() if _have(factors, given)]

    def _checked(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """Those factors that are of conditions. Raises for factors and levels that the study does not have."""
        known = self._known("condition")
        given = {f"condition.{name}" if f"condition.{name}" in known else name: value for name, value in given.items()}
        for name in given:
            if name not in known and name not in self._known("scenario"):
                there = _program.there_are(name, list(known), "factor", "list(results.runs)")
                raise _program.InputError(f"the conditions of this study have no factor {name!r}{there}")
        given = {name: value for name, value in given.items() if name in known}
        for name, value in given.items():
            if any(_is(level, value) for level in known[name]):
                continue
            given[name] = self.level_of(value, known[name])
            if given[name] not in known[name]:
                there = _program.there_are(value, known[name], "level", f"set(results.runs[{name!r}])")
                raise _program.InputError(f"the study has no {name} {value!r}{there}")
        return given

    def _with_factors(self, given: Mapping[str, Any], like: str | None) -> str:
        given = self._checked(given)
        conditions = self._factors["condition"]
        found = [name for name, factors in conditions.items() if _have(factors, given)]
        if like is not None:
            rest = {name: value for name, value in conditions[like].items() if name not in given}
            same = [name for name in found if {key: value for key, value in conditions[name].items() if key not in given} == rest]
            found = same or found
            of_kind = [name for name in found if name.partition("+")[0] == like.partition("+")[0]]
            found = of_kind or found
        return self._only(found, "condition", given)

    def _known(self, kind: str) -> dict[str, list[str]]:
        """Levels of each factor."""
        known: dict[str, list[str]] = {}
        for factors in self._factors[kind].values():
            for name, value in factors.items():
                known.setdefault(name, [])
                known[name] += [value] if value not in known[name] else []
        return known

    def _only(self, found: list[str], kind: str, given: Mapping[str, Any]) -> str:
        if len(found) == 1:
            return found[0]
        several = f"{len(found)} {kind}s: {', '.join(found[:_program.MOST_LISTED])}{', ...' if len(found) > _program.MOST_LISTED else ''}"
        raise _program.InputError(f"{dict(given)!r} chooses {several if found else f'no {kind}'} (allowed: factors that choose one)")


def _damaged(file: Path, error: Exception) -> _program.InputError:
    return _program.InputError(f"{file}: is damaged ({error!r}). Take it from a backup, or run the study into another folder")


def _have(factors: Mapping[str, str], given: Mapping[str, Any]) -> bool:
    return all(name in factors and _is(factors[name], value) for name, value in given.items())


def _is(text: str, value: Any) -> bool:
    """Whether a level of a factor, as the manifest has it, is this value."""
    if isinstance(value, str):
        return text == value
    try:
        return text == str(value).lower() if isinstance(value, bool) else float(text) == float(value)
    except (TypeError, ValueError):
        return False
