# SPDX-License-Identifier: BSD-3-Clause
"""A unit of work on a worker: one recording, one configuration, one version of `kestrel`."""
import contextlib
import csv
import os
import shutil
import tempfile
import time
from pathlib import Path

from distributed import get_worker

from . import monte_carlo, recordings
from .calibrations import calibrated
from .commands import run_limited, version_of
from .errors import StudyError, reason_of
from .scorer import scorer

# The folders of a unit, below its scratch folder: reasons name no folder that is another next time.
_OUTPUT, _RECORDING, _CONFIG, _CAMERA = "output", "recording", "config.yaml", "camera.yaml"
_RESULTS = ("landing_detections.csv", "landing_track.csv", "object_detections.csv")
# `kestrel fly` ended, whether or not with a landing.
_FLIGHT_ENDS = (0, 3, 4)


class Lacking(StudyError):
    """The worker has not the `kestrel` of a unit: the unit is for another worker."""


def _worker():
    """Returns (address, scratch folder) of the worker that runs this; of none without one."""
    try:
        worker = get_worker()
        return worker.address, worker.local_directory
    except ValueError:
        return "", None


def run_job(job):
    """Does a job and returns (address of the worker, content): the content is [(key, result)], or
    the recording's hash for a job without units.

    A result is {"state": "done", "frames", "bins", "summary", "worst", "detections", "resource"} or
    {"state": "failed", "reason"}, with "lacking" in the place of "failed" where the worker has not
    the version of the unit; it is never an exception.
    """
    address, scratch = _worker()
    if not job.units:
        try:
            return address, recordings.content_hash(job.recording.path)
        except StudyError as error:
            return address, error
    if job.settings["task"] == "nothing":
        return address, [(unit["key"], {"state": "done"}) for unit in job.units]
    with _scratch_folder(scratch) as folder:
        return address, list(_results(job, folder, address))


@contextlib.contextmanager
def _scratch_folder(above):
    folder = tempfile.mkdtemp(prefix="kestrel_study_", dir=above)
    try:
        yield Path(folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _results(job, folder, address):
    try:
        path = _provide(job, folder)
    except Exception as error:  # whatever a file system or a simulator has met
        for unit in job.units:
            yield unit["key"], _failed(error, address)
        return
    for unit in job.units:
        yield unit["key"], _run_unit(job, unit, path, folder, address)


def _failed(error, address):
    reason, log = reason_of(error)
    state = "lacking" if isinstance(error, Lacking) else "failed"
    return {"state": state, "reason": reason, "resource": {"worker": address, "log": log}}


def _provide(job, folder):
    """Returns the path of the job's recording on this computer: made, fetched, or a part of it."""
    recording = job.recording
    if recording.simulation:
        return _simulate(recording.simulation, job, folder)
    path = recording.path
    if recording.is_remote():
        (folder / "fetched").mkdir()
        path = recordings.fetch(path, folder / "fetched")
    elif not os.path.exists(path):
        raise StudyError(f"{path}: not there on this worker")
    return _view(Path(path), job.piece, folder) if job.piece else path


def _simulate(flight, job, folder):
    """Renders a flight that is landed on; of a closed loop each unit is a flight of its own."""
    if flight["kind"] != "landing":
        return None
    _require_version(flight["command"], flight["version"])
    words = monte_carlo.command_words(flight, output=_RECORDING)
    run = run_limited([flight["command"], *words], folder, job.settings["limits"])
    if run.reason():
        raise StudyError(f"simulate: {run.reason()}")
    return folder / _RECORDING


def _view(path, piece, folder):
    """Returns a folder that is the piece of a recording with its lead-in: only the table of the
    images is another."""
    view = folder / _RECORDING
    camera = view / "mav0/cam0"
    camera.mkdir(parents=True)
    _link(path, view, besides="mav0")
    _link(path / "mav0", view / "mav0", besides="cam0")
    _link(path / "mav0/cam0", camera, besides="data.csv")
    rows = (path / "mav0/cam0/data.csv").read_text(encoding="utf-8-sig").splitlines(keepends=True)
    (camera / "data.csv").write_text("".join(
        row for row in rows if row.startswith("#")
        or piece.lead_in_ns <= int(row.split(",")[0]) < piece.last_ns))
    return view


def _link(source, target, besides):
    for entry in source.iterdir():
        if entry.name != besides:
            (target / entry.name).symlink_to(entry.resolve())


def _require_version(command, version):
    try:
        here = version_of(command)
    except StudyError as error:
        raise Lacking(str(error)) from None
    if here != version:
        raise Lacking(f"{command}: is {here} on this computer, expected {version}")


def _run_unit(job, unit, path, folder, address):
    start = time.monotonic()
    try:
        (folder / _CONFIG).write_text(unit["text"])
        run = _run_command(job, unit, path, folder)
        result = _score(job, path, folder, run)
    except Exception as error:  # a unit that fails costs that unit only
        return _failed(error, address)
    finally:
        shutil.rmtree(folder / _OUTPUT, ignore_errors=True)
    result["resource"] = {**result.get("resource", {}), "seconds": time.monotonic() - start,
                          "cpu_s": run.cpu_s, "memory_mb": run.memory_mb, "worker": address,
                          "log": run.log}
    return {"state": "done", **result}


def _run_command(job, unit, path, folder):
    """Runs `kestrel` for a unit. Raises StudyError with its reason when it fails."""
    _require_version(unit["command"], unit["version"])
    run = run_limited([unit["command"], *_words(job, path)], folder, job.settings["limits"])
    if job.settings["label"] == "fly" and (run.status in _FLIGHT_ENDS or run.timed_out):
        return run
    if run.reason():
        raise StudyError(run.reason())
    return run


def _words(job, path):
    arguments, label = job.settings["arguments"], job.settings["label"]
    if label in monte_carlo.KINDS:
        return [*monte_carlo.command_words(job.recording.simulation, _CONFIG, _OUTPUT), *arguments]
    target = _CAMERA if label.startswith("calibrate") else _OUTPUT
    return [*label.split(), str(path), "--output", target, *arguments, "--config", _CONFIG]


def _score(job, path, folder, run):
    """Returns the rows of a unit."""
    label, flight = job.settings["label"], job.recording.simulation
    if label.startswith("calibrate"):
        return {"summary": calibrated(folder / _CAMERA, run.log)}
    output = folder / _OUTPUT
    if job.piece:
        _cut_lead_in(output, job.piece.first_ns)
    # The recording of a closed loop is its output.
    model = _argument(job.settings["arguments"], "--model")
    question = str(path or output), str(output), label, str(folder / _CONFIG), model
    # A flight may take its whole time: its scoring begins anew.
    spent_s = 0 if run.timed_out else run.seconds
    result = scorer().score(question, spent_s, job.settings["limits"])
    if flight:
        result["summary"].update(monte_carlo.drawn_numbers(flight))
    if label in monte_carlo.KINDS:
        result["summary"].update(monte_carlo.outcome(label, output, run.log))
    return result


def _argument(words, name):
    """Returns the value of an option of a command line, or None."""
    for word, following in zip(words, [*words[1:], None]):
        if word == name:
            return following
        if word.startswith(f"{name}="):
            return word.partition("=")[2]
    return None


def _cut_lead_in(output, first_ns):
    """Takes the frames before the piece off the tables: they are in the piece before."""
    for name in _RESULTS:
        table = output / name
        if not table.exists():
            continue
        with open(table, newline="") as file:
            rows = list(csv.reader(file))
        column = rows[0].index("timestamp_ns")
        with open(table, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(
                rows[:1] + [row for row in rows[1:] if int(row[column]) >= first_ns])
