# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program as a separate process: starts it, follows its output files, and stops it so that it can resume."""

import importlib.util
import json
import os
import re
import signal
import stat
import subprocess
import sys

from . import files

PROGRAM = "singe.exe" if sys.platform == "win32" else "singe"
RUNNING = {}  # jobs of this Blender, by folder


class ProgramError(Exception):
    """There is no program to run."""


def find_program(chosen=""):
    """The program `chosen` if given, else the one that SINGE_PROGRAM of the environment names, that of the extension's
    wheel, or the first in PATH. None of these is saved in a .blend file, which may come from a stranger."""
    chosen = chosen or os.environ.get("SINGE_PROGRAM", "")
    if chosen:
        if not os.path.isabs(chosen) or chosen.startswith("//"):  # Blender's //: beside the .blend file
            raise ProgramError(f"the program must have an absolute path, not {chosen}")
        if not os.path.isfile(chosen):
            raise ProgramError(f"there is no program {chosen}")
        return chosen
    package = importlib.util.find_spec("singe")
    if package and package.origin:
        path = os.path.join(os.path.dirname(package.origin), "bin", PROGRAM)
        if os.path.isfile(path):
            if not os.access(path, os.X_OK):  # Blender's installer drops this permission
                os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
            return path
    for folder in os.get_exec_path():
        path = os.path.join(folder, PROGRAM)
        # a relative folder of PATH could be that of the .blend file
        if os.path.isabs(folder) and os.path.isfile(path) and os.access(path, os.X_OK):
            return path
    raise ProgramError("this build of the extension has no program for this system: choose one in its preferences")


class Job:
    """One run of the program into `folder`/cache."""

    def __init__(self, program, folder, frames, resume=False, branch=0):
        """branch: the frame from 1 of folder/earlier from which the run goes on; 0: none."""
        self.folder, self.frames, self.branch = folder, frames, branch
        self.cache = os.path.join(folder, files.CACHE)
        self.log = os.path.join(folder, "log.txt")
        command = [program, "run", os.path.join(folder, files.SCENE), "-o", self.cache, "--no-preview"]
        if branch:
            command += ["--from", f"{os.path.join(folder, files.EARLIER)}:{branch}"]
        self.started = self._mark()
        self.resumed = self.counting = resume
        with files.create(self.log) as log:
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
        if self.branch:
            files.put_back(self.folder)
        # at its end a run writes run.json after stats.csv, so one that ends between two polls is noticed only here
        self.counting = self.counting or self._mark() not in (None, self.started)
        try:
            lines = files.read(self.log).decode(errors="replace").splitlines()
        except OSError:
            lines = []
        # only the lines of errors; the lines of the scene quoted below them are dropped
        said = [files.printable(line) for line in lines
                if "error:" in line or (code == 0 and "nothing ignited" in line)]
        return code, "\n".join(re.sub(r"^singe: (error|warning): ", "", line) for line in said[:6])


def frames_in(cache):
    """The number of complete frames of a cache."""
    try:
        return max(files.read(os.path.join(cache, "stats.csv")).count(b"\n") - 1, 0)
    except OSError:
        return 0


def can_branch(cache, frame, frames):
    """Whether a frame (from 1) of a cache is there to continue from, and not the last of the new run."""
    return os.path.exists(os.path.join(cache, "run.json")) and 0 < frame <= frames_in(cache) and frame < frames


def can_resume(cache, frames):
    return os.path.exists(os.path.join(cache, "checkpoint.singe")) and 0 < frames_in(cache) < frames


def root_frames(root):
    """The number of frames that a USD root refers to. A run rewrites the root from time to time."""
    try:
        found = re.search(rb"endTimeCode = (\d{1,9})\b", files.read(root, 4096))
    except OSError:
        found = None
    return int(found.group(1)) if found else 0


def root_of(cache):
    """The cache's USD root, the gas of its first frame (or None) and its frame rate; None if there is no root."""
    try:
        scene = json.loads(files.read(os.path.join(cache, "run.json")))["scene"]
        name, fps = scene["name"], float(scene["fps"])
    except (OSError, ValueError, KeyError, TypeError, OverflowError, RecursionError):
        return None
    if not 0 < fps < 1e6:  # also of what is no number
        return None
    if not isinstance(name, str) or os.path.basename(name) != name:  # a name with folders leads out of the cache
        return None
    root = os.path.join(cache, f"{name}.usda")
    if not os.path.isfile(root):
        return None
    for part in ("gas_detail", "gas"):
        gas = os.path.join(cache, part, f"{name}.0001.vdb")
        if os.path.isfile(gas):
            return root, gas, fps
    return root, None, fps
