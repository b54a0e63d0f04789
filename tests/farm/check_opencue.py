#!/usr/bin/env python3
"""A sweep as a job of OpenCue, by the script of docs/sweep.md: PyOutline writes the job that it would send to a server, and
each frame runs as a host of the farm would run it. Every mesh has the bytes of a sweep without OpenCue. No server was tried.

    tests/farm/check_opencue.py PROGRAM FOLDER

PyOutline is installed into FOLDER.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

from check_openjd import begin, end
from check_slurm import PLAN, SCENE

ROOT = pathlib.Path(__file__).resolve().parents[2]
# writes a session, which hosts take, and prints the job that the server would get: layers and their dependencies
LAUNCH = """\
import outline.cuerun
from outline.backend import cue
from outline.loader import load_outline
job = load_outline("sweep.outline")
launcher = outline.cuerun.OutlineLauncher(job)
job.setup()
print(cue.serialize(launcher))
"""


def main():
    program, tools = begin("pycuerun", "opencue.txt")
    script = re.search(r"```python\n(# sweep\.outline\n.*?)```", (ROOT / "docs/sweep.md").read_text(), re.S).group(1)
    with tempfile.TemporaryDirectory() as temporary:
        at = pathlib.Path(temporary) / "the farm's #1"
        at.mkdir()
        (at / "scene.yaml").write_text(SCENE.replace("frames: 40", "frames: 4"))
        (at / "plan.yaml").write_text(PLAN)
        (at / "sweep.outline").write_text(script.replace("/shared", str(at)))
        path = os.pathsep.join([str(tools / "bin"), str(program.parent), os.environ["PATH"]])
        host = {**os.environ, "PATH": path, "HOME": str(at), "OUTLINE_OUTLINE_SESSION_DIR": str(at / "sessions"),
                "SHOW": "testing", "SHOT": "one", "USER": "tester"}

        def ask(*command, **options):
            return subprocess.run(list(map(str, command)), cwd=at, env=host, check=True, capture_output=True, text=True,
                                  **options).stdout

        (at / "commands.txt").write_text(ask(program, "sweep", "plan.yaml", "--no-preview", "-o", "cue", "--print"))
        job = ask(tools / "bin/python", "-", input=LAUNCH)
        waits = re.search(r'type="LAYER_ON_LAYER".*<deplayer>report</deplayer>.*<onlayer>rows</onlayer>', job) is not None
        first, last = map(int, re.search(r'name="rows".*?<range>(\d+)-(\d+)</range>', job).groups())
        [session] = at.glob("sessions/*/*/outline.yaml")
        for frame in [f"{row}-rows" for row in range(first, last + 1)] + ["1-report"]:
            ask("pycuerun", session, "-e", frame)
        ask(program, "sweep", "plan.yaml", "--no-preview", "-o", "plain")
        return end(at / "cue", at / "plain", waits, f"it {'waits' if waits else 'DOES NOT WAIT'} for the rows")


if __name__ == "__main__":
    sys.exit(main())
