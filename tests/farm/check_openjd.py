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

LOCKS = pathlib.Path(__file__).resolve().parents[1] / "locks"


def begin(tool, lock):
    """The program and the folder of the arguments. Installs what the lock lists there if the tool is missing."""
    program, tools = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if not (tools / "bin" / tool).exists():
        subprocess.run([sys.executable, "-m", "venv", tools], check=True)
        subprocess.run([tools / "bin/pip", "install", "--quiet", "--disable-pip-version-check", "--require-hashes", "-r",
                        LOCKS / lock], check=True)
    return program, tools


def end(farm, plain, good, said):
    """Exit status: 0 if the farm made the same meshes as a plain sweep, and a report, and `good` holds."""
    by_job, by_sweep = ({file.relative_to(folder): file.read_bytes() for file in folder.glob("rows/*/ply/*")}
                        for folder in (farm, plain))
    report = (farm / "report.csv").exists()
    print(f"{len(by_job)} meshes of {len(by_sweep)}, {'the same' if by_job == by_sweep else 'OTHER'} bytes; the report is "
          f"{'there' if report else 'MISSING'}; {said}")
    return 0 if by_sweep and by_job == by_sweep and report and good else 1


def main():
    program, tools = begin("openjd", "openjd.txt")
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
        return end(at / "jobs", at / "plain", refused, f"a broken job is {'refused' if refused else 'TAKEN'}")


if __name__ == "__main__":
    sys.exit(main())
