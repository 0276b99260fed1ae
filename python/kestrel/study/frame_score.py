# SPDX-License-Identifier: BSD-3-Clause
"""The outcome of one image, or of one object in it, and the rows that sum many outcomes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any, Iterable

Row = dict[str, Any]

INFINITY = math.inf
# Edges of the bins: lower <= value < upper. Those of altitude, tilt and the part in view are those
# of `kestrel evaluate`.
EDGES: dict[str, list[float]] = {
    "altitude_m": [0, 2, 6, 9, 14, INFINITY],
    "tilt_deg": [0, 10, 20, 30, INFINITY],
    "visible_fraction": [0, 0.25, 0.5, 0.75, 0.999, INFINITY],
    "light": [0, 40, 80, 120, 160, INFINITY],
    "speed_mps": [0, 0.5, 2, 5, 10, INFINITY],
    "quality": [0, 0.7, 0.8, 0.9, 0.95, 0.99, INFINITY],
}
_WORST_OF_A_KIND = 4


@dataclass
class FrameScore:
    """One image of a landing, or one sighting or detection of an object of a hunt.

    asked: a pad or an object is so well in view that it should be found; found: it was; false:
    something else was detected. error_m, nees and quality are those of a detection. where: values
    of the quantities of EDGES, as far as they are known.
    """

    time_ns: int
    frame: str
    asked: bool = False
    found: bool = False
    false: bool = False
    error_m: float | None = None
    nees: float | None = None
    quality: float | None = None
    where: dict[str, float] = field(default_factory=dict)


@dataclass
class _Bin:
    frames: int = 0
    found: int = 0
    false: int = 0
    error_sum: float = 0
    error_squares: float = 0
    nees_sum: float = 0
    nees_count: int = 0
    quality_sum: float = 0

    def add(self, score: FrameScore) -> None:
        self.frames += score.asked
        self.found += score.asked and score.found
        self.false += score.false
        if score.asked and score.found and score.error_m is not None:
            self.error_sum += score.error_m
            self.error_squares += score.error_m**2
        if score.found and score.nees is not None:
            self.nees_sum += score.nees
            self.nees_count += 1
        self.quality_sum += score.quality or 0


def bins(scores: Iterable[FrameScore]) -> list[Row]:
    """Returns the rows of the table `bin`: one for all images, one for each bin that has any.

    In the bins of `visible_fraction` every image that shows a part of the pad counts, as its first
    bin is what is hardly in view. In those of `quality` the detections count, `found` those that
    are right.
    """
    tallies: dict[tuple[str, float, float], _Bin] = {}
    for score in scores:
        tallies.setdefault(("all", -INFINITY, INFINITY), _Bin()).add(score)
        for quantity, value in _counted(score):
            low, high = _edges_around(quantity, value)
            tallies.setdefault((quantity, low, high), _Bin()).add(_as_counted(score, quantity))
    return [{"quantity": quantity, "lower": low, "upper": high, **vars(tally)}
            for (quantity, low, high), tally in sorted(tallies.items())]


def _counted(score: FrameScore) -> list[tuple[str, float]]:
    places = list(score.where.items())
    if not score.asked:
        places = [(name, value) for name, value in places
                  if name == "visible_fraction" and value > 0]
    if score.quality is not None and (score.found or score.false):
        places.append(("quality", score.quality))
    return places


def _as_counted(score: FrameScore, quantity: str) -> FrameScore:
    if score.asked or quantity not in ("visible_fraction", "quality"):
        return score
    return replace(score, asked=True)


def _edges_around(quantity: str, value: float) -> tuple[float, float]:
    edges = EDGES[quantity]
    last = max(index for index, edge in enumerate(edges[:-1])
               if value >= edge or index == 0)
    return edges[last], edges[last + 1]


def detections(scores: Iterable[FrameScore]) -> list[Row]:
    """Returns the rows of the table `detection`: one for each image in which something was to be
    found or was detected, with how many were found and how many are false."""
    rows: dict[int, Row] = {}
    for score in scores:
        if not (score.asked or score.found or score.false):
            continue
        row = rows.setdefault(score.time_ns, {"time_ns": score.time_ns, "frame": score.frame,
                                              "found": 0, "false": 0, "error_m": None})
        row["found"] += score.found
        row["false"] += score.false
        if score.error_m is not None:
            row["error_m"] = max(score.error_m, row["error_m"] or 0)
    return [rows[time] for time in sorted(rows)]


def worst(scores: list[FrameScore]) -> list[Row]:
    """Returns the rows of the table `worst`, the worst first: false detections by their quality,
    misses by how near the pad was, errors by their size."""
    false = sorted((s for s in scores if s.false), key=lambda s: (-(s.quality or 0), s.time_ns))
    missed = sorted((s for s in scores if s.asked and not s.found),
                    key=lambda s: (s.where.get("altitude_m", INFINITY), s.time_ns))
    wrong = sorted((s for s in scores if s.found and s.error_m is not None),
                   key=lambda s: (-(s.error_m or 0), s.time_ns))
    chosen = [("false", s, s.quality) for s in false[:_WORST_OF_A_KIND]]
    chosen += [("missed", s, s.where.get("altitude_m")) for s in missed[:_WORST_OF_A_KIND]]
    chosen += [("error_m", s, s.error_m) for s in wrong[:_WORST_OF_A_KIND]]
    return [{"rank": rank, "time_ns": s.time_ns, "frame": s.frame, "what": what, "value": value}
            for rank, (what, s, value) in enumerate(chosen, 1)]
