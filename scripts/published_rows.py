"""What render-docs and count-docs share: the rows of `results/*.csv`, and where a page shows them."""
import csv
import dataclasses
import datetime
import functools
import io
import operator
import re
import subprocess

FIELDS = ("study", "tree", "date", "seed", "pairs", "command", "scenario", "condition", "measure", "unit", "mean", "low", "high",
          "lost_evs", "origin", "behaviour")
HEADER = ",".join(FIELDS)
NUMBER = re.compile(r"-?(\d+(\.\d+)?|\.\d+)")
MEASURE = re.compile(r"[a-z0-9_]+(:(difference|percent|median|unlocked|replications))?")
PATTERNS = {
    "tree": (re.compile(r"[0-9a-f]{7,40}"), "the first digits of a commit"),
    "date": (re.compile(r"\d{4}-(0[1-9]|1[0-2])-(0[1-9]|[12]\d|3[01])"), "a date like 2026-11-24"),
    "seed": (re.compile(r"\d*"), "a whole number or nothing"),
    "pairs": (re.compile(r"\d*"), "a whole number or nothing"),
    "measure": (MEASURE, "a name like others_time_loss_s, with :difference, :percent, :median, :unlocked or :replications "
                "where it is against the baseline"),
    "mean": (NUMBER, "a decimal number"),
    "lost_evs": (re.compile(r"(\d+ of \d+)?"), "a text like '1 of 420' or nothing"),
    "origin": (re.compile(r"product|transcribed"), "product or transcribed"),
}
NAMES = ("study", "scenario", "condition", "measure")
RESERVED = re.compile(r"[|;]|--|^\s*$| / ")
UNPRINTABLE = re.compile(r"[\x00-\x1f\x7f-\x9f\u200b-\u200f\u202a-\u202e\u2066-\u2069\ufeff]")


class Fault(Exception):
    """What is wrong where: `file:line: text`."""

    def __init__(self, file, line, text):
        super().__init__(f"{file}:{line}: {text}")


@dataclasses.dataclass(frozen=True)
class Row:
    file: str
    line: int
    values: dict

    def __getitem__(self, field):
        return self.values[field]

    @property
    def key(self):
        return tuple(self.values[name] for name in NAMES)

    @property
    def place(self):
        return f"{self.file}:{self.line}"


YOUNGER_RUNS = {"corridor"}  # since 2026-12-01, when holds by a model of queues became the default


def behaviours(root):
    """Twelve digits that change when a golden run does, the exclusive or of all their hashes, and those of earlier rows: they say
    nothing of YOUNGER_RUNS, because their studies name what was the default."""
    runs = [line.split() for line in (root / "tests/loop/golden.txt").read_text(encoding="utf-8").splitlines()]

    def digits(without=()):
        hashes = [int(word, 16) for name, *words in runs if name not in without for word in words]
        return f"{functools.reduce(operator.xor, hashes):032x}"[:12]

    return digits(), digits(YOUNGER_RUNS)


def read_text(root, path, faults):
    """Text of a file, or None with a fault where it is not UTF-8 or has carriage returns."""
    data = path.read_bytes()
    name = path.relative_to(root).as_posix() if path.is_relative_to(root) else path
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        faults.append(Fault(name, data.count(b"\n", 0, error.start) + 1, f"byte 0x{data[error.start]:02x} is not UTF-8"))
        return None
    if (place := text.find("\r")) >= 0:
        faults.append(Fault(name, line_of(text, place), "a carriage return: lines end with a line feed alone"))
        return None
    return text


def wrong_in(values):
    """What is wrong with the fields of one row."""
    for name, value in values.items():
        if UNPRINTABLE.search(value):
            yield f"{name} {ascii(value)} contains an unprintable character"
    for name in NAMES:
        if RESERVED.search(values[name]):
            yield f"{name} '{values[name]}' is empty or contains one of | ; -- or ' / '"
    for name, (pattern, meant) in PATTERNS.items():
        if not pattern.fullmatch(values[name]):
            yield f"{name} '{values[name]}' is not {meant}"
    ends = [values["low"], values["high"]]
    if ends == ["", ""]:
        pass
    elif not all(map(NUMBER.fullmatch, ends)):
        yield f"low '{ends[0]}' and high '{ends[1]}' are not two decimal numbers, and not both empty"
    elif NUMBER.fullmatch(values["mean"]) and not float(ends[0]) <= float(values["mean"]) <= float(ends[1]):
        yield f"mean {values['mean']} is outside of [{ends[0]}, {ends[1]}]"
    if values["measure"].endswith(":percent") and values["unit"] != "%":
        yield f"unit '{values['unit']}' of a measure in percent is not %"
    if (values["origin"] == "product") != bool(re.fullmatch(r"[0-9a-f]{12}", values["behaviour"])):
        yield (f"behaviour '{values['behaviour']}' of a row of origin '{values['origin']}': rows of the product have the "
               "twelve digits that `scripts/render-docs --behaviour` prints, transcribed ones nothing")


def read_file(root, path, faults):
    """Rows of one file; appends what is wrong to `faults`."""
    name = path.relative_to(root).as_posix()
    rows, seen = [], {}
    if (text := read_text(root, path, faults)) is None:
        return rows
    reader = csv.reader(io.StringIO(text, newline=""))
    if (header := ",".join(next(reader, []))) != HEADER:
        faults.append(Fault(name, 1, f"the header is {ascii(header)}, not '{HEADER}'"))
        return rows
    for cells in reader:
        line = reader.line_num
        if not cells:
            continue
        if len(cells) != len(FIELDS):
            faults.append(Fault(name, line, f"{len(cells)} fields, not {len(FIELDS)}"))
            continue
        row = Row(name, line, dict(zip(FIELDS, cells)))
        faults.extend(Fault(name, line, text) for text in wrong_in(row.values))
        if row.key in seen:
            faults.append(Fault(name, line, f"the same study, scenario, condition and measure as in line {seen[row.key]}"))
        seen[row.key] = line
        rows.append(row)
    return rows


def made(root, study, command):
    """What all rows say that a benchmark makes now."""
    tree = subprocess.run(["git", "-C", root, "rev-parse", "--short=7", "HEAD"], capture_output=True, text=True, check=True)
    return {"study": study, "tree": tree.stdout.strip(), "date": datetime.date.today().isoformat(), "command": command,
            "origin": "product", "behaviour": behaviours(root)[0]}


def read_rows(root, faults):
    """All rows, by the name of their file without its ending."""
    return {path.stem: read_file(root, path, faults) for path in sorted((root / "results").glob("*.csv"))}


def put_rows(path, rows, dropped=lambda row: False):
    """Writes rows into a file of results in place of those with the same names, and of those that `dropped` names."""
    new = {tuple(row[name] for name in NAMES) for row in rows}
    with path.open(encoding="utf-8", newline="") as file:
        kept = [row for row in csv.DictReader(file) if tuple(row[name] for name in NAMES) not in new and not dropped(row)]
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, FIELDS, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows([*rows, *kept])


def pages(root):
    return [page for page in (root / "README.md", *sorted((root / "docs").rglob("*.md"))) if page.exists()]


BLOCK_START = re.compile(r"<!-- (?P<kind>table|picture): *(?P<spec>.*?)-->", re.DOTALL)
FIGURE = re.compile(r"<!--= *(?P<spec>[^>]*?) *-->(?P<text>.*?)<!--/-->", re.DOTALL)
MARKER = re.compile(r"<!--(=| *table:| *picture:| *end of table| *end of picture|/)")
FENCE = re.compile(r"^ *(```|~~~).*?^ *\1[^\n]*$", re.DOTALL | re.MULTILINE)


@dataclasses.dataclass(frozen=True)
class Block:
    """A table, a picture or a figure in a sentence: where it is, what it asks for, where its text is."""
    kind: str
    line: int
    spec: str
    start: int
    end: int


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def find_blocks(page, text, faults):
    """Blocks outside of fenced code, in their order; appends faults of markers."""
    hidden = [match.span() for match in FENCE.finditer(text)]
    blocks, position = [], 0
    while marker := MARKER.search(text, position):
        position = marker.end()
        if any(start <= marker.start() < end for start, end in hidden):
            continue
        line = line_of(text, marker.start())
        word = marker.group(1).strip()
        if word in ("table:", "picture:"):
            kind = word[:-1]
            closing = f"<!-- end of {kind} -->"
            start = BLOCK_START.match(text, marker.start())
            end = text.find(closing, start.end()) if start else -1
            other = BLOCK_START.search(text, start.end()) if start else None
            if end < 0 or (other and other.start() < end):
                faults.append(Fault(page, line, f"this {kind} has no end: write {closing} below it"))
                continue
            blocks.append(Block(kind, line, start["spec"], start.end(), end))
            position = end + len(closing)
        elif word == "=":
            figure = FIGURE.match(text, marker.start())
            if figure is None or MARKER.search(figure["text"]):
                faults.append(Fault(page, line, "this figure has no end: write <!--/--> after it"))
                continue
            start_of_line = text.rfind("\n", 0, marker.start()) + 1
            if text.startswith("#", start_of_line):
                faults.append(Fault(page, line, "a figure in a heading: links to it would break when its row changes"))
            if not text[start_of_line:marker.start()].strip(" >"):
                faults.append(Fault(page, line, "a figure at the start of a line, which Markdown takes for HTML: put a word before it"))
            if text[start_of_line:].lstrip().startswith("|"):
                faults.append(Fault(page, line, "a figure in a table by hand, whose cells its | would divide: write a table block"))
            blocks.append(Block("figure", line, figure["spec"], *figure.span("text")))
            position = figure.end()
        else:
            faults.append(Fault(page, line, f"marker {text[marker.start():text.find('>', position) + 1]} belongs to no block"))
    return blocks
