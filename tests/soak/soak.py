#!/usr/bin/env python3
"""Runs random scenes through a command, which may be built with sanitizers.

soak.py SINGE DRAW_SCENE [--minutes M | --scenes N] [--seed S] [--jobs J] [--work FOLDER]

DRAW_SCENE makes a scene from its seed. The scene is checked, run with one thread and with two, verified, and run again in
two parts by --resume; all caches must have the same bytes. A scene that `check` accepts must run, or fail later with a
reason. Nothing may crash, hang or grow without bound.
Scenes that fail are kept with their messages in FOLDER/findings/SEED, and the exit code is 1.
"""

import argparse
import concurrent.futures
import filecmp
import os
import resource
import shutil
import signal
import subprocess
import sys
import time

MEMORY_MB = 3000  # of a command under the address sanitizer, which keeps count
SECONDS = 120     # of a command, on all processors
HANGS = 1800      # s by the clock, which a crowded machine stretches
GOOD, FAILED, INPUT = 0, 1, 2
SANITIZER = 99


class Finding(Exception):
    """A fault that a scene has shown."""


def limit_time():
    """A command that takes too long is ended by the system."""
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 5))


def environment():
    common = f"exitcode={SANITIZER}:abort_on_error=0"
    return dict(os.environ, ASAN_OPTIONS=f"{common}:hard_rss_limit_mb={MEMORY_MB}:allocator_may_return_null=1",
                UBSAN_OPTIONS=f"{common}:halt_on_error=1:print_stacktrace=1", LC_ALL="C")


class Soak:
    def __init__(self, options):
        self.singe, self.draw = os.path.abspath(options.singe), os.path.abspath(options.draw)
        self.work = os.path.abspath(options.work)
        self.counts = {"refused": 0, "stopped": 0, "clean": 0, "faulty": 0, "found": 0}

    def call(self, folder, name, *arguments, codes):
        """Runs a command; its output is kept in folder/name.txt."""
        with open(os.path.join(folder, name + ".txt"), "w", encoding="utf-8", errors="replace") as said:
            try:
                code = subprocess.run([self.singe, *arguments], stdin=subprocess.DEVNULL, stdout=said, stderr=said,
                                      timeout=HANGS, env=environment(), check=False,
                                      preexec_fn=limit_time).returncode
            except subprocess.TimeoutExpired as expired:
                raise Finding(f"{name} takes more than {HANGS} s") from expired
        if code in (-signal.SIGXCPU, -signal.SIGKILL):
            raise Finding(f"{name} takes more than {SECONDS} s of processors' time, or too much memory")
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

    def look(self, folder):
        """One scene. Returns what became of it."""
        scene = os.path.join(folder, "scene.json")
        code, _ = self.call(folder, "check", "check", scene, codes=(GOOD, FAILED, INPUT))
        if code != GOOD:
            return "refused"  # also where a step of it fails
        outs = [os.path.join(folder, name) for name in ("one", "two", "parts")]
        runs = [self.call(folder, f"run-{n}", "run", scene, "-o", out, "--threads", str(n), "--no-preview",
                          codes=(GOOD, FAILED)) for n, out in ((1, outs[0]), (2, outs[1]))]
        if runs[0][0] != runs[1][0]:
            raise Finding("one thread and two end with different codes")
        self.same(outs[0], outs[1], "one thread and two")
        if runs[0][0] == FAILED:
            return "stopped"  # a step failed and reported why
        code, _ = self.call(folder, "verify", "verify", outs[0], codes=(GOOD, FAILED))
        self.call(folder, "first", "run", scene, "-o", outs[2], "--no-preview", "--frames", "1", codes=(GOOD,))
        self.call(folder, "rest", "run", scene, "-o", outs[2], "--no-preview", "--resume", codes=(GOOD,))
        self.same(outs[0], outs[2], "whole and resumed")
        return "clean" if code == GOOD else "faulty"

    def scene(self, seed):
        folder = os.path.join(self.work, "scenes", str(seed))
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        with open(os.path.join(folder, "scene.json"), "wb") as file:
            subprocess.run([self.draw, str(seed)], stdout=file, env=environment(), check=True)
        try:
            became = self.look(folder)
        except Finding as finding:
            kept = os.path.join(self.work, "findings", str(seed))
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept)
            with open(os.path.join(kept, "finding.txt"), "w", encoding="utf-8") as file:
                file.write(f"{finding}\n")
            print(f"seed {seed}: {finding}; see {kept}", flush=True)
            became = "found"
        if became == "faulty":
            print(f"seed {seed}: verify finds faults", flush=True)
        shutil.rmtree(folder, ignore_errors=True)
        return became

    def run(self, options):
        """Scenes side by side, until there were enough or the time is up."""
        end = time.monotonic() + 60 * options.minutes
        last = options.seed + options.scenes if options.scenes else None
        seed, running = options.seed, set()
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            while running or seed != last and (last or time.monotonic() < end):
                while len(running) < options.jobs and seed != last and (last or time.monotonic() < end):
                    running.add(pool.submit(self.scene, seed))
                    seed += 1
                done, running = concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED)
                for future in done:
                    self.counts[future.result()] += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("singe")
    parser.add_argument("draw")
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--scenes", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--work", default="soak")
    options = parser.parse_args()
    soak = Soak(options)
    soak.run(options)
    counts = soak.counts
    print(f"{sum(counts.values())} scenes: {counts['clean']} clean, {counts['stopped']} stopped by a step that failed, "
          f"{counts['faulty']} with faults by verify, {counts['refused']} refused by check, {counts['found']} FINDINGS")
    if counts["clean"] == 0:
        sys.exit("no scene was clean: they are drawn badly, or nothing works")
    sys.exit(1 if counts["found"] else 0)


if __name__ == "__main__":
    main()
