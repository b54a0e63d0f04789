# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program as a separate process: starts it, follows its output files, and stops it so that it can resume."""

import json
import os
import re
import shutil
import signal
import stat
import subprocess
import sys

RUNNING = {}  # jobs of this Blender, by folder


class ProgramError(Exception):
    """There is no program to run."""


def find_program(override=""):
    """The program `override` if given, else that of the extension's wheel, else that in PATH."""
    if override:
        if not os.path.isfile(override):
            raise ProgramError(f"there is no program {override}")
        return override
    try:
        import singe
        path = os.path.join(os.path.dirname(singe.__file__), "bin", "singe")
    except ImportError:
        path = ""
    if os.path.isfile(path):
        if not os.access(path, os.X_OK):  # Blender's installer drops this permission
            os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
        return path
    found = shutil.which("singe")
    if not found:
        raise ProgramError("this build of the extension has no program for this system; choose one under Program")
    return found


class Job:
    """One run of the program into `folder`/cache."""

    def __init__(self, program, folder, frames, resume=False):
        self.folder, self.frames = folder, frames
        self.cache = os.path.join(folder, "cache")
        self.log = os.path.join(folder, "log.txt")
        command = [program, "run", os.path.join(folder, "burn.yaml"), "-o", self.cache, "--no-preview"]
        self.started = self._mark()
        self.resumed = self.counting = resume
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen(command + (["--resume"] if resume else []), stdin=subprocess.DEVNULL,
                                            stdout=log, stderr=log, cwd=folder,
                                            start_new_session=sys.platform != "win32")
        RUNNING[folder] = self

    def _mark(self):
        try:
            status = os.stat(os.path.join(self.cache, "run.json"))
            return status.st_ino, status.st_mtime_ns
        except OSError:
            return None

    def frames_done(self):
        """Complete frames of this run; frames of an earlier run in the same folder do not count."""
        if not self.counting:  # a new run writes run.json before stats.csv
            mark, stats = self._mark(), os.path.join(self.cache, "stats.csv")
            self.counting = (mark not in (None, self.started) and os.path.exists(stats)
                             and os.stat(stats).st_mtime_ns >= mark[1])
        return frames_in(self.cache) if self.counting else 0

    def running(self):
        return self.process.poll() is None

    def stop(self):
        """Asks the program to end after its current step, with a checkpoint."""
        if self.running():
            self.process.send_signal(signal.SIGINT if sys.platform != "win32" else signal.SIGTERM)

    def finish(self):
        """Waits for the program and returns its exit code and its errors."""
        code = self.process.wait()
        RUNNING.pop(self.folder, None)
        # at its end a run writes run.json after stats.csv, so one that ends between two polls is noticed only here
        self.counting = self.counting or self._mark() not in (None, self.started)
        with open(self.log, encoding="utf-8", errors="replace") as file:
            lines = file.read().splitlines()
        # only the lines of errors; the lines of the scene quoted below them are dropped
        said = [line for line in lines if "error:" in line]
        return code, "\n".join(re.sub(r"^singe: error: ", "", line) for line in said[:6])


def frames_in(cache):
    """The number of complete frames of a cache."""
    try:
        with open(os.path.join(cache, "stats.csv"), "rb") as file:
            return max(file.read().count(b"\n") - 1, 0)
    except OSError:
        return 0


def can_resume(cache, frames):
    return os.path.exists(os.path.join(cache, "checkpoint.singe")) and 0 < frames_in(cache) < frames


def root_frames(root):
    """The number of frames that a USD root refers to. A run rewrites the root from time to time."""
    try:
        with open(root, encoding="utf-8") as file:
            found = re.search(r"endTimeCode = (\d+)", file.read(4096))
    except OSError:
        found = None
    return int(found.group(1)) if found else 0


def root_of(cache):
    """The cache's USD root, the gas of its first frame (or None) and its frame rate; None if there is no root."""
    try:
        with open(os.path.join(cache, "run.json"), encoding="utf-8") as file:
            record = json.load(file)
    except (OSError, ValueError):
        return None
    name = record["scene"]["name"]
    root = os.path.join(cache, f"{name}.usda")
    if not os.path.exists(root):
        return None
    for part in ("gas_detail", "gas"):
        gas = os.path.join(cache, part, f"{name}.0001.vdb")
        if os.path.exists(gas):
            return root, gas, float(record["scene"]["fps"])
    return root, None, float(record["scene"]["fps"])
