#!/usr/bin/env python3
"""A sweep as a job of Open Job Description: openjd-cli of PyPI checks it, and runs it on this machine, where every mesh has
the bytes of a sweep without it.

    tests/farm/check_openjd.py PROGRAM FOLDER

openjd-cli is installed into FOLDER.
"""

import pathlib
import subprocess
import sys
import tempfile

from check_slurm import PLAN, SCENE

LOCK = pathlib.Path(__file__).resolve().parents[1] / "locks/openjd.txt"


def meshes(folder):
    return {file.relative_to(folder): file.read_bytes() for file in folder.glob("rows/*/ply/*")}


def main():
    program, tools = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    if not (tools / "bin/openjd").exists():
        subprocess.run([sys.executable, "-m", "venv", tools], check=True)
        subprocess.run([tools / "bin/pip", "install", "--quiet", "--disable-pip-version-check", "--require-hashes", "-r",
                        LOCK], check=True)
    with tempfile.TemporaryDirectory() as temporary:
        at = pathlib.Path(temporary)
        (at / "scene.yaml").write_text(SCENE.replace("frames: 40", "frames: 8"))
        (at / "plan.yaml").write_text(PLAN)
        sweep = [program, "sweep", "plan.yaml", "--no-preview", "-o"]
        job = subprocess.run([*sweep, "jobs", "--openjd"], cwd=at, check=True, capture_output=True, text=True).stdout
        (at / "job.json").write_text(job)
        (at / "broken.json").write_text(job.replace('"INT"', '"INTEGER"'))
        openjd = tools / "bin/openjd"
        subprocess.run([openjd, "check", "job.json"], cwd=at, check=True)
        refused = subprocess.run([openjd, "check", "broken.json"], cwd=at, capture_output=True).returncode != 0
        subprocess.run([openjd, "run", "job.json", "--step", "Report", "--run-dependencies"], cwd=at, check=True,
                       capture_output=True)
        subprocess.run([*sweep, "plain"], cwd=at, check=True, capture_output=True)
        by_job, plain = meshes(at / "jobs"), meshes(at / "plain")
        report = (at / "jobs/report.csv").exists()
        print(f"{len(by_job)} meshes of {len(plain)}, {'the same' if by_job == plain else 'OTHER'} bytes; the report is "
              f"{'there' if report else 'MISSING'}; a broken job is {'refused' if refused else 'TAKEN'}")
        return 0 if plain and by_job == plain and report and refused else 1


if __name__ == "__main__":
    sys.exit(main())
