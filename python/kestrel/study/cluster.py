# SPDX-License-Identifier: BSD-3-Clause
"""The workers that do the units: workers of Dask distributed on this computer, at a scheduler's address, or
started by Slurm."""
import os
import subprocess
import sys
import tempfile
import time

import dask
from distributed import Client, LocalCluster
from distributed.utils import get_ip

from .errors import StudyError, one_line

_PATIENCE_S = 600  # for a scheduler that is started anew
# Memory of the scheduler is bounded: it keeps a history of this length, and no profile of itself. A
# worker's death costs the units that were on it one try. No worker takes over what is to be done elsewhere than on it.
_CONFIG = {"distributed.scheduler.transition-log-length": 1000,
           "distributed.scheduler.events-log-length": 1000,
           "distributed.scheduler.allowed-failures": 1,
           "distributed.scheduler.work-stealing": False,
           "distributed.worker.memory.spill": False,
           "distributed.worker.profile.enabled": False,
           "distributed.logging.distributed": "critical"}


def _local_cluster(count, host):
    dask.config.set(_CONFIG)
    # The processes of the workers read their configuration from there.
    os.environ["DASK_DISTRIBUTED__LOGGING__DISTRIBUTED"] = "critical"
    try:
        # Dask removes what a worker that was killed has left in the folder.
        return LocalCluster(n_workers=count, threads_per_worker=1, processes=True, host=host,
                            dashboard_address=f"{host}:0", silence_logs=50,
                            preload=["kestrel.study.worker_preload"],
                            local_directory=tempfile.gettempdir())
    except Exception as error:  # no port, no process, no disk: in Dask's words
        raise StudyError(f"the workers do not start: {one_line(error)}") from None


class LocalWorkers:
    """A scheduler and workers on this computer, for one study."""

    def __init__(self, count):
        self._count = count or len(os.sched_getaffinity(0))

    def __enter__(self):
        self._cluster = _local_cluster(self._count, "127.0.0.1")
        return self

    def __exit__(self, kind, error, trace):
        self._cluster.close()

    def connect(self):
        """Returns a client."""
        return Client(self._cluster)


class RemoteWorkers:
    """The workers of a scheduler that somebody else has started."""

    def __init__(self, address):
        self._address = address
        self._patience_s = 20

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        pass

    def connect(self):
        """Returns a client; waits for a scheduler that was there and is started anew."""
        deadline = time.monotonic() + self._patience_s
        while True:
            try:
                client = Client(self._address, timeout=5, set_as_default=False)
                self._patience_s = _PATIENCE_S
                return client
            except (OSError, ValueError, TimeoutError) as error:
                if isinstance(error, ValueError) or time.monotonic() > deadline:
                    raise StudyError(f"{self._address}: no scheduler there: {one_line(error)}") \
                        from None


class SlurmWorkers:
    """A scheduler on this computer and workers that srun starts: within an allocation one for each
    task, else of an allocation that srun asks for."""

    def __init__(self, count, options):
        self._count = count or int(os.environ.get("SLURM_NTASKS", "1"))
        self._options = options

    def __enter__(self):
        self._cluster = _local_cluster(0, get_ip())
        command = ["srun", f"--ntasks={self._count}", *self._options, sys.executable, "-m",
                   "distributed.cli.dask_worker", self._cluster.scheduler_address, "--nthreads",
                   "1", "--no-dashboard", "--death-timeout", "60", "--local-directory",
                   tempfile.gettempdir()]
        try:
            self._workers = subprocess.Popen(command, stdin=subprocess.DEVNULL,
                                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                             text=True)
        except FileNotFoundError:
            self._cluster.close()
            raise StudyError("where: slurm: no command srun on this computer") from None
        return self

    def __exit__(self, kind, error, trace):
        self._workers.terminate()
        self._cluster.close()
        self._workers.communicate()

    def connect(self):
        """Returns a client when the first worker is there. Raises StudyError with what srun says
        when it fails."""
        client = Client(self._cluster, set_as_default=False)
        while not client.nthreads():
            if self._workers.poll() is not None:
                raise StudyError(f"srun: {one_line(self._workers.stderr.read())}")
            time.sleep(0.2)
        return client


def workers_of(where, count):
    """Returns the workers that a study asks for, as a context.

    where: 'local', 'slurm', {'slurm': [options of srun]}, or the address of a scheduler
    (tcp://HOST:8786, tls://...). count: how many, of the first two; None: as many as there are
    cores, or tasks of the allocation. Raises StudyError.
    """
    if where == "local":
        return LocalWorkers(count)
    if where == "slurm":
        return SlurmWorkers(count, [])
    if isinstance(where, dict) and list(where) == ["slurm"]:
        return SlurmWorkers(count, [str(option) for option in where["slurm"]])
    if isinstance(where, str) and where.startswith(("tcp://", "tls://")):
        return RemoteWorkers(where)
    raise StudyError(f"where: {where}, expected local, slurm, or a scheduler as tcp://HOST:8786")
