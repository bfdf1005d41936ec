"""Draws rows of results as SVG: panels side by side, points with their 95 % intervals, each label above its line.

A picture is so narrow that a phone shows its letters at two thirds of their size.
"""
import itertools
import math
import re
import textwrap
from xml.sax.saxutils import escape

INK, FAINT, GRID, POINT = "#1f2933", "#5f6c7b", "#e3e7eb", "#2f62ad"
WIDTH, MARGIN, GAP = 560, 22, 36
PITCH, TITLE_HEIGHT = 36, 18
LETTER = 7.4  # width of a letter of 14 px, on average


def ticks_between(low, high):
    """At least three multiples of the largest round step that has so many."""
    for power in itertools.count(math.ceil(math.log10(high - low)), -1):
        for factor in (5, 2, 1):
            step = factor * 10.0 ** power
            first, last = math.ceil(low / step), math.floor(high / step)
            if last - first >= 2:
                return [number * step for number in range(first, last + 1)]


def axis_of(points):
    """Ends and ticks of an axis with all points, their intervals and 0."""
    values = [0.0, *(value for point in points if point for value in point)]
    low, high = min(values), max(values)
    room = 0.04 * (high - low) or 0.5
    low, high = low - room, high + room
    return low, high, ticks_between(low, high)


def text(x, y, words, colour=INK, anchor="start", size=14):
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}" font-size="{size}">{escape(words)}</text>'


def line(x1, y1, x2, y2, colour, width=1.0):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" stroke-width="{width}"/>'


def panel(left, top, width, title, points, axis):
    """`points`: (mean, low, high) by line, or None."""
    low, high, ticks = axis
    bottom = top + PITCH * len(points)

    def at(value):
        return left + (value - low) / (high - low) * width

    svg = [text(left + width / 2, TITLE_HEIGHT * (number + 1), words, anchor="middle") for number, words in enumerate(title)]
    for tick in ticks:
        svg.append(line(at(tick), top, at(tick), bottom, FAINT if tick == 0 else GRID, 1.5 if tick == 0 else 1.0))
        svg.append(text(at(tick), bottom + 16, f"{tick:g}", FAINT, "middle", 12))
    for number, point in enumerate(points):
        if point:
            y = top + PITCH * (number + 1) - 9
            svg.append(line(at(point[1]), y, at(point[2]), y, POINT, 2))
            svg.append(f'<circle cx="{at(point[0]):.1f}" cy="{y:.1f}" r="4" fill="{POINT}"/>')
    return svg


def wrapped(title, letters):
    """Lines of a title, in which units stay with what they belong to."""
    return textwrap.wrap(re.sub(r"(?<=[\d,]) (?=\S{1,3}\b)", "\N{NO-BREAK SPACE}", title), letters)


def label(x, y, words):
    """A label with a white ground, so that the grid does not cross its letters."""
    ground = f'<rect x="{x - 2:.1f}" y="{y - 13:.1f}" width="{LETTER * len(words) + 4:.1f}" height="17" fill="#ffffff"/>'
    return [ground, text(x, y, words)]


def drawn(labels, panels, one_measure):
    """The picture; `panels` are titles and their points. Those of one measure have the same axis."""
    together = [point for _, points in panels for point in points]
    width = (WIDTH - 2 * MARGIN - GAP * (len(panels) - 1)) // len(panels)
    titles = [wrapped(title, max(8, int((width + GAP) / LETTER))) for title, _ in panels]
    top = TITLE_HEIGHT * max(map(len, titles)) + 12
    height = top + PITCH * len(labels) + 48
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" viewBox="0 0 {WIDTH} {height}" '
           'font-family="sans-serif">', '<rect width="100%" height="100%" fill="#ffffff"/>']
    for number, (_, points) in enumerate(panels):
        axis = axis_of(together if one_measure else points)
        svg += panel(MARGIN + number * (width + GAP), top, width, titles[number], points, axis)
    for number, words in enumerate(labels):
        svg += label(MARGIN, top + PITCH * number + 16, words)
    svg.append(text(MARGIN, height - 8, "Point: mean. Bar: 95 % interval. Dark line: 0.", FAINT, size=12))
    return "\n".join([*svg, "</svg>"]) + "\n"
