#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Usage: study_slurm.py [TASKS]

A study by Slurm on this machine, as root: munged, slurmctld and slurmd are started with a
configuration of their own, examples/study/slurm is given to sbatch, with TASKS (2) workers. The tables
must be those of a study without Slurm, to the byte. Prints one line; status 1 when it fails. Needs
slurm-wlm and munge. `kestrel` is a stand-in that takes its time.
"""
import contextlib
import os
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parents[2]
sys.path.insert(0, str(HERE))

from bench import Bench

RECORDINGS, UNIT_S = 20, 0.5
CONFIGURATION = """ClusterName=study
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory=8000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


@contextlib.contextmanager
def daemon(*command, **more):
    process = subprocess.Popen(command, **more)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


@contextlib.contextmanager
def slurm(folder):
    """Slurm with one node; gives the environment of its commands."""
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key, socket_path = folder / "munge.key", folder / "munge.socket"
    key.write_bytes(os.urandom(128))
    key.chmod(0o600)
    configuration = folder / "slurm.conf"
    configuration.write_text(CONFIGURATION.format(host=socket.gethostname(), folder=folder, cpus=os.cpu_count()))
    environment = {**os.environ, "SLURM_CONF": str(configuration)}
    munged = daemon("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={socket_path}",
                    f"--pid-file={folder}/munged.pid", f"--seed-file={folder}/munged.seed",
                    f"--log-file={folder}/munged.log", stderr=subprocess.DEVNULL)
    with munged, daemon("slurmctld", "-D", env=environment, stderr=subprocess.DEVNULL), \
            daemon("slurmd", "-D", env=environment, stderr=subprocess.DEVNULL):
        for _ in range(60):
            state = subprocess.run(["sinfo", "-h", "-o", "%T"], env=environment, text=True, capture_output=True,
                                   check=False).stdout.strip()
            if state == "idle":
                break
            time.sleep(1)
        else:
            logs = "".join(log.read_text()[-1000:] for log in folder.glob("*.log"))
            raise AssertionError(f"the node is '{state}' after a minute:\n{logs}")
        yield environment


def install_command(bench):
    """Writes a `kestrel` that knows `study`; returns its folder."""
    folder = bench.folder / "bin"
    folder.mkdir()
    (folder / "kestrel").write_text(f'#!/bin/sh\nshift\nexec {sys.executable} -m kestrel.study "$@"\n')
    (folder / "kestrel").chmod(0o755)
    return folder


def run_study(bench, environment, tasks):
    """Runs the example's script to its end; returns (seconds, state of the job, what was said)."""
    ours = bench.environment()
    path = f"{install_command(bench)}:{ours['PATH']}"
    start = time.monotonic()
    command = ["sbatch", "--wait", f"--ntasks={tasks}", "--mem-per-cpu=1G", f"--output={bench.folder}/job.log",
               str(PROJECT / "examples/study/slurm"), str(bench.folder / "study.yaml"), str(bench.folder / "slurm")]
    run = subprocess.run(command, env={**environment, **ours, "SLURM_CONF": environment["SLURM_CONF"], "PATH": path},
                         cwd=bench.folder, text=True, capture_output=True, check=False, timeout=600)
    log = bench.folder / "job.log"
    return time.monotonic() - start, run.returncode, run.stderr + (log.read_text() if log.exists() else "")


def main(tasks=2):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bench = Bench(folder)
        expected = bench.tables_alone(RECORDINGS, UNIT_S, workers=2)
        with slurm(folder) as environment:
            seconds, status, said = run_study(bench, environment, int(tasks))
        tables = bench.tables("slurm")
        is_equal = tables == expected
        units = tables["unit.csv"].count(b"\n") - 1 if tables else 0
        print(f"{tasks} workers of Slurm: {units} units in {seconds:.0f} s, tables "
              f"{'equal' if is_equal else 'different'}, status {status}")
        if not (is_equal and status == 0):
            print(said, file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
