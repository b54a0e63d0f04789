#!/usr/bin/env python3
"""A sweep on a Slurm of one node that this script starts and ends: its rows are preempted, requeued and resumed, and
every file of the simulation has the bytes of a sweep without Slurm.

    tests/farm/check_slurm.py PROGRAM [--install]

--install gets Debian's slurm-wlm and munge by apt-get. Prints what it measured; without Slurm or root, that it is skipped.
"""

import argparse
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCENE = """\
frames: 40
fps: 24
steps: 10
solver: {substeps: 3}
pace: 6
sheets:
  - grid: {size: [10 cm, 10 cm], cells: [32, 32]}
    translate: [0, 0, 1 mm]
sources:
  - {kind: spot, position: [-5 cm, 0, 0], temperature: 1200 K, conductance: 300, radius: 1 cm, falloff: 1 cm}
colliders:
  - kind: plane
preview: {size: [160, 120], samples: 1}
"""
NAME = "the farm's \"%a\" of $HOME; 100 %\t`ü` $(touch x) #1"  # sbatch puts a number in place of %a
PLAN = """\
scene: scene.yaml
method: latin-hypercube
samples: 4
parameters:
  pace: {from: 3, to: 9}
  sources.0.temperature: {from: 800 C, to: 1100 C}
"""
CONF = """\
ClusterName=singe
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={at}/munge/sock
CryptoType=crypto/munge
SlurmUser=root
SlurmdUser=root
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation={at}/ctld
SlurmdSpoolDir={at}/spool
SlurmctldPidFile={at}/ctld.pid
SlurmdPidFile={at}/slurmd.pid
SlurmctldLogFile={at}/ctld.log
SlurmdLogFile={at}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1,sched_min_interval=100000
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
JobRequeue=1
MpiDefault=none
KillWait=5
PreemptMode=REQUEUE
PreemptType=preempt/partition_prio
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory=2000 State=UNKNOWN
PartitionName=low Nodes={host} Default=YES MaxTime=INFINITE State=UP PriorityTier=1 PreemptMode=REQUEUE GraceTime=10
PartitionName=high Nodes={host} MaxTime=INFINITE State=UP PriorityTier=10 PreemptMode=off
"""


class Slurm:
    """Daemons of one node; all their state is in a folder."""

    def __init__(self, at):
        self.processes = []
        for name in "spool", "ctld", "munge":
            os.makedirs(os.path.join(at, name), mode=0o700)
        key = Path(at, "munge", "key")
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        host = os.uname().nodename.split(".")[0]
        os.environ["SLURM_CONF"] = os.path.join(at, "slurm.conf")
        Path(os.environ["SLURM_CONF"]).write_text(CONF.format(at=at, host=host, cpus=os.cpu_count()))
        munge = os.path.join(at, "munge")
        self.start("munged", "--force", "--foreground", f"--key-file={munge}/key", f"--socket={munge}/sock",
                   f"--pid-file={munge}/pid", f"--log-file={munge}/log", f"--seed-file={munge}/seed")
        self.wait(lambda: os.path.exists(f"{munge}/sock"), "munged")
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D")
        self.wait(lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"), "slurmd")

    def start(self, *command):
        self.processes.append(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))

    def ask(self, *command):
        return subprocess.run(command, capture_output=True, text=True).stdout

    def wait(self, condition, what, seconds=60.0):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise SystemExit(f"check_slurm: {what} does not come")
            time.sleep(0.2)

    def states(self):
        return self.ask("squeue", "-h", "-r", "-o", "%j %T").splitlines()

    def stop(self):
        for process in reversed(self.processes):
            process.terminate()
        for process in reversed(self.processes):
            process.wait(timeout=30)


def digests(folder):
    """Of the simulation's files of all rows, by path."""
    found = {}
    for path, _, names in os.walk(os.path.join(folder, "rows")):
        for name in names:
            if name.endswith((".ply", ".vdb")):
                with open(os.path.join(path, name), "rb") as file:
                    found[os.path.relpath(file.name, folder)] = hashlib.sha256(file.read()).hexdigest()
    return found


def run(*command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def frames_done(out, row):
    try:
        return Path(out, "unfinished", f"{row:04}", "stats.csv").read_bytes().count(b"\n") - 1
    except FileNotFoundError:
        return 0


def check(program, at):
    plan, local, farm = (os.path.join(at, name) for name in ("plan.yaml", "local", NAME))
    for name, text in (("scene.yaml", SCENE), ("plan.yaml", PLAN)):
        Path(at, name).write_text(text)
    begun = time.monotonic()
    run(program, "sweep", plan, "-o", local, "--no-preview")
    print(f"4 rows without Slurm: {time.monotonic() - begun:.1f} s")

    slurm = Slurm(os.path.join(at, "slurm"))
    try:
        begun = time.monotonic()
        run(program, "sweep", plan, "-o", farm, "--no-preview", "--slurm", "--render-frames", "16",
            "--slurm-option=--partition=low")
        slurm.wait(lambda: frames_done(farm, 1) >= 5, "the first row")
        run("sbatch", "--partition=high", f"--cpus-per-task={os.cpu_count()}", "--output=/dev/null", "--wrap=sleep 3")
        slurm.wait(lambda: any(s.startswith("wrap RUNNING") for s in slurm.states()), "the job that preempts")
        print("preempted at frames", frames_done(farm, 1), "and", frames_done(farm, 2))
        slurm.wait(lambda: not slurm.states(), "the end of the queue", 600)
        print(f"the same under Slurm, preempted, with pictures and report: {time.monotonic() - begun:.1f} s")
    finally:
        slurm.stop()

    whole, resumed = digests(local), digests(farm)
    if not whole or whole != resumed:
        different = sorted(k for k in whole.keys() | resumed.keys() if whole.get(k) != resumed.get(k))
        raise SystemExit(f"check_slurm: {len(different)} files differ: {different[:5]}")
    with open(os.path.join(farm, "rows", "0001", "log.txt")) as file:
        if "continuing from frame" not in file.read():
            raise SystemExit("check_slurm: row 1 did not resume")
    pictures = [n for _, _, names in os.walk(os.path.join(farm, "rows")) for n in names if n.endswith(".png")]
    if len(pictures) != 160 or not os.path.exists(os.path.join(farm, "index.html")):
        raise SystemExit(f"check_slurm: {len(pictures)} pictures, expected 160, and a report")
    print(f"{len(whole)} files have the same bytes; 160 pictures; report: passed")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--install", action="store_true")
    options = parser.parse_args()
    if options.install and not shutil.which("slurmd"):
        for command in (["update"], ["install", "-y", "--no-install-recommends", "slurm-wlm", "munge"]):
            subprocess.run(["apt-get", "-qq", *command], stdout=subprocess.DEVNULL)
    if os.getuid() or not shutil.which("slurmd") or not shutil.which("munged"):
        print("check_slurm: skipped: it needs root, slurm-wlm and munge (--install)")
        return
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("check_slurm: ended"))  # so that the daemons are ended too
    with tempfile.TemporaryDirectory() as at:
        check(os.path.realpath(options.program), at)


if __name__ == "__main__":
    main()
