# SPDX-License-Identifier: BSD-3-Clause
"""`kestrel study run`: gives the units that have no result yet to the workers, a bounded number at
a time, and puts what comes back into the store."""
import collections
import dataclasses
import itertools
import time

from distributed import as_completed
from distributed.client import CancelledError

from .errors import StudyError, one_line
from .plan import Job, split
from .recordings import known_content
from .unit import run_job

_COUNT_S = 5  # between two questions for the workers
_LACKING_S = 60  # until a worker has to come that has the version of a unit
_DEATH = "its worker died"


class _LostScheduler(Exception):
    pass


class Runner:
    """The run of a plan: what the store has is not done again.

    show(done, failed, planned): called after each batch of results. say(text): called with what a
    user should know.
    """

    def __init__(self, plan, store, workers, show, say):
        self._plan, self._store, self._workers = plan, store, workers
        self._show, self._say = show, say
        self._recordings = iter(plan.recordings)
        self._ready = collections.deque()
        self._running = {}  # a future: its job
        self._numbers = itertools.count()
        self._threads, self._counted = {}, 0.0  # of each worker; when that was asked for
        self._lacking = collections.defaultdict(dict)  # a command: {worker without it: why}
        self._able = time.monotonic()  # when a worker could be given the next job
        self._at_least = len(plan.recordings) * len(plan.configurations)
        self.planned = self.done = self.failed = 0

    def run(self):
        """Does all units. Raises StudyError when the store or the workers fail for good."""
        if not self._is_done():
            with self._workers:
                while not self._is_done():
                    self._connect()
                    time.sleep(0 if self._is_done() else 1)
        self._store.retire()

    def _connect(self):
        """Works until all is done, or the scheduler is gone."""
        client = self._workers.connect()
        try:
            self._work(client)
        except (_LostScheduler, OSError):  # OSError: it is gone while it is asked for its workers
            self._say("the scheduler is gone; waiting for it, and going on")
            self._ready.extend(self._running.values())
            self._running.clear()
        finally:
            _close(client)

    def _is_done(self):
        """Returns whether nothing is left; takes the next job out of the plan to know that."""
        if not self._ready and not self._running:
            self._prepare()
        return not self._ready and not self._running

    def _work(self, client):
        finished = as_completed([], loop=client.loop, raise_errors=False)
        self._fill(client, finished)
        while self._running:
            for future in finished.next_batch():
                self._take(finished, future)
            self._store.commit()
            self._show(self.done, self.failed, max(self.planned, self._at_least))
            self._fill(client, finished)

    def _window(self, client):
        """Returns how many jobs may be with the workers: enough that none waits for its next."""
        if time.monotonic() - self._counted > _COUNT_S:
            self._threads = client.nthreads()
            self._counted = time.monotonic()
            if not self._threads:
                self._say("no worker is there yet; waiting for one")
        return 3 * sum(self._threads.values()) + 8

    def _fill(self, client, finished):
        window = self._window(client)
        while len(self._running) < window and self._prepare():
            where = self._where(self._ready[0])
            if where is None:
                return
            job = self._ready.popleft()
            future = client.submit(run_job, job, key=f"study-{next(self._numbers)}", pure=False,
                                   **where)
            self._running[future] = job
            finished.add(future)

    def _where(self, job):
        """Returns which workers a job is for: not the one on which it failed, and not those that
        lack its version; None where all that are there do. Raises StudyError after a while."""
        lacking = {}
        for command in {unit.get("command") for unit in job.units}:
            lacking.update(self._lacking.get(command, {}))
        if not lacking and not job.avoid:
            self._able = time.monotonic()
            return {}
        able = [address for address in self._threads if address not in lacking]
        if lacking and not able:
            self._counted = 0.0  # asks for the workers
            if time.monotonic() - self._able > _LACKING_S:
                raise StudyError(f"no worker can go on: {next(iter(lacking.values()))}")
            return None
        self._able = time.monotonic()
        others = [address for address in able if address != job.avoid]
        return {"workers": others, "allow_other_workers": True} if others else {}

    def _prepare(self):
        """Returns whether a job is ready; asks the plan for more where none is."""
        while not self._ready:
            recording = next(self._recordings, None)
            if recording is None:
                return False
            try:
                content = known_content(recording, self._store)
            except StudyError as error:
                self._expand(recording, "", str(error))
                continue
            if content is None:
                self._ready.append(Job(recording, [], settings=self._plan.settings))
            else:
                self._expand(recording, content)
        return True

    def _expand(self, recording, content, reason=None):
        """Adds the jobs of a recording; with a reason why it cannot be read its units fail."""
        is_shared = bool(recording.simulation) or recording.is_remote()
        for job in self._plan.units_of(recording, content):
            self.planned += len(job.units)
            new = [unit for unit in job.units if not self._store.has(unit["key"], unit["path"])]
            self.done += len(job.units) - len(new)
            if reason is None:
                self._ready.extend(split(dataclasses.replace(job, units=new), is_shared))
                continue
            for unit in new:
                self._add(unit, {"state": "failed", "reason": reason})

    def _take(self, finished, future):
        job = self._running.pop(future)
        status = future.status
        if status == "lost":  # its worker died before it was asked for the result
            self._running[future] = job
            finished.add(future)
            return
        if status == "error":
            self._retry(job, job.units, "", {"state": "failed", "reason": _reason(future)})
        else:
            try:
                self._take_result(job, *future.result())
            except (CancelledError, OSError):  # OSError: the connection broke
                self._running[future] = job
                raise _LostScheduler from None
        future.release()

    def _take_result(self, job, address, content):
        if not job.units:
            self._take_hash(job, address, content)
            return
        results = dict(content)
        for unit in job.units:
            result = results[unit["key"]]
            if result["state"] == "lacking":
                self._note_lacking(unit["command"], address, result["reason"])
                self._ready.append(dataclasses.replace(job, units=[unit]))
            elif result["state"] == "failed":
                self._retry(job, [unit], address, result)
            else:
                self._add(unit, result)

    def _note_lacking(self, command, address, reason):
        """Keeps in mind that a worker gets no more units of a command."""
        if address not in self._lacking[command]:
            self._lacking[command][address] = reason
            self._say(f"{address} gets none of these units: {reason}")

    def _take_hash(self, job, address, content):
        recording = job.recording
        if isinstance(content, StudyError):
            self._retry(job, [], address, {"state": "failed", "reason": str(content)})
            return
        self._store.remember_content(recording.path, recording.mark, content)
        self._expand(recording, content)

    def _retry(self, job, units, address, result):
        """Tries what failed once more, on another worker if there is one; then it has failed."""
        if not job.was_tried:
            again = dataclasses.replace(job, units=units, was_tried=True, avoid=address)
            self._ready.extend(split(again, is_shared=False) if units else [again])
        elif units:
            for unit in units:
                self._add(unit, result)
        else:
            self._expand(job.recording, "", result["reason"])

    def _add(self, unit, result):
        self._store.add(unit, result)
        if result["state"] == "failed":
            self.failed += 1
            self._say(f"{unit['recording']}, {unit['configuration']}: {result['reason']}")
        else:
            self.done += 1


def _reason(future):
    """Returns why a worker gave no result."""
    error = future.exception()
    if type(error).__name__ == "KilledWorker":
        return _DEATH
    return f"{type(error).__name__}: {one_line(error)}"


def _close(client):
    try:
        client.close(timeout=5)
    except (OSError, CancelledError, TimeoutError):
        pass  # the scheduler is gone
