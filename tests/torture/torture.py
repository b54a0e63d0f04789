#!/usr/bin/env python3
"""Makes the n-th allocation, write, open, ... of a whole command fail, for every n or a sample of them, once or from
then on, and looks at what is left: the exit code, the message, the files, and whether the run can be made up.

SINGE: the program; SINGE_TORTURE_SHIM: the library to preload (shim.c).
"""

import argparse
import concurrent.futures
import errno
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

from scenarios import CHECKPOINTS, comparable, contents, printed, scenarios, write_ffmpeg, write_scene

SINGE, SHIM = os.path.abspath(os.environ["SINGE"]), os.path.abspath(os.environ["SINGE_TORTURE_SHIM"])

# as the shim has them
KINDS = ("memory", "open", "read", "write", "sync", "close", "rename", "remove", "folder", "list", "cut", "stat",
         "process", "thread", "lock", "map")
ERRORS = {"memory": ["ENOMEM"], "open": ["EMFILE"], "read": ["EIO"], "write": ["ENOSPC"], "sync": ["EIO"],
          "close": ["EIO"], "rename": ["EIO"], "remove": ["EIO"], "folder": ["ENOSPC"], "list": ["EIO"],
          "cut": ["EIO"], "stat": ["EIO"], "process": ["EAGAIN"], "thread": ["EAGAIN"], "lock": ["ENOLCK"],
          "map": ["ENOMEM"]}
# these are no failures: the command must do all of its work
HARMLESS = {"read": ["short", "EINTR"], "write": ["short", "EINTR"]}
TIMEOUT = 120  # s


class Trial:
    """One failure of one command."""

    def __init__(self, scenario, kind, error, after, at):
        self.scenario, self.kind, self.error, self.after, self.at = scenario, kind, error, after, at

    @property
    def harmless(self):
        # Singe does without threads that it cannot have
        return self.error in HARMLESS.get(self.kind, []) or self.scenario.kinds == ("thread",)

    def environment(self, state):
        number = self.error if self.error == "short" else str(getattr(errno, self.error))
        variables = {"SINGE_TORTURE_STATE": state, "SINGE_TORTURE_KIND": self.kind, "SINGE_TORTURE_AT": str(self.at),
                     "SINGE_TORTURE_ERROR": number, "LD_PRELOAD": SHIM}
        if self.after:
            variables["SINGE_TORTURE_ALL"] = "1"
        return variables

    def __str__(self):
        return f"{self.scenario.name}: {self.kind} {self.at}{' and all after' if self.after else ''}: {self.error}"


class Expected:
    """The input of a scenario and its result if nothing fails."""

    def __init__(self, bench, scenario):
        with bench.place() as place:
            for command in scenario.before:
                place.singe(command)
            self.before = contents(place.folder)
            self.template = bench.keep(place.folder)
            done, state = place.tortured(scenario.command, {})
            if done.returncode != 0 or place.temporaries():
                raise SystemExit(f"{scenario.name}: fails already without a failure:\n{done.stderr}")
            self.output = printed(done.stdout)
            self.calls = dict(zip(KINDS, state[1:]))
            self.after = contents(place.folder)
        self.comparable = {name: comparable(name, data) for name, data in self.after.items()}


class Place:
    """A folder with the scene for one command at a time."""

    def __init__(self, dir):
        self.dir, self.folder, self.state = dir, os.path.join(dir, "o"), os.path.join(dir, "state")
        write_scene(dir)
        write_ffmpeg(dir)

    def singe(self, command, check=True, **variables):
        environment = {**os.environ, "PATH": self.dir + os.pathsep + os.environ["PATH"], **variables}
        command = [part.replace("FOLDER", "o") for part in command]
        done = subprocess.run([SINGE, *command], cwd=self.dir, env=environment, capture_output=True, text=True,
                              errors="replace", timeout=TIMEOUT)
        if check and done.returncode != 0:
            raise SystemExit(f"{' '.join(command)} fails on its own:\n{done.stderr}")
        return done

    def tortured(self, command, variables):
        """The command under the shim, and its counters: failed, then calls by kind."""
        Path(self.state).write_bytes(bytes(8 * (1 + len(KINDS))))
        asan = os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0:exitcode=99"
        known = os.path.join(os.path.dirname(os.path.abspath(__file__)), "leaks.txt")
        lsan = os.environ.get("LSAN_OPTIONS", "") + ":print_suppressions=0:suppressions=" + known
        done = self.singe(command, check=False, **{"SINGE_TORTURE_STATE": self.state, "LD_PRELOAD": SHIM,
                                                   "ASAN_OPTIONS": asan, "LSAN_OPTIONS": lsan, **variables})
        return done, struct.unpack(f"{1 + len(KINDS)}Q", Path(self.state).read_bytes())

    def fill(self, template):
        shutil.rmtree(self.folder, ignore_errors=True)
        if os.path.isdir(template):
            shutil.copytree(template, self.folder)

    def temporaries(self):
        return [n for _, _, names in os.walk(self.folder) for n in names if n.endswith((".tmp", ".part"))]


class Bench:
    """Places for several trials at a time."""

    def __init__(self):
        # files are flushed often, so they lie in memory where possible
        self.dir = tempfile.mkdtemp(prefix="singe-torture-", dir="/dev/shm" if os.path.isdir("/dev/shm") else None)
        self.free, self.lock, self.count = [], threading.Lock(), 0
        self.made_up = {}  # each state that was resumed, and the result

    def place(self):
        bench = self

        class Lent:
            def __enter__(self):
                with bench.lock:
                    if not bench.free:
                        bench.count += 1
                        dir = os.path.join(bench.dir, str(bench.count))
                        os.mkdir(dir)
                        bench.free.append(Place(dir))
                    self.place = bench.free.pop()
                shutil.rmtree(self.place.folder, ignore_errors=True)
                return self.place

            def __exit__(self, *_):
                with bench.lock:
                    bench.free.append(self.place)

        return Lent()

    def keep(self, folder):
        with self.lock:
            self.count += 1
            kept = os.path.join(self.dir, f"kept{self.count}")
        if os.path.isdir(folder):
            shutil.copytree(folder, kept)
        return kept

    def close(self):
        shutil.rmtree(self.dir, ignore_errors=True)


# ---- what must hold

def same(name, data, expected):
    try:
        return name in expected.comparable and comparable(name, data) == expected.comparable[name]
    except (ValueError, UnicodeDecodeError):
        return False


def difference(name, data, expected):
    """A description of the differences."""
    if name == "run.json":
        try:
            found, wanted = comparable(name, data), expected.comparable[name]
            keys = [key for key in wanted if found.get(key) != wanted[key]]
            return f"{name} differs in " + ", ".join(f"{k}: {found.get(k)!s:.80} for {wanted[k]!s:.80}" for k in keys)
        except ValueError:
            pass
    return f"{name} differs"


def exit_faults(trial, done, expected):
    if done.returncode < 0:
        yield f"ended by {signal.Signals(-done.returncode).name}"
    elif done.returncode not in (0, 1, 2):
        yield f"exit code {done.returncode}"
    elif done.returncode == 0:
        if printed(done.stdout) != expected.output:
            yield "exit code 0, but it printed something else"
    elif trial.harmless:
        yield "a harmless event ends it"
    elif "error" not in done.stderr:
        yield f"exit code {done.returncode} without a message"
    elif done.returncode == 2 and trial.kind in ("memory", "map", "write", "sync", "rename"):
        yield "exit code 2, but the input is good"


def is_shorter_video(data, left):
    """Whether the video has the first frames only: a run that ends early makes one of the frames it has."""
    pictures = [left[name] for name in sorted(left) if name.startswith("frames/") and name.endswith(".png")]
    return any(data == b"".join(pictures[:count]) for count in range(1, len(pictures) + 1))


def file_faults(trial, done, left, expected):
    """Every file is whole: as it was, or as it should become."""
    for name, data in left.items():
        if name.endswith((".tmp", ".part")):
            if trial.kind != "remove":
                yield f"{name} is left"
        elif name.endswith(".lock") and (done.returncode != 0 or trial.kind == "remove"):
            continue  # says who was there; the lock itself is gone with its process
        elif data == expected.before.get(name) or same(name, data, expected):
            continue
        elif name == "stats.csv":
            try:
                rows = comparable(name, data)
                whole = (expected.comparable[name], comparable(name, expected.before.get(name, b"")))
                if not any(rows == rows_whole[:len(rows)] for rows_whole in whole):
                    yield f"{name} has other lines"
            except ValueError as problem:
                yield f"{name}: {problem}"
        elif name == "run.json":
            try:
                if comparable(name, data)["result"] == "complete" and done.returncode == 0:
                    yield f"{name} differs"
            except ValueError:
                yield f"{name} is no JSON"
        elif name == "preview.mp4" and is_shorter_video(data, left):
            continue
        elif name not in CHECKPOINTS:
            yield f"{name} is neither whole nor absent"
    if done.returncode == 2 and left != expected.before:
        yield "exit code 2, but files of the earlier run are touched"
    if done.returncode == 0:
        for name in sorted(set(expected.after) - set(left)):
            yield f"exit code 0, but {name} is missing"
        for name in sorted(set(left) - set(expected.after)):
            yield f"exit code 0, but {name} is there"
        for name in sorted(set(left) & set(expected.after)):
            if not same(name, left[name], expected):
                yield f"exit code 0, but {difference(name, left[name], expected)}"


def mixture_faults(left, expected):
    """Frames of two runs never lie side by side."""
    frames = {n: d for n, d in left.items() if os.path.dirname(n) and not n.endswith((".tmp", ".part"))}
    old = [n for n, d in frames.items() if not same(n, d, expected)]
    new = [n for n, d in frames.items() if d != expected.before.get(n)]
    if old and new:
        yield f"frames of two runs: {old[0]} and {new[0]}"


def made_up_faults(bench, place, trial, left, expected):
    """Resuming gives what an undisturbed run gives. Each kind of remains is resumed once."""
    def key(name, data):
        try:
            return name, str(comparable(name, data))
        except ValueError:
            return name, data

    what = trial.scenario.name, tuple(sorted(key(n, d) for n, d in left.items()))
    with bench.lock:
        if what in bench.made_up:
            return bench.made_up[what]
    done, faults = place.singe(trial.scenario.goes_on, check=False), []
    if done.returncode == 2 and {n: d for n, d in left.items() if not n.endswith((".tmp", ".lock"))} == expected.before:
        pass  # it is another run's as it was before
    elif done.returncode != 0:
        faults.append(f"--resume afterwards: exit code {done.returncode}: {done.stderr.strip()[-200:]}")
    else:
        after = contents(place.folder)
        faults += [f"--resume afterwards: {n} is missing" for n in sorted(set(expected.after) - set(after))]
        faults += [f"--resume afterwards: {difference(n, after[n], expected)}" for n in sorted(after)
                   if not same(n, after[n], expected)]
    with bench.lock:
        bench.made_up[what] = faults
    return faults


def attempt(bench, trial, expected):
    """The faults after one failure: (whether the call was reached, sentences, the command's errors)."""
    with bench.place() as place:
        place.fill(expected.template)
        try:
            done, state = place.tortured(trial.scenario.command, trial.environment(place.state))
        except subprocess.TimeoutExpired:
            return True, [f"hangs for {TIMEOUT} s"], ""
        if state[0] == 0:
            return False, [], ""
        left = contents(place.folder)
        if trial.kind == "remove":
            left = {name: data for name, data in left.items() if not name.endswith(".lock")}
        faults = list(exit_faults(trial, done, expected)) + list(file_faults(trial, done, left, expected))
        if trial.scenario.goes_on:
            if trial.kind != "remove":
                faults += mixture_faults(left, expected)
            faults += made_up_faults(bench, place, trial, left, expected)
        return True, faults, done.stderr


# ---- all of them, or a sample

def modes(kind):
    """(errno, whether all after fail too)."""
    for error in ERRORS[kind]:
        yield error, False
        yield error, True
    for error in HARMLESS.get(kind, []):
        yield error, False
        if error == "short":
            yield error, True


def numbers(calls, sample, rng):
    """Which calls fail: all, or the ends and some between."""
    if not sample or calls <= sample:
        return range(1, calls + 1)
    picked = {1, calls} if sample > 1 else set()
    while len(picked) < sample:
        picked.add(rng.randint(1, calls))
    return sorted(picked)


def make_trials(scenario, expected, options, rng):
    for kind in KINDS:
        if (scenario.kinds and kind not in scenario.kinds) or (options.kind and kind not in options.kind):
            continue
        if kind in options.without:
            continue
        few = options.sample and scenario.slow
        for error, after in list(modes(kind))[:1 if few else None]:
            for at in numbers(expected.calls[kind], max(1, options.sample // 8) if few else options.sample, rng):
                yield Trial(scenario, kind, error, after, at)


class Table:
    """Counts and faults, row by row as they come."""

    def __init__(self, quiet):
        self.rows, self.faults, self.begun, self.quiet = {}, [], time.monotonic(), quiet

    def add(self, trial, reached, faults, errors):
        row = self.rows.setdefault((trial.scenario.name, trial.kind), [0, 0, 0])
        row[0] += 1
        row[1] += reached
        row[2] += bool(faults)
        if faults:
            self.faults.append((trial, faults))
            print(f"FAULT {trial}", *(f"    {fault}" for fault in faults), sep="\n", flush=True)
            print("".join(f"    | {line}\n" for line in errors.strip().splitlines()[-6:]), end="", flush=True)

    def progress(self, done, count):
        if not self.quiet and (done % 200 == 0 or done == count):
            print(f"{done} of {count} trials, {len(self.faults)} with faults, {time.monotonic() - self.begun:.0f} s",
                  file=sys.stderr, flush=True)

    def show(self):
        print(f"\n{'command':20}{'what fails':>12}{'trials':>9}{'reached':>9}{'faults':>8}")
        for (name, kind), (trials, reached, faults) in self.rows.items():
            print(f"{name:20}{kind:>12}{trials:>9}{reached:>9}{faults:>8}")
        total = [sum(row[i] for row in self.rows.values()) for i in range(3)]
        print(f"{'all':32}{total[0]:>9}{total[1]:>9}{total[2]:>8}")


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--sample", type=int, help="so many calls of every kind and mode [all]")
    parser.add_argument("--scenario", action="append", help="only these [all]")
    parser.add_argument("--kind", action="append", choices=KINDS, help="only these [all]")
    parser.add_argument("--without", action="append", choices=KINDS, default=[], help="all kinds but these")
    parser.add_argument("--quick", action="store_true", help="no command that takes seconds")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seed", type=int, default=int(time.time()), help="of the sample [the time]")
    parser.add_argument("--quiet", action="store_true", help="no progress")
    return parser.parse_args()


def main():
    options = parse_options()
    rng, table, bench = random.Random(options.seed), Table(options.quiet), Bench()
    print(f"seed {options.seed}", flush=True)
    try:
        trials = []
        for scenario in scenarios():
            if (options.scenario and scenario.name not in options.scenario) or (options.quick and scenario.slow):
                continue
            expected = Expected(bench, scenario)
            trials += [(trial, expected) for trial in make_trials(scenario, expected, options, rng)]
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            futures = {pool.submit(attempt, bench, *trial): trial[0] for trial in trials}
            try:
                for done, future in enumerate(concurrent.futures.as_completed(futures), 1):
                    table.add(futures[future], *future.result())
                    table.progress(done, len(trials))
            except KeyboardInterrupt:
                print("interrupted", file=sys.stderr)
                pool.shutdown(cancel_futures=True)
                table.faults.append(None)
    finally:
        bench.close()
    table.show()
    return 1 if table.faults or not table.rows else 0


if __name__ == "__main__":
    sys.exit(main())
