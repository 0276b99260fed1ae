# SPDX-License-Identifier: BSD-3-Clause
"""Scoring in a process of its own: a recording on which it hangs, crashes or fills the memory costs
its unit, not the worker. The process stays for the next units, as its modules take long to load."""
import os
import pickle
import select
import subprocess
import sys
import threading
import time
from pathlib import Path

from .commands import LOOK_S, broken_limit, ending, find_command
from .errors import StudyError, reason_of

PACKAGES = Path(__file__).parents[2]  # folder of the package `kestrel`


class ScoringError(StudyError):
    """A result that cannot be scored. log: a traceback where the cause is not the input."""

    def __init__(self, reason, log=""):
        super().__init__(reason)
        self.log = log


class Scorer:
    """The scoring process of one thread."""

    def __init__(self):
        self._process = None

    def score(self, question, spent_s, limits):
        """Returns the rows of scoring.score.

        question: its arguments. limits: {"seconds", "memory_mb"} of the unit, which has taken
        spent_s. Raises ScoringError when it fails or breaks a limit.
        """
        if self._process is None or self._process.poll() is not None:
            self._start()
        pickle.dump(question, self._process.stdin)
        self._process.stdin.flush()
        self._await(time.monotonic() - spent_s, limits)
        rows, reason, log = self._read()
        if reason:
            raise ScoringError(reason, log)
        return rows

    def _start(self):
        # setpriv: a worker that is killed takes the process with it.
        command = [find_command("setpriv"), "--pdeathsig", "KILL", sys.executable, "-m", __name__]
        paths = [str(PACKAGES), *filter(None, [os.environ.get("PYTHONPATH")])]
        self._process = subprocess.Popen(
            command, cwd="/", stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)})
        self._read()  # it has loaded its modules: this is not the unit's time

    def _await(self, start, limits):
        while not select.select([self._process.stdout], [], [], LOOK_S)[0]:
            broken = broken_limit(self._process.pid, time.monotonic() - start, limits)
            if broken:
                self._process.kill()
                self._process.wait()
                raise ScoringError(f"the scoring {broken}")

    def _read(self):
        try:
            return pickle.load(self._process.stdout)
        except (EOFError, pickle.UnpicklingError):
            raise ScoringError(f"the scoring was {ending(self._process.wait())}") from None


_of_thread = threading.local()


def scorer():
    """Returns the Scorer of this thread."""
    if not hasattr(_of_thread, "scorer"):
        _of_thread.scorer = Scorer()
    return _of_thread.scorer


def _answer(score, question):
    """Returns (rows, reason, log)."""
    try:
        return score(*question), "", ""
    except Exception as error:  # whatever is wrong in the recording
        return None, *reason_of(error)


def _serve():
    """Answers what comes on stdin, until it ends."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is no answer
    from .scoring import score
    answer = None, "", ""
    while True:
        pickle.dump(answer, answers)
        answers.flush()
        try:
            question = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        answer = _answer(score, question)


if __name__ == "__main__":
    _serve()
