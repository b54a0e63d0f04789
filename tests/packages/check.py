#!/usr/bin/env python3
"""Installs what scripts/release.py makes on bare systems, and burns a sheet there.

    tests/packages/check.py [--work FOLDER] [WHAT...]     bookworm trixie static conan conda [all]

bookworm, trixie   a bare Debian 12 or 13 (debootstrap); Debian's source package is built there into .deb packages, about
                   which lintian says nothing. Another bare root installs them with nothing but what they depend on, and
                   links a program against them
static             the static command in Debian 12, Debian 13 and a root without a C library, as Alpine is without glibc
conan              the recipe is created and consumed (PyPI's conan, in a folder of its own)
conda              the recipe is built with the system's tools, and installed into a prefix (PyPI's py-rattler-build and
                   py-rattler, in a folder of their own); conda-forge's tools were not tried

Needs root for the first three. The caches of all must have the same bytes as those of the command in build/.
"""

import argparse
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import venv

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import release  # noqa: E402

# whoever publishes the package names a maintainer, and the request for a package that it answers
NOBODYS = "bogus-mail-host,bogus-mail-host-in-debian-changelog,initial-upload-closes-no-bugs"
SCENE = """\
frames: 4
steps: 3
pace: 6
sheets:
  - grid: {size: [6 cm, 6 cm], cells: [16, 16]}
sources:
  - {kind: spot, position: [-3 cm, 0, 0], temperature: 1200 K, conductance: 300, radius: 1 cm, falloff: 1 cm}
gas: {cell_size: 8 mm}
preview: {size: [64, 48], samples: 1}
"""
CONSUMER = """\
#include <singe/singe.h>
#include <stdio.h>
int main(void) { return printf("%s\\n", singe_version()) < 0; }
"""


def run(*command, both=False, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, **options)
    if done.returncode or "Traceback" in done.stderr:
        sys.exit(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout + done.stderr if both else done.stdout


def bare_root(work, suite, name):
    """A fresh root of a suite; what debootstrap makes is kept and copied."""
    if os.geteuid() or not shutil.which("debootstrap"):
        sys.exit(f"{suite}: needs root and Debian's package debootstrap; conan and conda need neither")
    kept, made = work / suite, work / name
    if not kept.exists():
        run("debootstrap", "--variant=minbase", "--force-check-gpg", suite, work / f"{suite}.part")
        (work / f"{suite}.part").rename(kept)
    shutil.rmtree(made, ignore_errors=True)
    run("cp", "-a", kept, made)
    shutil.copy("/etc/resolv.conf", made / "etc" / "resolv.conf")
    return made


def inside(root, script):
    # mounts that end with the command
    mounts = f"mount -t proc proc {root}/proc && mount --rbind /dev {root}/dev && exec chroot {root} bash -euc \"$1\""
    return run("unshare", "--mount", "bash", "-c", mounts, "bash",
               f"export DEBIAN_FRONTEND=noninteractive HOME=/root\n{script}")


def cache(folder):
    """Digest of the simulation's files."""
    digest = hashlib.sha256()
    files = sorted(p for kind in ("ply", "gas") for p in (folder / kind).iterdir())
    for path in files:
        digest.update(path.name.encode() + path.read_bytes())
    return len(files), digest.hexdigest()


def expected(work):
    (work / "scene.yaml").write_text(SCENE)
    run(ROOT / "build/singe", "run", work / "scene.yaml", "-o", work / "expected", "--quiet", "--no-preview")
    return cache(work / "expected")


def compare(what, folder, wanted):
    found = cache(folder)
    if found != wanted:
        sys.exit(f"{what}: other bytes than here")
    print(f"{what}: {found[0]} files have the same bytes", flush=True)


def drawn(what, folder):
    """Ends the check unless every frame has a picture."""
    pictures = len(list((folder / "frames").iterdir())) if (folder / "frames").exists() else 0
    if pictures != 4:
        sys.exit(f"{what}: {pictures} pictures, not 4")
    print(f"{what}: 4 pictures", flush=True)


def debian(work, suite, wanted):
    """Builds in one root, installs in another."""
    builder = bare_root(work, suite, f"{suite}-build")
    place = builder / "build"
    place.mkdir()
    release.sources_of_debian("HEAD", place)
    inside(builder, "cd /build; apt-get -qq update; apt-get -qq install -y dpkg-dev lintian; "
                    "apt-get -qq build-dep -y ./*.dsc; dpkg-source -x *.dsc tree; (cd tree; dpkg-buildpackage -us -uc); "
                    f"lintian --allow-root --fail-on error,warning --suppress-tags {NOBODYS} --tag-display-limit 0 *.changes")
    print(f"{suite}: built from its source package; lintian has nothing to say", flush=True)
    root = bare_root(work, suite, f"{suite}-install")
    for package in place.glob("*.deb"):
        shutil.copy(package, root / "tmp")
    (root / "tmp/scene.yaml").write_text(SCENE)
    (root / "tmp/consumer.c").write_text(CONSUMER)
    inside(root, "apt-get -qq update; apt-get -qq install -y --no-install-recommends /tmp/*.deb; "
                 "singe run /tmp/scene.yaml -o /tmp/out --quiet")
    compare(f"{suite}, singe_*.deb", root / "tmp/out", wanted)
    drawn(f"{suite}, singe_*.deb", root / "tmp/out")
    version = inside(root, "apt-get -qq install -y --no-install-recommends gcc pkg-config >&2; cd /tmp; "
                           "gcc consumer.c $(pkg-config --cflags --libs singe) -o consumer; ./consumer")
    print(f"{suite}: a program linked against libsinge-dev says {version.strip()}", flush=True)


def static(work, wanted):
    build = work / "static"
    run("cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DSINGE_TESTS=OFF",
        "-DSINGE_PYTHON=OFF", "-DSINGE_EXR=OFF", "-DSINGE_ASSIMP=OFF", "-DSINGE_NLOPT=OFF",
        "-DSINGE_STATIC=ON")
    run("cmake", "--build", build)
    empty = work / "empty"
    shutil.rmtree(empty, ignore_errors=True)
    (empty / "tmp").mkdir(parents=True)
    roots = [("a root with nothing else", empty)]
    if os.geteuid() == 0 and shutil.which("debootstrap"):
        roots += [(suite, bare_root(work, suite, f"{suite}-static")) for suite in ("bookworm", "trixie")]
    for name, root in roots:
        shutil.copy(build / "singe", root / "singe")
        (root / "tmp/scene.yaml").write_text(SCENE)
        run("chroot", root, "/singe", "run", "/tmp/scene.yaml", "-o", "/tmp/out", "--quiet")
        compare(f"static command in {name}", root / "tmp/out", wanted)
        drawn(f"static command in {name}", root / "tmp/out")


def own_python(work, name):
    """The folder of programs of a Python of its own, with what tests/locks/NAME.txt has."""
    place = work / name
    if not (place / "bin/pip").exists():
        venv.create(place, with_pip=True)
    run(place / "bin/pip", "install", "-q", "--require-hashes", "-r", ROOT / f"tests/locks/{name}.txt")
    return place / "bin"


def conda(work, wanted):
    version = run(ROOT / "build/singe", "--version").split()[1]
    recipe = ROOT / "scripts/packaging/conda/recipe.yaml"
    run(own_python(work, "conda") / "python", ROOT / "tests/packages/conda.py", recipe,
        work / "conda-work", env={**os.environ, "SINGE_VERSION": version})
    prefix = work / "conda-work" / "prefix"
    run(prefix / "bin/singe", "run", work / "scene.yaml", "-o", work / "conda-out", "--quiet")
    compare("conda, singe in a prefix", work / "conda-out", wanted)
    drawn("conda, singe in a prefix", work / "conda-out")


def conan(work, _):
    """In its own home and its own Python."""
    environment = {**os.environ, "CONAN_HOME": str(work / "conan-home")}
    command = own_python(work, "conan") / "conan"
    run(command, "profile", "detect", "--force", env=environment)
    shown = run(command, "create", ROOT / "scripts/packaging/conan", env=environment, cwd=ROOT, both=True)
    version = run(ROOT / "build/singe", "--version").strip()
    if f"\n{version}\n" not in shown:
        sys.exit(f"conan: the test package does not say '{version}'\n{shown[-2000:]}")
    print(f"conan: created; its test package is built and says '{version}'", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build" / "packages")
    parser.add_argument("what", nargs="*", default=["all"])
    options = parser.parse_args()
    work = options.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    checks = {"bookworm": lambda: debian(work, "bookworm", wanted), "trixie": lambda: debian(work, "trixie", wanted),
              "static": lambda: static(work, wanted), "conan": lambda: conan(work, wanted),
              "conda": lambda: conda(work, wanted)}
    wanted = expected(work)
    for name in checks if options.what == ["all"] else options.what:
        checks[name]()


if __name__ == "__main__":
    main()
