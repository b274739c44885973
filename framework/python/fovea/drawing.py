"""Draws a graph for notebooks: passes in the columns of their levels, and lines along what they hand on."""

from __future__ import annotations

import re
from html import escape

WIDTH, HEIGHT, GAP_X, GAP_Y, MARGIN = 150, 34, 46, 14, 10

Box = tuple[str, str, int | None]  # name, second line, level; culled passes have no level
Line = tuple[str, str, list[str]]  # from, to, what is handed on


def read(dot: str) -> tuple[dict[str, Box], list[Line]]:
    """The boxes and lines of a plan for Graphviz."""
    boxes: dict[str, Box] = {}
    for key, name, rest in re.findall(r'^ *(p\d+) \[label="([^"\\]*)\\n([^"]*)"', dot, re.M):
        level = re.search(r"level (\d+)$", rest)
        boxes[key] = (name, rest.split(",")[0], int(level.group(1)) if level else None)
    carried: dict[tuple[str, str], list[str]] = {}
    for start, end, label in re.findall(r'^ *(p\d+) -> (p\d+|"[^"]*") \[label="([^"]*)"', dot, re.M):
        carried.setdefault((start, end.strip('"')), []).append(label)
    last = max((level for _, _, level in boxes.values() if level is not None), default=0)
    for _, end in carried:
        if end.startswith("output "):
            boxes[end] = (end.removeprefix("output "), "output", last + 1)
    return boxes, [(start, end, labels) for (start, end), labels in carried.items()]


def drawing(dot: str, name: str) -> str:
    """An SVG of a plan for Graphviz; what a line carries is shown when the pointer rests on it."""
    boxes, lines = read(dot)
    columns: dict[int, list[str]] = {}
    for key, (_, _, level) in boxes.items():
        if level is not None:
            columns.setdefault(level, []).append(key)
    place = {key: (MARGIN + column * (WIDTH + GAP_X), MARGIN + row * (HEIGHT + GAP_Y))
             for column, (_, keys) in enumerate(sorted(columns.items())) for row, key in enumerate(keys)}
    parts = []
    for start, end, labels in lines:
        if start not in place or end not in place:
            continue
        (x0, y0), (x1, y1) = place[start], place[end]
        x0, y0, y1 = x0 + WIDTH, y0 + HEIGHT // 2, y1 + HEIGHT // 2
        bend = max(30, abs(x1 - x0) // 2)
        parts.append(f'<path d="M{x0},{y0} C{x0 + bend},{y0} {x1 - bend},{y1} {x1},{y1}" fill="none" '
                     f'stroke="#789" stroke-width="1.5"><title>{escape(", ".join(labels))}</title></path>')
    for key, (x, y) in place.items():
        title, second, _ = boxes[key]
        fill = "#fff3d6" if second == "output" else "#e3eefa"
        parts.append(f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" rx="5" fill="{fill}" stroke="#456"/>'
                     f'<text x="{x + 8}" y="{y + 15}" font-weight="bold">{escape(title)}</text>'
                     f'<text x="{x + 8}" y="{y + 28}" fill="#456">{escape(second)}</text>')
    width = max((x for x, _ in place.values()), default=0) + WIDTH + MARGIN
    height = max((y for _, y in place.values()), default=0) + HEIGHT + MARGIN
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
            f'font-size="11" role="img" aria-label="graph {escape(name)}">{"".join(parts)}</svg>')
