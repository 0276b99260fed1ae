# SPDX-License-Identifier: BSD-3-Clause
"""The parts of a report below its verdict."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from .comparison import ALPHA, MEASURES, Change, Comparison, FrameRun
from .pages import Section, Table
from .reported_study import Study
from .results import Column, Variant
from .statistics import Effect, Sums, effects, interval
from .words import MINUS, bin_label, number, place, signed, title

_WORST_FRAMES = 8  # of a kind
_FAILURES = 50
# Values that calibrations estimate: (name of the value, of its standard deviation, words).
_CALIBRATED = (
    ("roll_deg", "roll_sigma_deg", "roll of the mount, degrees"),
    ("pitch_deg", "pitch_sigma_deg", "pitch of the mount, degrees"),
    ("yaw_deg", "yaw_sigma_deg", "yaw of the mount, degrees"),
    ("clock_offset_s", "clock_sigma_s", "clock offset, s"),
    ("fu_px", "focal_sigma_px", "focal length u, px"),
    ("fv_px", "focal_sigma_px", "focal length v, px"),
    ("cu_px", "cu_sigma_px", "principal point u, px"),
    ("cv_px", "cv_sigma_px", "principal point v, px"))


def sections(study: Study, effects_of: dict[str, list[Effect]]) -> list[Section]:
    """Returns the parts of the report. effects_of: what `disturbance_effects` returns."""
    parts: list[Section] = []
    for comparison, suffix in zip(study.comparisons, suffixes(study)):
        if not comparison.is_single:
            parts += _comparison(study, comparison, suffix)
    parts += _configurations(study) + _calibrations(study) + _misses(study)
    parts += _probability(study)
    return parts + _disturbances(effects_of) + _worst(study) + _failures(study)


def suffixes(study: Study) -> list[str]:
    """Returns what the names of the files of each comparison end with."""
    count = len(study.comparisons)
    return [""] if count == 1 else [f"_{number}" for number in range(1, count + 1)]


_VALUES = ["value", "images", "recordings", "before", "after", "change", "95 % interval", "p",
           "verdict"]


def _comparison(study: Study, comparison: Comparison, suffix: str) -> list[Section]:
    pair = f"{study.name(comparison.before)} -> {study.name(comparison.after)}"
    significant = comparison.of("worse") + comparison.of("better")
    changed = [Table(f"changed{suffix}", _VALUES, [_change_row(one) for one in significant])]
    heading = "What changed" if significant else \
        "Nothing significant" if comparison.is_enough else "Not judged"
    parts = [Section(f"{heading}: {pair}",
                     _how(study, comparison), changed if significant else [],
                     f"changes{suffix}.png")]
    frames = _frame_tables(comparison, suffix)
    if frames:
        parts.append(Section(
            f"Frames: {pair}", "Images in a row that one found and the other did not, the longest "
            "first, of the recordings that changed most.", frames))
    return [*parts, Section(f"All values: {pair}", "", [Table(
        f"values{suffix}", _VALUES, [_change_row(one) for one in comparison.changes], True)])]


def _how(study: Study, comparison: Comparison) -> str:
    how = "the same recordings, compared with each other" if comparison.paired else \
        "different recordings: two groups of flights"
    left = f"; {comparison.left_out} are in one of the two only and left out" \
        if comparison.left_out else ""
    hunt = " Of a hunt each object in view counts as an image." \
        if comparison.after.task == "hunt" else ""
    return (f"{comparison.recordings} recordings: {how}{left}.{hunt} Intervals are of each value "
            "alone; p is the probability that chance makes a difference as large anywhere in the table, "
            f"and below {ALPHA / len(study.comparisons):g} is significant.")


def _change_row(one: Change) -> list[str]:
    measure = one.column.measure
    words = (f"{signed(one.low, measure)} to {signed(one.high, measure)}")
    unit = MEASURES[measure].unit
    return [title(one.column) + (f", {unit}" if unit else ""), place(one.column),
            str(one.recordings), number(one.before, measure), number(one.after, measure),
            signed(one.difference, measure), words, "-" if np.isnan(one.p) else f"{one.p:.4f}",
            one.verdict]


def _frame_tables(comparison: Comparison, suffix: str) -> list[Table]:
    tables = []
    changed = sorted(((name, *counts) for name, counts in comparison.shares.items()
                      if counts[0] != counts[1]), key=lambda row: (row[2] - row[1], row[0]))
    if changed:
        tables.append(Table(
            f"recordings{suffix}", ["recording", "found before", "found after", "change", "images"],
            [[name, f"{before:g}", f"{after:g}", f"{after - before:+g}".replace("-", MINUS),
              f"{images:g}"] for name, before, after, images in changed], len(changed) > 12))
    for word, runs in (("lost", comparison.lost), ("won", comparison.won)):
        if runs:
            tables.append(Table(f"{word}{suffix}", [f"{word} in", "frames", "images"],
                                [[run.recording, _frames(run), str(run.count)] for run in runs]))
    return tables


def _frames(run: FrameRun) -> str:
    return run.first if run.count == 1 else f"{run.first} to {run.last}"


def values_of(study: Study, variant: Variant,
              measures: Iterable[str]) -> list[tuple[Column, float, float, float]]:
    """Returns (column, value, low, high) of measures, with the 95 % intervals."""
    cells = study.results.cells(variant)
    columns = cells.columns(measures)
    sums = cells.sums(columns, cells.recordings)
    low, high = interval(sums, study.seed)
    return [(column, float(value), float(low[place]), float(high[place]))
            for place, (column, value) in enumerate(zip(columns, sums.quotients()))]


def _configurations(study: Study) -> list[Section]:
    rows = []
    for variant in study.variants:
        for column, value, low, high in values_of(study, variant, MEASURES):
            measure = column.measure
            unit = MEASURES[measure].unit
            rows.append([study.name(variant), title(column) + (f", {unit}" if unit else ""),
                         place(column), number(value, measure),
                         f"{number(low, measure)} to {number(high, measure)}"])
    if not rows:
        return []
    return [Section("Each configuration", "Values with their 95 % intervals (bootstrap over "
                    "recordings).", [Table("configurations", [
                        "configuration", "value", "images", "value of all", "95 % interval"], rows,
                        len(rows) > 12)], "found.png")]


def _calibrations(study: Study) -> list[Section]:
    rows = []
    for variant in study.variants:
        for name, sigma_name, words in _CALIBRATED:
            sigmas = study.results.summary(variant, sigma_name)
            found = study.results.summary(variant, name)
            values = np.array([found[recording] for recording in sigmas])
            if values.size:
                spread = f"{values.std(ddof=1):.4g}" if values.size > 1 else "-"
                rows.append([study.name(variant), words, str(values.size), f"{values.mean():.5g}",
                             spread, f"{np.mean(list(sigmas.values())):.2g}"])
    if not rows:
        return []
    return [Section("Calibrations", "A camera that nobody has touched has the same values in every "
                    "recording: their spread is how far one calibration may be off. It should be "
                    "about the standard deviation that the calibrations state.", [Table(
                        "calibrations", ["configuration", "value", "recordings", "mean", "spread",
                                         "stated"], rows)])]


def _misses(study: Study) -> list[Section]:
    rows = []
    for variant in study.variants:
        names = ("has_truth", "in_view", "missed", "missed_seen", "unjudged", "images")
        values = {name: study.results.summary(variant, name) for name in names}
        without = [name for name, truth in values["has_truth"].items() if truth == 0
                   and name in values["in_view"]]
        if not without:
            continue
        seen, missed, sure, unjudged, images = (
            np.array([values[name].get(one, 0.0) for one in without]) for name in names[1:])
        rows.append([study.name(variant), str(len(without)), f"{images.sum():g}", f"{seen.sum():g}",
                     f"{missed.sum():g}", f"{sure.sum():g}", _share(missed, seen, study.seed),
                     f"{unjudged.sum():g}"])
    if not rows:
        return []
    return [Section(
        "Misses in recordings without truth", "Estimated: images in which the trajectory, smoothed "
        "from both directions of time, has the pad in view (of a hunt: the places of all "
        "detections have an object), and it was not found. 'Seen by the search' are surely "
        "missed. What neither run nor search ever saw of a flight is not in it.",
        [Table("misses", ["configuration", "recordings", "images", "in view", "missed",
                          "seen by the search", "missed, % with 95 % interval", "not judged"],
               rows)])]


def _share(part: Any, whole: Any, seed: int) -> str:
    sums = Sums(part[:, None], whole[:, None])
    low, high = interval(sums, seed)
    return f"{100 * sums.quotients()[0]:.1f} ({100 * low[0]:.1f} to {100 * high[0]:.1f})"


def _probability(study: Study) -> list[Section]:
    rows = []
    for variant in study.variants:
        values = {column: row for column, *row in values_of(study, variant, ("right", "said"))}
        for column, (right, low, high) in values.items():
            if column.measure != "right":
                continue
            said = values.get(replace(column, measure="said"))
            if said is not None:
                rows.append([study.name(variant), "truth" if column.has_truth else "the search",
                             bin_label(column), f"{100 * said[0]:.1f}", f"{100 * right:.1f}",
                             f"{100 * low:.1f} to {100 * high:.1f}"])
    if not rows:
        return []
    return [Section("Probability: what is said and what is right", "Of all detections; by truth, "
                    "or where there is none by the search.", [Table("probability", [
                        "configuration", "by", "said", "said, mean, %", "right, %",
                        "95 % interval, %"], rows)])]


def _disturbances(effects_of: dict[str, list[Effect]]) -> list[Section]:
    rows = [[effect.name, MEASURES[measure].title, *(f"{value:.3g}" for value in effect.values),
             f"{signed(effect.at_minus, measure)} ({signed(effect.minus_low, measure)} to "
             f"{signed(effect.minus_high, measure)})",
             f"{signed(effect.at_plus, measure)} ({signed(effect.plus_low, measure)} to "
             f"{signed(effect.plus_high, measure)})", MEASURES[measure].unit]
            for measure, found in effects_of.items() for effect in found]
    if not rows:
        return []
    return [Section("What each disturbance costs", "Change of the outcome when one disturbance "
                    "goes from the middle of what was drawn to its low and its high value, and all "
                    "others stay: three standard deviations below and above the middle, or as far "
                    "as it was drawn. Pale: the interval holds zero, so that it may cost nothing. "
                    "All configurations together.", [Table("disturbances", [
                        "disturbance", "of", "low", "middle", "high",
                        "change at low (95 % interval)", "change at high (95 % interval)",
                        "unit"], rows)], "disturbances.png")]


def disturbance_effects(study: Study) -> dict[str, list[Effect]]:
    """Returns by outcome what each drawn value does to it, the dearest first."""
    names = sorted({name for variant in study.variants
                    for name in study.results.summary_names(variant, "draw.")})
    found = {}
    for measure in ("touchdown_m", "landed", "landing_s") if names else ():
        drawn, outcome = [], []
        for variant in study.variants:
            values = [study.results.summary(variant, name) for name in names]
            for recording, value in study.results.summary(variant, measure).items():
                if all(recording in one for one in values):
                    drawn.append([one[recording] for one in values])
                    outcome.append(value)
        if outcome and np.ptp(outcome) > 0:
            found[measure] = effects([name[len("draw."):] for name in names], np.array(drawn),
                                     np.array(outcome), study.seed)
    return found


def _worst(study: Study) -> list[Section]:
    words = {"false": "false detection, said", "missed": "missed, from a height of, m",
             "error_m": "error, m"}
    rows = [[study.name(variant), words.get(what, what), "-" if value is None else f"{value:.3g}",
             recording, frame]
            for variant in study.variants
            for recording, frame, what, value in study.results.worst(variant, _WORST_FRAMES)]
    if not rows:
        return []
    return [Section("Worst frames", "", [Table("worst", [
        "configuration", "what", "value", "recording", "frame"], rows, len(rows) > 12)])]


def _failures(study: Study) -> list[Section]:
    failures = study.results.failures()
    if not failures:
        return []
    rows = [[study.name(one.variant), one.recording, one.reason] for one in failures[:_FAILURES]]
    return [Section("Units that failed", f"{len(failures)} in all.", [
        Table("failed", ["configuration", "recording", "reason"], rows)])]
