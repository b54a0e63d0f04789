#!/usr/bin/env python3
"""Writes bindings/python/singe/_abi.py, what ctypes has to know of the public headers: structs, enumerators, functions.

    generate.py [--cc CC] [--include DIR] [--output FILE] [--check PROGRAM]

The headers are read after the C preprocessor. --check writes no file: it compiles a program that prints sizes and
offsets, and compares them with those of ctypes. PROGRAM is where that program is put, with .c behind its name.
"""

import argparse
import ctypes
import importlib.util
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCALARS = {"char": "c_char", "float": "c_float", "double": "c_double", "int": "c_int", "_Bool": "c_bool",
           "bool": "c_bool", "size_t": "c_size_t", "int32_t": "c_int32", "int64_t": "c_int64", "uint8_t": "c_uint8",
           "uint32_t": "c_uint32", "uint64_t": "c_uint64", "void": "None"}
HEAD = '''"""Made by bindings/python/generate.py from include/singe: do not edit."""

from ctypes import (CFUNCTYPE, POINTER, Structure, c_bool, c_char, c_char_p, c_double, c_float, c_int, c_int32,
                    c_int64, c_size_t, c_uint8, c_uint32, c_uint64, c_void_p)
'''


def without_attributes(text):
    """The text without __attribute__((...))."""
    while "__attribute__" in text:
        start = text.index("__attribute__")
        end, depth = text.index("(", start), 0
        while True:
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
            if depth == 0:
                break
        text = text[:start] + text[end:]
    return text


def preprocessed(cc, include):
    command = [cc, "-E", "-P", "-I", include, "-include", "singe/singe.h", "-x", "c", os.devnull]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return without_attributes(text[text.index("typedef enum SingeResult"):])


def declarations(text):
    """Top-level declarations; functions with bodies, which are inline, are left out."""
    start, depth = 0, 0
    for i, c in enumerate(text):
        depth += {"{": 1, "}": -1}.get(c, 0)
        body = c == "}" and depth == 0 and re.match(r"\s*static\b", text[start:i])
        if depth == 0 and (c == ";" or body):
            if not body:
                yield text[start:i].strip()
            start = i + 1


class Reader:
    """Structs, enumerations, functions and types of functions, in the order of the headers."""

    def __init__(self, text):
        self.structs, self.enums, self.functions, self.callbacks = {}, {}, {}, {}
        self.opaque, self.constants, self.field_enums = set(), {}, {}
        for declaration in declarations(text):
            self.read(declaration)

    def read(self, declaration):
        if re.match(r"typedef struct \w+ \w+$", declaration):
            self.opaque.add(declaration.split()[-1])
        elif declaration.startswith("typedef struct"):
            body, name = re.fullmatch(r"typedef struct \w*\s*\{(.*)\}\s*(\w+)", declaration, re.S).groups()
            self.structs[name] = list(self.fields(name, body))
        elif re.match(r"(typedef )?enum", declaration):
            body, name = re.fullmatch(r"(?:typedef )?enum\s*\w*\s*\{(.*)\}\s*(\w*)", declaration, re.S).groups()
            self.enumerators(name, body)
        elif declaration.startswith("typedef"):
            name, kind = self.declarator(declaration.split(None, 1)[1])
            self.callbacks[name] = kind
        elif "(" in declaration:
            name, kind = self.declarator(declaration)
            self.functions[name] = kind

    def enumerators(self, name, body):
        for item in filter(str.strip, body.split(",")):
            key, value = item.split("=")
            self.constants[key.strip()] = int(value)
            self.enums.setdefault(name, {})[key.strip()] = int(value)

    def fields(self, struct, body):
        for line in filter(str.strip, body.split(";")):
            base = re.match(r"\s*(?:const\s+)?(?:struct\s+)?\w+", line).group()
            parts = re.split(r",(?![^(]*\))", line[len(base):])
            for part in parts:
                name, kind = self.declarator(base + " " + part)
                word = base.split()[-1]
                if word in self.enums:
                    self.field_enums[f"{struct}.{name}"] = word
                yield name, kind

    def base(self, word):
        if word in SCALARS:
            return SCALARS[word]
        if word in self.enums:
            return "c_int"
        if word in self.structs or word in self.callbacks:
            return word
        return "opaque"

    def pointer(self, kind):
        if kind in ("None", "opaque"):
            return "c_void_p"
        if kind == "c_char":
            return "c_char_p"
        if kind.startswith("CFUNCTYPE") or kind in self.callbacks:
            return kind
        return f"POINTER({kind})"

    def declarator(self, text):
        """(name, type) of a declaration such as `const float (*position)[4]`."""
        tokens = [t for t in re.findall(r"\w+|[*()\[\],]|\.\.\.", text) if t not in ("const", "struct")]
        name, kind, rest = self.inner(tokens[1:], self.base(tokens[0]))
        assert not rest, text
        return name, kind

    def inner(self, tokens, kind):
        """Reads a declarator of what has the type `kind`: its name, its type, and the tokens behind it."""
        while tokens and tokens[0] == "*":
            kind, tokens = self.pointer(kind), tokens[1:]
        nested, name = None, ""
        if tokens and tokens[0] == "(" and tokens[1] == "*":
            end = closing(tokens, 0)
            nested, tokens = tokens[1:end], tokens[end + 1:]
        elif tokens and re.match(r"\w", tokens[0]):
            name, tokens = tokens[0], tokens[1:]
        sizes = []
        while tokens and tokens[0] in "([":
            end = closing(tokens, 0)
            if tokens[0] == "(":
                kind = f"CFUNCTYPE({', '.join([kind, *self.arguments(tokens[1:end])])})"
            else:
                sizes.append(self.constants.get(tokens[1]) or int(tokens[1]))
            tokens = tokens[end + 1:]
        for size in reversed(sizes):
            kind = f"{kind} * {size}" if "*" not in kind else f"({kind}) * {size}"
        if nested:
            name, kind, left = self.inner(nested, kind)
            assert not left
        return name, kind, tokens

    def arguments(self, tokens):
        kinds, start, depth = [], 0, 0
        for i, token in enumerate([*tokens, ","]):
            depth += {"(": 1, ")": -1}.get(token, 0)
            if token == "," and depth == 0:
                kind = self.declarator(" ".join(tokens[start:i]))[1]
                array = re.fullmatch(r"(.*) \* \d+", kind)  # an array that is an argument is a pointer
                kinds.append(self.pointer(array.group(1)) if array else kind)
                start = i + 1
        return [] if kinds == ["None"] else kinds


def closing(tokens, at):
    """Index of the bracket that closes the one at `at`."""
    depth = 0
    for i in range(at, len(tokens)):
        depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(tokens[i], 0)
        if depth == 0:
            return i
    raise ValueError(tokens)


def wrapped(head, items, tail):
    """Items in brackets, broken at 118 columns."""
    lines, line = [], head
    for i, item in enumerate(items):
        item += tail if i + 1 == len(items) else ","
        if len(line) + len(item) + 1 > 118:
            lines.append(line)
            line = " " * len(head) + item
        else:
            line += item if line == head else " " + item
    return "\n".join([*lines, line if items else head + tail])


def written(reader, include):
    version = re.search(r'#define SINGE_VERSION "(.*)"', (include / "singe/base.h").read_text()).group(1)
    out = [HEAD, f'VERSION = "{version}"\n', "# by the name of the enumeration, \"\" for unnamed ones", "ENUMS = {"]
    for name, values in reader.enums.items():
        out.append(wrapped(f'    "{name}": {{', [f'"{key}": {value}' for key, value in values.items()], "},"))
    out.append("}\n")
    out += [f"{name} = {kind}" for name, kind in reader.callbacks.items()]
    for name, fields in reader.structs.items():
        out.append(f"\n\nclass {name}(Structure):")
        out.append(wrapped("    _fields_ = [", [f'("{field}", {kind})' for field, kind in fields], "]"))
    out.append("\n\n" + wrapped("STRUCTS = [", list(reader.structs), "]"))
    out.append("# enumerations of fields")
    out.append(wrapped("FIELD_ENUMS = {", [f'"{f}": "{e}"' for f, e in reader.field_enums.items()], "}"))
    out.append("# name: (result, arguments)")
    out.append("FUNCTIONS = {")
    for name, kind in reader.functions.items():
        result, *arguments = split_top(kind[len("CFUNCTYPE("):-1])
        out.append(wrapped(f'    "{name}": ({result}, [', arguments, "]),"))
    return "\n".join(out + ["}\n"])


def split_top(text):
    parts, depth, start = [], 0, 0
    for i, c in enumerate(text + ","):
        depth += {"(": 1, ")": -1}.get(c, 0)
        if c == "," and depth == 0:
            parts.append(text[start:i].strip())
            start = i + 1
    return parts


def load(path):
    spec = importlib.util.spec_from_file_location("singe_abi", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def in_ctypes(abi):
    """What the C program prints, by ctypes."""
    for struct in abi.STRUCTS:
        yield f"{struct.__name__} {ctypes.sizeof(struct)}"
        for name, *_ in struct._fields_:
            yield f"{struct.__name__}.{name} {getattr(struct, name).offset} {getattr(struct, name).size}"
    for values in abi.ENUMS.values():
        yield from (f"{name} {value}" for name, value in values.items())


def in_c(abi, cc, include, program):
    lines = ["#include <singe/singe.h>", "#include <stdio.h>", "int main(void) {"]
    for struct in abi.STRUCTS:
        s = struct.__name__
        lines.append(f'printf("{s} %zu\\n", sizeof({s}));')
        lines += [f'printf("{s}.{f} %zu %zu\\n", offsetof({s}, {f}), sizeof((({s} *)0)->{f}));'
                  for f, *_ in struct._fields_]
    for values in abi.ENUMS.values():
        lines += [f'printf("{name} %d\\n", (int){name});' for name in values]
    source = pathlib.Path(f"{program}.c")
    source.write_text("\n".join([*lines, "return 0; }"]))
    subprocess.run([cc, "-I", include, source, "-o", program], check=True)
    return subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cc", default="cc")
    parser.add_argument("--include", type=pathlib.Path, default=ROOT / "include")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "bindings/python/singe/_abi.py")
    parser.add_argument("--check", metavar="PROGRAM")
    options = parser.parse_args()
    if options.check:
        abi = load(options.output)
        wanted, found = in_c(abi, options.cc, options.include, options.check), list(in_ctypes(abi))
        differ = [f"C has {w}, ctypes {f}" for w, f in zip(wanted, found) if w != f]
        if differ or len(wanted) != len(found):
            sys.exit("\n".join(differ) or "lists differ in length")
        print(f"{len(found)} sizes, offsets and enumerators are those of C")
        return
    text = written(Reader(preprocessed(options.cc, options.include)), options.include)
    compile(text, str(options.output), "exec")
    options.output.write_text(text)


if __name__ == "__main__":
    main()
