#!/usr/bin/env python3
"""Follows the steps of examples/02_own_policy/README.md on copies: `follow_guide.py SOURCE OUT` writes OUT/policy/keep_distance.hpp,
OUT/registry.cpp and OUT/conformance.cpp with the lines that the page tells to add. Where SOURCE has followed a step already,
its own files stay as they are."""
import re
import sys
from pathlib import Path


def told(page: str, begin: str) -> str:
    """The indented lines of the page from the one that begins so to the next blank one."""
    found = re.search(rf"^ +{re.escape(begin)}.*?\n\n", page, re.MULTILINE | re.DOTALL)
    if found is None:
        sys.exit(f"follow_guide: the page has no line that begins with: {begin}")
    return found.group()


def added(text: str, lines: str, before: str, followed: str) -> str:
    """The text with lines before the first one that begins so; as it is, where it has `followed`."""
    if followed in text:
        return text
    place = re.search(rf"^ *{re.escape(before)}", text, re.MULTILINE)
    if place is None:
        sys.exit(f"follow_guide: no line begins with: {before}")
    return text[:place.start()] + lines + text[place.start():]


def main() -> None:
    source, out = Path(sys.argv[1]), Path(sys.argv[2])
    example = source / "examples" / "02_own_policy"
    page = (example / "README.md").read_text()
    registry = (source / "src" / "policy" / "registry.cpp").read_text()
    include = told(page, "#include").strip() + "\n"
    registry = added(registry, include, '#include "policy/listing_5_5.hpp"', include)
    registry = added(registry, told(page, "entry<"), "entry<Listing55", "entry<KeepDistance")
    conformance = (source / "tests" / "policy" / "conformance.cpp").read_text()
    follower = told(page, 'add("').rstrip() + "\n"
    conformance = added(conformance, follower, 'add("h1"', follower.strip())
    vehicle = follower.split(",")[0].strip()
    if conformance.count(vehicle) > 1:
        sys.exit(f"follow_guide: the page adds {vehicle}...), and tests/policy/conformance.cpp has another vehicle of that name: rename it")
    own = source / "src" / "policy" / "keep_distance.hpp"
    header = own if own.exists() else example / "keep_distance.hpp"
    (out / "policy").mkdir(parents=True, exist_ok=True)
    (out / "policy" / "keep_distance.hpp").write_text(header.read_text())
    (out / "registry.cpp").write_text(registry)
    (out / "conformance.cpp").write_text(conformance)


main()
