#!/usr/bin/env python3
"""Writes bindings/web/src/options.ts, the types of the npm package's options, from the tables of Defs
(include/singe/*.def): one interface for each Def, with its fields, units, ranges and documentation. The build of that
package runs it.
"""

import pathlib
import re
import textwrap

import write_types

FILE = pathlib.Path(__file__).resolve().parents[1] / "bindings/web/src/options.ts"
DEFS = (*write_types.HEADERS["types.h"], "material")
HEAD = """// Made by scripts/write_options.py from include/singe/*.def: do not edit.
// Keys are those of scenes (docs/scene.md). Units are SI and kelvin.

/** Seeded noise from 0 to 1 over the sheet; scale in m is the size of its largest features. */
export interface Noise { scale: number; octaves?: number; seed?: number }
/** A grey picture over uv, 0 black to 1 white, its top row first. */
export interface Texture { width: number; height: number; values: Float32Array }
/** A parameter of a material: a number, or a pair between which noise or a picture leads. */
export type Param = number | { from: number; to: number; noise: Noise } | { from: number; to: number; texture: Texture };
export type Vector = readonly [number, number, number];
/** A position at a time, in m and s; positions between two keys lie on a straight line. */
export interface Key { time: number; position: Vector; rotation?: readonly [number, number, number, number] }
"""


def words_of(tables):
    """The words of each enum, as a union of strings."""
    found = {}
    for part in DEFS:
        for macro, row in tables[part]:
            if macro == "WORD" and row[3]:
                found.setdefault(row[0], []).append(f'"{row[3]}"')
    return {of: " | ".join(words) for of, words in found.items()}


def kind_of(kind, length, words):
    enum = re.match(r"(?:ENUM|KIND)\((\w+)\)", kind)
    if enum:
        return words[enum.group(1)]
    if kind == "ORDER":
        return f"readonly ({words['SingeColour']})[]"
    if kind == "VECTOR":
        return "Vector" if length == "3" else "readonly number[]"
    return "boolean" if kind == "BOOL" else "number"


def options(part, table, units, words):
    lines = []
    for macro, row in table:
        if macro in write_types.FIELDS:
            kind, field, length, dimension, _, found, kinds, text = row
            kind = kind_of(kind, length, words)
        elif macro in ("PARAM", "PARAM_BACK"):
            _, _, field, dimension, _, found, _, _, text = row
            kind, kinds = "Param", ""
        elif macro == "PARAM_COLOURS":
            _, _, field, found, text = row
            kind, dimension, kinds = "readonly [Param, Param, Param, Param]", "DIM_NONE", ""
        elif macro == "SCALAR":
            kind, field, dimension, _, found, text = row
            kind, kinds = kind_of(kind, "1", words), ""
        else:
            continue
        facts = [fact for fact in (units[dimension], write_types.kinds_in_words(kinds), write_types.in_words(found)) if fact]
        comment = "; ".join(([", ".join(facts)] if facts else []) + [write_types.plain(text)])
        lines += ["    /** " + "\n     *  ".join(textwrap.wrap(comment, 108)) + " */", f"    {field}?: {kind};"]
    return "\n".join([f"export interface {part.capitalize()}Options {{", *lines, "}"])


def main():
    tables = {file.stem: list(write_types.rows(file.read_text(encoding="utf-8")))
              for file in write_types.FOLDER.glob("*.def")}
    units = {"DIM_" + row[0]: row[2] for _, row in tables["dimensions"]}
    words = words_of(tables)
    text = "\n".join([HEAD, *(options(part, tables[part], units, words) + "\n" for part in DEFS)])
    FILE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
