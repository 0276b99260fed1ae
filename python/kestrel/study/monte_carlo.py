# SPDX-License-Identifier: BSD-3-Clause
"""Simulated flights over seeds, with parameters that are drawn from distributions."""
import csv
import hashlib
import re
from pathlib import Path

import numpy as np

from .configurations import settings_of
from .errors import StudyError
from .mappings import take
from .recordings import Recording

KINDS = ("landing", "touchdown", "fly")
_KEYS = {"kind": str, "scenario": str, "seeds": (int, list), "set": dict, "draw": dict,
         "autopilot": str, "guide": bool}
_DRAW_KEYS = {"uniform": list, "normal": list, "choice": list, "keys": list}
_AT_LEAST = {"uniform": 2, "normal": 2, "choice": 1}
_ON_BOARD = re.compile(r"on the board, ([0-9.]+) m from")


def read_simulation(mapping):
    """Returns what `simulate` says, checked. Raises StudyError that names the key."""
    found = {"kind": "landing", "set": {}, "draw": {}, "autopilot": "sim:ardupilot", "guide": False,
             **take(mapping, "simulate", _KEYS, required=("scenario", "seeds"))}
    if found["kind"] not in KINDS:
        raise StudyError(f"simulate: kind: {found['kind']}, expected {', '.join(KINDS)}")
    for name, distribution in found["draw"].items():
        _check_distribution(f"simulate: draw: {name}", distribution)
    found["seeds"] = _seeds(found["seeds"])
    return found


def _check_distribution(where, distribution):
    take(distribution, where, _DRAW_KEYS)
    kinds = [kind for kind in _AT_LEAST if kind in distribution]
    if len(kinds) != 1:
        raise StudyError(f"{where}: expected one of {', '.join(_AT_LEAST)}")
    values = distribution[kinds[0]]
    if kinds[0] == "choice":
        if not values:
            raise StudyError(f"{where}: choice: expected values")
    elif len(values) != 2 or not all(isinstance(value, (int, float)) for value in values):
        words = "[least, most]" if kinds[0] == "uniform" else "[mean, standard deviation]"
        raise StudyError(f"{where}: {kinds[0]}: {values}, expected {words}")


def _seeds(value):
    """Returns the seeds: of a number so many from 1 on, of two numbers all between them."""
    bounds = [1, value] if isinstance(value, int) else value
    if len(bounds) != 2 or not all(isinstance(one, int) for one in bounds) or bounds[0] > bounds[1]:
        raise StudyError(f"simulate: seeds: {value}, expected a number, or [first, last]")
    return range(bounds[0], bounds[1] + 1)


def _draw(name, distribution, seed):
    """Returns a drawn value: each name has random numbers of its own, so that one more name does
    not change the others."""
    entropy = int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "little")
    random = np.random.default_rng([seed, entropy])
    if "uniform" in distribution:
        return round(float(random.uniform(*distribution["uniform"])), 6)
    if "normal" in distribution:
        return round(float(random.normal(*distribution["normal"])), 6)
    return distribution["choice"][int(random.integers(len(distribution["choice"])))]


def simulated_flight(simulation, seed):
    """Returns the flight of a seed as a Recording: its values drawn, and the command's words."""
    drawn, settings = {}, dict(simulation["set"])
    for name, distribution in simulation["draw"].items():
        value = _draw(name, distribution, seed)
        drawn[name] = value
        settings.update({key: value for key in distribution.get("keys", [name])})
    flight = {"kind": simulation["kind"], "scenario": simulation["scenario"], "seed": seed,
              "settings": settings, "drawn": drawn, "autopilot": simulation["autopilot"],
              "guide": simulation["guide"], "command": simulation.get("command"),
              "version": simulation.get("version")}
    scenario = simulation["scenario"].split(",")[0]
    words = " ".join(["kestrel", *command_words(flight)])
    return Recording(f"{scenario} {seed:06d}", words, flight)


def command_words(flight, config=None, output=None):
    """Returns the words after `kestrel` that simulate a flight. config: a file of options;
    output: a folder."""
    seed, scenario = str(flight["seed"]), flight["scenario"]
    if flight["kind"] == "fly":
        words = ["fly", f"sim:{scenario}", "--autopilot", flight["autopilot"]]
        words += ["--guide"] if flight["guide"] else []
        words += ["--set", f"fly.sim_seed={seed}"]
    else:
        words = ["simulate", flight["kind"], "--scenario", scenario, "--seed", seed]
        words += ["--threads", "1"] if flight["kind"] == "landing" else []
    words += ["--config", config] if config else []
    words += settings_of(flight["settings"])
    return words + (["--output", output] if output else [])


def print_words(simulation):
    """Returns the words by which `kestrel` prints the options of the configurations."""
    if simulation["kind"] == "touchdown":
        return ["simulate", "touchdown", "--scenario", simulation["scenario"], "--print-config"]
    return ["config"]


def check_words(simulation):
    """Returns the words by which `kestrel` checks the settings of the first flight."""
    flight = simulated_flight(simulation, simulation["seeds"][0]).simulation
    if simulation["kind"] == "fly":
        return ["config", *settings_of(flight["settings"])]
    return ["simulate", simulation["kind"], "--scenario", simulation["scenario"], "--print-config",
            *settings_of(flight["settings"])]


def drawn_numbers(flight):
    """Returns the drawn values that are numbers as {"draw.NAME": value}."""
    return {f"draw.{name}": float(value) for name, value in flight["drawn"].items()
            if isinstance(value, (int, float))}


def outcome(kind, output, log):
    """Returns how a closed loop ended: {"landed": 0 or 1, "touchdown_m", "seconds", ...}; what is
    not known is left out.

    output: folder that the command wrote. log: what it said.
    """
    if kind == "touchdown":
        return _touchdown_outcome(Path(output) / "touchdown.csv")
    return _flight_outcome(Path(output) / "flight_end.csv", log)


def _flight_outcome(path, log):
    if not path.exists():
        return {"landed": 0.0}  # still in the air when its time was up
    end = _row(path)
    found = {"landed": float(end["end"] == "on pattern")}
    # The simulation's own distance is the truth; that of flight_end.csv is the tracker's.
    on_board = _ON_BOARD.search(log)
    distance = on_board[1] if on_board else end["offset_m"]
    if distance:
        found["touchdown_m"] = float(distance)
    return found


def _row(path):
    with open(path, newline="") as file:
        return next(csv.DictReader(file))


def _touchdown_outcome(path):
    row = _row(path)
    names = {"distance_m": "touchdown_m", "time_s": "landing_s", "first_seen_s": "first_seen_s",
             "slip_mps": "slip_mps", "sink_mps": "sink_mps", "go_arounds": "go_arounds",
             "wind_mps": "wind_mps", "frames": "frames"}
    found = {name: float(row[column]) for column, name in names.items() if row[column]}
    found["landed"] = float(row["outcome"] == "landed")
    return found
