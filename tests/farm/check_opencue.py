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

from check_openjd import meshes
from check_slurm import PLAN, SCENE

ROOT = pathlib.Path(__file__).resolve().parents[2]
# a host takes the session that the launch has written; the server gives it the layers and what they wait for
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
    program, tools = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if not (tools / "bin/pycuerun").exists():
        subprocess.run([sys.executable, "-m", "venv", tools], check=True)
        subprocess.run([tools / "bin/pip", "install", "--quiet", "--disable-pip-version-check", "--require-hashes", "-r",
                        ROOT / "tests/locks/opencue.txt"], check=True)
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
        by_job, plain = meshes(at / "cue"), meshes(at / "plain")
        report = (at / "cue/report.csv").exists()
        print(f"{len(by_job)} meshes of {len(plain)}, {'the same' if by_job == plain else 'OTHER'} bytes; the report is "
              f"{'there' if report else 'MISSING'}, and {'waits' if waits else 'DOES NOT WAIT'} for the rows")
        return 0 if plain and by_job == plain and report and waits else 1


if __name__ == "__main__":
    sys.exit(main())
