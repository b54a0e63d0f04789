#!/usr/bin/env python3
"""Builds the files of a release from a commit, with the same bytes every time.

    release.py [--out FOLDER] [--commit COMMIT] [--twice] [--wheels] [--sign KEY]

    singe-VERSION.tar.gz                  the sources
    singe-VERSION-linux-ARCH.tar.gz       the static command for any Linux, without EXR, assimp, fit and view
    singe_VERSION-1.dsc, .debian.tar.xz, .orig.tar.gz        Debian's source package
    singe_VERSION-1_ARCH.deb, libsinge-dev_VERSION-1_ARCH.deb    of it, for the Debian or Ubuntu on which this runs
    *.whl                                 with --wheels; bindings/python/build_wheels.py states its needs
    singe-VERSION.spdx.json               the contents with versions and licences (SPDX 2.3)
    singe-VERSION.intoto.json             of which commit and packages they were made (SLSA provenance 1, not signed by itself)
    SHA256SUMS, and with --sign SHA256SUMS.asc, by the key of gpg that KEY names

--twice builds everything again in another folder and compares the bytes. Needs the packages of setup.sh, debhelper, and
the static libraries in the -dev packages of libfyaml, libpng, zlib and libjpeg.
"""

import argparse
import gzip
import hashlib
import io
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Ubuntu's name, or Debian's
JPEG = "libjpeg-turbo8-dev" if pathlib.Path("/usr/share/doc/libjpeg-turbo8-dev").exists() else "libjpeg62-turbo-dev"
# the packages whose code the static command contains, and the SPDX names of their licences
LINKED = {"libc6-dev": "LGPL-2.1-or-later", "libfyaml-dev": "MIT", "libpng-dev": "Libpng", "zlib1g-dev": "Zlib",
          JPEG: "IJG AND BSD-3-Clause AND Zlib"}

# nobody's address: whoever publishes the packages names a maintainer here and in scripts/packaging/debian/control
MAINTAINER = "The Singe authors <singe@localhost>"


def run(*command, **options):
    options.setdefault("stdout", subprocess.DEVNULL)
    subprocess.run([str(c) for c in command], check=True, **options)


def ask(*command, **options):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True, **options).stdout.strip()


def sources(commit, prefix, epoch, target):
    """git archive gives the same bytes for a commit, and gzip stores neither a name nor a time."""
    tar = subprocess.run(["git", "-C", str(ROOT), "archive", f"--prefix={prefix}/", commit], check=True,
                         capture_output=True).stdout
    with open(target, "wb") as file, gzip.GzipFile("", "wb", 9, file, mtime=epoch) as packed:
        packed.write(tar)


def time_of(commit):
    return int(ask("git", "-C", ROOT, "show", "-s", "--format=%ct", commit))


def unpacked(commit, work, out):
    """Writes the archive of the sources into out, and its tree into work; returns the tree, the version, the archive."""
    text = ask("git", "-C", ROOT, "show", f"{commit}:include/singe/base.h")
    version = re.search(r'#define SINGE_VERSION "(.*)"', text).group(1)
    archive = out / f"singe-{version}.tar.gz"
    sources(commit, f"singe-{version}", time_of(commit), archive)
    with tarfile.open(archive) as tar:
        tar.extractall(work, filter="data")
    return work / f"singe-{version}", version, archive


def pack(folder, prefix, epoch, target):
    """A tar with sorted entries of one time, owned by root."""
    memory = io.BytesIO()
    with tarfile.open(fileobj=memory, mode="w", format=tarfile.PAX_FORMAT) as tar:
        for path in sorted(folder.rglob("*")):
            entry = tar.gettarinfo(path, f"{prefix}/{path.relative_to(folder)}")
            entry.uid = entry.gid = 0
            entry.uname = entry.gname = "root"
            entry.mtime = epoch
            entry.mode = 0o755 if path.is_dir() or os.access(path, os.X_OK) else 0o644
            with open(path, "rb") if path.is_file() else io.BytesIO() as data:
                tar.addfile(entry, data if path.is_file() else None)
    with open(target, "wb") as file, gzip.GzipFile("", "wb", 9, file, mtime=epoch) as packed:
        packed.write(memory.getvalue())


def configure(source, build, *more):
    # no path of this machine in the binaries
    flags = f"-ffile-prefix-map={source}=. -ffile-prefix-map={build}=build"
    run("cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_INSTALL_PREFIX=/usr",
        f"-DCMAKE_C_FLAGS={flags}", "-DSINGE_TESTS=OFF", "-DSINGE_PYTHON=OFF", *more)
    run("cmake", "--build", build)


def debian_source(source, version, epoch, orig, work, out):
    """Debian's source package of a tree, whose archive is `orig`; returns the path of its .dsc."""
    place = work / "debian"
    tree = place / f"singe-{version}"
    shutil.copytree(source, tree)
    shutil.copytree(source / "scripts/packaging/debian", tree / "debian")
    day = ask("date", "-u", "-R", "-d", f"@{epoch}", env={**os.environ, "LC_ALL": "C"})
    (tree / "debian" / "changelog").write_text(
        f"singe ({version}-1) unstable; urgency=medium\n\n  * As docs/CHANGELOG.md of the sources says.\n\n"
        f" -- {MAINTAINER}  {day}\n")
    shutil.copy(orig, place / f"singe_{version}.orig.tar.gz")
    run("dpkg-source", "-b", tree.name, cwd=place)
    for made in place.glob("singe_*"):
        shutil.copy(made, out)
    return out / f"singe_{version}-1.dsc"


def sources_of_debian(commit, out):
    """Debian's source package alone."""
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        source, version, archive = unpacked(commit, work, work)
        debian_source(source, version, time_of(commit), archive, work, out)


def debian_packages(dsc, work, out):
    run("dpkg-source", "-x", dsc, work / "deb")
    run("dpkg-buildpackage", "-b", "-us", "-uc", cwd=work / "deb", stderr=subprocess.DEVNULL,
        env={**os.environ, "DEB_BUILD_OPTIONS": "noautodbgsym"})
    for package in work.glob("*.deb"):
        shutil.copy(package, out)


def static_command(source, work, out, name, epoch):
    """The command, its licences, and what a first try needs."""
    build, folder = work / "static", work / "portable"
    configure(source, build, "-DSINGE_EXR=OFF", "-DSINGE_ASSIMP=OFF",
              "-DSINGE_NLOPT=OFF", "-DSINGE_STATIC=ON")
    (folder / "examples").mkdir(parents=True)
    shutil.copy(build / "singe", folder)
    run("strip", folder / "singe")
    for file in ("LICENSE", "README.md"):
        shutil.copy(source / file, folder)
    for part, place in ("docs", "docs"), ("src/materials", "materials"), ("examples/letter", "examples/letter"):
        shutil.copytree(source / part, folder / place, ignore=shutil.ignore_patterns("gallery", "samples", "*.[ch]"))
    licences = folder / "licences"
    licences.mkdir()
    for package in LINKED:
        shutil.copy(f"/usr/share/doc/{package}/copyright", licences / f"{package}.txt")
    pack(folder, name, epoch, out / f"{name}.tar.gz")


def bill_of_materials(version, commit, created, out):
    """SPDX 2.3: the files of the release, and the libraries inside the static command."""
    def package(key, name, version, licence, **more):
        return {"SPDXID": f"SPDXRef-{key}", "name": name, "versionInfo": version, "downloadLocation": "NOASSERTION",
                "filesAnalyzed": False, "licenseConcluded": licence, "licenseDeclared": licence,
                "copyrightText": "NOASSERTION", **more}

    packages, relations = [], []
    for path in sorted(out.iterdir()):
        key = "file-" + re.sub(r"[^A-Za-z0-9.-]", "-", path.name)
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        packages.append(package(key, path.name, version, "MIT", supplier="Organization: Singe",
                                checksums=[{"algorithm": "SHA256", "checksumValue": digest}]))
        relations.append(("SPDXRef-DOCUMENT", "DESCRIBES", f"SPDXRef-{key}"))
        if "-linux-" in path.name:
            relations += [(f"SPDXRef-{key}", "STATIC_LINK", f"SPDXRef-{name}") for name in LINKED]
    for name, licence in LINKED.items():
        packages.append(package(name, name, ask("dpkg-query", "-W", "-f", "${Version}", name), licence,
                                supplier="Organization: Debian"))
    document = {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"singe-{version}",
        "documentNamespace": f"https://spdx.org/spdxdocs/singe-{version}-{commit}",
        "creationInfo": {"created": created, "creators": ["Organization: Singe", "Tool: scripts/release.py"]},
        "packages": packages,
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b}
                          for a, kind, b in relations]}
    (out / f"singe-{version}.spdx.json").write_text(json.dumps(document, indent=1) + "\n")


def provenance(version, commit, created, out):
    """An in-toto statement of SLSA provenance 1: the files, the commit, and Debian's packages whose code they contain."""
    subjects = [{"name": path.name, "digest": {"sha256": hashlib.sha256(path.read_bytes()).hexdigest()}}
                for path in sorted(out.iterdir())]
    packages = [{"uri": f"pkg:deb/debian/{name}@{ask('dpkg-query', '-W', '-f', '${Version}', name)}"} for name in LINKED]
    statement = {
        "_type": "https://in-toto.io/Statement/v1", "subject": subjects,
        "predicateType": "https://slsa.dev/provenance/v1",
        "predicate": {
            "buildDefinition": {
                "buildType": "urn:singe:scripts/release.py",
                "externalParameters": {"commit": commit},
                "resolvedDependencies": [{"uri": "urn:singe:git", "digest": {"gitCommit": commit}}, *packages]},
            "runDetails": {"builder": {"id": "urn:singe:scripts/release.py"}, "metadata": {"startedOn": created}}}}
    (out / f"singe-{version}.intoto.json").write_text(json.dumps(statement, indent=1) + "\n")


def release(commit, out, wheels):
    epoch = time_of(commit)
    created = ask("date", "-u", "-d", f"@{epoch}", "+%Y-%m-%dT%H:%M:%SZ")
    os.environ.update(SOURCE_DATE_EPOCH=str(epoch), LC_ALL="C", TZ="UTC")
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        source, version, archive = unpacked(commit, work, out)
        static_command(source, work, out, f"singe-{version}-linux-{os.uname().machine}", epoch)
        debian_packages(debian_source(source, version, epoch, archive, work, out), work, out)
        if wheels:
            run(sys.executable, source / "bindings" / "python" / "build_wheels.py", "--out", out, "--work", work / "wheels")
    bill_of_materials(version, commit, created, out)
    provenance(version, commit, created, out)
    sums = "".join(f"{hashlib.sha256(p.read_bytes()).hexdigest()}  {p.name}\n" for p in sorted(out.iterdir()))
    (out / "SHA256SUMS").write_text(sums)
    return sums


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--commit", default="HEAD")
    parser.add_argument("--twice", action="store_true")
    parser.add_argument("--wheels", action="store_true")
    parser.add_argument("--sign", metavar="KEY")
    options = parser.parse_args()
    options.commit = ask("git", "-C", ROOT, "rev-parse", options.commit)  # HEAD may move meanwhile
    if options.wheels:
        run(sys.executable, ROOT / "bindings" / "python" / "build_wheels.py", "--tools")
    sums = release(options.commit, options.out.resolve(), options.wheels)
    print(sums, end="")
    if options.twice:
        with tempfile.TemporaryDirectory() as again:
            other = release(options.commit, pathlib.Path(again) / "again", options.wheels)
        differ = [a for a, b in zip(sums.splitlines(), other.splitlines()) if a != b]
        if differ or len(sums) != len(other):
            sys.exit("release.py: the second build has other bytes:\n" + "\n".join(differ))
        print(f"built twice: {len(sums.splitlines())} files have the same bytes")
    if options.sign:
        run("gpg", "--batch", "--yes", "--armor", "--detach-sign", "--local-user", options.sign, "SHA256SUMS",
            cwd=options.out)


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as error:  # which has printed what is wrong
        sys.exit(f"release.py: {' '.join(map(str, error.cmd))[:200]} failed")
