#!/usr/bin/env python3
"""Writes what follows from the tables of Defs (include/singe/*.def) into the headers beside them: structs, enums,
defaults.

usage: write_types.py [--check]

Everything else of the headers is written by hand. --check: changes nothing, and fails where a header differs. A range
of scenes that is wider than the library's is refused.
"""

import pathlib
import re
import sys
import textwrap

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "include/singe"
HEADERS = {"types.h": ("sheet", "source", "collider", "pin", "wind", "solver", "gas", "contact", "sim"),
           "mesh.h": ("mesh", "grid"), "surface.h": ("render_mesh",),
           "research.h": ("network",)}
TYPES = {"FLOAT": "float", "DOUBLE": "double", "VECTOR": "float", "ORDER": "SingeColour", "INT": "int", "UINT32": "uint32_t", "UINTS": "uint32_t", "UINT64": "uint64_t", "BOOL": "bool"}
FIELDS = ("FIELD", "APART", "NEEDED", "HIDDEN", "HOOK")
WIDTH = 120


def arguments(text):
    """The arguments of a macro's call, with neighbouring strings joined."""
    parts, depth, quoted, begin = [], 0, False, 0
    for i, c in enumerate(text):
        if c == '"' and text[i - 1] != "\\":
            quoted = not quoted
        if quoted:
            continue
        depth += (c in "([{") - (c in ")]}")
        if c == "," and depth == 0:
            parts.append(text[begin:i])
            begin = i + 1
    parts.append(text[begin:])
    parts = [" ".join(part.split()) for part in parts]
    return [re.sub(r'(?<!\\)" "', "", part)[1:-1].replace('\\"', '"') if part.startswith('"') else part for part in parts]


def rows(text):
    """(macro, arguments) of each row of a table."""
    text = re.sub(r"//[^\n]*", "", text)
    for name, bits in re.findall(r"^#define (SINGE_\w+) \\\n *\((.*)\)", text, re.MULTILINE):
        text = re.sub(rf"\b{name}\b", re.sub(r"1u << (\w+)", r"BIT(\1)", bits), text)  # a set of kinds
    for match in re.finditer(r"^SINGE_(FIELD|APART|NEEDED|HIDDEN|HOOK|COUNT|NUMBERS|OTHER|WORD|DIMENSION|PARAM|PARAM_BACK|PARAM_COLOURS|SCALAR)\(", text, re.MULTILINE):
        depth, i, quoted = 1, match.end(), False
        while depth:
            if text[i] == '"' and text[i - 1] != "\\":
                quoted = not quoted
            if not quoted:
                depth += (text[i] == "(") - (text[i] == ")")
            i += 1
        row = arguments(text[match.end():i - 1])
        if match.group(1) == "APART":
            row = row[1:]  # without its key
        yield match.group(1), row


def in_words(found):
    """A range as the header states it; "" if there is none."""
    name, inside = re.match(r"(\w+)(?:\((.*)\))?$", found).groups()
    bounds = arguments(inside) if inside else []
    return {"WITHIN": "{0} to {1}", "BELOW": "{0} to below {1}", "OVER_UP_TO": "above {0}, to {1}", "FROM": ">= {0}",
            "FROM_OR_INF": ">= {0}", "OVER": "> {0}", "OVER_OR_INF": "> {0}", "ANY": ""}[name].format(*bounds)


def plain(text):
    """A text without Markdown's links."""
    return re.sub(r"\s*\(\[[^\]]*\]\([^)]*\)\)", "", text).replace("`", "")


def kinds_in_words(kinds):
    names = [name.lower() for name in re.findall(r"BIT\(SINGE_[A-Z]+?_(\w+)\)", kinds)]
    return " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


def comment(line, text):
    """A declaration with its comment, which stands above it where it is too long."""
    beside = f"    {line} ///< {text}" if text else f"    {line}"
    if len(beside) <= WIDTH:
        return [beside]
    above = textwrap.wrap(text, WIDTH - 8, break_long_words=False, break_on_hyphens=False)
    return [f"    /// {part}" for part in above] + [f"    {line}"]


def struct(name, table, units):
    lines = ["    size_t struct_size;"]
    for macro, row in table:
        if macro in FIELDS:
            kind, field, length, dimension, _, found, kinds, text = row
            kind = TYPES.get(kind) or re.match(r"(?:ENUM|KIND)\((\w+)\)", kind).group(1)
            facts = [part for part in (units[dimension], kinds_in_words(kinds), in_words(found)) if part]
            size = "" if length == "1" else f"[{length}]"
            lines += comment(f"{kind} {field}{size};", "; ".join(([", ".join(facts)] if facts else []) + [plain(text)]))
        if macro == "COUNT":
            lines += comment(f"uint32_t {row[0]};", plain(row[1]))
        if macro == "NUMBERS":
            each, count, field, dimension, found, text = row
            size = count if each == "1" else f"{each} * {count}"
            facts = ", ".join(part for part in (units[dimension], in_words(found)) if part)
            lines += comment(f"const double *{field};", f"[{size}] {facts}; {plain(text)}")
        if macro == "OTHER":
            lines += comment(f"{row[0]};", plain(row[3]))
    return "\n".join([f"typedef struct {name} {{", *lines, f"}} {name};"])


def material_struct(table, units):
    lines = ["    size_t struct_size;"]
    for macro, row in table:
        if macro in ("PARAM", "PARAM_BACK"):
            _, _, field, dimension, standard, found, _, _, text = row
            kind = "SingeParam"
        elif macro == "PARAM_COLOURS":
            _, _, field, found, text = row
            kind, dimension, field = "SingeParam", "DIM_NONE", field + "[SINGE_COLOUR_COUNT]"
        elif macro == "SCALAR":
            kind, field, dimension, standard, found, text = row
            kind = TYPES.get(kind) or re.match(r"ENUM\((\w+)\)", kind).group(1)
        else:
            continue
        facts = ", ".join(part for part in (units[dimension], in_words(found)) if part)
        lines += comment(f"{kind} {field};", (f"{facts}; " if facts else "") + plain(text))
    return "\n".join(["typedef struct SingeMaterialDef {", *lines, "} SingeMaterialDef;"])


def enum(name, words):
    lines = []
    for _, (of, value_name, value, _, text) in words:
        if of == name:
            lines += comment(f"{value_name} = {value},", plain(text))
    return "\n".join([f"typedef enum {name} {{", *lines, f"}} {name};"])


def defaults(table):
    """The paragraph on the fields whose defaults are not zero."""
    found = []
    for macro, row in table:
        if macro not in (*FIELDS, "OTHER"):
            continue
        field, value = (row[1], row[2]) if macro == "OTHER" else (row[1], row[4])
        value = re.sub(r"(\d)f\b", r"\1", re.sub(r"BRACED\((.*)\)", r"{\1}", value))
        if macro == "OTHER" and re.match(r"Singe\w+Def ", row[0]):
            found.append(f"{field} singe_default_{row[0].split('Def ')[0][5:].lower()}()")
        elif value not in ("0", "{0}", "NULL", "false"):
            found.append(f"{field} {value}")
    text = "Defaults: " + (", ".join(found) + "; all else 0 or NULL." if found else "0 or NULL.")
    return "\n".join("/// " + line for line in textwrap.wrap(text, WIDTH - 4, break_long_words=False,
                                                             break_on_hyphens=False))


def blurred(text):
    """A text without what the formatter decides: blanks, and where comments break."""
    return re.sub(r"\s+", " ", re.sub(r"///<?", " ", text))


def with_enums(text, table):
    """A header with the enums that a table lists."""
    words = [row for row in table if row[0] == "WORD"]
    for of in dict.fromkeys(row[1][0] for row in words):
        text = re.sub(r"typedef enum %s \{.*?\} %s;" % (of, of), lambda _: enum(of, words), text, flags=re.DOTALL)
    return text


def defs_header(header, text, tables, units):
    for part in HEADERS[header]:
        name = f"Singe{part.title().replace('_', '')}Def"
        new = defaults(tables[part]) + "\n" + struct(name, tables[part], units)
        text, count = re.subn(r"/// Defaults:[^\n]*\n(?:///[^\n]*\n)*typedef struct %s \{.*?\} %s;" % (name, name),
                              lambda _: new, text, flags=re.DOTALL)
        if count != 1:
            sys.exit(f"write_types.py: {header} has no struct {name} below a line of its defaults")
        text = with_enums(text, tables[part])
    return text


def material_header(_, text, tables, units):
    text = re.sub(r"typedef struct SingeMaterialDef \{.*?\} SingeMaterialDef;",
                  lambda _: material_struct(tables["material"], units), text, flags=re.DOTALL)
    return with_enums(text, tables["material"])


def main():
    tables = {file.stem: list(rows(file.read_text(encoding="utf-8"))) for file in FOLDER.glob("*.def")}
    units = {"DIM_" + row[0]: row[2] for _, row in tables["dimensions"]}
    for name in (*HEADERS, "material.h"):
        header = FOLDER / name
        before = header.read_text(encoding="utf-8")
        after = (defs_header if name in HEADERS else material_header)(name, before, tables, units)
        if "--check" not in sys.argv[1:]:
            header.write_text(after, encoding="utf-8")
        elif blurred(after) != blurred(before):
            sys.exit(f"include/singe/{name} does not follow from the tables: run scripts/write_types.py")
    return 0


if __name__ == "__main__":
    sys.exit(main())
