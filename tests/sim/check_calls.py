#!/usr/bin/env python3
"""Every public call that takes a simulation to change it is a row of src/sim/calls.def, and every row is such a call.

    check_calls.py [--header FILE] [--table FILE]
"""
import argparse
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def declared(text):
    """Names of functions whose first parameter is a simulation that is not const."""
    text = re.sub(r"//[^\n]*", "", text)
    return set(re.findall(r"\bSINGE_API\b[^;{}]*?\bsinge_sim_(\w+)\(\s*SingeSim \*\s*\w+\s*[,)]", text))


def faults(header, table):
    rows = re.findall(r"^SINGE_(CALL\((\d+), |UNRECORDED\()(\w+)", re.sub(r"//[^\n]*", "", table), re.MULTILINE)
    calls, listed, numbers = declared(header), [name for _, _, name in rows], [n for _, n, _ in rows if n]
    found = [f"singe_sim_{name} is missing in src/sim/calls.def: recordings would lack it"
             for name in sorted(calls - set(listed))]
    found += [f"src/sim/calls.def has {name}, which sim.h does not declare" for name in sorted(set(listed) - calls)]
    found += [f"src/sim/calls.def has {name} twice" for name in sorted(set(listed)) if listed.count(name) > 1]
    found += [f"src/sim/calls.def has the number {n} twice" for n in sorted(set(numbers)) if numbers.count(n) > 1]
    found += [f"the number {n} is not from 16 to 255" for n in numbers if not 16 <= int(n) <= 255]
    return found, len(calls)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--header", type=pathlib.Path, default=ROOT / "include/singe/sim.h")
    parser.add_argument("--table", type=pathlib.Path, default=ROOT / "src/sim/calls.def")
    options = parser.parse_args()
    header, table = options.header.read_text(), options.table.read_text()
    found, count = faults(header, table)
    # a call more than the table has must be found, in one line and in several
    for new in ("SINGE_API SingeResult singe_sim_set_rain(SingeSim *sim, float rain);",
                "SINGE_API SINGE_NODISCARD SingeResult\nsinge_sim_set_rain(SingeSim *sim,\n    float rain);"):
        if len(faults(header + new, table)[0]) != len(found) + 1:
            found.append("a call that is missing would not be found")
    for fault in found:
        print(fault)
    if not found:
        print(f"{count} calls, all of them in the table")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
