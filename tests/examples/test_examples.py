"""The examples: what a burning sheet must and must not do, in numbers, on the scenes that are shipped."""

import math
import os
import random
import statistics
import time

from support import Case, Ply

EXAMPLES = os.path.join(os.path.dirname(__file__), "..", "..", "examples")
ZERO_CELSIUS = 273.15


def root_mean_square(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


class Example(Case):
    """Runs the scene once, whole, and reads its numbers."""

    NAME = None
    # faults that `singe verify` may still count, in all frames together; what is not named must be 0
    FAULTS = {}

    def run_example(self, out, *args, **options):
        scene = os.path.join(EXAMPLES, self.NAME, self.NAME + ".yaml")
        return self.singe("run", scene, "-o", self.path(out), "--no-preview", "--quiet", *args, timeout=800, **options)

    def setUp(self):
        super().setUp()
        self.run_example("whole", "--threads", "1")
        self.rows = [{k: float(v) for k, v in row.items()} for row in self.stats("whole")]
        self.cells = self.record("whole")["counts"]["cells"]
        self.fps = self.record("whole")["scene"]["fps"]
        self.say = {}
        self.addCleanup(self.report)

    def column(self, name):
        return [row[name] for row in self.rows]

    def common(self):
        """In every example numbers are finite, and nothing is created or lost."""
        for row in self.rows:
            for name, value in row.items():
                self.assertTrue(math.isfinite(value), f"{name} of frame {row['frame']}")
        for row in self.rows:
            # the first warm frame of a sheet that stores kilojoules holds microjoules: 1e-7 J are rounding
            largest = max(abs(row[name]) for name in ("heat_in", "heat_lost", "heat_of_combustion", "heat_stored"))
            self.assertLess(row["ledger_error"] * largest, 1e-5 * max(largest, 1e-2), f"ledger of frame {row['frame']}")
        self.assertLess(max(self.column("mass_ledger_error")), 1e-6)
        self.assertEqual(self.rows[-1]["frame"], len(self.rows))
        self.verified()
        self.say["ledgers"] = f"{max(self.column('ledger_error')):.1e}, {max(self.column('mass_ledger_error')):.1e}"
        self.say["burnt"] = f"{self.rows[-1]['burnt_fraction']:.2f}"

    def verified(self):
        """`singe verify` finds no faults in the cache, except known ones."""
        path = self.path("faults.csv")
        run = self.start("verify", self.path("whole"), "--csv", path)
        err = run.communicate(timeout=800)[1]
        self.assertIn(run.returncode, (0, 1), err)
        rows = self.table("faults.csv")
        self.assertEqual(len(rows), len(self.rows))
        for kind in list(rows[0])[3 : list(rows[0]).index("stats") + 1]:
            count = sum(int(row[kind]) for row in rows)
            self.say[kind] = count
            self.assertLessEqual(count, self.FAULTS.get(kind, 0), f"{kind}: {err}")

    def before_the_fire(self):
        """The same scene without its sources hangs, lies and falls without turning a cell inside out."""
        self.run_example("cold", "--threads", "1", "--frames", "36", "--set", "sources=[]")
        rows = [{k: float(v) for k, v in row.items()} for row in self.stats("cold")]
        self.assertEqual(max(row["ignited"] for row in rows), 0)
        self.assertEqual(max(row["inverted_cells"] for row in rows), 0)
        self.assertLessEqual(max(row["strain_mean"] for row in rows), 0.01)

    def frame(self, number):
        return Ply(self.path("whole", "ply", f"{self.NAME}.{number:04d}.ply"))

    def vertices(self, frame):
        """The values of a frame's vertices, by name."""
        return self.frame(frame).vertices()

    def ash_left(self):
        """Vertices of the last frame that have burnt to ash and are still there."""
        return sum(vertex["burnt"] > 0.95 for vertex in self.vertices(len(self.rows)))

    def look(self, frames, burnt=1.0, unburnt=5.0):
        """What pictures are judged by, over some frames: an ember line of less than 3 mm, creases that do not follow
        the mesh, wrinkles where it has burnt, in degrees of the normal (the letter without shrinkage has
        0.05, one whose char rolls up 13), and none elsewhere."""
        self.singe("measure", self.path("whole"), "--frames", frames, "--csv", self.path("look.csv"), timeout=800)
        rows = self.table("look.csv")

        def median(name):
            values = [float(row[name]) for row in rows if row[name]]
            return statistics.median(values) if values else math.nan

        bias = median("crease_axis_over_diagonal")
        rough, smooth = median("burnt_angle_deg"), median("unburnt_angle_deg")
        self.say["creases"] = f"{bias:.2f} axis over diagonal"
        self.say["wrinkles"] = f"{rough:.1f} degrees where burnt, {smooth:.1f} where not"
        self.say["curl"] = f"{median('curl_p50_deg'):.0f} and {median('curl_p90_deg'):.0f} degrees over 10 mm"
        self.say["slope"] = f"{median('rim_4_7_slope_p50_deg'):.0f} degrees at 4 to 7 mm"
        self.say["jitter"] = f"{median('jitter_mm_per_s'):.1f} mm/s"
        if rows[0].get("ember_width_mm"):
            width = median("ember_width_mm")
            self.say["embers"] = f"{width:.2f} mm"
            self.assertTrue(0.1 < width <= 3)
        if burnt:
            self.assertGreaterEqual(rough, burnt)
        if unburnt:
            self.assertLessEqual(smooth, unburnt)
        return median

    def curls(self, frames):
        """Paper that shrinks by a fifth rolls up at its rim and folds far into what has not burnt: medians over frames
        in the midst of the burn. The letter that shrank by a third of eq 6 and lost its char at once had 7 and 14
        degrees of curl, 10 of slope and 1.8 where burnt; without shrinkage .3, 1, 0 and .05."""
        median = self.look(frames, burnt=10)
        area = (median("rim_0_1_area") + median("rim_1_2_area")) / 2
        self.say["area"] = f"{area:.2f} at 0 to 2 mm"
        self.assertGreaterEqual(median("curl_p50_deg"), 25)
        self.assertGreaterEqual(median("curl_p90_deg"), 60)
        self.assertGreaterEqual(median("rim_4_7_slope_p50_deg"), 20)
        self.assertTrue(0.45 <= area <= 0.75)
        # folds are drawn smoothly: .56 to .69 here, and 1.6 and 1.9 on the torus and the ball, whose folds are crushed
        self.say["folds"] = f"{median('fold_angle_deg'):.2f} degrees below three cells"
        self.assertLessEqual(median("fold_angle_deg"), 1)

    def keeps_still(self):
        """What has not burnt looks as still as it is. With the velocities of single substeps the letter's jitter was 8.4
        and 12.1 mm/s, and 10 far from the fire."""
        self.singe("measure", self.path("whole"), "--no-preview", "--csv", self.path("still.csv"), timeout=800)
        rows = self.table("still.csv")
        near, cold = ([float(row[name]) for row in rows if row[name]] for name in ("jitter_mm_per_s", "jitter_cold_mm_per_s"))
        middle, worst, far = statistics.median(near), max(near), statistics.median(cold)
        self.say["still"] = f"jitter {middle:.1f}, at most {worst:.1f}; {far:.2f} mm/s far from the fire"
        self.assertLess(middle, 4)
        self.assertLess(worst, 12)
        self.assertLess(far, 1)

    def leaf(self, frame):
        """m2 at rest of black char that has no fuel left, on the piece that has most of it."""
        vertices, areas = self.vertices(frame), {}
        black = [v["char_fraction"] > 0.1 and v["mass"] < v["char_fraction"] + v["ash_fraction"] + 0.02 for v in vertices]
        for triangle in self.frame(frame).triangles:
            if not all(black[i] for i in triangle):
                continue
            a, b, c = ([vertices[i]["rest_" + axis] for axis in "xyz"] for i in triangle)
            u, w = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
            cross = (u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0])
            piece = vertices[triangle[0]]["piece_id"]
            areas[piece] = areas.get(piece, 0) + math.hypot(*cross) / 2
        return max(areas.values(), default=0)

    def report(self):
        print("  ".join(f"{name} {value}" for name, value in self.say.items() if value != 0))
        self.say.clear()


class Letter(Example):
    NAME = "letter"

    def test_burns(self):
        self.common()
        self.before_the_fire()
        last = self.rows[-1]
        ash = self.ash_left()
        hottest = max(self.column("temperature_max")) - ZERO_CELSIUS
        self.say["front"] = f"{1e3 * last['front_speed']:.2f} mm/s"
        self.say["hottest"] = f"{hottest:.0f} C"
        self.say["left"] = f"{last['pieces']:.0f} pieces, {last['particles']:.0f} particles, {ash} vertices of ash"
        leaf = 1e4 * self.leaf(len(self.rows))
        self.say["leaf"] = f"{leaf:.0f} cm2 of char at last"
        self.curls("56-60")
        self.keeps_still()
        self.assertGreaterEqual(leaf, 10)
        self.assertTrue(750 <= hottest <= 1050)  # of flame and embers; strips without edges keep to 950 (heat_front)
        # what office paper does, lying free
        self.assertTrue(4.4e-3 <= last["front_speed"] <= 7.0e-3)
        self.assertGreaterEqual(last["burnt_fraction"], 0.5)
        self.assertGreater(last["particles"], 100)
        self.assertGreater(ash, 100)
        self.assertGreater(last["holes_opened"], 0)
        self.assertLessEqual(last["tears"], 2)  # nothing pulls at it: 0; with burnt corners that spun, 19
        self.assertEqual(max(self.column("inverted_cells")), 0)
        # the demo stays small
        self.assertLessEqual(self.rows[0]["springs"], 110000)
        self.assertEqual(len(self.rows), 100)


class LetterHanging(Example):
    NAME = "letter-hanging"

    def test_hangs_and_burns(self):
        self.common()
        self.before_the_fire()
        # without flames, which shake it, what has not burnt hangs still
        self.run_example("still", "--threads", "1", "--set", "gas=no")
        second = self.stats("still")[-int(self.fps):]
        rest = root_mean_square([float(row["speed_rms_unburnt"]) for row in second])
        self.say["strain"] = f"mean {max(self.column('strain_mean')):.4f} p99 {max(self.column('strain_p99')):.4f}"
        self.say["inverted"] = f"{max(self.column('inverted_cells')):.0f} of {self.cells:.0f} cells"
        self.say["unburnt"] = f"{1e3 * rest:.2f} mm/s rms in the last second"
        self.say["hottest"] = f"{max(self.column('temperature_max')) - ZERO_CELSIUS:.0f} C"
        self.curls("100-119")
        self.assertLessEqual(max(self.column("strain_mean")), 0.008)
        self.assertLessEqual(max(self.column("strain_p99")), 0.03)
        self.assertGreater(self.column("tears")[-1], 0)
        self.assertEqual(max(self.column("inverted_cells")), 0)
        self.assertLessEqual(rest, 5e-3)
        self.assertGreater(self.rows[-1]["burnt_fraction"], 0.3)  # it did burn
        self.assertLess(self.rows[-1]["burnt_fraction"], 0.9)  # and there is something left to be still


class HotSphere(Example):
    NAME = "hot-sphere"

    def test_burns_through(self):
        self.common()
        self.before_the_fire()
        last = self.rows[-1]
        self.say["pieces"] = f"{last['pieces']:.0f}"
        self.look("50-69")
        self.assertGreaterEqual(last["pieces"], 2)
        self.assertTrue(0.1 < last["burnt_fraction"] < 0.9)
        self.assertEqual(max(self.column("inverted_cells")), 0)


class PageHot(Example):
    NAME = "page-hot"

    def test_burns_where_the_picture_says(self):
        self.common()
        self.say["pieces"] = f"{self.rows[-1]['pieces']:.0f}"
        self.look("40-49", unburnt=None)  # nothing of it stays unburnt
        self.assertGreater(self.rows[-1]["burnt_fraction"], 0.6)
        self.assertGreaterEqual(self.rows[-1]["pieces"], 4)
        self.assertEqual(max(self.column("inverted_cells")), 0)


class Note(Example):
    """A match lights a corner; all of the note burns, and most of its char becomes ash."""

    NAME = "note"

    def test_burns_to_ash(self):
        self.common()
        last = self.rows[-1]
        self.assertGreater(last["burnt_fraction"], 0.75)  # what is left is ash and a rest of char
        self.assertLess(self.rows[12]["burnt_fraction"], 1e-3)  # the match comes first
        self.assertEqual(max(self.column("inverted_cells")), 0)


class Macro(Example):
    """Cells of 0.75 mm: the leaf curls away from the fire and nothing crosses."""

    NAME = "macro"

    def test_burns_to_a_leaf(self):
        self.common()
        self.curls("40-49")
        self.assertTrue(0.6 < self.rows[-1]["burnt_fraction"] < 0.95)
        self.assertLess(self.rows[-1]["pieces"], 20)
        self.assertEqual(max(self.column("inverted_cells")), 0)


class Newspaper(Example):
    NAME = "newspaper"

    def test_burns_fast(self):
        self.common()
        self.say["front"] = f"{1e3 * self.rows[-1]['front_speed']:.2f} mm/s"
        self.curls("80-99")
        # newsprint as sources have it: 7.8 to 12.4 mm/s
        self.assertTrue(7.8e-3 <= self.rows[-1]["front_speed"] <= 12.4e-3)
        self.assertTrue(0.2 < self.rows[-1]["burnt_fraction"] < 0.9)
        self.assertEqual(max(self.column("inverted_cells")), 0)


class Curtain(Example):
    """Pleats in gusts of wind, lit below."""

    NAME = "curtain"

    def test_fire_climbs_in_the_wind(self):
        self.common()
        ignited = next(row["time"] for row in self.rows if row["ignited"] > 0)
        self.say["ignites"] = f"after {ignited:.1f} s"
        # gusts keep it moving long after the hooks have come to rest
        moving = root_mean_square([row["speed_rms_unburnt"] for row in self.rows if 2 < row["time"] < 4])
        self.say["swings"] = f"{100 * moving:.1f} cm/s rms"
        self.look("100-119", unburnt=None)
        self.assertTrue(0.1 < self.rows[-1]["burnt_fraction"] < 0.9)
        self.assertGreater(moving, 0.02)
        self.assertLessEqual(max(self.column("strain_mean")), 0.01)


class StackEdge(Example):
    NAME = "stack-edge"

    def test_goes_from_sheet_to_sheet(self):
        self.common()
        self.look("60-79")
        # one sheet alone is a fifth
        self.assertGreater(self.rows[-1]["burnt_fraction"], 0.4)
        self.assertEqual(max(self.column("inverted_cells")), 0)


class Stack(Example):
    """Five letters lie on each other; fire climbs through them from the lowest."""

    NAME = "stack"

    def burnt_of_sheets(self):
        """Mean char of what is left of each sheet in the last frame; a sheet that is gone counts as burnt."""
        char = [[] for _ in range(5)]
        for vertex in self.vertices(len(self.rows)):
            char[int(vertex["sheet"])].append(vertex["burnt"])
        return [statistics.mean(values) if values else 1.0 for values in char]

    def lit(self):
        """When each sheet caught fire, in s, as far as what still lies there in some frames tells."""
        first = [math.inf] * 5
        for frame in range(25, len(self.rows) + 1, 15):
            for vertex in self.vertices(frame):
                if vertex["time_ignited"] >= 0:
                    sheet = int(vertex["sheet"])
                    first[sheet] = min(first[sheet], vertex["time_ignited"])
        return first

    def test_climbs_through_all(self):
        self.common()
        self.before_the_fire()
        burnt = self.burnt_of_sheets()
        self.say["char of the sheets"] = " ".join(f"{share:.2f}" for share in burnt)
        lit = self.lit()
        self.say["lit"] = " ".join(f"{time:.1f}" for time in lit) + " s"
        self.assertGreater(burnt[0], burnt[4])
        self.assertGreater(burnt[4], 0.01)
        match_out = 1.1  # s
        self.assertLess(lit[0], match_out)
        self.assertGreater(min(lit[1:]), match_out)
        self.assertEqual(max(lit), lit[4])
        self.assertTrue(0.2 < self.rows[-1]["burnt_fraction"] < 0.95)
        self.assertEqual(max(self.column("inverted_cells")), 0)
        self.assertLessEqual(max(self.column("strain_mean")), 0.008)


class CrumpledBall(Example):
    """A letter is crumpled into a ball between moving boxes, let go and lit."""

    NAME = "crumpled-ball"

    def size(self, frame):
        """The sheet's length along x, y and z, and the rms distance of its vertices from their centre."""
        axes = [[row[axis] for row in self.vertices(frame)] for axis in "xyz"]
        return [max(a) - min(a) for a in axes], math.hypot(*(statistics.pstdev(a) for a in axes))

    def test_stays_crumpled_and_burns(self):
        self.common()
        (flat, _), (held, tight), (lying, loose) = (self.size(int(t * self.fps) + 1) for t in (0, 1.9, 2.65))
        lit = next(row["time"] for row in self.rows if row["ignited"] > 0)
        sizes = ("x".join(f"{1e3 * side:.0f}" for side in size) for size in (flat, held, lying))
        self.say["size"] = f"{', '.join(sizes)} mm; rms {1e3 * tight:.0f}, then {1e3 * loose:.0f} mm"
        self.say["strain"] = f"mean {max(self.column('strain_mean')):.4f} p99 {max(self.column('strain_p99')):.4f}"
        # 21 cm long as it lay flat, less than a third of that between the boxes, and still crumpled when they have gone: it
        # is 74 mm rms flat, and was 42 in cells of 2.3 mm, which cannot fold as sharp; then it sinks under its weight
        self.assertGreater(max(flat), 0.2)
        self.assertLess(max(held), 0.07)
        self.assertLess(max(lying), 0.14)
        self.assertLess(loose, 0.036)
        self.assertGreater(min(lying), 0.015)
        self.assertGreater(lit, 2.65)
        self.assertGreater(self.rows[-1]["burnt_fraction"], 0.3)
        self.assertEqual(max(self.column("inverted_cells")), 0)
        self.assertLessEqual(max(self.column("strain_mean")), 0.03) # it is squeezed hard


class HotIron(Example):
    NAME = "hot-iron"

    def parts(self, frame):
        """Vertices well under the sole, and those well beside it; the iron is turned by 20 degrees."""
        under, beside = [], []
        back = complex(math.cos(math.pi / 9), -math.sin(math.pi / 9))
        for vertex in self.vertices(frame):
            turned = complex(vertex["rest_x"], vertex["rest_y"]) * back
            x, y = 1e3 * abs(turned.real), 1e3 * abs(turned.imag)
            if x < 40 and y < 15:
                under.append(vertex)
            elif x > 61 or y > 38:
                beside.append(vertex)
        return under, beside

    def test_burns_its_shape(self):
        self.common()
        lifted = 63  # the last frame before
        under, beside = self.parts(lifted)
        heated = statistics.median(v["temperature"] for v in under) - ZERO_CELSIUS
        warmest = max(v["temperature_peak"] for v in beside) - ZERO_CELSIUS
        self.say["under the sole"] = f"{heated:.0f} C"
        self.say["beside"] = f"{warmest:.0f} C at most"
        self.say["heat"] = f"{self.rows[lifted - 1]['heat_in']:.0f} J"
        last_under, last_beside = self.parts(len(self.rows))
        burnt = sum(v["burnt"] for v in last_under) / len(last_under)
        self.say["char at last"] = f"{burnt:.2f}"
        self.assertTrue(290 < heated < 335 and warmest < 80)
        self.assertLess(max(v["burnt"] for v in beside + last_beside), 1e-5)
        self.assertGreater(burnt, 0.5)
        # what it stands on for two seconds does not burn before it is lifted
        self.assertLess(self.rows[lifted - 1]["burnt_fraction"], 0.01)
        self.assertGreater(self.rows[-1]["burnt_fraction"], 0.02)
        self.assertEqual(max(self.column("inverted_cells")), 0)


class Tear(Example):
    """A ticket is pulled apart along its perforation while it burns."""

    NAME = "tear"

    def test(self):
        self.common()
        tears = self.column("tears")
        # the right hand pulls from the first second on: within the next second and a half the perforation has gone, top
        # to bottom but for a corner at most
        pulled, parted = (int(t * self.fps) for t in (1, 2.5))
        self.assertGreater(tears[parted] - tears[pulled], 35)
        self.assertLess(tears[-1], 2000) # of the vertices in reserve
        self.assertLess(max(self.column("strain_mean")[:parted]), 0.008)
        self.assertLess(max(self.column("strain_p99")[:parted]), 0.05) # it hangs from a corner then
        self.assertGreater(self.column("pieces_freed")[-1], 1)


class Shirt(Example):
    """A garment of triangles falls onto a dummy and burns on it."""

    NAME = "shirt"

    def test_falls_and_burns(self):
        self.common()
        lit = int(self.fps)  # the last frame before
        below = min(vertex["z"] for vertex in self.vertices(lit))
        burning = len(self.rows) // 2
        burnt = [vertex["rest_z"] for vertex in self.vertices(burning) if vertex["burnt"] > 0.5]
        self.say["hem"] = f"{below:.2f} m"
        self.say["fire"] = f"up to {max(burnt):.2f} m in frame {burning}"
        self.say["strain"] = f"mean {max(self.column('strain_mean')):.4f}"
        self.say["tears"] = f"{self.rows[104]['tears']:.0f} until frame 105"
        self.assertTrue(0.75 < below < 0.84)  # from 0.85 m: it hangs from the shoulders, and not through them
        self.assertEqual(self.rows[lit - 1]["burnt_fraction"], 0)
        self.assertGreater(max(burnt), 1.2)  # climbs
        self.assertTrue(0.15 < self.rows[-1]["burnt_fraction"] < 0.9)
        self.assertLess(self.rows[104]["tears"], 300)  # char that is equally strong all over tears into a comb: 560
        self.assertLessEqual(max(self.column("strain_mean")), 0.01)


class Garment(Example):
    """A sewn shirt is drawn in place of the coarse one that burns; its buttons keep their size."""

    NAME = "garment"

    def test_is_drawn_as_it_is_sewn(self):
        def buttons(frame):
            """Widths of what is left of the buttons: vertices whose rest position is off the front's middle."""
            sizes, near = [], {}
            for vertex in self.vertices(frame):
                if vertex["s"] > 0.98 and vertex["t"] > 0.98:
                    near.setdefault(round(vertex["rest_z"] / 0.05), []).append([vertex[axis] for axis in "xyz"])
            for points in near.values():
                if len(points) > 100:
                    sizes.append(max(math.dist(a, b) for a in points[::3] for b in points[::3]))
            return sizes

        first, last = buttons(1), buttons(len(self.rows))
        self.say["buttons"] = f"{len(first)}, {len(last)} at the end, {1e3 * min(last):.2f} to {1e3 * max(last):.2f} mm"
        self.say["burnt"] = f"{self.rows[-1]['burnt_fraction']:.2f}"
        self.assertEqual(self.cells, 1312)
        self.assertEqual(len(first), 5)
        self.assertTrue(0.0135 < min(first) <= max(first) < 0.0155)
        self.assertTrue(0.0135 < min(last) <= max(last) < 0.0155)
        self.assertTrue(0.04 < self.rows[-1]["burnt_fraction"] < 0.2)
        self.assertGreater(min(row["triangles"] for row in self.rows), 60000)


class BurningTorus(Example):
    """A closed surface falls on the ground, burns, caves in and falls apart."""

    NAME = "burning-torus"

    def unburnt_halves(self, frame):
        """Pieces that have a tenth and more of what has hardly charred."""
        count = {}
        for vertex in self.vertices(frame):
            if vertex["burnt"] < 0.5:
                count[vertex["piece_id"]] = count.get(vertex["piece_id"], 0) + 1
        return sum(number >= 0.1 * sum(count.values()) for number in count.values())

    def test_caves_in(self):
        self.common()
        first, rest, last = (max(v["z"] for v in self.vertices(frame)) for frame in (1, 15, len(self.rows)))
        self.say["top"] = f"{1e3 * first:.0f}, {1e3 * rest:.0f}, {1e3 * last:.0f} mm"
        self.say["pieces"] = f"{self.rows[-1]['pieces']:.0f}"
        halves = max(self.unburnt_halves(frame) for frame in range(90, 150, 5))
        self.say["halves"] = halves
        self.assertEqual(self.unburnt_halves(15), 1)
        self.assertGreaterEqual(halves, 2)
        self.assertGreater(self.column("tears")[-1], 0)
        self.assertTrue(0.082 < rest < 0.115 < first)  # 115 mm high at rest: it lands, and sags a little
        self.assertLess(last, 0.8 * rest)
        self.assertTrue(0.3 < self.rows[-1]["burnt_fraction"] < 0.95)
        self.assertGreaterEqual(self.rows[-1]["pieces"], 2)


class Title(Example):
    """Fire writes a word, as a map says."""

    NAME = "title"

    def test_writes(self):
        self.common()
        last = self.rows[-1]
        self.say["arrival"] = f"{1e3 * last['arrival_error']:.1f} ms, {last['arrival_missed']:.0f} missed"
        self.assertTrue(0 < max(self.column("arrival_error")) <= 1.01 / (self.fps * 16)) # a step
        self.assertEqual(max(self.column("arrival_missed")), 0)
        self.assertEqual(max(self.column("inverted_cells")), 0)
        self.assertTrue(0.1 < last["burnt_fraction"] < 0.3) # the word, and not the page
        self.assertLess(last["ignited"], 0.4 * self.rows[0]["particles"])


class PutOut(Example):
    """A fire that is put out stays out, and has left most of the sheet."""

    NAME = "blown-out"
    OTHERS = ("rained-on", "smothered")

    def test_stays_out(self):
        for name in (self.NAME, *self.OTHERS):
            if name != self.NAME:
                self.NAME = name
                self.run_example("whole", "--threads", "1", "--force")
                self.rows = [{k: float(v) for k, v in row.items()} for row in self.stats("whole")]
            with self.subTest(name):
                self.common()
                burnt = self.column("burnt_fraction")
                self.say["burnt"] = f"{burnt[23]:.3f} at 1 s, {burnt[47]:.3f} at 2 s, {burnt[59]:.3f} at the end"
                self.say["hottest at the end"] = f"{self.rows[-1]['temperature_max'] - ZERO_CELSIUS:.0f} C"
                self.report()
                self.assertTrue(0.05 < burnt[23] < 0.3)
                self.assertLess(burnt[59] - burnt[23], 0.1) # without it 0.3 and more burns
                self.assertLess(burnt[59] - burnt[52], 1e-4)
                self.assertLess(self.rows[-1]["temperature_max"], 350 + ZERO_CELSIUS)


class Blanket(Example):
    """A sheet smothers another, which without it would burn on."""

    NAME = "blanket"

    def test_goes_out(self):
        self.common()
        burnt = self.column("burnt_fraction")
        self.run_example("air", "--threads", "1", "--set", "sheets.1.material.smother_distance=0")
        air = [float(row["burnt_fraction"]) for row in self.stats("air")]
        self.say["burnt"] = f"{burnt[19]:.4f} before, {burnt[-1]:.4f} at the end, {air[-1]:.4f} with air"
        self.assertGreater(burnt[19], 0.005)
        self.assertLess(burnt[-1] - burnt[48], 1e-6)
        self.assertLess(self.rows[-1]["temperature_max"], 240 + ZERO_CELSIUS)
        self.assertGreater(air[-1] - air[19], 2 * (burnt[-1] - burnt[19]))


class Branches(Case):
    """Small runs of four examples, branched at ten random frames with nothing changed, give the bytes of the whole, also
    if the branch is killed on its way."""

    FRAMES = 14
    SETS = {"letter": ("sheets.0.grid.cells=[21, 30]",), "note": (), "title": ("sheets.0.grid.cells=[44, 20]",),
            "blown-out": ("sheets.0.grid.cells=[16, 16]", "sources.1.strength=2", "pace=12")}

    def test_ten_random_frames(self):
        seed = int(time.time())
        chosen = random.Random(seed)
        for name, sets in self.SETS.items():
            scene = os.path.join(EXAMPLES, name, name + ".yaml")
            given = [part for one in sets for part in ("--set", one)] + ["--frames", str(self.FRAMES)]
            more = ["--no-preview", "--quiet", *given]
            self.singe("run", scene, "-o", self.path(name), "--set", "checkpoints.every=5", *more, timeout=800)
            for frame in chosen.sample(range(1, self.FRAMES), 3 if name in ("letter", "title") else 2):
                with self.subTest(name, seed=seed, frame=frame):
                    threads = str(1 + frame % 2)
                    self.singe("run", scene, "-o", self.path(name + "-b"), "--force", "--from", f"{self.path(name)}:{frame}",
                               "--threads", threads, *more, timeout=800)
                    self.assertEqual(self.plys(name), self.plys(name + "-b"))
                    self.assertEqual(self.numbers(name), self.numbers(name + "-b"))

            # killed once it has written a frame of its own
            frame = chosen.randrange(1, self.FRAMES - 2)
            with self.subTest(name, seed=seed, killed=frame):
                out = self.path(name + "-k")
                run = self.start("run", scene, "-o", out, "--from", f"{self.path(name)}:{frame}", *more)
                self.addCleanup(run.stderr.close)
                while not os.path.exists(os.path.join(out, "ply", f"{name}.{frame + 1:04d}.ply")) and run.poll() is None:
                    time.sleep(0.002)
                run.kill()
                run.wait()
                self.singe("run", scene, "-o", out, "--resume", "--threads", "2", *more, timeout=800)
                self.assertEqual(self.plys(name), self.plys(name + "-k"))
                self.assertEqual(self.numbers(name), self.numbers(name + "-k"))


class SameBytes(Example):
    """Any number of threads, and a run that is killed and goes on, give the same cache."""

    NAME = "letter"
    FRAMES = ("--frames", "28")

    def setUp(self):
        Case.setUp(self)

    def test_threads_and_resume(self):
        self.run_example("1", "--threads", "1", *self.FRAMES)
        self.run_example("4", "--threads", "4", *self.FRAMES)
        self.assertEqual(self.plys("1"), self.plys("4"))
        self.assertEqual(self.numbers("1"), self.numbers("4"))
        seed = int(time.time())
        frame = random.Random(seed).randrange(3, 24)
        with self.subTest(seed=seed, frame=frame):
            scene = os.path.join(EXAMPLES, self.NAME, self.NAME + ".yaml")
            run = self.start("run", scene, "-o", self.path("killed"), "--no-preview", "--threads", "2", *self.FRAMES)
            self.addCleanup(run.stderr.close)
            wanted = self.path("killed", "ply", f"{self.NAME}.{frame:04d}.ply")
            while not os.path.exists(wanted) and run.poll() is None:
                time.sleep(0.002)
            run.kill()
            run.wait()
            self.run_example("killed", "--resume", "--threads", "4", *self.FRAMES)
            self.assertEqual(self.plys("1"), self.plys("killed"))
            self.assertEqual(self.numbers("1"), self.numbers("killed"))
