"""Meshes of every class that users bring (scripts/make_meshes.py): two seconds of each, and what `singe verify` says.

A good mesh runs without a warning and without a fault, and its first frame has all of it: every vertex at its position
with its uv. A broken one either runs, and then its repairs are reported
with the file's name and a number, or it is refused with exit code 2, the file's name and the element's number.
"""

import collections
import math
import os
import re
import sys

from support import SANITIZED, Case
from test_verify import Surface

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "scripts"))
import make_meshes  # noqa: E402

SCENE = """\
name: zoo
frames: {frames} # 25: two seconds
fps: 12
steps: 20
pace: 4
detail: 1 mm
solver: {{substeps: 8}}
sheets:
  - mesh: {mesh}
    scale: {scale}
    rotate: [{turn}, 0, 0]
    translate: [0, 0, 15 cm]
    drop_pieces_below: 4 mm2
    material: {{thickness: 4 mm}}
sources:
  - {{kind: spot, position: [5 cm, 0, 1 cm], radius: 2 cm, falloff: 3 cm, temperature: 1200, conductance: 300}}
colliders:
  - {{kind: plane, friction: 0.4}}
gas: no
"""

FRAMES = 3 if SANITIZED else 25

SCALE = {"millimetres": 0.001}
TURN = {"y-up": 110}

# The outcome of broken meshes: RUNS, and reports its repairs; REFUSED, with the number of the element; or
# EITHER. The words of a refusal follow the file's name, and so do those of a repair, of `run` or of `check`.
RUNS, REFUSED, EITHER = "runs", "refused", "either"
NUMBER = r"\D*\d"
BROKEN = {
    "crossed": (RUNS, None, r"\bcross initially\b"),
    "isolated-vertices": (RUNS, None, "2 .*(no face|isolated|unused)"),
    "non-manifold": (RUNS, None, "1 .*more than two"),
    "tent": (RUNS, None, "32 .*more than two"),
    "moebius": (RUNS, None, "one-sided"),
    "winding": (EITHER, NUMBER, "flipped"),
    "duplicate-faces": (EITHER, NUMBER, "2 .*(twice|duplicate)"),
    "degenerate-faces": (EITHER, NUMBER, "2 .*(area|degenerate)"),
    "repeated-vertex": (EITHER, ":619\\b", "(twice|corner|triangle)"),
    "bow-tie": (EITHER, NUMBER, "(only there|bow|doubled|parted)"),
    "not-a-number": (REFUSED, r":51\b.*not a finite number", None),
    "not-a-number-binary": (REFUSED, r"byte 1207\b.*not a finite number", None),
    "infinite": (REFUSED, r"byte 1211\b.*not a finite number", None),
    "out-of-range": (REFUSED, r":639\b.*out of range", None),
    "out-of-range-binary": (REFUSED, r"byte 7024\b.*out of range", None),
    "empty": (REFUSED, "empty", None),
    "no-faces": (REFUSED, "no faces", None),
    "empty-ply": (REFUSED, r":10\b.*no vertices", None),
}

# Checks that still fail. They run anyway, and one that passes is reported, so that it can be removed from here.
PENDING = set()


class MeshZoo(Case):
    maxDiff = None

    def run_mesh(self, name):
        """Exit code and messages of a run, and the faults of its cache by kind."""
        mesh = make_meshes.write(name, self.dir)
        scene = self.path(name + ".yaml")
        with open(scene, "w") as file:
            file.write(SCENE.format(frames=FRAMES, mesh=os.path.basename(mesh), scale=SCALE.get(name, 1), turn=TURN.get(name, 20)))
        code, err = self.code_of("run", scene, "-o", self.path(name), "--no-preview", "--threads", "1")
        if code:
            return code, err, {}
        found, said = self.code_of("verify", self.path(name), "--csv", self.path("counts.csv"))
        self.assertIn(found, (0, 1), said)
        rows = self.table("counts.csv")
        self.assertEqual(len(rows), FRAMES)
        counts = collections.Counter()
        for row in rows:
            counts.update({k: int(v) for k, v in row.items()
                           if k not in ("frame", "vertices", "triangles", "near_crossings", "folded_edges", "initial_crossings")})
        self.assertEqual(found == 0, sum(counts.values()) == 0)
        return code, err, {k: v for k, v in counts.items() if v}

    def code_of(self, *args):
        done = self.start(*args)
        err = done.communicate(timeout=100)[1]
        return done.returncode, err

    def told_of_repair(self, name, err):
        check, said = self.singe("check", self.path(name + ".yaml"))
        return " ".join((check + said + err).split())

    def judge(self, name, code, err, faults):
        """Why it is not as it should be, or None."""
        outcome, refusal, repair = BROKEN.get(name, (RUNS, None, None))
        reported, file = " ".join(err.split()), re.escape(make_meshes.file_name(name))
        if code not in (0, 2) or (code == 2 and outcome == RUNS):
            return f"exit code {code}: {reported}"
        if code == 2:
            return None if re.search(file + ".*" + refusal, reported) else f"not reported as {refusal!r}: {reported}"
        if outcome == REFUSED:
            return "is not refused"
        if repair and not re.search(f"{file}.*{repair}", self.told_of_repair(name, err)):
            return f"what was repaired is not reported as {repair!r}"
        # three frames are too short for some to ignite
        of_mesh = reported.replace("warning: nothing ignited", "")
        if name not in BROKEN and ("warning" in of_mesh or self.lost(name)):
            return self.lost(name) or reported
        return f"verify: {faults}" if faults else None

    def lost(self, name):
        """The vertices of the input that the first frame lacks: each vertex at its position, under its number, with its uv."""
        mesh = make_meshes.MESHES[name][2]()
        angle, scale = math.radians(TURN.get(name, 20)), SCALE.get(name, 1)
        values, uv_faces = mesh.corner_uv or (mesh.uv, mesh.faces)
        uv = collections.defaultdict(list)
        for f, c in zip(mesh.faces, uv_faces):
            for v, number in zip(f, c):
                uv[v] += [values[number]] if values else []
        seen = set()
        for row in Surface(self.path(name, "ply", "zoo.0001.ply")).vertices:
            number = row["vertex_id"]
            if number < 0:
                continue
            x, y, z = (scale * c for c in mesh.points[number])
            position = x, y * math.cos(angle) - z * math.sin(angle), y * math.sin(angle) + z * math.cos(angle) + 0.15
            # what is drawn is smooth: it leaves bent cells by at most 0.45 of the 0.5 mm that contact keeps
            if math.dist(position, [row[axis] for axis in "xyz"]) > 2.3e-4:
                return f"vertex {number} is not at {position}"
            known = uv[number]
            if known and min(math.dist(t, (row["s"], row["t"])) for t in known) > 1e-6:
                return f"vertex {number} has the uv {row['s']}, {row['t']} instead of {uv[number][0]}"
            seen.add(number)
        missing = set(uv) - seen
        return f"vertices {sorted(missing)[:9]} are not drawn" if missing else None

    def test_meshes(self):
        self.assertEqual(set(BROKEN), {n for n, row in make_meshes.MESHES.items() if row[1] == "broken"})
        lines = []
        good = [name for name in make_meshes.MESHES if name not in BROKEN]
        skipped = set(good) - set(good[::4]) if SANITIZED else set()  # there each takes ten times as long
        for name in make_meshes.MESHES:
            if name in skipped:
                continue
            with self.subTest(name):
                code, err, faults = self.run_mesh(name)
                wrong = self.judge(name, code, err, faults)
                later = name in PENDING
                state = "good"
                if later:
                    state = f"pending ({wrong[-90:]})" if wrong else "holds, is no longer pending"
                kinds = ", ".join(f"{v} {k}" for k, v in faults.items())
                lines.append(f"{name:22}{'runs' if code == 0 else 'refused':9}{state}{kinds and ': ' + kinds}")
                if wrong and not later:
                    self.fail(wrong)
        print("\n".join(lines))

    def test_they_are_what_they_say(self):
        """The good ones are manifold and wound alike; closed, genus and valence are as promised."""
        shapes = {}
        for name, (_, kind, make, _) in make_meshes.MESHES.items():
            mesh = make()
            runs = collections.Counter((a, b) for f in mesh.faces for a, b in zip(f, f[1:] + f[:1]))
            edges = collections.Counter(frozenset(pair) for pair in runs.elements())
            valence = collections.Counter(v for edge in edges for v in edge)
            used = len(valence)
            shapes[name] = (used - len(edges) + len(mesh.faces), sum(n == 1 for n in edges.values()),
                            max(valence.values(), default=0))
            if kind == "good":
                self.assertEqual(max(runs.values()), 1, f"{name}: winding")
                self.assertEqual(used, len(mesh.points), name)
                self.assertTrue(100 <= len(mesh.faces) <= 700, name)
        self.assertEqual(shapes["open"][0], 1)
        self.assertEqual(shapes["closed"][:2], (2, 0))
        self.assertEqual(shapes["torus"][:2], (0, 0))
        self.assertEqual(shapes["tube"][:2], (0, 48))
        self.assertEqual(shapes["high-valence"], (1, 80, 40))
        self.assertEqual(shapes["cone"], (1, 40, 40))
        self.assertEqual(shapes["components"][0], 4)
        self.assertEqual(shapes["moebius"][:2], (0, 80))
