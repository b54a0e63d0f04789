#!/usr/bin/env python3
"""The core on other systems: builds it by cross compilers, runs hash_runs there and compares the bytes.

Recordings (docs/replay.md) of these runs, made here, are replayed there: the state after every step is the same.
hash_runs is tried on the static library with the best instructions, plain ones and the system's own by name; and on the
shared library of the Python package (Windows: the DLL; WebAssembly has none).

    check.py --source FOLDER --build FOLDER [--install] [SYSTEM...]

All are built with SINGE_PORTABLE_MATH, as C libraries differ in the last digits of exp and others. The measure is what
hash_runs prints here, built by the preset "portable". Windows runs under wine, 64-bit Arm Linux under qemu; macOS is
built, not run; WebAssembly runs under wasmtime. A system whose compiler or emulator is missing is skipped, with a
message; --install gets them first (Debian's packages, and Zig and wasmtime from PyPI into the build folder). The last
line counts. Fails if a build fails, a program does, a run does too little, or a hash differs.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys

# preset: what to install, compilers, emulators (None: it is not run)
SYSTEMS = {
    "windows": (["gcc-mingw-w64-x86-64-win32", "wine64"], ["x86_64-w64-mingw32-gcc-win32"],
                ["wine64", "wine", "/usr/lib/wine/wine64"]),
    "arm64": (["gcc-aarch64-linux-gnu", "libc6-dev-arm64-cross", "qemu-user"], ["aarch64-linux-gnu-gcc"],
              ["qemu-aarch64", "qemu-aarch64-static"]),
    "macos": (["python3-venv"], [], None),
    "wasm": (["clang", "lld", "wasi-libc", "libclang-rt-14-dev-wasm32", "python3-venv"], ["wasm-ld"], []),
}
FROM_PYPI = {"macos": ("zig", "ziglang"), "wasm": ("wasmtime", "wasmtime")}  # folder and lock, module
OWN = {"arm64": ["neon"], "windows": ["v2", "v3", "v4"], "wasm": ["simd128"]}  # sets of instructions
PLAIN = ["--instructions", "plain"]


def fail(message):
    print(message)
    sys.exit(1)


def output(command, environment=None, used=None):
    """Lines that hash_runs prints; ends the check where it fails, or uses instructions that are not among `used`."""
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=3000)
    if done.returncode != 0:
        fail(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    found = done.stderr.replace("\r", "").partition("instructions: ")[2].split("\n")[0]
    if used and found not in used:
        fail(f"{' '.join(map(str, command))} used the instructions '{found}', not {' or '.join(used)}")
    return done.stdout.replace("\r", "").splitlines()


def python_with(system, build):
    """The Python that has what a system needs from PyPI: the one that --install made, or this one. None without."""
    folder, module = FROM_PYPI[system]
    for python in filter(shutil.which, (build / folder / "bin/python3", sys.executable)):
        if subprocess.run([python, "-c", f"import {module}"], capture_output=True).returncode == 0:
            return str(python)
    return None


def zig(build):
    """How to call Zig: SINGE_ZIG, or a module of a Python; None without."""
    python = python_with("macos", build)
    return os.environ.get("SINGE_ZIG") or (python and f"{python} -m ziglang")


def install(systems, build):
    root = [] if os.geteuid() == 0 else ["sudo"]
    packages = [package for system in systems for package in SYSTEMS[system][0]]
    if packages:
        environment = ["env", "DEBIAN_FRONTEND=noninteractive"]
        subprocess.run([*root, "apt-get", "update", "-q"], check=True)
        subprocess.run([*root, *environment, "apt-get", "-o", "DPkg::Lock::Timeout=300", "install", "-q", "-y",
                        "--no-install-recommends", *packages], check=True)
    for system, (name, _) in FROM_PYPI.items():
        if system not in systems or python_with(system, build) or (system == "macos" and zig(build)):
            continue
        subprocess.run([sys.executable, "-m", "venv", build / name], check=True)
        lock = pathlib.Path(__file__).resolve().parents[1] / f"locks/{name}.txt"
        subprocess.run([build / name / "bin/pip", "install", "-q", "--require-hashes", "-r", lock], check=True)


def missing(system, build):
    """What a system lacks, or None if it can be tried."""
    if system == "macos":
        return None if zig(build) else "PyPI's ziglang"
    _, compilers, emulators = SYSTEMS[system]
    if not any(map(shutil.which, compilers)):
        return " or ".join(compilers)
    if system == "wasm":
        return None if python_with(system, build) else "PyPI's wasmtime"
    return None if any(map(shutil.which, emulators)) else " or ".join(emulators)


def built(system, source, build):
    """Configures and builds a system; hash_runs on its static library, and on its shared one."""
    folder = build / system
    environment = dict(os.environ)
    if system == "macos":
        environment["SINGE_ZIG"] = zig(build)
        environment.setdefault("ZIG_GLOBAL_CACHE_DIR", str(build / "zig-cache"))
        environment.setdefault("ZIG_LOCAL_CACHE_DIR", str(build / "zig-cache"))
    subprocess.run(["cmake", "--preset", system, "-S", source, "-B", folder, "-DSINGE_RECORDING=ON"], check=True,
                   env=environment, stdout=subprocess.DEVNULL, cwd=source)
    subprocess.run(["cmake", "--build", folder, "-j2"], check=True, env=environment, stdout=subprocess.DEVNULL)
    end = ".exe" if system == "windows" else ""
    return folder / f"tests/platforms/hash_runs{end}", folder / f"python/singe/hash_runs_shared{end}"


def emulator(system, build):
    if system == "wasm":
        return [python_with(system, build), pathlib.Path(__file__).with_name("run_wasi.py")]
    name = next(filter(None, map(shutil.which, SYSTEMS[system][2])))
    return [name, "-L", "/usr/aarch64-linux-gnu"] if system == "arm64" else [name]


def compare(name, lines, wanted):
    differ = [(a, b) for a, b in zip(lines, wanted) if a != b]
    if len(lines) != len(wanted) or differ:
        first = differ[0] if differ else (f"{len(lines)} lines", f"{len(wanted)} lines")
        fail(f"{name}: {len(differ)} of {len(wanted)} hashes differ, first \"{first[0]}\", not \"{first[1]}\"")
    print(f"{name}: {len(lines)} hashes, the same")


def damage(path):
    """A copy of a recording in which a bit of the last state's hash is another (docs/replay.md)."""
    data, at, found = bytearray(path.read_bytes()), 32, 0
    while at + 9 <= len(data):
        if data[at] == 5:
            found = at + 17
        at += 9 + int.from_bytes(data[at + 1:at + 9], "little")
    data[found] ^= 1
    other = path.with_suffix(".damaged")
    other.write_bytes(data)
    return other


def replay(name, command, recordings, environment=None):
    """Every recording gives the same states, and a damaged one does not."""
    done = subprocess.run([*command, "--replay", damage(recordings[0])], capture_output=True, text=True,
                          env=environment)
    if not done.stdout.startswith("differs first: the state after step "):
        fail(f"{name}: the replay of a damaged recording says {done.stdout}{done.stderr}")
    steps = 0
    for path in recordings:
        said = output([*command, "--replay", path], environment)
        if len(said) != 1 or not said[0].startswith("the same: "):
            fail(f"{name}: the replay of {path.name} says {said}")
        steps += int(said[0].split()[2])
    print(f"{name}: {steps} replayed steps, the same")


def enough(lines):
    """Ends the check if the runs burn, ablate and tear too little to compare anything by."""
    counts = {words[0]: (int(words[2]), int(words[4]), int(words[6])) for words in map(str.split, lines)
              if words[1] == "counts"}
    whole = counts["fall"][0]
    if not (counts["burn"][0] < whole and counts["burn"][2] > 100 and counts["tear"][1] > 10 and counts["gas"][2] > 50):
        fail(f"the runs do too little: {counts}")
    hashes = [line.split()[2] for line in lines if "counts" not in line]
    if len(set(hashes)) != len(hashes):
        fail("two hashes are the same: the runs do not differ, or nothing moves")


def try_runs(system, build, program, shared, wanted, recordings):
    """Runs a system's programs by its emulator, with the instructions that it has and with some that it lacks."""
    quiet = dict(os.environ, WINEDEBUG="-all", WINEPREFIX=str(build / "wine"))
    views = [line for line in wanted if "snapshot" not in line]
    call, own = emulator(system, build), OWN[system]
    compare(f"{system}, the best instructions", output([*call, program], quiet, own), wanted)
    compare(f"{system}, plain loops", output([*call, program, *PLAIN], quiet, ["plain"]), views)
    named = own[0]
    compare(f"{system}, {named} by name", output([*call, program, "--instructions", named], quiet, [named]), views)
    if system != "wasm":
        compare(f"{system}, shared library", output([*call, shared], quiet, own), wanted)
    replay(system, [*call, program], recordings, quiet)
    lacking = "neon" if system == "windows" else "v2"
    done = subprocess.run([*call, program, "--instructions", lacking], capture_output=True, text=True, env=quiet)
    if done.returncode == 0 or "lacks the requested instructions" not in done.stderr:
        fail(f"{system}: {lacking} was not refused: {done.stderr[-500:]}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--source", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--install", action="store_true")
    parser.add_argument("systems", nargs="*", metavar="SYSTEM", help="windows, arm64, macos, wasm [all]")
    options = parser.parse_args()
    systems = options.systems or list(SYSTEMS)
    build = options.build.resolve()
    build.mkdir(parents=True, exist_ok=True)
    if options.install:
        install(systems, build)

    if not any(missing(system, build) is None for system in systems):
        for system in systems:
            print(f"skipped {system}: there is no {missing(system, build)}")
        sys.exit(77) # for ctest: nothing to try is a skip, not a success

    program, shared = built("portable", options.source, build)
    recorded = build / "recordings"
    shutil.rmtree(recorded, ignore_errors=True)
    recorded.mkdir()
    wanted = output([program, "--record", recorded])
    recordings = sorted(recorded.glob("*.singerec"))
    if len(recordings) != len({line.split()[0] for line in wanted}):
        fail(f"there are {len(recordings)} recordings")
    views = [line for line in wanted if "snapshot" not in line]
    enough(wanted)
    compare("here, 3 threads", output([program, "--threads", "3", *PLAIN], used=["plain"]), views)
    compare("here, shared library", output([shared]), wanted)
    replay("here, 3 threads", [program, "--threads", "3", *PLAIN], recordings)

    tried = 0
    for system in systems:
        lack = missing(system, build)
        if lack:
            print(f"skipped {system}: there is no {lack}")
            continue
        program, shared = built(system, options.source, build)
        tried += 1
        if SYSTEMS[system][2] is None:
            print(f"{system}: built, not run")
            continue
        try_runs(system, build, program, shared, wanted, recordings)
    print(f"tried {tried} of {len(systems)} systems")


if __name__ == "__main__":
    main()
