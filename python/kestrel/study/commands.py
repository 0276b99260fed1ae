# SPDX-License-Identifier: BSD-3-Clause
"""The command `kestrel`: which build it is, and a run of it with limits of time and memory."""
import functools
import hashlib
import os
import re
import select
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

from .errors import StudyError, one_line

_LOG_BYTES = 4000
LOOK_S = 0.1  # between two looks at the memory
_TOOK = "took longer than"
_PAGE = os.sysconf("SC_PAGESIZE")


@functools.lru_cache(maxsize=64)
def _digest(path, mtime_ns, size):
    """Returns the hash of a file; mtime_ns and size say when it is another."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def _digest_of(path):
    status = os.stat(path)
    return _digest(str(path), status.st_mtime_ns, status.st_size)


@functools.lru_cache(maxsize=64)
def _library_of(path, mtime_ns):
    """Returns the file of libkestrel that the command loads, or None."""
    if shutil.which("ldd") is None:
        return None
    ldd = subprocess.run(["ldd", path], capture_output=True, text=True, check=False)
    found = re.search(r"libkestrel\.\S+ => (\S+)", ldd.stdout)
    return found[1] if found else None


@functools.lru_cache(maxsize=64)
def _printed_version(path, mtime_ns):
    run = subprocess.run([path, "--version"], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise StudyError(f"{path} --version: {one_line(run.stderr)}")
    return run.stdout.split()[-1]


def find_command(command):
    """Returns the path of a command. Raises StudyError where it is not there."""
    path = shutil.which(os.path.expanduser(command))
    if path is None:
        raise StudyError(f"{command}: no such command on this computer")
    return os.path.abspath(path)


def version_of(command):
    """Returns the version that the command prints, and the beginning of a hash of its program: two
    builds of one version are two versions."""
    path = find_command(command)
    mtime_ns = os.stat(path).st_mtime_ns
    try:
        printed = _printed_version(path, mtime_ns)
    except OSError as error:
        raise StudyError(f"{path}: {error.strerror}") from None
    library = _library_of(path, mtime_ns)
    digests = [_digest_of(file) for file in (path, library) if file]
    return f"{printed}+{hashlib.sha256(''.join(digests).encode()).hexdigest()[:12]}"


def output_of(command, *arguments):
    """Returns what a command prints. Raises StudyError with what it says when it fails."""
    run = subprocess.run([find_command(command), *arguments], capture_output=True, text=True,
                         check=False)
    if run.returncode != 0:
        raise StudyError(one_line(run.stderr))
    return run.stdout


@dataclass
class Run:
    """A run of a command that has ended."""

    status: int  # negative: the signal that ended it
    seconds: float
    cpu_s: float
    memory_mb: float  # the most that it had
    log: str  # the end of what it said
    broken_limit: str = ""
    timed_out: bool = False

    def reason(self):
        """Returns why it failed, as one line; empty where it did not."""
        if self.broken_limit:
            return self.broken_limit
        if self.status < 0:
            return ending(self.status)
        return one_line(self.log) if self.status else ""


def ending(status):
    """Returns the end of a process in words. status: negative: the signal that ended it."""
    return f"ended by the signal {signal.Signals(-status).name}" if status < 0 else \
        f"ended with the status {status}"


def _memory_mb(pid):
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except (OSError, IndexError):
        return 0.0  # it ends at this moment
    return pages * _PAGE / 1e6


def broken_limit(pid, seconds, limits):
    """Returns which limit a process breaks, in words; empty where it keeps them."""
    if seconds > limits["seconds"]:
        return f"{_TOOK} {limits['seconds']:g} s (limits.seconds)"
    if _memory_mb(pid) > limits["memory_mb"]:
        return f"needed more than {limits['memory_mb']:g} MB (limits.memory_mb)"
    return ""


def _wait(process, start, limits):
    """Waits for a process, and ends it with all its children when it breaks a limit. Returns the
    limit in words, its status and its usage."""
    broken = ""
    ended = select.poll()
    handle = os.pidfd_open(process.pid)
    try:
        ended.register(handle, select.POLLIN)
        while not ended.poll(LOOK_S * 1000):
            broken = broken_limit(process.pid, time.monotonic() - start, limits)
            if broken:
                os.killpg(process.pid, signal.SIGKILL)
                break
    finally:
        os.close(handle)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return broken, process.returncode, usage


def run_limited(command, folder, limits):
    """Runs a command in a folder and waits for it.

    command: a list of words. limits: {"seconds", "memory_mb"}. The command dies with the process
    that called this.
    """
    start = time.monotonic()
    log = Path(folder) / "log.txt"
    with open(log, "wb") as errors:
        # setpriv: a worker that is killed takes the command with it.
        bound = [find_command("setpriv"), "--pdeathsig", "KILL", *command]
        process = subprocess.Popen(bound, cwd=folder, stdin=subprocess.DEVNULL, stdout=errors,
                                   stderr=errors, start_new_session=True)
        broken, status, usage = _wait(process, start, limits)
    with open(log, "rb") as said:
        said.seek(max(0, log.stat().st_size - _LOG_BYTES))
        words = said.read().decode(errors="replace")
    return Run(status, time.monotonic() - start, usage.ru_utime + usage.ru_stime,
               usage.ru_maxrss * 1024 / 1e6, words, broken, broken.startswith(_TOOK))
