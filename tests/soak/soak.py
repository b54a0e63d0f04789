#!/usr/bin/env python3
"""Runs random scenes through a command, which may be built with sanitizers.

soak.py SINGE DRAW_SCENE [--extremes] [--minutes M | --scenes N] [--seed S] [--stride D] [--jobs J] [--work FOLDER]

DRAW_SCENE makes a scene from its seed; with --extremes extremes.py does, at the limits of what is legal. The scene is checked, run with one thread and with two, verified, and run again in
two parts by --resume; all caches must have the same bytes. A scene that `check` accepts must run, or fail later with a
reason. Nothing may crash, hang or grow without bound, and no file may hold what is no number.
Scenes that fail are kept with their messages in FOLDER/findings/SEED, and the exit code is 1.
"""

import argparse
import concurrent.futures
import filecmp
import json
import math
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import extremes

MEMORY_MB = 3000  # of a command under the address sanitizer, which keeps count
SECONDS = 120     # of a command, on all processors
SECONDS_EXTREME = 60  # the same for the small scenes of extremes.py,
SECONDS_OF_FILM = 3   # and for each second of their film: gas takes steps of its own, of milliseconds of fire
HANGS = 1800      # s by the clock, which a crowded machine stretches
GOOD, FAILED, INPUT = 0, 1, 2
SANITIZER = 99
# what the reason for a refusal begins with: a place in the scene, a stage of its first steps, or its memory
PLACE = re.compile(r"scene\.json:\d+:\d+: error: |error: (heat|burn|ablate|dynamics|tear|gas): |error: .*memory")


class Finding(Exception):
    """A fault that a scene has shown."""


def environment():
    common = f"exitcode={SANITIZER}:abort_on_error=0"
    return dict(os.environ, ASAN_OPTIONS=f"{common}:hard_rss_limit_mb={MEMORY_MB}:allocator_may_return_null=1",
                UBSAN_OPTIONS=f"{common}:halt_on_error=1:print_stacktrace=1", LC_ALL="C")


class Soak:
    def __init__(self, options):
        self.singe, self.draw = os.path.abspath(options.singe), os.path.abspath(options.draw)
        self.work = os.path.abspath(options.work)
        self.ends = extremes.read_ends(self.draw) if options.extremes else None
        self.film = {}  # seconds of film, by the scene's folder
        self.counts = {"refused": 0, "checked": 0, "stopped": 0, "clean": 0, "faulty": 0, "found": 0}

    def seconds(self, folder):
        """The limit of a command on the scene in a folder."""
        if not self.ends:
            return SECONDS
        return SECONDS_EXTREME + math.ceil(SECONDS_OF_FILM * self.film[folder])

    def call(self, folder, name, *arguments, codes):
        """Runs a command; its output is kept in folder/name.txt."""
        seconds = self.seconds(folder)
        limit = (seconds, seconds + 5)
        with open(os.path.join(folder, name + ".txt"), "w", encoding="utf-8", errors="replace") as said:
            try:
                code = subprocess.run([self.singe, *arguments], stdin=subprocess.DEVNULL, stdout=said, stderr=said,
                                      timeout=HANGS, env=environment(), check=False,
                                      preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, limit)).returncode
            except subprocess.TimeoutExpired as expired:
                raise Finding(f"{name} takes more than {HANGS} s") from expired
        if code in (-signal.SIGXCPU, -signal.SIGKILL):
            raise Finding(f"{name} takes more than {seconds} s of processors' time, or too much memory")
        if code not in codes:
            raise Finding(f"{name} ends with code {code}")
        with open(os.path.join(folder, name + ".txt"), encoding="utf-8", errors="replace") as said:
            text = said.read()
        if code != GOOD and not text.strip():
            raise Finding(f"{name} ends with code {code} and says nothing")
        return code, text

    def same(self, one, other, what):
        """The caches in two folders are the same bytes."""
        for part in ("ply", "gas"):
            names = [sorted(os.listdir(path)) if os.path.isdir(path) else []
                     for path in (os.path.join(one, part), os.path.join(other, part))]
            if names[0] != names[1]:
                raise Finding(f"{what}: other files in {part}")
            for name in names[0]:
                if not filecmp.cmp(os.path.join(one, part, name), os.path.join(other, part, name), shallow=False):
                    raise Finding(f"{what}: {part}/{name} differs")

    @staticmethod
    def reason(folder):
        """The first error or fault that any of the commands has told."""
        for name in ("check", "run-1", "verify"):
            path = os.path.join(folder, name + ".txt")
            if os.path.exists(path):
                with open(path, encoding="utf-8", errors="replace") as said:
                    for line in said:
                        if re.search("error:|fault", line):
                            return line.strip().replace(folder + os.sep, "")
        return "no reason told"

    @staticmethod
    def finite(folder):
        """All numbers of the run's tables are numbers."""
        for name in ("stats.csv", "probes.csv", "run.json"):
            path = os.path.join(folder, name)
            if os.path.exists(path):
                with open(path, encoding="utf-8") as file:
                    for number, line in enumerate(file, 1):
                        if re.search(r"(?<![a-z\"])-?(nan|inf)\b", line):
                            raise Finding(f"{name}, line {number} holds what is no number")

    def make(self, folder, seed):
        """Writes the scene of a seed. Returns whether it is to be run."""
        with open(os.path.join(folder, "scene.json"), "wb") as file:
            if not self.ends:
                subprocess.run([self.draw, str(seed)], stdout=file, env=environment(), check=True)
                return True
            scene, runs = extremes.draw_scene(self.ends, seed)
            self.film[folder] = (scene["frames"] - 1) / scene.get("fps", 24)
            file.write(json.dumps(scene).encode())
            return runs

    def look(self, folder, runs):
        """One scene. Returns what became of it."""
        scene = os.path.join(folder, "scene.json")
        code, text = self.call(folder, "check", "check", scene, codes=(GOOD, FAILED, INPUT))
        if code != GOOD and not PLACE.search(text):
            raise Finding("check refuses the scene and names neither a place in it nor a stage")
        if code != GOOD:
            return "refused"  # also where a step of it fails
        if not runs:
            return "checked"
        outs = [os.path.join(folder, name) for name in ("one", "two", "parts")]
        runs = [self.call(folder, f"run-{n}", "run", scene, "-o", out, "--threads", str(n), "--no-preview",
                          codes=(GOOD, FAILED)) for n, out in ((1, outs[0]), (2, outs[1]))]
        if runs[0][0] != runs[1][0]:
            raise Finding("one thread and two end with different codes")
        self.same(outs[0], outs[1], "one thread and two")
        self.finite(outs[0])
        if runs[0][0] == FAILED:
            return "stopped"  # a step failed and reported why
        code, _ = self.call(folder, "verify", "verify", outs[0], codes=(GOOD, FAILED))
        if self.ends:
            formats = [word for name in ("usd", "vtp", "glb", "textures", "usdz", "vat") for word in ("--to", name)]
            self.call(folder, "convert", "convert", outs[0], *formats, codes=(GOOD,))
            self.call(folder, "measure", "measure", outs[0], "--no-preview", codes=(GOOD,))
            self.call(folder, "render", "render", outs[0], "--frames", "3", codes=(GOOD,))
        self.call(folder, "first", "run", scene, "-o", outs[2], "--no-preview", "--frames", "1", codes=(GOOD,))
        self.call(folder, "rest", "run", scene, "-o", outs[2], "--no-preview", "--resume", codes=(GOOD,))
        self.same(outs[0], outs[2], "whole and resumed")
        return "clean" if code == GOOD else "faulty"

    def scene(self, seed):
        folder = os.path.join(self.work, "scenes", str(seed))
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        try:
            became = self.look(folder, self.make(folder, seed))
        except Finding as finding:
            kept = os.path.join(self.work, "findings", str(seed))
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept)
            Path(kept, "finding.txt").write_text(f"{finding}\n", encoding="utf-8")
            print(f"seed {seed}: {finding}; see {kept}", flush=True)
            became = "found"
        if became == "faulty" or self.ends and became in ("stopped", "refused"):
            print(f"seed {seed}: {became}: {self.reason(folder)}", flush=True)
        shutil.rmtree(folder, ignore_errors=True)
        return became

    def run(self, options):
        """Scenes side by side, until there were enough or the time is up."""
        end = time.monotonic() + 60 * options.minutes
        last = options.seed + options.scenes * options.stride if options.scenes else None
        seed, running = options.seed, set()
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            while running or seed != last and (last or time.monotonic() < end):
                while len(running) < options.jobs and seed != last and (last or time.monotonic() < end):
                    running.add(pool.submit(self.scene, seed))
                    seed += options.stride
                done, running = concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED)
                for future in done:
                    self.counts[future.result()] += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("singe")
    parser.add_argument("draw")
    parser.add_argument("--extremes", action="store_true")
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--scenes", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--stride", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--work", default="soak")
    options = parser.parse_args()
    soak = Soak(options)
    soak.run(options)
    counts = soak.counts
    print(f"{sum(counts.values())} scenes: {counts['clean']} clean, {counts['stopped']} stopped by a step that failed, "
          f"{counts['faulty']} with faults by verify, {counts['refused']} refused and "
          f"{counts['checked']} only estimated by check, {counts['found']} FINDINGS")
    if counts["clean"] == 0:
        sys.exit("no scene was clean: they are drawn badly, or nothing works")
    sys.exit(1 if counts["found"] else 0)


if __name__ == "__main__":
    main()
