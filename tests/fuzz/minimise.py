#!/usr/bin/env python3
"""Leaves out calls of a recording (docs/replay.md) as long as a command still fails in the same way.

    minimise.py FILE COMMAND...

`COMMAND... FILE` must fail: a crash, a sanitizer's report, or any exit code but 0. It fails in the same way if it ends
with the same code or signal and, where it prints a sanitizer's SUMMARY, with the same one. Writes FILE.min.

A difference that a replay finds cannot be searched for: without a call, all states after it are others.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

HEADER, HEAD, CREATE, LOAD, CALLS = 32, 9, 1, 2, 16
SECONDS = 600  # for one replay


def parts(data):
    """The header with the record that makes the simulation, and the calls, each with what followed it."""
    ends, starts = [], []
    at = HEADER
    while at + HEAD <= len(data):
        kind, end = data[at], at + HEAD + int.from_bytes(data[at + 1:at + HEAD], "little")
        if end > len(data):
            break  # cut short
        if kind not in (CREATE, LOAD) and (kind >= CALLS or not starts):
            starts.append(at)
        at = end
        ends.append(at)
    starts.append(ends[-1] if ends else HEADER)
    return data[:starts[0]], [data[a:b] for a, b in zip(starts, starts[1:])]


def failure(command, data):
    """How a command fails on a recording; None where it does not."""
    with tempfile.NamedTemporaryFile(suffix=".singerec") as file:
        file.write(data)
        file.flush()
        try:
            done = subprocess.run([*command, file.name], capture_output=True, text=True, errors="replace",
                                  timeout=SECONDS, check=False)
        except subprocess.TimeoutExpired:
            return "hangs"
    summary = re.search(r"^SUMMARY: .*", done.stdout + done.stderr, re.MULTILINE)
    said = summary[0] if summary else ""
    return (done.returncode, said) if done.returncode else None


def smallest(calls, fails):
    """Leaves out half of the calls, then quarters, down to single ones."""
    size = len(calls)
    while size > 0:
        at = len(calls)
        while at > 0:  # from the end: what comes after the failure goes first
            fewer = calls[:max(0, at - size)] + calls[at:]
            if fails(fewer):
                calls = fewer
            at -= size
        size //= 2
    return calls


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("command", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    if not options.command:
        parser.error("there is no COMMAND")
    data = options.file.read_bytes()
    if data[:8] != b"SINGEREC":
        sys.exit(f"{options.file} is not a recording")
    head, calls = parts(data)
    wanted = failure(options.command, data)
    if wanted is None or failure(options.command, head + b"".join(calls)) != wanted:
        sys.exit(f"{' '.join(options.command)} {options.file} does not fail")

    tries = 0

    def fails(fewer):
        nonlocal tries
        tries += 1
        return failure(options.command, head + b"".join(fewer)) == wanted

    least = smallest(calls, fails)
    path = options.file.with_name(options.file.name + ".min")
    path.write_bytes(head + b"".join(least))
    print(f"{path}: {len(least)} of {len(calls)} calls, {path.stat().st_size} of {len(data)} bytes, after {tries} tries")


if __name__ == "__main__":
    main()
