#!/usr/bin/env python3
"""Draws the milliseconds of a step over the number of springs, log-log, with the paper's Table 2, from tables with the
columns springs and step_ms (`singe bench dynamics` or `step` with --csv).

usage: draw_cost.py TABLE.csv... OUT.svg
"""

import csv
import math
import pathlib
import sys
from xml.sax.saxutils import escape

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 920, 560, 76, 340, 24, 56
COLOURS = "#888888 #444444 #c8401c #1c6cc8 #2c8c3c #8c3ca0 #c89018 #18a0a0 #a03c5c #5c5cc8 #6c8c1c #7c5c3c".split()
SPRINGS = 1000, 4000, 16000, 25000, 100000
TABLE_2 = {
    "Table 2 (four cores, 2010), to convergence": [*zip(SPRINGS, (6.50, 27.93, 159.17, 211.67, 1045.02))],
    "Table 2 (four cores, 2010), 7 projections": [*zip(SPRINGS, (142.46, 362.69, 1268.00, 1877.92, 7412.92))],
}


def main():
    if len(sys.argv) < 3 or not sys.argv[-1].endswith(".svg"):
        sys.exit(__doc__)
    curves = dict(TABLE_2)
    for path in map(pathlib.Path, sys.argv[1:-1]):
        for row in csv.DictReader(line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")):
            threads = f"{row['threads']} thread{'s' * (row['threads'] != '1')}" if "threads" in row else ""
            name = ", ".join(filter(None, (row.get("solver"), threads, path.stem)))
            curves.setdefault(name, []).append((float(row["springs"]), float(row["step_ms"])))

    # powers of ten that enclose all points
    points = [[math.log10(value) for value in point] for curve in curves.values() for point in curve]
    low = [math.floor(min(axis)) for axis in zip(*points)]
    high = [math.ceil(max(axis)) for axis in zip(*points)]
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    x = lambda power: LEFT + (power - low[0]) / (high[0] - low[0]) * (right - LEFT)
    y = lambda power: bottom - (power - low[1]) / (high[1] - low[1]) * (bottom - TOP)
    number = lambda power: (f"{10.0 ** power:.{max(-power, 0)}f}" if -2 <= power <= 3 else
                            f'10<tspan dy="-6" font-size="9">{power}</tspan>')

    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
           'font-family="sans-serif" font-size="12" fill="#222222">', f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>']
    for power in range(low[0], high[0] + 1):
        svg += [f'<path d="M{x(power):.1f} {TOP} V{bottom}" stroke="#dddddd"/>',
                f'<text x="{x(power):.1f}" y="{bottom + 20}" text-anchor="middle">{number(power)}</text>']
    for power in range(low[1], high[1] + 1):
        svg += [f'<path d="M{LEFT} {y(power):.1f} H{right}" stroke="#dddddd"/>',
                f'<text x="{LEFT - 8}" y="{y(power) + 4:.1f}" text-anchor="end">{number(power)}</text>']
    svg += [f'<text x="{(LEFT + right) / 2}" y="{bottom + 42}" text-anchor="middle">springs</text>',
            f'<text transform="translate(20 {(TOP + bottom) / 2}) rotate(-90)" text-anchor="middle">ms a step</text>']
    for i, ((name, curve), colour) in enumerate(zip(curves.items(), COLOURS)):
        places = [(x(math.log10(springs)), y(math.log10(ms))) for springs, ms in curve]
        svg += [f'<path fill="none" stroke="{colour}" stroke-width="2" d="M{" L".join(f"{a:.1f} {b:.1f}" for a, b in places)}"/>']
        svg += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3" fill="{colour}"/>' for a, b in places]
        svg += [f'<path d="M{right + 16} {TOP + 8 + 20 * i} h20" stroke="{colour}" stroke-width="2"/>',
                f'<text x="{right + 42}" y="{TOP + 12 + 20 * i}">{escape(name)}</text>']
    pathlib.Path(sys.argv[-1]).write_text("\n".join([*svg, "</svg>\n"]), encoding="utf-8")


if __name__ == "__main__":
    main()
