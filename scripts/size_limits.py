"""What count-docs and count-house share: limits of sizes, which grow only by a line with a reason.

A file of limits has a number for each count, and below it lines that raise it, oldest first:

    words 40000
    words +60 2026-11-27: a guide to signals that are asked by radio

A limit is the sum of its lines, so that those of parallel branches add up (.gitattributes merges these files by keeping the lines
of both). Where a file limits one count alone, the lines have no name.
"""
import datetime
import re
import sys

LIMIT = re.compile(r"(?:(\w+) )?(\d+)")
RAISE = re.compile(r"(?:([a-z_]+) )?([+-]\d+) \d{4}-\d\d-\d\d: (.+)")
PLACEHOLDER = "REASON"


def read(path, fixed=()):
    """Limits by name; None is the name of the one without. Ends the program, saying what to do, where a line is none of them, where
    a reason is missing, or where a limit of `fixed` is raised."""
    limits = {}

    def refuse(number, what):
        sys.exit(f"{path}:{number}: {what}")

    text = path.read_text(encoding="utf-8")
    if not text.endswith("\n"):
        refuse(text.count("\n") + 1, "has no line feed at its end, so that what is added there would be part of it. Add one")
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        limit, more = LIMIT.fullmatch(line), RAISE.fullmatch(line)
        if limit:
            name = limit[1]
            if name in limits:
                refuse(number, f"{line}: a second limit, beside {limits[name]} (two branches have changed it?). Keep the one that both "
                               "began with, and write what each added as a line of its own, `+N DATE: why`")
            limits[name] = int(limit[2])
        elif more:
            name = more[1]
            if name not in limits:
                refuse(number, f"{line}: raises a limit that no line above has (allowed: {', '.join(str(known) for known in limits)})")
            if name in fixed:
                refuse(number, f"{line}: {name} cannot be raised; remove the line, and what is above the limit")
            if re.search(r"[+-]\d+ \d{4}-\d\d-\d\d:", more[3]):
                refuse(number, f"{line}: two lines in one. Begin a line with each `+N DATE:`")
            if more[3].startswith(PLACEHOLDER):
                refuse(number, f"{line}: write why in place of {PLACEHOLDER}")
            limits[name] += int(more[2])
        else:
            refuse(number, f"{line}: neither a comment, nor a limit, nor what raises one (`+12 2026-11-27: why`)")
    return limits


def line_to_add(above, name=None):
    """The line that allows `above` more."""
    return f"    {name + ' ' if name else ''}+{above} {datetime.date.today()}: {PLACEHOLDER}"
