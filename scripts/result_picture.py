"""Draws rows of results as SVG: a line for each label, a panel for each title, points with their 95 % intervals."""
import math
from xml.sax.saxutils import escape

INK, FAINT, GRID, POINT = "#1f2933", "#5f6c7b", "#e3e7eb", "#2f62ad"
LINE_HEIGHT, PANEL_WIDTH, GAP, TOP = 26, 300, 36, 40
LETTER = 7.6  # width of a letter of 13 px, on average


def step_of(span):
    """A round step that divides the span into four to eight parts."""
    step = 10 ** math.floor(math.log10(span / 4))
    return next(factor * step for factor in (1, 2, 2.5, 5, 10) if span / (factor * step) <= 8)


def axis_of(points):
    """Ends and ticks of an axis with all points, their intervals and 0."""
    values = [0.0, *(value for point in points if point for value in point)]
    low, high = min(values), max(values)
    if low == high:
        high = low + 1.0
    step = step_of(high - low)
    first, last = math.floor(low / step), math.ceil(high / step)
    return first * step, last * step, [number * step for number in range(first, last + 1)]


def text(x, y, words, colour=INK, anchor="start", size=13):
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}" font-size="{size}">{escape(words)}</text>'


def line(x1, y1, x2, y2, colour, width=1.0):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" stroke-width="{width}"/>'


def panel(left, title, points, axis):
    """`points`: (mean, low, high) by line, or None."""
    low, high, ticks = axis
    bottom = TOP + LINE_HEIGHT * len(points)

    def at(value):
        return left + (value - low) / (high - low) * PANEL_WIDTH

    svg = [text(left + PANEL_WIDTH / 2, 18, title, anchor="middle")]
    for tick in ticks:
        svg.append(line(at(tick), TOP - 8, at(tick), bottom, FAINT if tick == 0 else GRID))
        svg.append(text(at(tick), bottom + 16, f"{tick:g}", FAINT, "middle", 11))
    for number, point in enumerate(points):
        if point:
            y = TOP + LINE_HEIGHT * (number + 0.5) - 4
            svg.append(line(at(point[1]), y, at(point[2]), y, POINT, 2))
            svg.append(f'<circle cx="{at(point[0]):.1f}" cy="{y:.1f}" r="4" fill="{POINT}"/>')
    return svg


def drawn(labels, panels, one_measure):
    """The picture; `panels` are titles and their points. Those of one measure have the same axis."""
    together = [point for _, points in panels for point in points]
    left = 20 + LETTER * max(map(len, labels))
    width = left + len(panels) * (PANEL_WIDTH + GAP)
    height = TOP + LINE_HEIGHT * len(labels) + 28
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height}" font-family="sans-serif">',
           '<rect width="100%" height="100%" fill="#ffffff"/>']
    svg += [text(left - 14, TOP + LINE_HEIGHT * (number + 0.5), label, anchor="end") for number, label in enumerate(labels)]
    for number, (title, points) in enumerate(panels):
        svg += panel(left + number * (PANEL_WIDTH + GAP), title, points, axis_of(together if one_measure else points))
    return "\n".join([*svg, "</svg>"]) + "\n"
