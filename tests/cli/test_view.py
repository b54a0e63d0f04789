"""singe view: what it serves, whom it refuses, and scenes that are watched while they burn."""

import http.client
import json
import os
import signal
import socket
import struct
import subprocess
import time
from pathlib import Path

from support import SANITIZED, SINGE, Case, write_png

PATIENCE = 60 if SANITIZED else 20


class View:
    """A view in progress, and requests to it as a browser sends them."""

    def __init__(self, case, *args, **options):
        self.process = subprocess.Popen([SINGE, "view", *args], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)
        case.addCleanup(self.end)
        self.address = self.process.stdout.readline().strip()
        case.assertRegex(self.address, r"^http://127\.0\.0\.1:\d+/[0-9a-f]{32}/$")
        self.port = int(self.address.split(":")[2].split("/")[0])
        self.base = "/" + self.address.split("/")[3] + "/"

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        code = self.process.wait(PATIENCE)
        self.errors = self.process.stderr.read() if not self.process.stderr.closed else ""
        self.process.stdout.close()
        self.process.stderr.close()
        return code

    def ask(self, path, method="GET", whole=None, body=None, **headers):
        """(status, bytes); `whole` is a path without the token."""
        link = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        try:
            link.request(method, self.base + path if whole is None else whole, body=body, headers={k.replace("_", "-"): v for k, v in headers.items()})
            answer = link.getresponse()
            self.headers = dict(answer.getheaders())
            return answer.status, answer.read()
        finally:
            link.close()

    def state(self):
        return json.loads(self.ask("state")[1])

    def wait(self, what):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            state = self.state()
            if what(state):
                return state
            time.sleep(0.02)
        raise AssertionError(f"it did not happen: {self.state()}")

    def memory(self):
        with open(f"/proc/{self.process.pid}/status") as file:
            return next(int(line.split()[1]) for line in file if line.startswith("VmRSS"))


class Sides(Case):
    def test_pictures_of_both_sides(self):
        """Of two sheets, one printed on both sides, and one of cotton."""
        for name, grey in (("front", 10), ("back", 200)):
            write_png(self.path(name + ".png"), [[grey] * 3] * 2)
        sheets = [{"name": "a", "picture": self.path("front.png"), "back": self.path("back.png")}, {"name": "b", "material": "cotton"}]
        grid = {"grid": {"size": [0.02, 0.02], "cells": [3, 3]}}
        Path(self.scene).write_text(json.dumps({"frames": 1, "steps": 1, "sheets": [{**grid, **one} for one in sheets]}))
        self.run_scene("sides")
        view = View(self, self.path("sides"))
        room = json.loads(view.ask("run/1/room")[1])
        self.assertEqual([[one[key] for key in ("picture", "back", "cloth")] for one in room["sheets"]], [[True, True, False], [False, False, True]])
        pictures = [view.ask(f"run/1/picture/{number}") for number in range(5)]
        self.assertEqual([status for status, _ in pictures], [200, 404, 200, 404, 404])
        for number, grey in ((0, 10), (2, 200)):
            self.assertEqual(pictures[number][1], struct.pack("<2I", 3, 2) + bytes([grey] * 18))


class Cache(Case):
    def setUp(self):
        super().setUp()
        self.run_scene("out")
        self.view = View(self, self.path("out"))

    def test_a_cache_is_served_frame_by_frame(self):
        state = self.view.state()
        self.assertEqual((state["run"], state["first"], state["last"], state["live"]), (1, 1, 6, False))
        room = json.loads(self.view.ask("run/1/room")[1])
        self.assertEqual((room["name"], room["fps"], len(room["sheets"]), len(room["ambient"])), ("tiny", 24, 1, 27))
        for number in (1, 6):
            status, frame = self.view.ask(f"run/1/frame/{number}")
            self.assertEqual((status, frame[:4]), (200, b"SVF1"))
            vertices, triangles, shapes, _, x, y, z = struct.unpack_from("<7I", frame, 4)
            self.assertEqual(len(frame), 592 + 64 * vertices + 72 * shapes + 12 * triangles + 4 * x * y * z)
            self.assertAlmostEqual(struct.unpack_from("<f", frame, 32)[0], (number - 1) / 24, 5)
        vertex = json.loads(self.view.ask("run/1/vertex/1/0")[1])
        self.assertAlmostEqual(vertex["values"][0], 293.15, 2)
        self.assertAlmostEqual(vertex["values"][5], 0, 5)
        status, mesh = self.view.ask("run/1/cells")
        vertices, cells = struct.unpack_from("<2I", mesh)
        self.assertEqual((status, vertices, cells, len(mesh)), (200, 13 * 13, 12 * 12, 8 + 12 * vertices + 16 * cells))
        corners = struct.unpack_from(f"<{4 * cells}I", mesh, 8 + 12 * vertices)
        self.assertEqual(set(corners), set(range(vertices)))
        # the page finds them in a frame by the bits of their rest positions
        frame = self.view.ask("run/1/frame/1")[1]
        drawn = {frame[at + 16 : at + 28] for at in range(592, 592 + 64 * struct.unpack_from("<I", frame, 4)[0], 64)}
        self.assertLessEqual({mesh[at : at + 12] for at in range(8, 8 + 12 * vertices, 12)}, drawn)
        self.assertEqual(self.view.ask("run/1/stats.csv"), (200, Path(self.path("out", "stats.csv")).read_bytes()))
        status, page = self.view.ask("")
        self.assertEqual(status, 200)
        self.assertIn(b"view.js", page)
        for name in ("view.js", "stage.js", "shaders.js", "view.css"):
            self.assertEqual(self.view.ask(name)[0], 200)
        self.assertIn("default-src 'none'", self.view.headers["Content-Security-Policy"])

    def test_only_the_page_with_the_token_may_ask(self):
        ask, base, port = self.view.ask, self.view.base, self.view.port
        wrong = base[:-2] + ("0" if base[-2] != "0" else "1") + "/"
        for whole in ("/", "/state", wrong + "state", base[:-1], base[:-3] + "/state", "//" + base[1:] + "state"):
            self.assertEqual(ask("", whole=whole)[0], 403, whole)
        for headers in ({"Host": "evil.example"}, {"Host": f"evil.example:{port}"}, {"Host": "127.0.0.1"}, {"Origin": "http://evil.example"},
                        {"Origin": "null"}, {"Origin": f"http://127.0.0.1:{port + 1}"}, {"Sec_Fetch_Site": "cross-site"}, {"Sec_Fetch_Site": "same-site"}):
            self.assertEqual(ask("state", **headers)[0], 403, headers)
        for headers in ({"Host": f"localhost:{port}"}, {"Origin": f"http://127.0.0.1:{port}", "Sec_Fetch_Site": "same-origin"}):
            self.assertEqual(ask("state", **headers)[0], 200, headers)
        for method in ("HEAD", "PUT", "DELETE", "OPTIONS"):
            self.assertEqual(ask("state", method=method)[0], 405, method)
        with self.assertRaises((http.client.HTTPException, OSError)):
            ask("state", method="POST", body=b"x" * 1000)
        self.assertEqual(self.raw(f"GET {base}state HTTP/1.1\r\nConnection: close\r\n\r\n")[9:12], b"403")

    def raw(self, text):
        with socket.create_connection(("127.0.0.1", self.view.port), PATIENCE) as link:
            link.sendall(text.encode())
            got = b""
            while more := link.recv(65536):
                got += more
            return got

    def test_no_path_leads_out_of_the_list(self):
        for path in ("../run.json", "run/1/../../etc/passwd", "run/1/%2e%2e/run.json", "run/1/frame/../1", "run/1/frame/0", "run/1/frame/7", "run/1/frame/-1",
                     "run/1/frame/1x", "run/1/frame/99999999999", "run/2/frame/1", "run/1/ply/tiny.0001.ply", "run/1/checkpoint.singe", "view.c", "run/1/",
                     "run/1/solid/1/0", "run/1/picture/0", "run/1/vertex/1/999999", "/etc/passwd"):
            self.assertIn(self.view.ask(path)[0], (403, 404), path)

    def test_only_the_loopback_listens(self):
        found = []
        for name in ("tcp", "tcp6"):
            with open(f"/proc/net/{name}") as file:
                for line in file.readlines()[1:]:
                    place, state = line.split()[1], line.split()[3]
                    if state == "0A" and int(place.split(":")[1], 16) == self.view.port:
                        found.append(place.split(":")[0])
        self.assertEqual(found, ["0100007F"])

    def test_floods_and_slow_clients_do_no_harm(self):
        self.view.ask("run/1/frame/6")
        before = self.view.memory()
        head = f"GET {self.view.base}run/1/frame/6 HTTP/1.1\r\nHost: 127.0.0.1:{self.view.port}\r\n"
        idle = []
        for i in range(200):  # some say nothing, some stop within a line, some ask and never read
            link = socket.socket()
            link.setblocking(False)
            link.connect_ex(("127.0.0.1", self.view.port))
            idle.append(link)
        time.sleep(0.1)
        for i, link in enumerate(idle):
            try:
                link.send(["", head, head + "\r\n", "X" * 4000, head + "A: " + "b" * 60000 + "\r\n\r\n"][i % 5].encode())
            except OSError:
                pass
        time.sleep(0.3)
        self.assertLess(self.view.memory(), before + (400000 if SANITIZED else 20000))
        begun = time.monotonic()
        answered = False
        while not answered and time.monotonic() - begun < 10:  # room again, though all of them still hold on
            try:
                answered = self.view.ask("state")[0] == 200
            except OSError:
                time.sleep(0.05)
        self.assertTrue(answered)
        self.assertLess(time.monotonic() - begun, 6 if SANITIZED else 4)
        for link in idle:
            link.close()
        self.assertEqual(self.view.end(), 0)
        self.assertNotIn("ERROR", self.view.errors)

    def test_a_damaged_frame_is_told_of(self):
        for number, damage in ((2, b"no mesh"), (3, None)):
            path = self.path("out", "ply", f"tiny.{number:04d}.ply")
            whole = Path(path).read_bytes()
            Path(path).write_bytes(damage or whole[: len(whole) // 2])
            status, text = self.view.ask(f"run/1/frame/{number}")
            self.assertEqual(status, 500)
            self.assertIn(b".ply", text)
        self.assertEqual(self.view.ask("run/1/frame/4")[0], 200)

    def test_a_taken_port_and_wrong_words_are_errors(self):
        _, errors = self.singe("view", self.path("out"), "--port", str(self.view.port), expect=1)
        self.assertIn("is in use", errors)
        _, errors = self.singe("view", self.path("out"), "--set", "pace=2", expect=2)
        self.assertIn("is a cache", errors)
        self.singe("view", self.path("nothing.yaml"), expect=2)
        self.singe("view", expect=2)


class Live(Case):
    def setUp(self):
        super().setUp()
        os.makedirs(self.path("tmp"))
        self.scene = self.write_scene(frames=4)
        self.view = View(self, self.scene, "--threads", "1", env={**os.environ, "TMPDIR": self.path("tmp")})

    def save(self, text):
        """By a new file in place of the old one, as editors do. Returns when."""
        Path(self.scene + "~").write_text(text)
        saved = time.monotonic()
        os.replace(self.scene + "~", self.scene)
        return saved

    def test_what_a_killed_view_left_is_removed_by_the_next(self):
        self.view.wait(lambda s: s["last"] == 4 and not s["burning"])
        left, = os.listdir(self.path("tmp"))
        os.mkdir(self.path("tmp", "singe-view-others"))
        second = View(self, self.scene, "--threads", "1", env={**os.environ, "TMPDIR": self.path("tmp")})
        self.assertIn(left, os.listdir(self.path("tmp")))  # in use
        second.end()
        self.view.process.kill()
        self.view.process.wait(PATIENCE)
        self.assertEqual(sorted(os.listdir(self.path("tmp"))), sorted([left, "singe-view-others"]))
        View(self, self.scene, "--threads", "1", env={**os.environ, "TMPDIR": self.path("tmp")}).end()
        self.assertEqual(os.listdir(self.path("tmp")), ["singe-view-others"])

    def test_a_scene_burns_while_it_is_watched_and_again_when_it_is_saved(self):
        state = self.view.wait(lambda s: s["last"] == 4 and not s["burning"])
        self.assertEqual((state["run"], state["live"], state["exit"]), (1, True, 0))

        # a save that is wrong: the message, and the frames of before
        good = Path(self.scene).read_text()
        self.save(good + "nonsense: 1\n")
        state = self.view.wait(lambda s: s["newest"] == 2 and not s["burning"])
        self.assertEqual((state["run"], state["last"], state["exit"]), (1, 4, 2))
        self.assertIn("nonsense", state["log"])
        self.assertEqual(self.view.ask("run/1/frame/4")[0], 200)

        saved = self.save(good.replace("frames: 4", "frames: 3"))
        self.view.wait(lambda s: s["newest"] == 3)
        began = time.monotonic() - saved
        self.view.wait(lambda s: s["run"] == 3 and s["last"] >= 1)
        print(f"began again {1e3 * began:.0f} ms after the save, first frame after {1e3 * (time.monotonic() - saved):.0f} ms (bar: 300 ms to begin)")
        self.assertLess(began, 3 if SANITIZED else 0.3)
        self.view.wait(lambda s: s["last"] == 3 and not s["burning"])
        self.assertEqual(self.view.ask("run/1/frame/1")[0], 404)
        self.assertEqual(json.loads(self.view.ask("run/3/room")[1])["frames"], 3)

        self.assertEqual(self.view.end(), 0)
        self.assertEqual(os.listdir(self.path("tmp")), [])

    def test_a_view_that_ends_ends_its_run(self):
        self.view.end()
        self.assertEqual(os.listdir(self.path("tmp")), [])


if subprocess.run([SINGE, "view", "--help"], capture_output=True).returncode:
    print("this singe was built without singe view")
    raise SystemExit(77)
