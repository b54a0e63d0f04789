#!/usr/bin/env python3
"""The prototype of one sheet on several nodes (strands_mpi.c) on 1, 2 and 4 ranks of this machine.

    tests/farm/check_mpi.py [--install] [--rate NS]

Holds the motion against one rank's, and what rounding does to it against a nudge of 1e-15 m; prints times and messages,
and what they say about 10^8 springs on 64 nodes. --rate: ns a spring and projection on one node, of `singe bench
dynamics` with all of its cores [1]. --install gets Open MPI by apt-get.
"""

import argparse
import array
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def run(work, ranks, size, substeps, nudge=None):
    """Positions, and the times and messages of a substep."""
    out = os.path.join(work, "out")
    command = ["mpirun", "--oversubscribe", "-n", str(ranks), os.path.join(work, "strands"), str(size), str(size),
               str(substeps), out, *([str(nudge)] if nudge else [])]
    done = subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT, check=True)
    found = re.search(r"([\d.]+) ms a substep, of it ([\d.]+) projecting and ([\d.]+) in messages; (\d+) messages, "
                      r"([\d.]+) kB", done.stdout)
    positions = array.array("d")
    with open(out, "rb") as file:
        positions.frombytes(file.read())
    return positions, [float(x) for x in found.groups()]


def distance(a, b):
    return max(abs(x - y) for x, y in zip(a, b))


def model(rate, latency, bandwidth):
    """10^8 springs on 8 x 8 nodes: a square sheet with 4 springs a particle, each block cut on all sides."""
    springs, blocks = 1e8, 8
    side = (springs / 4) ** 0.5 / blocks  # particles along a block's side
    compute = rate * 1e-9 * springs / blocks**2
    # rows are cut one way, columns the other, each diagonal both: 6 cuts; 6 messages each, of 13 numbers a strand in
    # all, and two passes along the 8 blocks of a row
    messages = 6 * ((6 + 2 * (blocks - 1)) * latency + 13 * 8 * side / bandwidth)
    return side, compute, messages


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--install", action="store_true")
    parser.add_argument("--rate", type=float, default=1.0)
    options = parser.parse_args()
    if options.install and not shutil.which("mpicc"):
        for command in (["update"], ["install", "-y", "--no-install-recommends", "openmpi-bin", "libopenmpi-dev"]):
            subprocess.run(["apt-get", "-qq", *command], check=True, stdout=subprocess.DEVNULL)
    if not shutil.which("mpicc"):
        sys.exit("check_mpi: needs Open MPI (--install)")
    with tempfile.TemporaryDirectory() as work:
        subprocess.run(["mpicc", "-O2", "-std=c17", "-Wall", "-Wextra", "-o", os.path.join(work, "strands"),
                        os.path.join(HERE, "strands_mpi.c"), "-lm"], check=True)
        one, _ = run(work, 1, 100, 10)
        for ranks in 2, 4:
            off = distance(one, run(work, ranks, 100, 10)[0])
            print(f"{ranks} ranks after 10 substeps: {off:.1e} m from one rank")
            if not off < 1e-13:
                sys.exit("check_mpi: the cut strands do not move as whole ones")
        one, _ = run(work, 1, 100, 240)
        nudged = distance(one, run(work, 1, 100, 240, 1e-15)[0])
        for ranks in 2, 4:
            off = distance(one, run(work, ranks, 100, 240)[0])
            print(f"{ranks} ranks after 240: {off:.1e} m; one rank with a particle nudged by 1e-15 m: {nudged:.1e} m")
            if not off < 10 * nudged:
                sys.exit("check_mpi: the motion differs by more than rounding explains")
        for size in 200, 800:
            times = {ranks: [run(work, ranks, size, 20)[1] for _ in range(3)] for ranks in (1, 2, 4)}
            for ranks, runs in times.items():
                whole, solve, wait, messages, size_kb = sorted(runs)[1]
                print(f"{size} x {size}, {ranks} ranks: {whole:8.2f} ms a substep ({sorted(times[1])[1][0] / whole:.2f} x),"
                      f" {solve:8.2f} projecting, {wait:.2f} in messages ({messages:.0f}, {size_kb:.0f} kB a rank)")
    for latency, bandwidth, name in ((2e-6, 10e9, "2 us, 10 GB/s"), (30e-6, 1e9, "30 us, 1 GB/s")):
        side, compute, messages = model(options.rate, latency, bandwidth)
        print(f"model, 10^8 springs on 64 nodes, {name}: blocks of {side:.0f} x {side:.0f}; a projection takes "
              f"{1e3 * compute:.2f} ms and its messages {1e3 * messages:.2f} ms: {compute / (compute + messages):.0%}")


if __name__ == "__main__":
    main()
