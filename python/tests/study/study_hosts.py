#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Usage: study_hosts.py [CASE]...

A study on three hosts (network namespaces of this machine, as root), with the scripts of
examples/study: host 1 has the scheduler, the user and a worker, hosts 2 and 3 have workers. Meanwhile
a worker is killed, a host is cut off for 30 s, the scheduler is started anew; or host 3 has no
`kestrel`. Its tables must be those of a study without any of that, to the byte. Prints a table with a row for each case; status 1 when
one fails, 77 where there can be no hosts. `kestrel` is a stand-in that takes its time.
"""
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parents[2]
sys.path += [str(HERE), str(PROJECT / "tests" / "team")]

from bench import FAKE, Bench
from radio import Radio, obstacle

SCRIPTS = PROJECT / "examples" / "study"
SKIPPED = 77
RECORDINGS, UNIT_S = 60, 1.0
HOSTS = 3


class Hosts:
    """The programs on three hosts."""

    def __init__(self, bench, lacking=None):
        """lacking: number of a host without `kestrel`."""
        self.bench = bench
        self.radio = Radio(HOSTS)
        self.scheduler = self.start(1, [SCRIPTS / "scheduler", "10.0.0.1"])
        self.workers = [self._start_worker(number, lacking) for number in range(1, HOSTS + 1)]

    def _start_worker(self, number, lacking):
        command = [str(SCRIPTS / "worker"), "10.0.0.1", "1"]
        if number == lacking:
            hide = f'mount --bind /dev/null {FAKE} && exec "$@"'
            command = ["unshare", "--mount", "sh", "-c", hide, "sh", *command]
        return self.start(number, command)

    def start(self, number, command, **more):
        folder = self.bench.folder / f"host{number}"
        folder.mkdir(exist_ok=True)
        return subprocess.Popen(command, preexec_fn=self.radio.hosts[number - 1].enter, start_new_session=True,
                                env={**self.bench.environment(), "TMPDIR": str(folder)},
                                **{"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **more})

    def close(self):
        for process in [self.scheduler, *self.workers]:
            for child in children(process.pid):
                signal_to(child, signal.SIGKILL)
            signal_to(process.pid, signal.SIGKILL)
            process.wait()
        self.radio.close()


def signal_to(pid, number):
    try:
        os.kill(pid, number)
    except ProcessLookupError:
        pass


def children(pid):
    """Returns the ids of all processes below one."""
    try:
        below = [int(one) for thread in Path(f"/proc/{pid}/task").iterdir()
                 for one in (thread / "children").read_text().split()]
    except FileNotFoundError:
        return []  # it has ended
    return below + [one for child in below for one in children(child)]


def named(pid, words):
    """Returns the processes below one whose command has all the words."""
    def command(one):
        try:
            return Path(f"/proc/{one}/cmdline").read_text().replace("\0", " ")
        except FileNotFoundError:
            return ""
    return [one for one in children(pid) if all(word in command(one) for word in words)]


def kill_worker(hosts):
    """SIGKILL to the worker of host 2: to the process that runs the units."""
    found = named(hosts.workers[1].pid, ["spawn_main"])
    assert found, "host 2 has no worker"
    for worker in found:
        signal_to(worker, signal.SIGKILL)


def kill_nanny(hosts):
    """SIGKILL to all of dask-worker on host 2."""
    for process in children(hosts.workers[1].pid):
        signal_to(process, signal.SIGKILL)


def cut_off(hosts):
    """Nothing goes to host 3 or comes from it, for 30 s."""
    hosts.radio.hears = lambda receiver, sender: 3 not in (receiver, sender)
    time.sleep(30)
    hosts.radio.hears = lambda receiver, sender: True


def restart_scheduler(hosts):
    """SIGKILL to the scheduler; the script starts it anew."""
    for process in named(hosts.scheduler.pid, ["dask_scheduler"]):
        signal_to(process, signal.SIGKILL)


CASES = {"nothing": None, "a worker killed": kill_worker, "dask-worker killed": kill_nanny,
         "a host cut off for 30 s": cut_off, "the scheduler killed": restart_scheduler,
         "no kestrel on host 3": None}


def run_case(bench, name):
    """Returns (seconds, status, what was said)."""
    hosts = Hosts(bench, lacking=3 if name == "no kestrel on host 3" else None)
    try:
        start = time.monotonic()
        command = bench.command("--where", "tcp://10.0.0.1:8786", output=name.replace(" ", "_"))
        study = hosts.start(1, command, stderr=subprocess.PIPE, text=True)
        if CASES[name]:
            thread = threading.Timer(15, CASES[name], [hosts])
            thread.start()
        said = study.communicate(timeout=600)[1]
        return time.monotonic() - start, study.returncode, said
    finally:
        hosts.close()


def judge(bench, name, expected):
    seconds, status, said = run_case(bench, name)
    tables = bench.tables(name.replace(" ", "_"))
    units = tables["unit.csv"].count(b"\n") - 1 if tables else 0
    is_equal = tables == expected
    print(f"| {name} | {seconds:.0f} | {units} | {'equal' if is_equal else 'different'} | {status} |", flush=True)
    for line in said.splitlines():
        if "units" not in line or "failed" in line and " 0 failed" not in line:
            print(line, file=sys.stderr)
    return is_equal and status == 0


def main(names):
    if reason := obstacle():
        print(f"no hosts: {reason}", file=sys.stderr)
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(folder)
        expected = bench.tables_alone(RECORDINGS, UNIT_S, workers=4)
        print("| what happened | s | units | tables | status |\n|---|---|---|---|---|", flush=True)
        good = [judge(bench, name, expected) for name in names or CASES]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
