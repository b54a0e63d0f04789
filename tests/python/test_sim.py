"""The Python package: what a simulation takes, what it shows, and what it refuses."""

import contextlib
import ctypes
import gc
import io
import logging
import os
import pickle
import re
import subprocess
import sys
import threading
import time

from support import ROOT, Case, burning, singe

import numpy as np
from singe import _abi
from singe._library import library

GENERATE = ROOT / "bindings/python/generate.py"
FIELDS = ("position velocity rest_position uv area mass fuel temperature temperature_peak burn_rate time_ignited "
          "time_burnt piece particle_flags cell_flags cells source_vertex").split()


def address(array):
    return array.__array_interface__["data"][0]


class Layout(Case):
    def generate(self, *arguments):
        return subprocess.run([sys.executable, str(GENERATE), "--cc", os.environ.get("CC", "cc"), *arguments],
                              capture_output=True, text=True)

    def test_is_of_the_headers(self):
        made = self.dir / "abi.py"
        done = self.generate("--output", str(made))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(made.read_text(), (ROOT / "bindings/python/singe/_abi.py").read_text(), "run bindings/python/generate.py")

    def test_is_that_of_c(self):
        done = self.generate("--check", str(self.dir / "abi"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(int(done.stdout.split()[0]), 450)

    def test_a_wrong_layout_is_found(self):
        text = (ROOT / "bindings/python/singe/_abi.py").read_text()
        wrong = self.dir / "abi.py"
        wrong.write_text(text.replace('("step", c_uint64), ("topology_version", c_uint64)',
                                      '("topology_version", c_uint64), ("step", c_uint64)'))
        self.assertNotEqual(wrong.read_text(), text)
        done = self.generate("--check", str(self.dir / "abi"), "--output", str(wrong))
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("SingeView", done.stderr)

    def test_lines_fit(self):
        """The width that the project's C has."""
        files = [*(ROOT / "bindings/python").rglob("*.py"), *(ROOT / "docs/samples").rglob("*.py")]
        self.assertGreater(len(files), 12)
        long = [f"{path.name}:{n}" for path in files for n, line in enumerate(path.read_text().split("\n"), 1)
                if len(line) > 120]
        self.assertEqual(long, [])

    def test_every_function_is_there(self):
        self.assertGreater(len(_abi.FUNCTIONS), 70)
        for name in _abi.FUNCTIONS:
            self.assertTrue(getattr(library, name))


class Burning(Case):
    def test_as_in_c(self):
        """docs/samples/burn.c, line by line."""
        program = os.environ.get("SINGE_BURN")
        if not program:
            self.skipTest("SINGE_BURN names no program")
        sim = singe.Sim(pace=5)
        sheet = sim.sheet(*singe.grid((0.15, 0.15), (40, 40)))
        sim.pin(sheet, vertices=[0, 40], radius=0.005)
        sim.spot((0.075, 0, 0), radius=0.01, falloff=0.01, temperature=1123, end=0.5)
        sim.commit()
        lines = []
        for frame in range(1, 49):
            sim.advance(1 / 24)
            alive = sim.alive
            lines.append(f"frame {frame:2d}: lowest at {1e3 * float(sim.position[alive, 2].min()):4.0f} mm, hottest "
                         f"{sim.temperature[alive].max():4.0f} K")
        self.assertEqual(lines, subprocess.run([program], capture_output=True, text=True).stdout.splitlines())

    def test_advance_and_events(self):
        sim, other = burning(), burning()
        self.assertEqual(sim.advance(0.25), 120)
        self.assertGreater(len(sim.events), 10)
        self.assertTrue(np.all(np.diff(sim.events["time"]) >= 0))
        self.assertEqual(set(sim.events["kind"]), {singe.IGNITED})
        found = []
        for _ in range(120):
            other.step()
            found += list(other.events["element"])
        self.assertEqual(found, list(sim.events["element"]))
        self.assertEqual(sim.advance(0.001), 0)
        self.assertAlmostEqual(sim.remainder, 0.001, 6)
        self.assertEqual(sim.advance(1, steps_max=3), 3)
        self.assertEqual(len(singe.Sim.load(sim.save()).events), 0)

    def test_a_save_follows_no_link(self):
        (self.dir / "mine").write_text("mine")
        guess = os.getpid()
        try:
            (self.dir / f"snapshot.{guess}.tmp").symlink_to(self.dir / "mine")
        except OSError:
            self.skipTest("no symbolic links")
        saved = burning().save(self.dir / "snapshot")
        self.assertEqual((self.dir / "snapshot").read_bytes(), saved)
        self.assertEqual((self.dir / "mine").read_text(), "mine")
        self.assertEqual(len(list(self.dir.iterdir())), 3)

    def test_copies_step_to_the_same_bytes(self):
        sim = burning(gas=True, contact=True)
        sim.step(40)
        copies = [singe.Sim.load(sim.save(self.dir / "snapshot")), singe.Sim.load(self.dir / "snapshot", threads=2),
                  sim.clone(), pickle.loads(pickle.dumps(sim))]
        sim.step(20)
        for copy in copies:
            self.assertNotEqual(copy.save(), sim.save())
            copy.step(20)
            self.assertEqual(copy.save(), sim.save())
        with self.assertRaises(singe.FormatError):
            singe.Sim.load(sim.save()[:-100])
        with self.assertRaises(singe.FormatError):
            singe.Sim.load(b"")

    def test_a_recording_is_replayed(self):
        path = self.dir / "burn.singerec"
        sim = burning(record=path)
        sim.source("callback", callback=lambda view: 3e3)
        sim.step(4)
        sim.set_gravity([0, 0, -1])
        sim.advance(0.01)
        done = sim.steps
        del sim
        gc.collect()
        replay = subprocess.run([os.environ["SINGE_PROGRAM"], "replay", path], capture_output=True, text=True)
        self.assertRegex(replay.stdout, rf"^the same: {done} steps, ", replay.stderr)
        self.assertEqual(replay.stderr, "")
        with self.assertRaises(OSError):
            singe.Sim(record=self.dir / "none" / "burn.singerec")
        with self.assertRaises(singe.ArgumentError):
            singe.Sim(record=path, pace=-1)

    def test_render_mesh(self):
        sim = singe.Sim()
        points, faces, uv = singe.grid((0.1, 0.1), (10, 10), jitter=0)
        sheet = sim.sheet(points, faces, uv)
        sim.commit()
        fine, quads, fine_uv = singe.grid((0.1, 0.1), (40, 40), jitter=0)
        fine = fine + np.float32([0, 0, 3e-4])
        triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        with self.assertRaises(ValueError):
            sheet.render_mesh(fine, quads)
        with self.assertRaises(ValueError):
            sheet.render_mesh(fine, triangles, uv=uv)
        with self.assertRaises(TypeError):
            sheet.render_mesh(fine, triangles, reech=1)
        with self.assertRaisesRegex(singe.Error, "farther from the sheet than its reach, 0.01 m"):
            sheet.render_mesh(fine + np.float32([0, 0, 1]), triangles)
        sheet.render_mesh(fine, triangles, uv=1 - fine_uv, rigid=1e-3)
        surface = sim.surface()
        self.assertEqual(len(surface.triangles), len(triangles))
        given = surface.source_vertex - len(points)
        self.assertTrue(np.allclose(surface.position, fine[given], atol=1e-7))
        self.assertTrue(np.allclose(surface.uv, 1 - fine_uv[given]))

    def test_surface_and_gas(self):
        sim = burning(gas={"cell_size": 0.008}, surface_detail=0.001)
        sim.advance(0.4)
        surface, gas = sim.surface(), sim.gas()
        self.assertEqual(surface.position.shape, (len(surface.mass), 3))
        self.assertEqual(surface.triangles.max() + 1, len(surface.position))
        self.assertTrue(np.allclose(np.linalg.norm(surface.normal, axis=1), 1, atol=1e-4))
        self.assertGreater(surface.temperature.max(), 700)
        z, y, x = gas.flame.shape
        self.assertEqual(gas.velocity.shape, (z, y, x, 3))
        self.assertGreater(gas.flame.max(), 1e5)
        heat = gas.flame.sum(axis=(0, 1))  # it burns at the lit edge, at x = 5 cm
        self.assertAlmostEqual(gas.origin[0] + gas.cell * (heat.argmax() + 0.5), 0.045, delta=0.02)
        kept = surface.position.copy()
        sim.step(20)
        self.assertTrue(np.array_equal(kept, surface.position))
        self.assertEqual(burning().gas().flame.size, 0)
        with self.assertRaises(ValueError):
            surface.mass[0] = 1

    def test_quick_picture(self):
        sim = burning()
        self.assertNotIn("<img", burning(commit=False)._repr_html_())
        fresh = singe.draw(sim.surface(), 120, 90).astype(int)
        sim.advance(0.6)
        burnt = singe.draw(sim.surface(), 120, 90).astype(int)
        self.assertEqual(burnt.shape, (90, 120, 3))
        glowing = (burnt[..., 0] > 200) & (burnt[..., 2] < 150)
        self.assertGreater(glowing.sum(), 100)
        self.assertFalse(((fresh[..., 0] > 200) & (fresh[..., 2] < 150)).any())
        self.assertIn("<img", sim._repr_html_())
        self.assertTrue(singe.draw_png(sim.surface()).startswith(b"\x89PNG"))

    def test_large_triangles_have_no_gaps(self):
        sim = singe.Sim()
        sim.sheet(*singe.grid((0.1, 0.1), (2, 2), jitter=0))
        sim.commit()
        picture = singe.draw(sim.surface(), 800, 600).astype(int)
        paper = (picture != picture[0, 0]).any(axis=2)
        left, right = paper.argmax(axis=1), 800 - paper[:, ::-1].argmax(axis=1)  # the square is convex
        rows = paper.any(axis=1)
        self.assertTrue((paper.sum(axis=1) == right - left)[rows].all())


class Tutorial(Case):
    def test_student(self):
        """docs/tutorials/student.md prints what it says, block after block."""
        text = (ROOT / "docs/tutorials/student.md").read_text(encoding="utf-8")
        blocks = re.findall(r"^```python\n(.*?)^```\n(?:```\n(.*?)^```\n)?", text, re.MULTILINE | re.DOTALL)
        self.assertEqual(len(blocks), 7)
        names = {}
        for code, said in blocks:
            shown = io.StringIO()
            with contextlib.redirect_stdout(shown):
                exec(code, names)
            self.assertEqual(shown.getvalue(), said)


class Given(Case):
    def test_triangles_and_what_vertices_become(self):
        points, faces, uv = singe.grid((0.1, 0.1), (8, 8))
        corners = faces[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
        loose = np.vstack([points, [[5, 5, 5]]])  # a vertex of no face, at the end
        sim = singe.Sim()
        sheet = sim.sheet(loose, corners, np.vstack([uv, [[0, 0]]]))
        self.assertEqual(sheet.became[-1], -1)
        sim.commit()
        self.assertEqual(sim.cells.shape, (64, 4))
        self.assertTrue(np.allclose(sim.position[sheet.vertices][sheet.became[:-1]], points))
        pin = sim.pin(sheet, vertices=[3, 81])
        self.assertEqual(list(pin.particles), [sheet.became[3]])
        with self.assertRaises(ValueError):
            sim.pin(sheet, vertices=[82])
        with self.assertRaises(ValueError):
            sim.pin(sheet, vertices=[-1])
        mixed = singe.Sim()
        mixed.sheet([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]], [[0, 1, 2, 3], [1, 4, 2]])
        mixed.commit()

    def test_materials(self):
        points, faces, uv = singe.grid((0.1, 0.1), (8, 8))
        wet = (points[:, 0] > 0).astype(float)

        def hottest(material, **attributes):
            sim = singe.Sim(pace=5)
            sim.sheet(points, faces, uv, material, **attributes)
            sim.source("texture", texture=np.ones((2, 2)), flux=3e4)
            sim.commit()
            sim.step(10)
            return sim.temperature[:81].copy()

        even = hottest({"base": "cotton", "specific_heat": 1400})
        self.assertLess(np.ptp(even), 5)
        ways = [{"specific_heat": 1400 + 8600 * wet}, {"specific_heat": singe.Vary(1400, 10000, attribute=wet)},
                {"specific_heat": singe.Vary(1400, 10000, attribute="wet")}]
        for material in ways:
            found = hottest({"base": "cotton", **material}, wet=wet)
            self.assertGreater(found[wet == 0].min(), found[wet == 1].max() + 20)
        for field in ({"texture": np.eye(2)}, {"noise": 0.02}, {"noise": (0.02, 2, 7)}):
            found = hottest({"base": "cotton", "specific_heat": singe.Vary(1400, 9000, **field)})
            self.assertGreater(np.ptp(found), 25)
        self.assertEqual(set(singe.materials()), {"cotton", "newsprint", "office-paper", "one-reaction", "tissue"})

    def test_callback_heats_as_a_texture_does(self):
        def hot(kind, **fields):
            sim = singe.Sim(pace=5)
            sim.sheet(*singe.grid((0.1, 0.1), (8, 8), jitter=0))
            sim.source(kind, **fields)
            sim.commit()
            sim.step(40)
            return sim

        seen = []

        def half(view):
            seen.append((view.time, view.position, view.temperature.copy()))
            return np.where(view.rest_position[:, 0] > 0, 3e4, 0)

        even = hot("texture", texture=np.ones((2, 2)), flux=3e4)
        self.assertEqual(hot("callback", callback=lambda view: 3e4).save()[-1000:], even.save()[-1000:])
        self.assertTrue(np.array_equal(hot("callback", callback=lambda view: (3e4, 0, 0)).temperature,
                                       even.temperature))
        sim = hot("callback", callback=half)
        right = sim.rest_position[:, 0] > 0
        self.assertGreater(sim.temperature[right].min(), sim.temperature[~right].min() + 50)
        self.assertEqual(len(seen), 40)
        self.assertAlmostEqual(seen[39][0], 39 / 480, 5)
        self.assertGreater(seen[39][2].max(), seen[0][2].max() + 50)
        self.assertEqual(seen[0][1].shape, (81 + 64, 3))
        bath = hot("callback", callback=lambda view: (0, 1e4, np.full(145, 500)))
        self.assertLess(np.abs(bath.temperature - 500).max(), 5)

    def test_callbacks_of_copies(self):
        def flux(view):
            calls.append(view.time)
            return 3e4

        calls = []
        sim = burning()
        source = sim.source("callback", callback=flux)
        sim.step(5)
        copy = sim.clone()
        loaded = singe.Sim.load(sim.save())
        del sim, source
        gc.collect()
        calls.clear()
        copy.step(3)
        copy.set_ambient_temperature(310)
        copy.step(3)
        self.assertEqual(len(calls), 6)
        loaded.step(3)
        self.assertEqual(len(calls), 6)  # no snapshot has them
        loaded.sources[1].set_callback(flux)
        loaded.step(2)
        self.assertEqual(len(calls), 8)
        loaded.sources[1].remove()
        loaded.clone().step()
        copy.sources[1].set_callback(None)
        copy.step()
        self.assertEqual(len(calls), 8)

    def test_a_callback_that_raises(self):
        sim = burning()
        answers = [lambda: 1 / 0, lambda: np.zeros(7), lambda: (1, 2), lambda: (0, -1, 300), lambda: "hot",
                   lambda: None, lambda: (0, None, 300), lambda: sim.step(), lambda: sys.exit(3)]
        kinds = [ZeroDivisionError, *[ValueError] * 4, TypeError, TypeError, singe.StateError, SystemExit]
        source = sim.source("callback", callback=lambda view: answers[0]())
        before = sim.position.copy()
        for kind in kinds:
            for call in (sim.step, lambda: sim.advance(0.1)):
                with self.subTest(kind), self.assertRaises(kind):
                    call()
                self.assertEqual(sim.steps, 0)
                self.assertTrue(np.array_equal(sim.position, before))
            answers.pop(0)
        source.set_callback(lambda view: 0)
        sim.step(3)
        self.assertEqual(sim.steps, 3)
        with self.assertRaisesRegex(singe.ArgumentError, "not a callback"):
            sim.sources[0].set_callback(lambda view: 0)
        for wrong in ({"kind": "callback"}, {"kind": "spot", "callback": lambda view: 0}):
            with self.assertRaisesRegex(ValueError, "no other kind"):
                sim.source(**wrong)

    def test_objects_move_and_go(self):
        sim = burning()
        sim.collider("sphere", position=[0, 0, -0.1], radius=0.03)
        box = sim.collider("box", half_size=(0.01, 0.01, 0.01), path=[(0, 0, 0, -1), (1, 0, 0, -2)])
        box.move([(0, 0, 0, -3)])
        box.remove()
        with self.assertRaises(singe.HandleError):
            box.remove()
        self.assertEqual(len(sim.colliders), 1)
        pin = sim.pins[0]
        self.assertEqual(pin, sim.pins[0])
        pin.set_positions(sim.position[pin.particles] + [0, 0, 0.01], sim.time + 0.1)
        with self.assertRaises(ValueError):
            pin.set_positions([[0, 0, 0]], 1)
        sim.wind([1, 0, 0], gust=0.5)
        sim.set_gravity([0, 0, 0])
        sim.set_pace(2)
        sim.sheets[0].set_velocity(np.full((289, 3), 0.1))
        sim.advance(0.1)
        self.assertAlmostEqual(float(sim.position[pin.particles, 2].min()), 0.01, 4)
        self.assertEqual(len(sim.sources), 1)
        corner = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], float) * 0.02 - [0, 0, 0.3]
        cube = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6],
                [0, 6, 4], [1, 5, 7], [1, 7, 3]]
        moving = sim.collider("deforming", vertices=corner, triangles=cube)
        moving.set_vertices(corner + 0.01, sim.time + 0.1)
        with self.assertRaises(ValueError):
            moving.set_vertices(corner[:4], 1)
        sim.step(5)

    def test_refusals(self):
        grid = singe.grid()
        cases = [
            (TypeError, "did you mean 'pace'", lambda: singe.Sim(pac=1)),
            (singe.ArgumentError, "pace must be between", lambda: singe.Sim(pace=-1)),
            (TypeError, "must be a whole number", lambda: singe.Sim(threads=1.5)),
            (ValueError, "must fit", lambda: singe.Sim(seed=-1)),
            (ValueError, "one of strand", lambda: singe.Sim(solver={"method": "euler"})),
            (TypeError, "there is no 'speed'", lambda: singe.Sim(wind={"speed": 1})),
            (ValueError, "3 values", lambda: singe.Sim(gravity=[0, 1])),
            (singe.StateError, "commit", lambda: singe.Sim().step()),
            (singe.StateError, "no sheet", lambda: singe.Sim().commit()),
            (singe.MeshError, "vertex 9 of 4", lambda: singe.Sim().sheet(np.eye(4, 3), [[0, 1, 2, 9]])),
            (ValueError, "whole numbers", lambda: singe.Sim().sheet(np.eye(4, 3), [[0, 1, 2.5]])),
            (ValueError, "between 0", lambda: singe.Sim().sheet(np.eye(4, 3), [[0, 1, -1]])),
            (ValueError, "points must have the shape", lambda: singe.Sim().sheet(np.eye(4), [[0, 1, 2]])),
            (ValueError, "uv must have 2601 rows", lambda: singe.Sim().sheet(*grid[:2], grid.uv[:5])),
            (ValueError, "one a vertex", lambda: singe.Sim().sheet(*grid, wet=[1, 2])),
            (singe.ArgumentError, "cotton", lambda: singe.Sim().sheet(*grid, material="wood")),
            (TypeError, "did you mean 'mass_rate'", lambda: singe.Sim().sheet(*grid, material={"masrate": 1})),
            (singe.ArgumentError, "grammage", lambda: singe.Sim().sheet(*grid, material={"grammage": -1})),
            (singe.ArgumentError, "nowhere", lambda: singe.Sim().sheet(
                *grid, material={"mass_rate": singe.Vary(0, 1, attribute="nowhere")})),
            (ValueError, "one of attribute", lambda: singe.Sim().sheet(
                *grid, material={"mass_rate": singe.Vary(0, 1)})),
            (singe.ArgumentError, "seconds", lambda: burning(4).advance(-1)),
            (singe.ArgumentError, "seconds", lambda: burning(4).advance(float("nan"))),
            (singe.ArgumentError, "seconds", lambda: burning(4).advance(float("inf"))),
            (singe.ArgumentError, "seconds", lambda: burning(4).advance(1.1e6)),
            (ValueError, "steps_max must fit", lambda: burning(4).advance(0.1, -1)),
            (ValueError, "gravity must have 3 values, not 2", lambda: burning(4).set_gravity([1, 2])),
            (ValueError, "gravity must have 3 values, not 4", lambda: burning(4).set_gravity([1, 2, 3, 4])),
            (TypeError, "gravity must be a number", lambda: burning(4).set_gravity("abc")),
            (ValueError, "triangles must have the shape", lambda: singe.Sim().collider(
                "mesh", vertices=np.eye(3), triangles=[0, 1, 2])),
            (ValueError, "heights must have the shape", lambda: singe.Sim().collider("heightfield", heights=[1, 2])),
            (ValueError, "rows .time, factor.", lambda: burning(4).spot([0, 0, 0], strength=[1, 2])),
            (ValueError, "name must not contain a NUL", lambda: singe.Sim().sheet(*grid, name="a\0b")),
            (ValueError, "of an attribute must not", lambda: singe.Sim().sheet(*grid, **{"a\0b": np.zeros(2601)})),
            (ValueError, "of an attribute must not", lambda: singe.Sim().sheet(
                *grid, wet=np.zeros(2601), material={"mass_rate": singe.Vary(0, 1, attribute="wet\0b")})),
            (ValueError, "of a material must not", lambda: singe.Sim().sheet(*grid, material="cotton\0b")),
            (singe.HandleError, "another simulation", lambda: burning(4).pin(burning(4).sheets[0], vertices=[0])),
        ]
        for kind, text, call in cases:
            with self.subTest(text), self.assertRaisesRegex(kind, text):
                call()

    def test_bad_arguments_are_named(self):
        """Whatever is given for an argument is taken, or refused by a message that says which it is."""
        grid = singe.grid((0.02, 0.02), (2, 2))
        sim, early = singe.Sim(), singe.Sim()
        sheet = sim.sheet(*grid)
        sim.commit()
        corner = 0.01 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) - [0, 0, 1]
        sides = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
        pin, source = sim.pin(sheet, points=[[0, 0, 0]]), sim.source("callback", callback=lambda view: 0.0)
        collider = sim.collider("deforming", vertices=corner, triangles=sides)
        drawn = corner + [0, 0, 1]

        def varies(**field):
            return early.sheet(*grid, material={"thickness": singe.Vary(1e-4, 2e-4, **field)})

        calls = {
            "pace": (lambda x: singe.Sim(pace=x), sim.set_pace),
            "gravity": (lambda x: singe.Sim(gravity=x), sim.set_gravity),
            "thread": (lambda x: singe.Sim(threads=x), lambda x: singe.Sim.load(sim.save(), threads=x)),
            "seed": (lambda x: singe.Sim(seed=x),),
            "gas": (lambda x: singe.Sim(gas=x),),
            "solver": (lambda x: singe.Sim(solver=x),),
            "wind": (lambda x: singe.Sim(wind=x),),
            "points": (lambda x: early.sheet(x, grid.faces), lambda x: sheet.render_mesh(x, sides)),
            "face": (lambda x: early.sheet(grid.points, x),),
            "uv": (lambda x: early.sheet(*grid[:2], x), lambda x: early.sheet(*grid[:2], corner_uv=x),
                   lambda x: sheet.render_mesh(drawn, sides, x)),
            "material": (lambda x: early.sheet(*grid, material=x), sheet.set_material,
                         lambda x: early.sheet(*grid, material={"base": x})),
            "compliance": (lambda x: early.sheet(*grid, material={"compliance": x}),),
            "velocity": (lambda x: early.sheet(*grid, velocity=x), sim.wind, sheet.set_velocity),
            "drop_pieces_below": (lambda x: early.sheet(*grid, drop_pieces_below=x),),
            "mesh": (lambda x: early.sheet(*grid, mesh=x),),
            "wet": (lambda x: early.sheet(*grid, wet=x),),
            "thickness": (lambda x: early.sheet(*grid, material={"thickness": x}), lambda x: varies(noise=x),
                          lambda x: varies(attribute=x), lambda x: varies(texture=x)),
            "kind": (sim.source, sim.collider),
            "path|null byte": (lambda x: sim.source("ball", path=x), pin.move, collider.move, lambda x: sim.save(x)),
            "texture": (lambda x: sim.source("texture", texture=x),),
            "strength": (lambda x: sim.source("spot", strength=x),),
            "callback": (lambda x: sim.source("callback", callback=x), source.set_callback),
            "position": (sim.spot, lambda x: pin.set_positions(x, 1)),
            "radius": (lambda x: sim.spot([0, 0, 0], radius=x), lambda x: sim.pin(sheet, [[0, 0, 0]], radius=x)),
            "sheet": (lambda x: sim.pin(x, [[0, 0, 0]]),),
            "point": (lambda x: sim.pin(sheet, points=x),),
            "vert": (lambda x: sim.pin(sheet, vertices=x), lambda x: sim.collider("mesh", vertices=x, triangles=sides),
                     lambda x: collider.set_vertices(x, 1)),
            "triangles": (lambda x: sim.collider("mesh", vertices=corner, triangles=x),
                          lambda x: sheet.render_mesh(drawn, x)),
            "heights": (lambda x: sim.collider("heightfield", heights=x),),
            "temperature": (sim.set_ambient_temperature,),
            "seconds": (lambda x: sim.advance(x, 1),),
            "steps_max": (lambda x: sim.advance(0, x),),
            "n must": (sim.step,),
            "time": (lambda x: collider.set_vertices(corner, x), lambda x: pin.set_positions(drawn[:1], x)),
            "first": (lambda x: sheet.set_velocity([[0, 0, 0]], x),),
            "share": (lambda x: sheet.set_material("cotton", x),),
            "size": (singe.grid,),
            "cells": (lambda x: singe.grid(cells=x),),
            "width": (lambda x: singe.draw(sim.surface(), width=x),),
            "snapshot|path|null byte": (singe.Sim.load,),
        }
        bad = (None, "a\0b", [[1, 2, 3], [1, 2]], object(), 2**70, 1.5, np.array([1 + 2j]), {"x": 1}, lambda *_: 0.0)
        for word, ways in calls.items():
            for way, value in ((way, value) for way in ways for value in bad):
                with self.subTest(word, value=value):
                    try:
                        way(value)
                    except (TypeError, ValueError, OSError, singe.Error) as error:
                        self.assertNotIsInstance(error, ctypes.ArgumentError)
                        self.assertRegex(str(error).lower(), f"{word}|there is no 'x'")

    def test_a_step_that_fails_changes_nothing(self):
        sim = burning()
        sim.step(10)
        before, steps = sim.position.copy(), sim.steps
        pin = sim.pins[0]
        pin.move([(sim.time, 0, 0, 0), (sim.time + 1e-3, 1e8, 0, 0)])  # drags its particles out of the world
        with self.assertRaises(singe.DivergedError) as caught:
            sim.step(5)
        self.assertEqual(caught.exception.stage, "dynamics")
        self.assertEqual(sim.steps, steps)
        self.assertTrue(np.array_equal(sim.position, before))
        pin.move([(0, 0, 0, 0)])
        sim.step(5)

    def test_messages_go_to_the_logger(self):
        with self.assertLogs("singe", logging.INFO) as found:
            burning()
        self.assertTrue(any("cells" in line for line in found.output))


class Shown(Case):
    def test_nothing_is_copied_or_written(self):
        sim = burning()
        places = {name: address(getattr(sim, name)) for name in FIELDS}
        before = sim.temperature
        cold = before.copy()
        sim.step(60)
        for name in FIELDS:
            array = getattr(sim, name)
            self.assertEqual(address(array), places[name], name)
            self.assertFalse(array.flags.writeable)
            with self.assertRaises(ValueError):
                array.flags.writeable = True
        self.assertGreater(before.max(), cold.max() + 100)
        self.assertEqual(sim.position.shape, (17 * 17 + 256, 3))
        self.assertEqual(sim.springs(singe.RED).shape, (1024, 2))
        self.assertEqual(sim.spring_length(singe.BLUE).shape, sim.spring_rest(singe.BLUE).shape)
        self.assertIsNone(sim.line_force)
        self.assertEqual(burning(commit=False).position.shape, (0, 3))

    def test_arrays_outlive_their_simulation(self):
        self.python("""
import gc, numpy as np
from support import burning, singe
def kept():
    with burning(gas=True) as sim:
        sim.step(30)
        arrays = [sim.position, sim.cells, sim.springs(0), sim.gas().flame, sim.surface().triangles, sim.temperature]
    return arrays, [a.copy() for a in arrays]
arrays, copies = kept()
gc.collect()
others = [burning(gas=True) for _ in range(5)]  # would take the place of what was freed
[other.step(40) for other in others]
assert all(np.array_equal(a, b) for a, b in zip(arrays, copies))
sim = burning()
sim.step(10)
old, ids = sim.temperature, sim.sheets[0]
sim.set_ambient_temperature(350)
ids.set_material("cotton", np.ones(289))
then = old.copy()
sim.step(30)
assert np.array_equal(old, then) and not np.array_equal(sim.temperature, then)
""")

    def test_memory_goes_with_the_last_array(self):
        def resident():
            with open("/proc/self/statm", encoding="ascii") as file:
                return int(file.read().split()[1]) * 4096
        if not os.path.exists("/proc/self/statm"):
            self.skipTest("no /proc")
        burning(100)
        gc.collect()
        before = resident()
        for _ in range(10):  # 20 MB each
            sim = burning(100)
            array = sim.position
            sim.surface()
            sim.close()
        del sim, array
        gc.collect()
        self.assertLess(resident() - before, 60e6)

    def test_closed(self):
        sim = burning()
        sim.close()
        sim.close()
        for call in (lambda: sim.position, sim.step, sim.save, sim.stats, lambda: sim.sheets):
            with self.assertRaisesRegex(singe.StateError, "closed"):
                call()
        self.assertIn("closed", repr(sim))


class Threads(Case):
    def overlap(self, step):
        """Steps of one simulation that end while one long call of another, in another thread, is under way."""
        long, short, stop, ends = burning(24), burning(4), threading.Event(), []
        span = []

        def many():
            done = ctypes.c_uint32()
            with long._locked() as handle:
                span.append(time.monotonic())
                step("singe_sim_advance", handle.pointer, ctypes.c_double(0.4), 0, ctypes.byref(done))
                span.append(time.monotonic())
            stop.set()

        # the lock changes hands only where a call lets go of it, not between the first look at the clock and the call
        self.addCleanup(sys.setswitchinterval, sys.getswitchinterval())
        sys.setswitchinterval(60)
        thread = threading.Thread(target=many)
        thread.start()
        while not stop.is_set():
            short.step()
            ends.append(time.monotonic())
        thread.join()
        margin = 0.05 * (span[1] - span[0])
        return sum(span[0] + margin < end < span[1] - margin for end in ends)

    def test_two_simulations_step_at_once(self):
        self.assertGreater(self.overlap(lambda name, *a: getattr(library, name)(*a)), 5)
        holding = ctypes.PyDLL(library._name)  # calls through it keep the interpreter's lock
        self.assertEqual(self.overlap(lambda name, *a: getattr(holding, name)(*a)), 0)

    def test_one_simulation_does_one_call_at_a_time(self):
        sim, other = burning(8), burning(8)
        threads = [threading.Thread(target=lambda: sim.step(50)) for _ in range(4)]
        for thread in threads:
            thread.start()
        while any(thread.is_alive() for thread in threads):
            sim.stats(), sim.surface(), sim.save()
        other.step(200)
        self.assertEqual(sim.save(), other.save())

    def test_ctrl_c_ends_a_long_step(self):
        out = self.python("""
import os, signal, threading, time
from support import burning
for call in (lambda sim: sim.step(10**9), lambda sim: sim.advance(1e6)):
    sim = burning(8)
    threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    try:
        call(sim)
    except KeyboardInterrupt:
        steps = sim.steps
        sim.step(2)
        print(steps > 0, sim.steps == steps + 2)
""")
        self.assertEqual(out.split(), ["True"] * 4)

    def test_ctrl_c_does_not_wait_for_the_end_of_a_step(self):
        """A step of seconds: Ctrl-C comes through at once, and the step ends by itself. Called directly it comes late."""
        out = self.python("""
import os, signal, threading, time
from support import burning, singe
from singe._library import library

def late(call):  # how late Ctrl-C comes through, as a share of what the call takes
    wait = 0.3 * whole
    threading.Timer(wait, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    try:
        call()
    except KeyboardInterrupt:
        pass
    return (time.monotonic() - begun - wait) / whole

sim = burning(200, solver={"substeps": 1000})
begun = time.monotonic()
sim.step()
whole = time.monotonic() - begun
print(whole > 0.4)
for call in (sim.step, lambda: sim.advance(2 / 480)):
    steps = sim.steps
    print(late(call) < 0.25)
    print(0 < sim.steps - steps <= 2)  # waits for the step to end
print(late(lambda: library.singe_sim_step(sim._handle.pointer)) > 0.3)

bigs = [burning(400, commit=False) for _ in range(2)]
begun = time.monotonic()
bigs[0].commit()
whole = time.monotonic() - begun
big = bigs[1]
print(whole > 0.3, late(big.commit) < 0.25)
try:
    big.commit()  # waits, and is the second one
except singe.StateError:
    print(big.committed)
""")
        self.assertEqual(out.split(), ["True"] * len(out.split()))
        self.assertEqual(len(out.split()), 9)

    def test_no_call_from_within(self):
        class Nosy(logging.Handler):
            def emit(self, record):
                if sim is None:  # the mesh's own
                    return
                try:
                    sim.stats()
                except singe.StateError as error:
                    found.append(str(error))

        sim = None
        found, nosy, logger = [], Nosy(), logging.getLogger("singe")
        level = logger.level
        logger.addHandler(nosy)
        logger.setLevel(logging.INFO)
        try:
            sim = singe.Sim()
            sim.sheet(*singe.grid((0.1, 0.1), (4, 4)))
            sim.commit()
        finally:
            logger.removeHandler(nosy)
            logger.setLevel(level)
        self.assertTrue(found and re.search("within", found[0]))
