#!/usr/bin/env python3
"""The node SingeSheet in Godot itself, without a window: bindings/godot/demo/test.gd. Exit code 77 where there is no Godot.

usage: godot.py SINGE FOLDER    the engine is $GODOT, or godot or godot4 in PATH; root without one unpacks Debian's package of
                                it (unstable, 160 MB) into FOLDER/root
"""

import os
import pathlib
import shutil
import subprocess
import sys

from plugin import ROOT, build, run

SINGE, FOLDER = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SCENE = """\
frames: 3
pace: 8
sheets:
  - grid: {size: [6 cm, 6 cm], cells: [8, 8]}
sources:
  - {kind: spot, position: [-3 cm, 0, 0], temperature: 1200 K, conductance: 300, radius: 1 cm, falloff: 1 cm}
"""


def unpack():
    """Debian's package of Godot and what it needs, in a root of its own; None where that cannot be."""
    root, apt = FOLDER / "root", FOLDER / "apt"
    if (root / "usr/bin/godot").exists():
        return root
    if os.geteuid() or not shutil.which("apt-get") or not shutil.which("chroot"):
        return None
    for part in ("etc", "lists/partial", "cache/archives/partial"):
        (apt / part).mkdir(parents=True, exist_ok=True)
    (apt / "etc/unstable.sources").write_text(
        "Types: deb\nURIs: http://deb.debian.org/debian\nSuites: sid\nComponents: main\n"
        "Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg\n")
    (apt / "status").touch()
    places = {"Dir::Etc::sourcelist": "/dev/null", "Dir::Etc::sourceparts": apt / "etc", "Dir::State::lists": apt / "lists",
              "Dir::Cache": apt / "cache", "Dir::State::status": apt / "status"}
    options = [word for name, value in places.items() for word in ("-o", f"{name}={value}")]
    for command in (["update"], ["install", "--no-install-recommends", "-y", "--download-only", "godot", "coreutils"]):
        if subprocess.run(["apt-get", *options, *command], stdout=subprocess.DEVNULL).returncode:
            return None
    part = FOLDER / "root.part"
    part.mkdir(exist_ok=True)
    for package in sorted((apt / "cache/archives").glob("*.deb")):
        run("dpkg-deb", "-x", package, part)
    for name in ("bin", "lib", "lib64"):  # links that Debian's installer makes, not its packages
        if not (part / name).exists():
            (part / name).symlink_to(f"usr/{name}")
    (part / "tmp").mkdir(exist_ok=True)
    part.rename(root)
    return root


class Engine:
    """Godot, in a folder `place` that it sees as `seen`."""

    def __init__(self):
        self.place = self.seen = FOLDER / "work"
        named = os.environ.get("GODOT") or shutil.which("godot") or shutil.which("godot4")
        root = None if named else unpack()
        if not named and not root:
            print("skipped: no Godot; set GODOT to the path of one (4.4 or later)")
            sys.exit(77)
        self.command = [named] if named else ["chroot", root, "/usr/bin/env", "HOME=/tmp", "/usr/bin/godot"]
        if root:
            self.place, self.seen = root / "tmp/singe", pathlib.Path("/tmp/singe")
        shutil.rmtree(self.place, ignore_errors=True)
        self.place.mkdir(parents=True)

    def __call__(self, *arguments):
        return subprocess.run([str(word) for word in (*self.command, "--headless", *arguments)], cwd=self.place, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300)


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    engine = Engine()
    demo = engine.place / "demo"
    shutil.copytree(ROOT / "bindings/godot/demo", demo)
    # the header is the engine's own; it is written where the engine runs, in its project
    engine("--path", engine.seen / "demo", "--dump-gdextension-interface", "--quit")
    found = [*demo.glob("gdextension_interface.h"), *engine.place.glob("gdextension_interface.h"),
             *(engine.place.parent.parent).glob("gdextension_interface.h")]
    if not found:
        sys.exit("Godot wrote no gdextension_interface.h")
    library = build(FOLDER, "godot", found[0].parent) / "libsinge_godot.so"
    (demo / "bin").mkdir(exist_ok=True)
    shutil.copy(library, demo / "bin")
    (demo / ".godot").mkdir(exist_ok=True)
    (demo / ".godot/extension_list.cfg").write_text("res://singe.gdextension\n")
    (FOLDER / "tiny.yaml").write_text(SCENE)
    run(SINGE, "run", FOLDER / "tiny.yaml", "-o", demo / "tiny", "--quiet", "--no-preview", "--force")
    done = engine("--path", engine.seen / "demo", "--fixed-fps", "60", "-s", "test.gd", "--",
                  "res://tiny/ply/tiny.####.ply")
    said = [line for line in done.stdout.splitlines() if ": yes" in line or ": NO" in line or "springs" in line]
    print("\n".join(said))
    if done.returncode or not done.stdout.rstrip().endswith("godot: all good"):
        sys.exit(f"the test in Godot failed ({done.returncode})\n{done.stdout[-4000:]}")
    print(next(line for line in done.stdout.splitlines() if line.startswith("Godot Engine")) + ": all good")


if __name__ == "__main__":
    main()
