"""The command `singe` of the package: run, check, measure, render."""

from __future__ import annotations

import csv
import json
import os
import pathlib
import re
import signal
import stat
import subprocess
import sys
import tempfile
import threading
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Tuple, Union

import numpy as np

from . import errors
from ._library import logger
from .cache import Cache, column, read_cache

Path = Union[str, "os.PathLike[str]"]
PROGRAM = "singe.exe" if os.name == "nt" else "singe"


def command_path() -> pathlib.Path:
    """The path of the program: SINGE_PROGRAM of the environment, or the one in the package.

    Restores an executable bit that installers dropped. CommandMissingError if there is no program.
    """
    named = os.environ.get("SINGE_PROGRAM")
    path = pathlib.Path(named) if named else pathlib.Path(__file__).with_name("bin") / PROGRAM
    if not path.is_file():
        raise errors.CommandMissingError(
            f"SINGE_PROGRAM names {path}, which does not exist" if named else
            "this package has no command singe: set SINGE_PROGRAM to the path of one")
    if not os.access(path, os.X_OK):
        path.chmod(path.stat().st_mode | stat.S_IXUSR | stat.S_IXGRP | stat.S_IXOTH)
    return path


def main() -> None:
    """The console script: replaces itself by the command. A stage of OpenUSD becomes a scene first."""
    arguments = sys.argv[1:]
    if arguments[:1] in (["run"], ["check"]) and any(word.split("=")[0] == "--sheets" for word in arguments):
        from . import usd
        arguments = usd.told(usd.command, arguments)
    try:
        path = str(command_path())
    except errors.CommandMissingError as error:
        sys.exit(f"singe: error: {error}")
    if os.name == "nt":  # which cannot replace a process
        sys.exit(subprocess.call([path, *arguments]))
    os.execv(path, [path, *arguments])


class _Process:
    """A running command. Its standard error is read as it arrives: warnings go to the logger."""

    def __init__(self, arguments: Iterable[str]):
        # a session of its own, so that Ctrl-C comes to us and we say it once
        self.child = subprocess.Popen([str(command_path()), *arguments], stdin=subprocess.DEVNULL,
                                      stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
        self.said: List[str] = []
        self.printed = b""
        self._readers = [threading.Thread(target=reader, daemon=True) for reader in (self._listen, self._collect)]
        for reader in self._readers:
            reader.start()

    def _listen(self) -> None:
        assert self.child.stderr
        for line in self.child.stderr:
            text = line.decode("utf-8", "replace").rstrip("\n")
            if re.match(r"frame \d+/\d+ ", text):
                continue
            self.said.append(text)
            if text.startswith("singe: warning: "):
                logger.warning("%s", text[len("singe: warning: "):])
            elif text.startswith("singe: ") and not text.startswith("singe: error: "):
                logger.info("%s", text[len("singe: "):])

    def _collect(self) -> None:
        assert self.child.stdout
        self.printed = self.child.stdout.read()

    def _stop(self) -> None:
        """Interrupts like Ctrl-C: the command finishes its step and writes a checkpoint. A second one kills it."""
        if self.child.poll() is None:
            try:
                self.child.send_signal(signal.SIGINT)
            except ValueError:  # Windows cannot interrupt another process: its last checkpoint is what remains
                self.child.terminate()
        try:
            self.child.wait()
        except BaseException:
            self.child.kill()
            raise

    def _close(self) -> None:
        for reader, pipe in zip(self._readers, (self.child.stderr, self.child.stdout)):
            reader.join(10)  # a grandchild may hold the pipe
            if pipe and not reader.is_alive():
                pipe.close()

    def finish(self, every: Callable[[], None]) -> str:
        """Waits, and calls `every` ten times a second; returns the output. Raises the command's errors."""
        try:
            while True:
                try:
                    self.child.wait(0.1)
                    break
                except subprocess.TimeoutExpired:
                    every()
        except BaseException:
            self._stop()
            raise
        finally:
            self._close()
        if self.child.returncode:
            text = "\n".join(line[len("singe: error: "):] if line.startswith("singe: error: ") else line
                             for line in self.said) or f"singe ended with exit code {self.child.returncode}"
            kind = errors.SceneError if self.child.returncode == 2 else errors.CommandError
            raise kind(text, self.child.returncode)
        return self.printed.decode("utf-8", "replace")


def _options(frames: Any, threads: Optional[int], settings: Optional[Mapping[str, Any]]) -> List[str]:
    made = []
    if frames is not None:
        made += ["--frames", f"{frames[0]}-{frames[1]}" if isinstance(frames, tuple) else str(int(frames))]
    if threads is not None:
        made += ["--threads", str(int(threads))]
    for name, value in (settings or {}).items():
        made += ["--set", f"{name}={value if isinstance(value, str) else json.dumps(_plain(value))}"]
    return made


def _plain(value: Any) -> Any:
    """Converts numpy's numbers and arrays to Python's."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return value


def _positional(path: Path) -> str:
    """A path that cannot be mistaken for an option."""
    text = os.fspath(path)
    return os.path.join(".", text) if text.startswith("-") else text


class _Progress:
    """Calls back with (frames done, frames in total) as the run's files grow."""

    def __init__(self, folder: pathlib.Path, call: Callable[[int, int], None]):
        self._folder, self._call, self._told, self._frames = folder, call, -1, 0
        self._before = self._mark()

    def _mark(self) -> Optional[Tuple[int, int]]:
        try:
            status = (self._folder / "run.json").stat()
            return status.st_ino, status.st_mtime_ns
        except OSError:
            return None

    def __call__(self) -> None:
        try:
            if not self._frames:  # run.json of an earlier run stays until the first frame is whole
                if self._mark() in (None, self._before):
                    return
                self._frames = json.loads((self._folder / "run.json").read_text(encoding="utf-8"))["frames"]
            with open(self._folder / "stats.csv", "rb") as file:
                done = file.read().count(b"\n") - 1
        except (OSError, ValueError, KeyError):
            return  # between two writes; the next call sees it
        if done > self._told and done > 0:
            self._told = done
            self._call(min(done, self._frames), self._frames)


def run(scene: Path, out: Optional[Path] = None, *, frames: Optional[int] = None, threads: Optional[int] = None,
        settings: Optional[Mapping[str, Any]] = None, resume: bool = False, preview: bool = True, exr: bool = False,
        progress: Optional[Callable[[int, int], None]] = None,
        start: Optional[Tuple[Path, int]] = None) -> Cache:
    """Burns a scene into the folder `out` (out/ and the name of the scene's file) and returns its cache.

    settings: values of the scene to override, such as {"pace": 8, "sheets.0.grid.cells": [40, 60]}. progress: called
    with (frames done, frames). Ctrl-C, or an exception in `progress`, lets the command write a checkpoint, from which
    resume=True continues a run. start: the folder of an earlier run and its frame to continue from, as in `branch`.
    SceneError has file, line and column of each error.
    """
    folder = pathlib.Path(out) if out is not None else pathlib.Path("out") / pathlib.Path(scene).stem
    arguments = ["run", _positional(scene), "-o", _positional(folder), *_options(frames, threads, settings)]
    for wanted, flag in ((resume, "--resume"), (not preview, "--no-preview"), (exr, "--exr")):
        arguments += [flag] if wanted else []
    if start is not None:
        arguments += ["--from", f"{os.fspath(start[0])}:{int(start[1])}"]
    watch = _Progress(folder, progress or (lambda done, frames: None))
    _Process(arguments).finish(watch)
    watch()
    return read_cache(folder)


def branch(folder: Union[Path, Cache], frame: int, out: Path, scene: Optional[Path] = None, *,
           settings: Optional[Mapping[str, Any]] = None, **options: Any) -> Cache:
    """Goes on from a frame of an earlier run with other settings, in the folder `out`, and returns its cache.

    folder: the earlier run, or its cache. scene: a scene file; without one it is the scene of the earlier run with all
    that its settings gave it. settings and options are those of `run`. What cannot change is a SceneError
    (docs/directing.md). Frames up to `frame` are those of the earlier run.

        singe.branch("out/letter", 80, "out/windy", settings={"wind.velocity": [0, 2, 0]})
    """
    earlier = folder.folder if isinstance(folder, Cache) else folder
    return run(scene if scene is not None else earlier, out, settings=settings, start=(earlier, frame), **options)


def check(scene: Path, *, frames: Optional[int] = None, threads: Optional[int] = None,
          settings: Optional[Mapping[str, Any]] = None) -> str:
    """Describes the scene and its expected time, as text. Writes nothing. SceneError: it would not run."""
    return _Process(["check", _positional(scene), *_options(frames, threads, settings)]).finish(lambda: None)


def measure(folder: Path, frames: Optional[Tuple[int, int]] = None) -> Dict[str, np.ndarray]:
    """The shape of the sheets of a cache, frame by frame: arrays by name (docs/cli.md, measure). NaN: undefined."""
    with tempfile.TemporaryDirectory() as place:
        table = os.path.join(place, "measure.csv")
        _Process(["measure", _positional(folder), "--csv", table, *_options(frames, None, None)]).finish(lambda: None)
        with open(table, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    return {name: column(rows[1:], i) for i, name in enumerate(rows[0])}


def render(folder: Path, *, frames: Optional[Tuple[int, int]] = None, threads: Optional[int] = None,
           settings: Optional[Mapping[str, Any]] = None) -> None:
    """Draws the pictures of a cache again. Needs a command that was built with the preview."""
    _Process(["render", _positional(folder), *_options(frames, threads, settings)]).finish(lambda: None)
