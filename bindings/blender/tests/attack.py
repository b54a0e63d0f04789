# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension under attack, in a real Blender without a window: usage attack.py PROGRAM FOLDER

What comes with a .blend file of a stranger, what others have in the folders that it names, damaged caches, odd paths, a
full disk, a program that dies. Whatever it is, no file of others changes, nothing but PROGRAM runs, nothing hangs, and
what the user sees is a sentence.
"""

import contextlib
import hashlib
import json
import math
import os
import pathlib
import random
import shutil
import signal
import stat
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import rig
from rig import add_curtain, burning, evaluated, fresh, points, values

import bpy

folder, program = pathlib.Path(rig.folder), rig.program
SECONDS = 100  # of a scenario, and more for each burn


def small(frames=3):
    """The curtain of rig.py, as few cells and frames as burn."""
    scene = fresh(frames)
    curtain = add_curtain()
    curtain.singe.cell_size = 0.03
    return scene, curtain


def attempt(operator, **options):
    """Runs an operator. Returns what it says if it fails, which must be a sentence, or None."""
    signal.alarm(SECONDS)
    try:
        assert operator(**options) == {"FINISHED"}, f"cancelled, and says nothing: {bpy.context.scene.singe.message}"
        return None
    except RuntimeError as error:  # how a report of an error arrives in a script
        said = str(error)
    for bad in ("Traceback", "Errno", "Python:", "\x1b", "it takes more"):
        assert bad not in said, said
    assert 10 < len(said) < 4000, said
    return said


def burn(**options):
    said = attempt(bpy.ops.singe.burn, **options)
    assert not bpy.context.scene.singe.message.startswith("Traceback")
    return said


def free():
    return attempt(bpy.ops.singe.free)


def expect(said, *words):
    assert said and any(word in said for word in words), (words, said)


def tree(root):
    """All below a folder: kind, and bytes or target."""
    found = {}
    for path in sorted(pathlib.Path(root).rglob("*")):
        mode = path.lstat().st_mode
        if stat.S_ISLNK(mode):
            found[str(path)] = os.readlink(path)
        elif stat.S_ISREG(mode):
            found[str(path)] = hashlib.sha256(path.read_bytes()).hexdigest()
        else:
            found[str(path)] = stat.S_IFMT(mode)
    return found


@contextlib.contextmanager
def unchanged(root):
    before = tree(root)
    yield
    after = tree(root)
    changed = [path for path in {*before, *after} if before.get(path) != after.get(path)]
    assert not changed, changed


def make_folder(name):
    path = folder / name
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir(parents=True)
    return path


def shows(frames=3):
    """The burnt curtain is in the scene, and it is warm."""
    sheet, = burning()
    mesh = evaluated(sheet, frames)
    assert len(mesh.vertices) > 10 and values(mesh, "temperature_peak").max() > 300


# ---- scenarios

def a_stranger_brings_programs():
    """Beside the .blend file lie programs of all names that are looked for, in the current folder and PATH's own."""
    place = make_folder("gift")
    marker = folder / "evil"
    for name in ("singe", "singe.exe", "singe.py", "evil.sh", "python", "python3"):
        (place / name).write_text(f"#!/bin/sh\ntouch '{marker}'\n")
        (place / name).chmod(0o755)
    (place / "numpy.py").write_text(f"open({str(marker)!r}, 'w')\n")
    scene, curtain = small()
    for key, value in (("program", "//evil.sh"), ("command", "//evil.sh"), ("SINGE_PROGRAM", "//singe")):
        scene[key] = value
        scene.singe.message = f"{key}={value}"
    scene.singe.folder = "//cache"
    bpy.ops.wm.save_as_mainfile(filepath=str(place / "gift.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(place / "gift.blend"))
    before, path, chosen = os.getcwd(), os.environ["PATH"], os.environ.pop("SINGE_PROGRAM")
    try:
        os.chdir(place)
        os.environ["PATH"] = os.pathsep.join(("", ".", "gift", "//", path))
        burn()  # by whatever singe the system has, or none
        os.environ["SINGE_PROGRAM"] = "//singe"
        expect(burn(), "absolute path")
        os.environ["SINGE_PROGRAM"] = "singe"
        expect(burn(), "absolute path")
    finally:
        os.chdir(before)
        os.environ["PATH"], os.environ["SINGE_PROGRAM"] = path, chosen
    assert not marker.exists(), "a program from beside the .blend file has run"
    assert burn() is None
    assert not marker.exists()


def settings_of_no_menu():
    """What a .blend file may hold though no panel sets it: values out of their ranges, of other types, of no number."""
    place = make_folder("settings")
    nothing, huge = float("nan"), 3e38
    for values_ in ({"pace": nothing}, {"pace": huge}, {"pace": -1.0}, {"quality": 77},
                    {"gas_detail": 10**9, "gas": True},
                    {"folder": ""}, {"folder": "//"}, {"folder": "/dev/null/x"}, {"folder": "/proc/self"},
                    {"folder": "//" + 300 * "x"}, {"folder": "//../" * 200}, {"folder": "x" * 2000},
                    {"folder": "//\n\x1b[31m"}, {"folder": "-o"}, {"folder": "~"}, {"message": "\x1b[2J" * 50}):
        scene, _ = small()
        for key, value in values_.items():
            force(scene.singe, key, value)
        reopen(place)
        with unchanged("/dev/shm"):
            burn()
            burn(preview=True)
            free()
    for values_ in ({"role": 9}, {"material": 9}, {"lit_by": 9}, {"cell_size": nothing}, {"cell_size": huge},
                    {"lit_temperature": nothing}, {"lit_temperature": -5.0},
                    {"lit_seconds": -huge}, {"friction": nothing}, {"friction": -1.0}, {"rate_low": nothing},
                    {"material": "FILE", "material_file": "/etc/passwd"},
                    {"material": "FILE", "material_file": "/dev/zero"},
                    {"material": "FILE", "material_file": "//"}, {"lit_group": "\x1b[31m'\"\n"},
                    {"pin_group": "../../x"}):
        scene, curtain = small()
        for key, value in values_.items():
            force(curtain.singe, key, value)
        reopen(place)
        said = burn() or ""
        assert "root:" not in said and "\x1b" not in bpy.context.scene.singe.message, said
    free()


def force(group, key, value):
    """Sets a property past its range where this Blender stores it by name, else as near as it allows."""
    try:
        group[key] = value
    except (TypeError, ValueError, KeyError, AttributeError):
        with contextlib.suppress(TypeError, ValueError):
            setattr(group, key, value)
    if isinstance(value, str):
        with contextlib.suppress(TypeError, ValueError):
            setattr(group, key, value)


def reopen(place):
    path = str(place / "hostile.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)


def meshes_of_no_kind():
    """Vertices that are no numbers, far away or all at one point; no faces; loose edges; scales of 0 and inf."""
    nothing = float("nan")

    def move(mesh, where):
        for vertex in mesh.vertices:
            vertex.co = where(vertex.index)

    cases = {
        "a NaN": lambda o: move(o.data, lambda i: (nothing, 0, 0) if i == 3 else (i, i * i % 7, 0)),
        "all NaN": lambda o: move(o.data, lambda i: (nothing,) * 3),
        "inf": lambda o: move(o.data, lambda i: (math.inf, 0, i)),
        "one point": lambda o: move(o.data, lambda i: (1, 1, 1)),
        "a line": lambda o: move(o.data, lambda i: (i, 0, 0)),
        "far": lambda o: setattr(o, "location", (1e30, 0, 0)),
        "scale 0": lambda o: setattr(o, "scale", (0, 0, 0)),
        "scale inf": lambda o: setattr(o, "scale", (math.inf, 1, 1)),
        "scale NaN": lambda o: setattr(o, "scale", (nothing, 1, 1)),
        "no faces": lambda o: o.data.clear_geometry(),
        "units of 0": lambda o: setattr(bpy.context.scene.unit_settings, "scale_length", 0),
        "huge units": lambda o: setattr(bpy.context.scene.unit_settings, "scale_length", 1e6),
        "names": lambda o: (setattr(o, "name", "../../%s\n\x1b[31m\"'"), setattr(o.data, "name", "//x")),
        "outside the view layer": lambda o: [c.objects.unlink(o) for c in list(o.users_collection)]
                                            + [hidden_collection().objects.link(o)],
    }
    for name, change in cases.items():
        for role in ("SHEET", "COLLIDER"):
            scene, curtain = small()
            if role == "COLLIDER":
                bpy.ops.mesh.primitive_cube_add(size=0.1, location=(0, 0, 0))
                bpy.context.object.singe.role = role
            change(curtain if role == "SHEET" else bpy.context.object)
            said = burn()
            if said:
                assert "\x1b" not in said, said
                print(f"  {role.lower()}, {name}: {said.strip()[:150]}", flush=True)


def hidden_collection():
    made = bpy.data.collections.new("hidden")
    bpy.context.scene.collection.children.link(made)
    bpy.context.view_layer.layer_collection.children["hidden"].exclude = True
    return made


def folders_of_others():
    """Everything that was in a folder stays, whatever it is: files with the names of a burn, pipes, links, devices."""
    mine = make_folder("elsewhere")
    for name in ("run.json", "ply/burn.0001.ply", "log.txt", "burn.yaml"):
        (mine / name).parent.mkdir(exist_ok=True)
        (mine / name).write_text("mine\n")
    mark = sys.modules["singe_extension.files"].MARK

    def name_it(*names):
        def put(place):
            for name in names:
                (place / name).parent.mkdir(parents=True, exist_ok=True)
                (place / name).write_text("mine\n")
        return put

    def link_to(name):
        def put(place):
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).symlink_to(mine)
        return put

    def pipe(name, marked):
        def put(place):
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            if marked:
                (place / "burn" / "burn.yaml").write_text(mark)
            os.mkfifo(place / name)
        return put

    for what, put in {
        "files": name_it("burn/log.txt", "burn/cache/run.json", "preview/burn.yaml"),
        "a folder as the mark": name_it("burn/burn.yaml/mine"),
        "a file as the folder": name_it("burn"),
        "a link as the folder": link_to("burn"),
        "a pipe as the mark": pipe("burn/burn.yaml", False),
    }.items():
        place = make_folder("others")
        put(place)
        scene, _ = small()
        scene.singe.folder = str(place)
        with unchanged(mine), unchanged(place):
            expect(burn(), "choose another cache folder", "not a folder")
            burn(resume=True)
            free()
        print(f"  {what}: {scene.singe.message}", flush=True)

    # marked as a burn's own, as a stranger's archive may be: only what a burn writes goes, and nothing is waited for
    for what, put in {
        "a linked cache": lambda place: (name_it("burn/x")(place), (place / "burn/burn.yaml").write_text(mark),
                                         link_to("burn/cache")(place)),
        "a linked folder": lambda place: ((place / "burn/cache").mkdir(parents=True),
                                          (place / "burn/burn.yaml").write_text(mark),
                                          link_to("burn/cache/ply")(place)),
        "a pipe as table": pipe("burn/cache/stats.csv", True),
        "a pipe as record": pipe("burn/cache/run.json", True),
        "a pipe as log": pipe("burn/log.txt", True),
        "a pipe as mesh": pipe("burn/sheet0.ply", True),
        "a pipe as checkpoint": pipe("burn/cache/checkpoint.singe", True),
    }.items():
        place = make_folder("others")
        put(place)
        scene, _ = small()
        scene.singe.folder = str(place)
        with unchanged(mine):
            burn(resume=True)
            burn()
            attempt(bpy.ops.singe.load, directory=str(place / "burn" / "cache"))
            free()
        print(f"  {what}: {scene.singe.message}", flush=True)


def damaged_caches():
    """Any bytes in a cache's record, table and USD: a sentence, or a cache that shows something."""
    scene, _ = small()
    assert burn() is None
    whole = folder / "cache" / "burn" / "cache"
    random_ = random.Random(1)
    cut = lambda data: data[:len(data) // 2]
    flip = lambda data: bytes(b ^ (random_.random() < 0.002) * 255 for b in data)
    outside = str(folder / "gift")
    record = json.loads((whole / "run.json").read_text())

    def scene_of(**more):
        return lambda data: json.dumps({**record, "scene": {**record["scene"], **more}}).encode()

    cases = [(name, damage) for name in ("run.json", "stats.csv", "burn.usda") for damage in
             (cut, flip, lambda data: b"", lambda data: b"\0" * 1000, lambda data: None, lambda data: b"[" * 10**6)]
    cases += [("usd/burn.0001.usdc", damage) for damage in (cut, lambda data: b"", lambda data: None)]
    cases += [("run.json", scene_of(name=name)) for name in ("../x", "", ".", "..", "a/b", "burn\0", 3, None,
                                                             "x" * 5000)]
    cases += [("run.json", scene_of(fps=fps)) for fps in (0, -1, 1e400, "24", None, [24])]
    cases += [("burn.usda", lambda data: data.replace(b"./usd/", outside.encode() + b"/")),
              ("stats.csv", lambda data: data + b"\n" * 10**6)]
    for name, damage in cases:
        copy = folder / "damaged"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(whole, copy)
        data = damage((whole / name).read_bytes())
        if data is None:
            (copy / name).unlink()
        else:
            (copy / name).write_bytes(data)
        small()
        with unchanged(copy):
            said = attempt(bpy.ops.singe.load, directory=str(copy))
            for sheet in burning() if not said else ():
                evaluated(sheet, 2)
    for path in (folder / "nowhere", pathlib.Path("/"), pathlib.Path("/dev/null"), whole / "run.json"):
        expect(attempt(bpy.ops.singe.load, directory=str(path)), "cannot load")


def odd_paths():
    """Blanks, quotes, other scripts, and marks that shells, Blender, YAML and printf read, in the names of folders."""
    for name in ("a b", "it's \"quoted\"", "Größe 日本語 🔥", "100%s%n", "#### $HOME `id` $(id)", "{x: [1]} & | ; > <",
                 "-o", "a\nb", ".hidden", "e\u0301 \u202e", "x" * 200):
        place = make_folder("odd") / name
        place.mkdir()
        scene, curtain = small()
        curtain.keyframe_insert("location", frame=1)  # a pin that moves has files of its own
        curtain.name = name[:60]
        scene.singe.folder = "//" + name
        bpy.ops.wm.save_as_mainfile(filepath=str(place / (name[:100] + ".blend")))
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        said = burn()
        assert said is None, (name, said)
        shows()
        cache = place / name / "burn" / "cache"
        assert (cache / "run.json").exists(), list(place.rglob("run.json"))
        assert attempt(bpy.ops.singe.load, directory=str(cache)) is None
        shows()
        bpy.ops.wm.save_mainfile()
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        shows()
        assert free() is None
        assert not (place / name / "burn").exists(), list((place / name).rglob("*"))


    scene, _ = small()
    scene.singe.folder = str(make_folder("odd") / "back\\slash")
    expect(burn(), "choose another cache folder")


def full_disk():
    """A sentence at whatever the disk has no room for; with room again it burns, and a full one can be freed."""
    place = make_folder("disk")
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "none", place], capture_output=True)
    if mounted.returncode:
        print("  skipped: only root can mount a small disk", flush=True)
        return
    try:
        for room in (0, 4, 8, 16, 32, 64, 128, 256):  # KiB
            scene, curtain = small()
            curtain.singe.cell_size = 0.01
            scene.singe.folder = str(place / "cache")
            (place / "ballast").write_bytes(b"x")
            status = os.statvfs(place)
            with open(place / "ballast", "wb") as file, contextlib.suppress(OSError):
                file.write(bytes(max(status.f_bavail * status.f_frsize - 1024 * room, 0)))
            said = burn()
            assert said is None or "space" in said or "disk" in said or "room" in said, said
            print(f"  {room} KiB: {(said or 'burnt').strip()[:150]}", flush=True)
            assert free() is None
            left = [str(path) for path in place.rglob("*") if path.name != "ballast" and path.is_file()]
            assert not left, left
        os.unlink(place / "ballast")
        assert burn() is None
        shows()
    finally:
        fresh()
        subprocess.run(["umount", "-l", place], check=True)


def a_program_that_dies():
    """Killed at once or in the middle, ending with nonsense, or no program at all."""
    scene, _ = small(40)
    scene.singe.quality = "FINE"
    hand = type("Hand", (sys.modules["singe_extension.operators"].Burning,), {})()
    hand.begin_job(bpy.context, False, False)
    while hand.look(bpy.context) and hand.job.frames_done() < 4:
        time.sleep(0.02)
    hand.job.process.kill()
    hand.end_job(bpy.context)
    assert burn(resume=True) is None, "what was killed does not go on"
    shows(40)

    fake = folder / "fake"
    try:
        for script in ("kill -9 $$", "exit 1", "exit 3", "head -c 3000000 /dev/zero | tr '\\0' x; exit 2",
                       "printf 'error: \\033[31m\\033]0;x\\007\\n'; exit 2", "printf 'error: \\377\\376\\n'; exit 2",
                       "for i in 1 2 3 4 5 6 7 8 9; do echo error: $i; done; exit 1"):
            fake.write_text(f"#!/bin/sh\n{script}\n")
            fake.chmod(0o755)
            os.environ["SINGE_PROGRAM"] = str(fake)
            scene, _ = small()
            expect(burn(), "before the first frame", "rror", "1\n2\n3\n4\n5\n6")
            assert "\x1b" not in scene.singe.message, scene.singe.message
        fake.chmod(0o644)
        expect(burn(), "ermission")
        fake.write_bytes(b"\x7fELF" + bytes(60))
        fake.chmod(0o755)
        expect(burn(), "xec format")
    finally:
        os.environ["SINGE_PROGRAM"] = program
    small()
    assert burn() is None


def late(signum, frame):
    raise AssertionError(f"it takes more than {SECONDS} s")


def main():
    rig.install()
    signal.signal(signal.SIGALRM, late)
    chosen = sys.argv[3:]
    for scenario in (a_stranger_brings_programs, settings_of_no_menu, meshes_of_no_kind, folders_of_others,
                     damaged_caches, odd_paths, full_disk, a_program_that_dies):
        if chosen and scenario.__name__ not in chosen:
            continue
        begun = time.monotonic()
        scenario()
        print(f"passed: {scenario.__name__} ({time.monotonic() - begun:.1f} s)", flush=True)
    print(f"Blender {bpy.app.version_string} withstood it")


if __name__ == "__main__":
    rig.archive = None
    os.environ["SINGE_PROGRAM"] = program
    rig.run(main)
