#!/usr/bin/env python3
"""Makes the pictures of examples/newspaper, curtain, shirt and page-hot, which the repository contains.

Needs Pillow, numpy and the Debian package fonts-ebgaramond.
Usage: python3 scripts/make_pictures.py [newspaper] [curtain] [shirt] [page]   (default: all)
"""

import math
import pathlib
import sys

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent / "examples"
FONTS = pathlib.Path("/usr/share/fonts/opentype/ebgaramond")


def font(name, size):
    return ImageFont.truetype(str(FONTS / f"EBGaramond12-{name}.otf"), int(size))


def clouds(rng, width, height, cells, octaves):
    """Smooth noise in [-1, 1], the same in all directions, with features from width/cells down `octaves` halvings."""
    fx, fy = np.meshgrid(np.fft.rfftfreq(width) * width, np.fft.fftfreq(height) * width)
    f = np.hypot(fx, fy) / cells
    strength = np.where((f > 0) & (f < 2.0 ** octaves), 1 / (0.5 + f) ** 2.2, 0)
    field = np.fft.irfft2(strength * np.fft.rfft2(rng.standard_normal((height, width))), s=(height, width))
    return np.clip(field / (2.5 * field.std()), -1, 1)


def blurred(mask, radius):
    """A mask with soft edges, from 0 to 1."""
    image = Image.fromarray((mask * 255).astype("uint8")).filter(ImageFilter.GaussianBlur(radius))
    return np.asarray(image, dtype=float) / 255


def save(image, path):
    image.save(path, quality=86, optimize=True, subsampling=2)
    print(f"{path.name}: {path.stat().st_size // 1000} kB")


# ---- a newspaper's front page, 0.289 x 0.400 m

PAGE = (1156, 1600)
SCALE = 2
INK = (38, 36, 34)
NEWSPRINT = (222, 214, 196)

TITLE = "The Gannet Quay Courier"
LINE = ("No. 4,117", "THURSDAY, THE FIRST OF NOVEMBER", "One Penny")
HEADLINE = "LAMP HOUSE LOST TO FIRE"
BELOW = "Flames seen from the roads · Nobody hurt · Letters of forty years are gone"
PARAGRAPHS = (
    "The old Lamp House at the end of the quay burnt to its walls last night. The fire was first seen by the watch of "
    "the barque Halcyon, which lay at anchor in the roads, and who took it for a signal until it began to climb.",
    "By the time that the engine had been drawn along the sea wall the roof was gone. The wind held to the west, and "
    "so the net lofts and the chandler's were spared; sparks and flakes of burnt paper came down as far as the "
    "customs steps.",
    "Miss Ashdown, who kept the lamps there for her father and then by herself, had left the town on the early coach. "
    "It is said that a letter on her table was the first thing to burn, and that it had been lit at its middle.",
    "Those who saw it tell us that paper does not burn as one would think. It browns before it blackens; it draws "
    "itself together, and so it lifts and curls; a thin bright line walks through it and leaves a grey leaf behind "
    "that weighs nothing.",
    "Mr Thorne, third mate of the Halcyon, came ashore at first light and walked through what is left. He asked for "
    "nothing but the brass of the great lantern, which is whole.",
    "The harbour board meets on Saturday. A light will be shown from a boat until a new house can be built, and "
    "masters are asked to give the point half a mile more than they are used to.",
    "A collection is made at the chapel for the two keepers. Dry goods are wanted, and boots.",
    "From the market: herring steady, coal dearer by a shilling, lamp oil not to be had.",
    "The tide is high at ten minutes past seven and again at half past. The glass falls. Wind westerly, with rain by "
    "night; small craft are warned.",
    "Lost, between the quay and the coach office, a blue scarf. Whoever finds it may keep it, for it made its wearer "
    "look like weather.",
)


def words_of(rng):
    """The paragraphs again and again, in an order that does not show."""
    while True:
        for k in rng.permutation(len(PARAGRAPHS)):
            yield PARAGRAPHS[k].split()


def justify(draw, words, face, x, y, width, indent, last):
    space = draw.textlength(" ", font=face)
    left = x + indent
    gap = space
    if not last and len(words) > 1:
        gap = (width - indent - sum(draw.textlength(w, font=face) for w in words)) / (len(words) - 1)
    for word in words:
        draw.text((left, y), word, font=face, fill=INK)
        left += draw.textlength(word, font=face) + gap


def column(draw, rng, source, face, x, y, width, bottom, step):
    while True:
        words = next(source)
        indent = 14 * SCALE
        while words:
            if y + step > bottom:
                return
            room, taken, length = width - indent, [], 0
            while words and length + draw.textlength(words[0], font=face) <= room:
                length += draw.textlength(words[0] + " ", font=face)
                taken.append(words[0])
                words = words[1:]
            justify(draw, taken, face, x, y, width, indent, not words)
            indent = 0
            y += step


def centred(draw, text, face, y, middle):
    draw.text((middle - draw.textlength(text, font=face) / 2, y), text, font=face, fill=INK)


def engraving(rng, width, height):
    """A burning tower over water at night, as a halftone."""
    x, y = np.meshgrid(np.linspace(-1, 1, width), np.linspace(0, 1, height))
    grey = 0.42 + 0.28 * clouds(rng, width, height, 4, 5) * (1 - y)
    glow = np.exp(-((x - 0.25) ** 2 / 0.10 + (y - 0.34) ** 2 / 0.06))
    grey = grey + 0.75 * glow
    smoke = clouds(rng, width, height, 6, 5)
    plume = np.exp(-((x - 0.25 + 0.9 * (0.30 - y)) / (0.05 + 0.5 * np.clip(0.32 - y, 0, 1))) ** 2) * (y < 0.32)
    grey = grey * (1 - 0.65 * plume * (0.6 + 0.5 * smoke))
    water = y > 0.74
    ripple = 0.5 + 0.5 * np.sin(220 * np.abs(y + 0.006 * np.sin(31 * x + 9 * smoke)) ** 1.6 + 4 * smoke)
    grey = np.where(water, 0.16 + 0.5 * ripple * np.exp(-((x - 0.25) / 0.32) ** 2) + 0.06 * ripple, grey)
    tower = (np.abs(x - 0.25) < 0.075 + 0.05 * (y - 0.36)) & (y > 0.36) & ~water
    rock = (y > 0.70 + 0.05 * smoke + 0.25 * (x - 0.2) ** 2) & ~water
    up = np.clip((0.40 - y) / 0.24, 0, 1)  # 0 at the lamp, 1 at the tip
    wide = 0.11 * np.sqrt(up + 0.02) * (1 - up) ** 0.8 + 1e-3
    flame = np.exp(-((x - 0.25 + 0.06 * up * np.sin(9 * up + 5 * smoke)) / wide) ** 4) * (y < 0.41)
    grey = np.where(tower | rock, 0.08, grey) + 0.9 * flame
    u, v = np.meshgrid(np.arange(width), np.arange(height))
    a = math.radians(45)
    p, q = (u * math.cos(a) + v * math.sin(a)) / 4.6, (v * math.cos(a) - u * math.sin(a)) / 4.6
    screen = 0.5 + 0.25 * (np.cos(2 * math.pi * p) + np.cos(2 * math.pi * q))
    ink = np.clip((screen - np.clip(grey, 0.03, 0.97)) * 9 + 0.5, 0, 1)
    return Image.fromarray((255 * ink).astype("uint8"))


def newspaper():
    rng = np.random.default_rng(1117)
    w, h = PAGE[0] * SCALE, PAGE[1] * SCALE
    sheet = Image.new("RGB", (w, h), NEWSPRINT)
    draw = ImageDraw.Draw(sheet)
    edge = 56 * SCALE
    centred(draw, TITLE, font("Bold", 98 * SCALE), 34 * SCALE, w / 2)
    y = 172 * SCALE
    draw.line((edge, y, w - edge, y), fill=INK, width=3 * SCALE)
    small = font("Regular", 21 * SCALE)
    draw.text((edge, y + 5 * SCALE), LINE[0], font=small, fill=INK)
    centred(draw, LINE[1], small, y + 5 * SCALE, w / 2)
    draw.text((w - edge - draw.textlength(LINE[2], font=small), y + 5 * SCALE), LINE[2], font=small, fill=INK)
    y += 38 * SCALE
    draw.line((edge, y, w - edge, y), fill=INK, width=SCALE)
    centred(draw, HEADLINE, font("Bold", 76 * SCALE), y + 8 * SCALE, w / 2)
    centred(draw, BELOW, font("Italic", 29 * SCALE), y + 106 * SCALE, w / 2)
    y += 160 * SCALE
    draw.line((w / 2 - 90 * SCALE, y, w / 2 + 90 * SCALE, y), fill=INK, width=SCALE)
    y += 16 * SCALE

    gap, columns = 26 * SCALE, 4
    wide = (w - 2 * edge - (columns - 1) * gap) / columns
    tall = int(430 * SCALE)
    picture = engraving(rng, int(2 * wide + gap), tall)
    at = (int(edge + wide + gap), int(y + 6 * SCALE))
    sheet.paste(Image.new("RGB", picture.size, INK), at, picture)
    draw.rectangle((at[0], at[1], at[0] + picture.size[0], at[1] + tall), outline=INK, width=2 * SCALE)
    centred(draw, "The Lamp House at eleven, from a sketch made on board the Halcyon", font("Italic", 19 * SCALE),
            at[1] + tall + 4 * SCALE, at[0] + picture.size[0] / 2)
    face, step, source = font("Regular", 19.5 * SCALE), 23.0 * SCALE, words_of(rng)
    for k in range(columns):
        x = edge + k * (wide + gap)
        top = at[1] + tall + 38 * SCALE if k in (1, 2) else y
        column(draw, rng, source, face, x, top, wide, h - edge, step)
        if k:
            start = top if k == 2 else y
            draw.line((x - gap / 2, start, x - gap / 2, h - edge), fill=INK, width=SCALE)
    sheet = np.asarray(sheet.resize(PAGE, Image.LANCZOS), dtype=float)
    grain = 1 + 0.02 * clouds(rng, *PAGE, 9, 3) + 0.02 * clouds(rng, *PAGE, 140, 2)
    through = 1 - 0.035 * np.asarray(
        Image.fromarray(sheet.astype("uint8")).transpose(Image.Transpose.FLIP_LEFT_RIGHT).convert("L")
        .filter(ImageFilter.GaussianBlur(2)).point(lambda v: 255 if v < 150 else 0), dtype=float) / 255
    image = Image.fromarray(np.clip(sheet * (grain * through)[:, :, None], 0, 255).astype("uint8"))
    save(image, EXAMPLES / "newspaper" / "newspaper.jpg")


# ---- a cotton curtain with a printed border, 0.5 x 0.7 m

CLOTH = (1000, 1400)


def rosette(x, y, petals):
    r, a = np.hypot(x, y), np.arctan2(y, x)
    return (r < 0.34 + 0.11 * np.cos(petals * a)) & (r > 0.10) | (r < 0.055)


def curtain():
    rng = np.random.default_rng(7)
    w, h = CLOTH
    u, v = np.meshgrid((np.arange(w) + 0.5) / w, (np.arange(h) + 0.5) / h)
    ground, print_ = np.array((233, 224, 203.0)), np.array((52, 84, 116.0))
    # rosettes in staggered rows, a stripe below
    x, y = u * 10, v * 14
    y2 = y - 0.5 * (np.floor(x) % 2)
    dyed = rosette(x % 1 - 0.5, y2 % 1 - 0.5, 6) & (v < 0.86)
    dyed |= (v > 0.885) & (v < 0.900) | (v > 0.960) & (v < 0.975)
    leaf = np.abs(v - 0.93 + 0.014 * np.sin(u * 2 * math.pi * 11)) < 0.0042
    dot = np.hypot((u * 22 % 1 - 0.5) / 22, (v - 0.93) * 1.4) < 0.0075
    dyed |= leaf | dot & (v > 0.9) & (v < 0.96)
    mask = blurred(dyed, 0.8)
    mask *= 0.86 + 0.10 * clouds(rng, w, h, 60, 3)
    colour = ground * (1 - mask[:, :, None]) + print_ * mask[:, :, None]
    weave = 1 + 0.035 * np.sin(u * w * 1.9) * np.sin(v * h * 1.9)
    threads = Image.fromarray((rng.random((h, 24)) * 255).astype("uint8")).resize((w, h), Image.BICUBIC)
    slub = 1 + 0.03 * np.asarray(threads, dtype=float) / 255 + 0.03 * rng.random((h, 1)) + 0.02 * rng.random((1, w))
    colour *= (weave * slub / 1.06)[:, :, None]
    save(Image.fromarray(np.clip(colour, 0, 255).astype("uint8")), EXAMPLES / "curtain" / "curtain.jpg")


# ---- a sailor's shirt, 1.2 m to a side, as its charts are: stripes around body and sleeves

KNIT = (1200, 1200)


def shirt():
    rng = np.random.default_rng(3)
    w, h = KNIT
    u, v = np.meshgrid((np.arange(w) + 0.5) / w, (np.arange(h) + 0.5) / h)
    up = 1 - v
    height = 0.85 + 1.2 * (up - 0.03)  # of the body above the floor, m
    body, sleeve = height / 0.034 % 1 < 0.36, (up - 0.77) * 1.2 / 0.034 % 1 < 0.36
    stripe = blurred(np.where(up < 0.6, (height < 1.30) & (height > 0.89) & body, sleeve), 0.7)
    rib = 1 + 0.03 * np.sin(u * w * 1.7) + 0.02 * rng.random((1, w)) + 0.02 * rng.random((h, w))
    colour = np.array((236, 230, 216.0)) * (1 - stripe[:, :, None]) + np.array((38, 52, 92.0)) * stripe[:, :, None]
    colour *= (rib / 1.05 * (1 + 0.03 * clouds(rng, w, h, 40, 3)))[:, :, None]
    save(Image.fromarray(np.clip(colour, 0, 255).astype("uint8")), EXAMPLES / "shirt" / "shirt.jpg")


# ---- how readily a page burns, 0 to 1: figure 12's texture

RATE = (420, 594)


def page():
    rng = np.random.default_rng(12)
    w, h = RATE
    broad, fine = clouds(rng, w, h, 4, 6), clouds(rng, w, h, 23, 4)
    veins = 1 - np.abs(clouds(rng, w, h, 7, 5)) * 3
    value = 0.42 + 0.52 * broad + 0.14 * fine + 0.22 * np.clip(veins, 0, 1)
    picture = Image.fromarray((255 * np.clip(value, 0, 1)).astype("uint8"))
    picture.save(EXAMPLES / "page-hot" / "rate.png", optimize=True)
    print("rate.png")


if __name__ == "__main__":
    wanted = sys.argv[1:] or ["newspaper", "curtain", "shirt", "page"]
    for name in wanted:
        {"newspaper": newspaper, "curtain": curtain, "shirt": shirt, "page": page}[name]()
