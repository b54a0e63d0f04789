#!/usr/bin/env python3
"""Writes web/view/look.js, the look of paper, embers and flames in GLSL for the page and `singe view`, from the C of the
preview (program/preview): the functions that are named here, the constants and the structs.

usage: write_look.py [--check]

--check: changes nothing, and fails where the file differs. What the functions call and is not among them (noise, lookups)
is in web/view/shaders.js. They are to be plain: numbers, vectors, structs of these, no pointers but to structs.
"""

import pathlib
import re
import sys

import write_types

ROOT = pathlib.Path(__file__).resolve().parents[1]
FILE = ROOT / "web/view/look.js"
CONSTANTS = ("ember.h", "paper_look.h", "fire.h", "shade_paper.c", "fire_shade.c", "fire_kernel.h", "fire_march.c", "airborne.c", "sparks.c", "light.h", "fire.c", "fire_feet.c",
             "shade_ground.c", "shade_metal.c", "lamps.c")
PARTS = {
    "PAPER": {
        "structs": {"paper_look.h": ["PaperState"], "shade_paper.c": ["Bent"]},
        "functions": {
            "ember.h": ["ember_activity", "ember_starved"],
            "paper_look.h": ["ember_temperature"],
            "noise.h": ["noise3_gradient"],
            "shade_paper.c": ["paper_noise", "ridge", "scorch_colour", "askew", "shade_paper_bend", "paper_cracks", "tilt",
                              "ash_amount", "border_bite", "border_bay", "border_distance", "near_border", "fibres_along", "ash_on_char", "ash_lace", "ash_shade", "ember_air", "ember_seen",
                              "line_life", "ember_line", "sparks", "border_glow", "leaf_alive", "leaf_glow", "ember_shade", "is_hole",
                              "flocks_of", "print_seen", "scorch_amount", "ink_kept", "char_shade"],
            "lighting.c": ["light_mirrored"],
        },
    },
    "FLAME": {
        "calls": ["Noise noise_at(vec3 q);", "FireCell cell_at(vec3 p);"],
        "structs": {"fire.h": ["FireCell", "FirePoint", "Matter", "Smoke"], "fire_shade.c": ["Noise"]},
        "functions": {
            "fire_eddies.h": ["eddies"],
            "fire_kernel.h": ["eddies_passed", "shade_flame"],
            "fire_shade.c": ["fire_sway", "fire_between", "fire_smoke_at", "fold_sum", "fold_sum_twice", "fire_smoke_between"],
        },
    },
}
# what the C computes for many positions at once, shaders do for one
TYPES = {"Float3": "vec3", "uint32_t": "float", "int32_t": "float", "int": "float", "Wide": "float", "Wide3": "vec3",
         "WidePoint": "FirePoint", "Real": "float", "Real3": "vec3"}
CALLS = {"expf": "exp", "sqrtf": "sqrt", "fabsf": "abs", "logf": "log", "powf": "pow", "sinf": "sin", "cosf": "cos",
         "floorf": "floor", "minf": "min", "maxf": "max", "mixf": "mix", "clampf": "clamp", "float3": "vec3",
         "float3_mix": "mix", "float3_dot": "dot", "float3_length": "length", "wide_exp": "exp", "wide_sqrt": "sqrt",
         "wide_abs": "abs", "wide_min": "min", "wide_max": "max", "wide_mix": "mix", "wide_clamp": "clamp",
         "wide_step": "stepf", "wide_any": "", "wide3": "vec3", "wide3_mad": "float3_mad",
         "wide3_scale": "float3_scale", "wide3_of": "float3_scale", "real3": "vec3"}
DROPPED = ("preview", "fire", "preview->blackbody", "NULL")


def read(path):
    return re.sub(r"//[^\n]*", "", path.read_text(encoding="utf-8"))


def block(text, at):
    """The text from `at` to the end of the braces that begin behind it."""
    depth, i = 0, text.index("{", at)
    while True:
        depth += (text[i] == "{") - (text[i] == "}")
        i += 1
        if not depth:
            return text[at:i]


def constants(texts):
    found = {}
    for text in texts.values():
        for name, value in re.findall(r"^#define (\w+) \(?(-?[\d.]+(?:e-?\d+)?)f?\)?[ ]*$", text, re.MULTILINE):
            found[name] = float(value)
    return found


def function(text, name):
    match = re.search(r"^(?:static )?(?:inline )?\w+ %s\([^;{]*\) \{" % name, text, re.MULTILINE)
    if not match:
        sys.exit(f"write_look.py: there is no function {name}")
    return block(text, match.start())


def number(match):
    text = match.group(0).rstrip("f")
    return text if re.search(r"[.e]", text) else text + ".0"


def listed(text):
    """Arrays with their values, in GLSL's words."""
    rows = re.compile(r"\bfloat (\w+)\[(\d+)\]\[4\] = \{(.*?)\}\s*;", re.DOTALL)  # of four numbers each
    text = rows.sub(lambda m: "vec4 %s[%s] = vec4[%s](%s);" % (
        m[1], m[2], m[2], m[3].replace("{", "vec4(").replace("}", ")")), text)
    return re.sub(r"(\w+)\[(\d+)\] = \{([^{}]*)\}", r"\1[\2] = float[\2](\3)", text)


def translated(text, structs):
    text = re.sub(r"^(?:static )?(?:inline )?", "", text)
    text = re.sub(r"\bstatic const\b", "const", text)
    for name, value in re.findall(r"enum \{ (\w+) = (\d+) \};", text):
        text = re.sub(rf"\[{name}\]", f"[{value}]", text)
        text = re.sub(r"enum \{ %s = \d+ \};" % name, f"const float {name} = {value};", text)
    text = listed(text)

    text = re.sub(r"\b(min|max|distance|patch|sample|step)\b(?! ?\()", r"\1_", text)  # GLSL has these words

    # pointers, and what shaders have once and for all
    head, body = text.split("{", 1)
    head = re.sub(r"const (?:Preview|Fire) \*\w+, ", "", head)
    head = re.sub(r"\bconst (\w+) \*(\w+)", r"\1 \2", head)
    head = re.sub(r"(?<=[(,])( ?)(\w+) \*(\w+)", r"\1inout \2 \3", head)
    head = re.sub(r"\bfloat (\w+)\[2\]", r"inout float \1[2]", head)
    for gone in DROPPED:
        body = re.sub(r"(?<=\()%s, " % re.escape(gone), "", body)
        body = re.sub(r"(?<=\()%s(?=\))" % re.escape(gone), "", body)
        body = re.sub(r", %s(?=\))" % re.escape(gone), "", body)
    text = head + "{" + re.sub(r"\bconst (?=float |Float3 |Wide3? |Noise |vec4 |bool |FireCell )", "", body)
    text = re.sub(r"\b(?:fire|preview)->(\w)", lambda m: "fire" + m[1].upper(), text)
    text = re.sub(r"(?<=[(,])( ?)&(?=\w)", r"\1", text)
    text = text.replace("->", ".")

    # values
    text = re.sub(r"(?<!!)\bwide_(?:all|any)\(([^()]*)\)", r"\1", text)
    text = re.sub(r"float3_load\((\w+\[[^\]]*\]) \+ 1\)", r"\1.yzw", text)
    text = re.sub(r"\((\w+)\)\{", r"\1{", text)
    for name, fields in structs.items():
        text = re.sub(r"\b%s (\w+) = (\{)" % name, rf"{name} \1 = {name}\2", text)
        while True:
            match = re.search(r"\b%s\{" % name, text)
            if not match:
                break
            braces = block(text, match.start())
            inside = braces[len(name) + 1:-1]
            given = dict(re.findall(r"\.(\w+) = ([^,]*(?:\([^()]*\))?[^,]*)", inside)) if inside.lstrip().startswith(".") else None
            if given is not None:
                inside = ", ".join(given.get(field, "0" if kind == "float" else "vec3(0)") for kind, field in fields)
            inside = re.sub(r"^\{(.*)\}$", r"\1", inside)
            text = text.replace(braces, f"{name}({inside})", 1)
    text = re.sub(r"\* \(([\w.]+ (?:<=|>|<|>=) \w+)\)", r"* float(\1)", text)
    text = re.sub(r"\(float\)(\w+)", r"float(\1)", text)
    for old, new in {**TYPES, **CALLS}.items():
        text = re.sub(rf"\b{old}\b", new, text)
    text = re.sub(r"(?<![\w.\[])(\d+\.?\d*(?:e-?\d+)?f?)(?![\w.])", number, text)
    text = re.sub(r"(?<=[a-z])\[(?!\d+(?:\]| ?\()[^\]]* ?=?)([^\]]+)\]", r"[int(\1)]", text)
    text = re.sub(r"[ \t]*\n(?:\s*\n)?", "\n", text)
    wrong = re.search(r"->|\bNULL\b|\{[^;{}]*\}|&\w|\*\w", text)
    if wrong:
        sys.exit(f"write_look.py: no GLSL for {wrong.group(0)!r} in\n{text}")
    return text


def struct(text, name):
    match = re.search(r"typedef struct %s \{(.*?)\} %s;" % (name, name), text, re.DOTALL)
    fields = []
    for kind, names in re.findall(r"(\w+) ([\w, \[\]]+);", match.group(1)):
        fields += [(TYPES.get(kind, kind), field) for field in names.split(", ") if kind in ("float", "Float3")]
    return [(kind, field) for kind, field in fields if "[" not in field]


def check(parts, numbers, others):
    """Calls by hand in shaders.js have as many arguments as the functions have now, and each constant has a value."""
    shaders = others["shaders.js"]
    for name, given in re.findall(r"^\w+ (\w+)\(([^)]*)\)", "\n".join(parts), re.MULTILINE):
        for match in re.finditer(rf"(?<![\w ]) ?\b{name}\(", shaders):
            if len(write_types.arguments(round_brackets(shaders, match.end()))) != len(given.split(",")):
                sys.exit(f"write_look.py: web/view/shaders.js calls {name} with other arguments than ({given})")
    names = re.findall(r"\b[A-Z][A-Z]+_[A-Z_]+\b", "\n".join(parts)) + re.findall(r"\bLOOK\.(\w+)", " ".join(others.values()))
    lost = sorted(set(names) - set(numbers))
    if lost:
        sys.exit(f"write_look.py: no #define of {', '.join(lost)} in {', '.join(CONSTANTS)}")


def round_brackets(text, at):
    depth, i = 1, at
    while depth:
        depth += (text[i] == "(") - (text[i] == ")")
        i += 1
    return text[at:i - 1]


def main():
    texts = {path.name: read(path) for path in sorted((ROOT / "program/preview").glob("*.[ch]"))}
    texts["ember.h"] = read(ROOT / "program/formats/ember.h")
    numbers = constants({name: texts[name] for name in CONSTANTS})
    others = {path.name: path.read_text(encoding="utf-8") for folder in ("view", "src")
              for path in (ROOT / "web" / folder).glob("*.[jt]s") if path != FILE}
    out = []
    for part, what in PARTS.items():
        structs = {name: struct(texts[file], name) for file, names in what["structs"].items() for name in names}
        glsl = ["struct %s { %s };" % (name, " ".join(f"{kind} {field};" for kind, field in fields))
                for name, fields in structs.items()] + what.get("calls", [])
        glsl += [translated(function(texts[file], name), structs)
                 for file, names in what["functions"].items() for name in names]
        text = "\n".join(glsl)
        with_it = text + " ".join(re.findall(r"`[^`]*\$\{%s\}[^`]*`" % part, others["shaders.js"]))
        out.append((part, "\n".join(f"const float {name} = {number_text(value)};" for name, value in numbers.items()
                                    if re.search(rf"\b{name}\b", with_it)) + "\n" + text))
    check([glsl for _, glsl in out], numbers, others)
    wanted = [name for name in numbers if re.search(rf"\bLOOK\.{name}\b", " ".join(others.values()))]
    text = "// Made by scripts/write_look.py from program/preview: do not edit.\n"
    text += "export const LOOK = { " + ", ".join(f"{name}: {numbers[name]:g}" for name in wanted) + " };\n"
    text += "".join(f"\nexport const {part} = /* glsl */ `\n{glsl}\n`;\n" for part, glsl in out)
    if "--check" not in sys.argv[1:]:
        FILE.write_text(text, encoding="utf-8")
    elif FILE.read_text(encoding="utf-8") != text:
        sys.exit("web/view/look.js does not follow from program/preview: run scripts/write_look.py")


def number_text(value):
    text = f"{value:g}"
    return text if re.search(r"[.e]", text) else text + ".0"


if __name__ == "__main__":
    main()
