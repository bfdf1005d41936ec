"""Prints the files that a part in Python is made of, its own first: `python3 -I -S _sources.py FILE`. Run by Clearway to hash them.

Besides the file itself these are the modules that it imports from its own folder, what they import from there, and files of that
folder whose names, with an ending, stand in them as texts, such as "net.pth". All is read from the text, so nothing of it is run here; a file that
cannot be parsed counts alone, and loading it tells why. What the machine fails to read is told: without it, the same part would have
another hash.
"""
from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path


def imported_names(tree: ast.AST, package: list[str]) -> Iterator[list[str]]:
    """Dotted names that a module of ``package`` may import: of ``from a import b`` both ``a`` and ``a.b``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (name.name.split(".") for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[:len(package) - node.level + 1] if node.level else []
            base = above + (node.module.split(".") if node.module else [])
            yield base
            yield from (base + [name.name] for name in node.names)


def files_of(name: list[str], folder: Path) -> Iterator[Path]:
    """Files below ``folder`` that the import of a dotted name runs: packages on the way, and the module."""
    place = folder
    for word in name:
        place = place / word
        for file in (place / "__init__.py", place.with_name(word + ".py")):
            if file.is_file():
                yield file
                break


def files_named(tree: ast.AST, folder: Path) -> Iterator[Path]:
    """Files below ``folder`` that a text of the module names, such as its weights."""
    longest = 255
    for node in ast.walk(tree):
        text = node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""
        if not text or len(text) > longest or not text.isprintable() or text.startswith("/") or ".." in Path(text).parts:
            continue
        file = folder / text
        if file.suffix and file.is_file():
            yield file


def sources(file: Path) -> list[Path]:
    folder, found, waiting, data = file.parent, {file}, [file], set()
    while waiting:
        module = waiting.pop()
        try:
            tree = ast.parse(module.read_bytes())
        except (SyntaxError, ValueError, FileNotFoundError, PermissionError):
            continue
        data |= set(files_named(tree, folder))
        package = list(module.relative_to(folder).parent.parts)
        for name in imported_names(tree, package):
            new = set(files_of(name, folder)) - found
            found |= new
            waiting += new
    return [file, *sorted((found | data) - {file})]


if __name__ == "__main__":
    try:
        print("\n".join(str(file) for file in sources(Path(sys.argv[1]))))
    except OSError as error:
        sys.exit(str(error))
