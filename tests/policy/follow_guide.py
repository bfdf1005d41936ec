#!/usr/bin/env python3
"""Follows the steps of examples/02_own_policy/README.md on copies: `follow_guide.py SOURCE OUT` writes OUT/policy/keep_distance.hpp
and OUT/registry.cpp with the lines that the page tells to add, and OUT/scenes.cpp with those for the policy's test. Where SOURCE has
followed a step already, its own files stay as they are."""
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
    scenes = told(page, "const OwnScenes").strip()
    own = source / "src" / "policy" / "keep_distance.hpp"
    header = own if own.exists() else example / "keep_distance.hpp"
    (out / "policy").mkdir(parents=True, exist_ok=True)
    (out / "policy" / "keep_distance.hpp").write_text(header.read_text())
    (out / "registry.cpp").write_text(registry)
    (out / "scenes.cpp").write_text('#include "policy/conformance.hpp"\n\nnamespace clearway::testing {\nnamespace {\n\n'
                                    f"{scenes}\n\n}}  // namespace\n}}  // namespace clearway::testing\n")


main()
