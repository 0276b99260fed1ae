# SPDX-License-Identifier: BSD-3-Clause
"""The changes from one variant to another, better and worse, by bin and by frame."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from .results import Cells, Column, Results, Variant
from .statistics import Differences, compare

ALPHA = 0.02  # probability that a comparison of two equal things shows a difference anywhere
_RIGHT_NEES = 3.0
_OF_FOUND = ("error_m", "nees")  # measures of what was found
_SLOWER = 0.05  # of the time: less is the computer's own unrest
_MIN_RECORDINGS = 8  # with fewer, chance alone is never rarer than ALPHA


@dataclass(frozen=True)
class Measure:
    """A value that is compared.

    good: 1 where more is better, -1 where less is, 0 where what is nearest to the right value is.
    scale: of the value as it is printed.
    """

    title: str
    unit: str
    good: int
    scale: float = 1.0
    decimals: int = 2


MEASURES = {
    "found": Measure("found", "%", 1, 100.0, 1),
    "false": Measure("false detections for 100 images with the pad in view", "", -1, 100.0, 2),
    "error_m": Measure("position error, mean", "m", -1, 1.0, 3),
    "nees": Measure("NEES, mean (3 is right)", "", 0),
    "frame_ms": Measure("time of the detection, median of an image", "ms", -1),
    "class_right": Measure("class right, of the objects found", "%", 1, 100.0, 1),
    "rms_after_m": Measure("residual of the calibration, RMS", "m", -1, 1.0, 3),
    "residual_px": Measure("residual of the lens, RMS", "px", -1, 1.0, 3),
    "landed": Measure("landed", "%", 1, 100.0, 1),
    "touchdown_m": Measure("distance from the centre at touchdown", "m", -1, 1.0, 3),
    "landing_s": Measure("time to the touchdown", "s", -1, 1.0, 1),
}
QUANTITIES = {"all": "all images", "altitude_m": "altitude, m", "tilt_deg": "tilt, degrees",
              "visible_fraction": "part in view", "light": "light, mean gray level",
              "speed_mps": "speed of the pad, m/s"}


@dataclass
class Change:
    """A column of a comparison.

    verdict: 'better', 'worse', 'no difference', 'too few' (recordings), or 'other images': what was
    found differs significantly, so that errors of what was found are of other images.
    """

    column: Column
    recordings: int
    before: float
    after: float
    low: float
    high: float
    p: float
    verdict: str

    @property
    def difference(self) -> float:
        return self.after - self.before


@dataclass
class FrameRun:
    """Images in a row that one variant found and the other did not."""

    recording: str
    first: str
    last: str
    count: int


@dataclass
class Comparison:
    """Two variants: values, recordings and frames.

    is_single: both are the same, as a study of one variant has no other. lost, won: images that
    only before, or only after, were found in; at most so many runs as asked. shares: by recording
    (images found before, found after, images).
    """

    before: Variant
    after: Variant
    paired: bool
    recordings: int
    left_out: int
    changes: list[Change]
    is_single: bool = False
    shares: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    lost: list[FrameRun] = field(default_factory=list)
    won: list[FrameRun] = field(default_factory=list)

    def of(self, verdict: str) -> list[Change]:
        """Returns the changes of a verdict: of what was found first, of all images first, the
        largest first."""
        measures = list(MEASURES)
        return sorted((one for one in self.changes if one.verdict == verdict),
                      key=lambda one: (measures.index(one.column.measure),
                                       one.column.quantity != "all", -abs(one.difference),
                                       one.column))

    @property
    def is_enough(self) -> bool:
        """Returns whether there are enough recordings to tell a difference from chance."""
        return self.recordings >= _MIN_RECORDINGS

    @property
    def too_few(self) -> str:
        """Returns why it is not judged, in words."""
        some = "1 recording" if self.recordings == 1 else f"{self.recordings} recordings"
        return f"{some}, {_MIN_RECORDINGS} are the least"


def compare_variants(before: tuple[Results, Variant], after: tuple[Results, Variant], seed: int,
                     comparisons: int = 1, frame_runs: int = 20) -> Comparison:
    """Compares two variants, of one study or of two.

    Recordings that both have are compared with each other; where there are none, the two are taken
    for different flights. comparisons: so many share the probability of a wrong verdict.
    """
    names = [results.recordings(variant) for results, variant in (before, after)]
    both = sorted(set(names[0]) & set(names[1]))
    paired = bool(both)
    used = [both, both] if paired else names
    cells = [results.cells(variant) for results, variant in (before, after)]
    columns = sorted(set(cells[0].columns(MEASURES)) & set(cells[1].columns(MEASURES)))
    changes: list[Change] = []
    for family in _families(columns):
        sums = [cells[side].sums(family, used[side]) for side in (0, 1)]
        differences = compare(sums[0], sums[1], paired, seed)
        having = np.minimum(*((each.denominator > 0).sum(axis=0) for each in sums))
        changes += [_change(column, differences, place, int(having[place]), ALPHA / comparisons)
                    for place, column in enumerate(family)]
    _set_apart_other_images(changes)
    comparison = Comparison(before[1], after[1], paired,
                            len(both) if paired else min(map(len, names)),
                            len(set(names[0]) ^ set(names[1])) if paired else 0, changes,
                            before == after)
    if paired and not comparison.is_single:
        _compare_frames(comparison, before, after, cells, both, frame_runs)
    return comparison


def _families(columns: list[Column]) -> list[list[Column]]:
    """The values of all images, and those of the bins: each has half of the probability of a wrong
    verdict, so that the many bins do not hide a difference of the whole."""
    whole = [column for column in columns if column.quantity == "all"]
    return [whole, [column for column in columns if column not in whole]]


def _change(column: Column, differences: Differences, place: int, recordings: int,
            alpha: float) -> Change:
    before, after, low, high, p = (
        float(part[place]) for part in (differences.before, differences.after, differences.low,
                                        differences.high, np.minimum(1, 2 * differences.p)))
    return Change(column, recordings, before, after, low, high, p,
                  _verdict(column.measure, before, after, p, alpha))


def _set_apart_other_images(changes: list[Change]) -> None:
    """An error is smaller where only near pads are found: that is no gain."""
    differs = {one.column for one in changes
               if one.column.measure == "found" and one.verdict in ("better", "worse")}
    for one in changes:
        if one.column.measure in _OF_FOUND and replace(one.column, measure="found") in differs:
            one.verdict = "other images"


def _verdict(measure: str, before: float, after: float, p: float, alpha: float) -> str:
    if np.isnan(p):
        return "too few"
    if p >= alpha or (measure == "frame_ms" and abs(after - before) < _SLOWER * before):
        return "no difference"
    good = MEASURES[measure].good
    gain = good * (after - before) if good else _off(before) - _off(after)
    return "better" if gain > 0 else "worse"


def _off(nees: float) -> float:
    """Returns the distance of the mean NEES from the right one, as a factor."""
    return abs(float(np.log(max(nees, 1e-9) / _RIGHT_NEES)))


def _compare_frames(comparison: Comparison, before: tuple[Results, Variant],
                    after: tuple[Results, Variant], cells: list[Cells], names: list[str],
                    count: int) -> None:
    """Names the images that differ, of the recordings that changed most."""
    columns = [Column("found", has_truth) for has_truth in (True, False)]
    for name in names:
        found = [sum(side.value(column, name)[0] for column in columns) for side in cells]
        images = sum(cells[0].value(column, name)[1] for column in columns)
        comparison.shares[name] = (found[0], found[1], images)
    by_loss = sorted(names, key=lambda name: (comparison.shares[name][1]
                                              - comparison.shares[name][0], name))
    for name in by_loss[:count]:
        comparison.lost += _runs(name, before, after)
    for name in by_loss[::-1][:count]:
        comparison.won += _runs(name, after, before)
    for runs in (comparison.lost, comparison.won):
        runs.sort(key=lambda run: (-run.count, run.recording, run.first))
        del runs[count:]


def _runs(recording: str, one: tuple[Results, Variant],
          other: tuple[Results, Variant]) -> list[FrameRun]:
    """Images in a row of which `one` found more than `other`."""
    mine, theirs = (results.detections(variant, recording) for results, variant in (one, other))
    runs: list[FrameRun] = []
    is_open = False
    for time in sorted(set(mine) | set(theirs)):
        frame, found, _ = mine.get(time, ("", 0, 0))
        if found <= theirs.get(time, ("", 0, 0))[1]:
            is_open = False
            continue
        if is_open:
            runs[-1].last, runs[-1].count = frame, runs[-1].count + 1
        else:
            runs.append(FrameRun(recording, frame, frame, 1))
        is_open = True
    return runs
