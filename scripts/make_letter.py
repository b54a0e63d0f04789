#!/usr/bin/env python3
"""Makes examples/letter/letter.png and letter.obj, which the repository contains.

Needs Pillow, numpy and the Debian packages fonts-ebgaramond and fonts-dancingscript.
Usage: python3 scripts/make_letter.py [picture] [mesh]   (default: both)
"""

import math
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "examples" / "letter"

# ---- the mesh: A4, 46 x 65 cells, ten springs a cell and fewer at the border: 29,900

WIDTH, HEIGHT = 0.210, 0.297  # m
CELLS_X, CELLS_Y = 46, 65
JITTER = 0.15  # of a cell
RELIEF = 0.0012  # m, root mean square height of its waves


def lattice(i, j, seed):
    """A hash of a lattice point in [-1, 1]."""
    h = (i * 374761393 + j * 668265263 + seed * 2246822519) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((h ^ (h >> 16)) & 0xFFFFFF) / 0x7FFFFF - 1.0


def noise(x, y, seed):
    """Smooth value noise, one period a unit."""
    i, j = math.floor(x), math.floor(y)
    fx, fy = x - i, y - j
    fx, fy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
    low = lattice(i, j, seed) * (1 - fx) + lattice(i + 1, j, seed) * fx
    high = lattice(i, j + 1, seed) * (1 - fx) + lattice(i + 1, j + 1, seed) * fx
    return low * (1 - fy) + high * fy


def vertex(i, j):
    """Vertex i, j: off its grid point by a smooth displacement; the border slides along itself only."""
    dx = 0.0 if i in (0, CELLS_X) else JITTER * noise(i / 1.7, j / 1.9, 1)
    dy = 0.0 if j in (0, CELLS_Y) else JITTER * noise(i / 1.8 + 40, j / 1.6 + 40, 2)
    if (i in (0, CELLS_X)) and (j in (0, CELLS_Y)):
        dx = dy = 0.0
    return (i + dx) / CELLS_X, (j + dy) / CELLS_Y


def relief(x, y):
    """Height in m of a sheet that has been in a pocket: waves of a hand's width and a corner that will not lie down."""
    waves = 0.0
    for k in range(9):
        angle = math.pi * (k + 0.5 * lattice(k, 1, 5)) / 9
        f = 2 * math.pi / 0.115 * 2 ** (0.5 * lattice(k, 2, 5))
        waves += math.cos(f * (math.cos(angle) * x + math.sin(angle) * y) + math.pi * lattice(k, 3, 5)) / 3
    corner = max(0.0, (x + y - 0.165) / 0.0885)  # 1 at the upper right corner
    other = max(0.0, (-x - y - 0.205) / 0.0485)
    return RELIEF * waves + 0.011 * corner ** 2 + 0.004 * other ** 2


def make_mesh(path):
    lines = [
        "# A sheet of A4 paper, 0.210 x 0.297 m, in the x-y plane, centred at the origin; it lies in waves of about "
        "1 mm.",
        f"# {CELLS_X} x {CELLS_Y} quads; vertices lie off the grid by up to {JITTER:.0%} of a cell, so that folds and "
        "fronts",
        "# find no lines to follow. The picture is undistorted: u = x / 0.210 + 0.5, v = y / 0.297 + 0.5.",
        "# Made by scripts/make_letter.py.",
        "o letter",
    ]
    points = [vertex(i, j) for j in range(CELLS_Y + 1) for i in range(CELLS_X + 1)]
    places = [((u - 0.5) * WIDTH, (v - 0.5) * HEIGHT) for u, v in points]
    lowest = min(relief(x, y) for x, y in places)
    lines += [f"v {x:.7f} {y:.7f} {relief(x, y) - lowest:.6f}" for x, y in places]
    lines += [f"vt {u:.6f} {v:.6f}" for u, v in points]
    row = CELLS_X + 1
    for j in range(CELLS_Y):
        for i in range(CELLS_X):
            a = j * row + i + 1
            lines.append("f " + " ".join(f"{k}/{k}" for k in (a, a + 1, a + row + 1, a + row)))
    path.write_text("\n".join(lines).replace("-0.0000000", "0.0000000") + "\n")


# ---- the picture

PIXELS = (1240, 1754)  # A4 at 150 dots an inch
SCALE = 2  # drawn larger, then reduced
PAPER = (246, 241, 229)
INK = (34, 38, 66)
HEAD = (92, 58, 42)

LETTERHEAD = ("MARGUERITE ASHDOWN", "The Lamp House  ·  Gannet Quay  ·  Port Sorrel")
DATE = "the last night of October"
ADDRESS = ("Mr Elias Thorne", "Third Mate, the barque Halcyon", "at anchor, Saint Brannoc Roads")
GREETING = "My dearest Elias,"
BODY = (
    "When you read this the lamps along the quay will be out and I shall be on the early coach, with one trunk "
    "and the blue scarf you said made me look like weather. I am not brave enough to say goodbye on the steps, "
    "so I am doing it here, at your desk, with your good pen and the last of your ink.",
    "You asked me once what I should save if the house were burning. I said the clock, and you laughed, because "
    "it has never told the right hour in its life. I was not being honest. I should have saved the afternoon you "
    "came up from the harbour soaked to the skin with your arms full of lemons, and stood dripping on my mother's "
    "carpet as if you had brought me the sun.",
    "We were happy, weren't we? I have been counting it out all evening, the way one counts coins before a "
    "journey: the boat with no name, the night of the green lights, the winter we read one book between us a "
    "chapter at a time because neither of us would wait. I find I have more than I thought. I find it is enough "
    "to travel on.",
    "Do not come after me. The sea had you first, and I have never been able to hate her for it. If you must do "
    "something with your hands, mend the gate; it has been singing on its hinge since March. And when you have "
    "read this twice, put it to the candle. Let it go up the chimney and out over the water. I should like to "
    "think that some small part of it will reach you, wherever you are on watch, and that you will look up.",
    "Keep the clock. It is nearly right now.",
)
CLOSING = "Always, and in all weathers,"


def font(name, size):
    from PIL import ImageFont

    try:
        return ImageFont.truetype(name, int(size * SCALE))
    except OSError:
        sys.exit(f"font {name} is missing: install fonts-ebgaramond and fonts-dancingscript")


def wrap(draw, text, face, width, indent):
    lines, line = [], ""
    for word in text.split():
        longer = f"{line} {word}".strip()
        if draw.textlength(longer, font=face) > width - (0 if lines else indent) and line:
            lines.append(line)
            line = word
        else:
            line = longer
    return lines + [line]


def write_line(draw, rng, x, y, text, face, ink):
    """One written line: words drift off the base line and the pen presses unevenly."""
    slope = rng.normal(0, 0.0012)
    space = draw.textlength(" ", font=face)
    start = x
    for word in text.split():
        shade = int(rng.integers(-6, 16))
        colour = tuple(max(0, min(255, c + shade)) for c in ink)
        drop = slope * (x - start) + rng.normal(0, 0.8 * SCALE)
        draw.text((x, y + drop), word, font=face, fill=colour)
        x += draw.textlength(word, font=face) + space * (1 + rng.normal(0, 0.09))


def stroke(draw, points, thin, thick, ink):
    """A pen stroke through Catmull-Rom points, thicker where it runs down."""
    path = []
    padded = [points[0], *points, points[-1]]
    for a, b, c, d in zip(padded, padded[1:], padded[2:], padded[3:]):
        for k in range(40):
            t = k / 40
            path.append(tuple(
                0.5 * (2 * b[n] + (c[n] - a[n]) * t + (2 * a[n] - 5 * b[n] + 4 * c[n] - d[n]) * t * t
                       + (3 * b[n] - a[n] - 3 * c[n] + d[n]) * t ** 3) for n in (0, 1)))
    for (x0, y0), (x1, y1) in zip(path, path[1:]):
        length = math.hypot(x1 - x0, y1 - y0) or 1
        r = thin + (thick - thin) * max(0.0, (y1 - y0) / length) ** 1.5
        steps = max(1, int(length))
        for k in range(steps):
            x, y = x0 + (x1 - x0) * k / steps, y0 + (y1 - y0) * k / steps
            draw.ellipse((x - r, y - r, x + r, y + r), fill=ink)


def signature(draw, x, y, size):
    """A pointed M, a trailing hand, and a paraph below it."""
    s = size * SCALE
    hand = [(0.00, 0.62), (0.10, 0.92), (0.20, 0.55), (0.30, 0.05), (0.36, 0.45), (0.38, 0.95), (0.46, 0.45),
            (0.58, 0.02), (0.63, 0.45), (0.66, 0.88), (0.74, 0.90), (0.82, 0.66), (0.92, 0.60), (0.86, 0.80),
            (0.96, 0.90), (1.06, 0.66), (1.10, 0.88), (1.20, 0.64), (1.30, 0.62), (1.24, 0.84), (1.34, 0.84),
            (1.36, 1.25), (1.26, 1.42), (1.24, 1.24), (1.44, 0.86), (1.50, 0.66), (1.56, 0.88), (1.66, 0.86),
            (1.72, 0.64), (1.78, 0.88), (1.92, 0.62), (1.98, 0.86), (2.12, 0.30), (2.10, 0.84), (2.24, 0.88),
            (2.34, 0.64), (2.40, 0.84), (2.66, 0.72), (2.95, 0.80)]
    stroke(draw, [(x + px * s, y + py * s) for px, py in hand], 1.1 * SCALE, 3.0 * SCALE, INK)
    paraph = [(2.70, 1.12), (1.90, 1.30), (0.90, 1.46), (0.30, 1.58), (0.80, 1.66), (1.80, 1.50), (2.50, 1.46)]
    stroke(draw, [(x + px * s, y + py * s) for px, py in paraph], 0.9 * SCALE, 2.2 * SCALE, INK)
    for px, py in ((2.24, 0.22), (1.60, 0.40)):
        r = 2.2 * SCALE
        draw.ellipse((x + px * s - r, y + py * s - r, x + px * s + r, y + py * s + r), fill=INK)


def letterhead(draw):
    w = PIXELS[0] * SCALE
    name, place = font("EBGaramond12-Regular.otf", 42), font("EBGaramond12-Italic.otf", 24)
    spaced = " ".join(LETTERHEAD[0])
    draw.text(((w - draw.textlength(spaced, font=name)) / 2, 92 * SCALE), spaced, font=name, fill=HEAD)
    draw.text(((w - draw.textlength(LETTERHEAD[1], font=place)) / 2, 156 * SCALE), LETTERHEAD[1], font=place, fill=HEAD)
    y, middle = 206 * SCALE, w // 2
    for sign in (-1, 1):
        draw.line((middle + sign * 22 * SCALE, y, middle + sign * 330 * SCALE, y), fill=HEAD, width=2 * SCALE)
    r = 9 * SCALE
    draw.polygon([(middle, y - r), (middle + r, y), (middle, y + r), (middle - r, y)], fill=HEAD)


def write_letter(draw, rng):
    left, right = 150 * SCALE, (PIXELS[0] - 135) * SCALE
    hand, step = font("DancingScript-Regular.otf", 34), 43.5 * SCALE
    indent = 52 * SCALE
    y = 238 * SCALE
    write_line(draw, rng, right - draw.textlength(DATE, font=hand), y, DATE, hand, INK)
    y += 34 * SCALE
    for line in ADDRESS:
        write_line(draw, rng, left, y, line, hand, INK)
        y += 40 * SCALE
    y += 26 * SCALE
    write_line(draw, rng, left, y, GREETING, hand, INK)
    y += step + 8 * SCALE
    for paragraph in BODY:
        for n, line in enumerate(wrap(draw, paragraph, hand, right - left, indent)):
            write_line(draw, rng, left + (indent if n == 0 else 0) + rng.normal(0, 1.5 * SCALE), y, line, hand, INK)
            y += step
        y += 8 * SCALE
    y += 10 * SCALE
    write_line(draw, rng, 660 * SCALE, y, CLOSING, hand, INK)
    signature(draw, 700 * SCALE, y + 44 * SCALE, 96)
    return y / SCALE


def paper(rng):
    """Off-white with broad clouds and faint fibres, as factors near 1."""
    import numpy as np
    from PIL import Image, ImageDraw, ImageFilter

    w, h = PIXELS
    clouds = np.zeros((h, w))
    for cells, strength in ((5, 1.0), (17, 0.6)):
        small = Image.fromarray((rng.random((cells * 7 // 5, cells)) * 255).astype("uint8"))
        clouds += strength * (np.asarray(small.resize((w, h), Image.BICUBIC), dtype=float) / 255 - 0.5)
    fibres = Image.new("L", (w, h), 128)
    draw = ImageDraw.Draw(fibres)
    for _ in range(1500):
        x, y, angle, bend = rng.random() * w, rng.random() * h, rng.random() * math.tau, rng.normal(0, 0.12)
        points = [(x, y)]
        for _ in range(int(rng.integers(4, 12))):
            angle += bend + rng.normal(0, 0.1)
            points.append((points[-1][0] + 5 * math.cos(angle), points[-1][1] + 5 * math.sin(angle)))
        draw.line(points, fill=int(rng.choice([92, 104, 160])), width=1)
    fibres = np.asarray(fibres.filter(ImageFilter.GaussianBlur(0.7)), dtype=float) / 128 - 1
    return 1 + 0.012 * clouds + 0.05 * fibres


def make_picture(path):
    import numpy as np
    from PIL import Image, ImageDraw

    rng = np.random.default_rng(1848)
    sheet = Image.new("RGB", (PIXELS[0] * SCALE, PIXELS[1] * SCALE), PAPER)
    draw = ImageDraw.Draw(sheet)
    letterhead(draw)
    end = write_letter(draw, rng)
    sheet = np.asarray(sheet.resize(PIXELS, Image.LANCZOS), dtype=float) * paper(rng)[:, :, None]
    image = Image.fromarray(np.clip(sheet, 0, 255).astype("uint8"))
    image = image.quantize(128, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    image.save(path, optimize=True, dpi=(150, 150))
    print(f"{path.name}: {path.stat().st_size // 1000} kB, the text ends at {end:.0f} of {PIXELS[1]}")


if __name__ == "__main__":
    wanted = sys.argv[1:] or ["picture", "mesh"]
    if "picture" in wanted:
        make_picture(FOLDER / "letter.png")
    if "mesh" in wanted:
        make_mesh(FOLDER / "letter.obj")
