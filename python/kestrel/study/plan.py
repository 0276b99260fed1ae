# SPDX-License-Identifier: BSD-3-Clause
"""STUDY.yaml: what is read, checked and expanded to units of work."""
import csv
import dataclasses
import functools
import hashlib
import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Optional

import yaml

from . import monte_carlo
from .commands import output_of
from .configurations import Configuration, parse_setting, read_configurations
from .errors import StudyError
from .gates import GateError, parse_gates
from .mappings import take
from .recordings import Recording, find_recordings

TASKS = ("land", "hunt", "calibrate", "simulate", "nothing")
_CALIBRATIONS = ("mount", "clock", "lens")
_KEYS = {"task": str, "recordings": list, "configurations": list, "simulate": dict,
         "calibrate": str, "arguments": list, "where": (str, dict), "workers": int, "limits": dict,
         "pieces": dict, "gates": list, "output": str, "units": int}
_LIMITS = {"seconds": 3600.0, "memory_mb": 4000.0}
_PIECES = {"lead_in_s": 3.0}
_OURS = ("--output", "--config", "--set", "--force", "--annotate", "--mcap", "--seed")
# Number of configurations that share a recording which a worker has fetched or simulated.
_SHARED = 8


@dataclass
class Piece:
    """A part of a recording: its results count from `first_ns` to before `last_ns`; frames are
    processed from `lead_in_ns` on."""

    number: int
    lead_in_ns: int
    first_ns: int
    last_ns: int


@dataclass
class Job:
    """The work of one call of a worker: units that share a recording; without units, its hash."""

    recording: object  # recordings.Recording
    units: list  # of dicts: the columns of the table `unit` and {"command", "text"}
    piece: Optional[Piece] = None
    settings: dict = field(default_factory=dict)  # limits, arguments, task, ...
    was_tried: bool = False
    avoid: str = ""  # address of the worker on which it failed


@dataclass
class Plan:
    """A study, complete and checked."""

    task: str
    recordings: object  # has a length and can be iterated
    configurations: list
    settings: dict  # of every job
    pieces: Optional[dict]
    where: object
    workers: Optional[int]
    output: str
    text: str  # STUDY.yaml

    def configuration_rows(self):
        """Returns the rows of the store's table `configuration`."""
        arguments = json.dumps(self.settings["arguments"])
        return [{"name": one.name, "version": one.version, "task": self.settings["label"],
                 "place": place, "command": one.command, "arguments": arguments, "text": one.text}
                for place, one in enumerate(self.configurations)]

    def units_of(self, recording, content):
        """Yields the jobs of a recording, each with all its units; content: its hash."""
        for piece in self._pieces_of(recording):
            units = [self._unit(recording, content, piece, one) for one in self.configurations]
            yield Job(recording, units, piece, self.settings)

    def _unit(self, recording, content, piece, configuration):
        number = piece.number if piece else 0
        task = self.settings["label"]
        said = [content, configuration.text, configuration.version, task,
                self.settings["arguments"], recording.name, configuration.name,
                dataclasses.astuple(piece) if piece else number]
        key = hashlib.sha256(json.dumps(said).encode()).hexdigest()
        return {"key": key, "recording": recording.name, "piece": number,
                "configuration": configuration.name, "version": configuration.version, "task": task,
                "seed": recording.seed(), "path": recording.path, "command": configuration.command,
                "text": configuration.text}

    def _pieces_of(self, recording):
        times = _times(recording.path) if self.pieces and not recording.simulation else []
        if not times:
            return [None]
        length, lead_in = (round(1e9 * self.pieces[key]) for key in ("seconds", "lead_in_s"))
        count = max(1, -(-(times[-1] + 1 - times[0]) // length))
        starts = [times[0] + number * length for number in range(count + 1)]
        return [Piece(number + 1, starts[number] - lead_in, starts[number], starts[number + 1])
                for number in range(count)]


class Flights:
    """Simulated flights, each made when it is asked for: there may be very many."""

    def __init__(self, make, seeds):
        self._make, self._seeds = make, seeds

    def __len__(self):
        return len(self._seeds)

    def __iter__(self):
        return map(self._make, self._seeds)


def _times(path):
    """Returns the times of a recording's images; empty where it is not divided: where it is no EuRoC
    folder, or its table is broken, which `kestrel` will tell."""
    try:
        with open(Path(path) / "mav0/cam0/data.csv", newline="", encoding="utf-8-sig") as file:
            return sorted(int(row[0]) for row in csv.reader(file)
                          if row and not row[0].startswith("#"))
    except (OSError, ValueError):
        return []


def split(job, is_shared):
    """Returns the jobs that a job is divided into for the workers: its units one by one, or, where
    they share what a worker fetches or simulates, some at once."""
    count = _SHARED if is_shared else 1
    return [dataclasses.replace(job, units=job.units[first:first + count])
            for first in range(0, len(job.units), count)]


def _load(path):
    try:
        text = Path(path).read_text()
        mapping = yaml.safe_load(text)
    except OSError as error:
        raise StudyError(f"{path}: {error.strerror}") from None
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        mark = getattr(error, "problem_mark", None)
        row = f":{mark.line + 1}" if mark else ""
        raise StudyError(f"{path}{row}: no YAML: {getattr(error, 'problem', error)}") from None
    return take(mapping, str(path), _KEYS, required=("task",)), text


def _check_arguments(arguments):
    for word in arguments:
        if any(str(word).split("=")[0] == ours for ours in _OURS):
            raise StudyError(f"arguments: {word}: the study gives it itself")
    return [str(word) for word in arguments]


def _pieces(mapping):
    if mapping is None:
        return None
    take(mapping, "pieces", {"seconds": float, "lead_in_s": float}, required=("seconds",))
    found = {**_PIECES, **mapping}
    if found["seconds"] < 1 or found["lead_in_s"] < 0:
        raise StudyError("pieces: expected seconds >= 1 and lead_in_s >= 0")
    return found


def _check_gates(gates):
    try:
        parse_gates(gates)
    except GateError as error:
        raise StudyError(str(error)) from None


def _limits(mapping):
    limits = {**_LIMITS, **take(mapping, "limits", {key: float for key in _LIMITS})}
    for key, value in limits.items():
        if value <= 0:
            raise StudyError(f"limits: {key}: {value}, expected more than 0")
    return limits


def _settings(study):
    """Returns what every job is told beside its units."""
    task = study["task"]
    label = task
    if task == "calibrate":
        kind = study.get("calibrate", "mount")
        if kind not in _CALIBRATIONS:
            raise StudyError(f"calibrate: {kind}, expected {', '.join(_CALIBRATIONS)}")
        label = f"calibrate {kind}"
    if task == "simulate":
        kind = study["simulate"]["kind"]
        label = "land" if kind == "landing" else kind
    return {"task": task, "label": label, "limits": _limits(study.get("limits", {})),
            "arguments": _check_arguments(study.get("arguments", []))}


def _recordings(study, base):
    """Returns (recordings, words by which the command prints the options)."""
    task = study["task"]
    if task == "simulate":
        if "simulate" not in study:
            raise StudyError("'simulate' is missing: kind, scenario, seeds")
        simulation = study["simulate"] = monte_carlo.read_simulation(study["simulate"])
        flights = Flights(functools.partial(monte_carlo.simulated_flight, simulation),
                          simulation["seeds"])
        return flights, monte_carlo.print_words(simulation)
    if not study.get("recordings"):
        raise StudyError("'recordings' is missing: folders, globs, files or URLs")
    for entry in study["recordings"]:
        if isinstance(entry, dict):
            take(entry, "recordings", {"path": str, "name": str}, required=("path",))
        elif not isinstance(entry, str):
            raise StudyError(f"recordings: {entry!r}, expected a path, a glob or a URL")
    return find_recordings(study["recordings"], base), ["config"]


def _expand(study, base, settings):
    """Returns (recordings, configurations)."""
    if study["task"] == "nothing":  # what the engine itself costs
        return (Flights(_nothing, range(1, study.get("units", 1000) + 1)),
                [Configuration("nothing", "", "", "")])
    recordings, print_command = _recordings(study, base)
    context = {"command": os.environ.get("KESTREL_COMMAND", "kestrel"), "base": base,
               "settings": dict(map(parse_setting, settings)), "print_command": print_command}
    configurations = read_configurations(study.get("configurations"), context)
    if study["task"] == "simulate":
        _share_simulator(study["simulate"], configurations[0])
    return recordings, configurations


def _nothing(seed):
    return Recording(f"nothing {seed:06d}", "", {"kind": "nothing", "seed": seed})


def _share_simulator(simulation, configuration):
    """All configurations see the flights of one simulator: that of the first."""
    try:
        output_of(configuration.command, *monte_carlo.check_words(simulation))
    except StudyError as error:
        raise StudyError(f"simulate: {error}") from None
    simulation.update(command=configuration.command, version=configuration.version)


def read_plan(path, settings=()):
    """Returns the plan of a file STUDY.yaml.

    settings: words `key=value` for all configurations. Relative paths are seen from the file's
    folder. Raises StudyError, before anything is started, for whatever is wrong in it.
    """
    try:
        study, text = _load(path)
        if study["task"] not in TASKS:
            raise StudyError(f"task: {study['task']}, expected {', '.join(TASKS[:-1])}")
        recordings, configurations = _expand(study, str(Path(path).parent), settings)
        shared = _settings(study)
        pieces = _pieces(study.get("pieces"))
        if pieces and study["task"] == "calibrate":
            raise StudyError("pieces: a calibration is of a whole recording")
        _check_gates(study.get("gates", []))
        workers = study.get("workers")
        if workers is not None and workers < 1:
            raise StudyError(f"workers: {workers}, expected 1 or more")
    except StudyError as error:
        message = str(error)
        raise error if message.startswith(str(path)) else StudyError(f"{path}: {message}") from None
    return Plan(study["task"], recordings, configurations, shared, pieces,
                study.get("where", "local"), workers,
                study.get("output", Path(path).stem + "_study"), text)
