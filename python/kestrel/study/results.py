# SPDX-License-Identifier: BSD-3-Clause
"""The results of a study as a report reads them: by variant and recording."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .statistics import Sums
from .store import DATABASE

# Summary values of a recording that are compared, one a recording.
_OUTCOMES = ("class_right", "rms_after_m", "residual_px", "landed", "touchdown_m", "landing_s")


class ResultsError(ValueError):
    """Results that are not there or do not fit; the message is one line."""


@dataclass(frozen=True)
class Variant:
    """A configuration that was run by a version: the unit of comparison."""

    configuration: str
    version: str
    task: str


@dataclass(frozen=True, order=True)
class Column:
    """A value that is compared: a measure in a bin of a quantity.

    has_truth: the measure is truth; else the search of `truthless`.
    """

    measure: str
    has_truth: bool = True
    quantity: str = "all"
    lower: float = -np.inf
    upper: float = np.inf


class Cells:
    """Numerators and denominators of values, of a variant, by column and recording."""

    def __init__(self, recordings: list[str]) -> None:
        self.recordings = recordings
        self._rows = {name: row for row, name in enumerate(recordings)}
        self._sums: dict[Column, NDArray[np.float64]] = {}  # (2, recordings)

    def columns(self, measures: Iterable[str]) -> list[Column]:
        """Returns the columns of some measures, in order."""
        return sorted(column for column in self._sums if column.measure in set(measures))

    def add(self, column: Column, recording: str, numerator: float, denominator: float) -> None:
        """Adds to a value; nothing where the denominator is zero."""
        if denominator > 0:
            sums = self._sums.setdefault(column, np.zeros((2, len(self.recordings))))
            sums[:, self._rows[recording]] += numerator, denominator

    def value(self, column: Column, recording: str) -> tuple[float, float]:
        """Returns (numerator, denominator); zeros where there is no value."""
        if column not in self._sums:
            return 0.0, 0.0
        numerator, denominator = self._sums[column][:, self._rows[recording]]
        return float(numerator), float(denominator)

    def sums(self, columns: list[Column], recordings: list[str]) -> Sums:
        """Returns the sums of columns (values) over recordings (rows)."""
        rows = [self._rows[name] for name in recordings]
        numbers = np.zeros((2, len(rows), len(columns)))
        for place, column in enumerate(columns):
            numbers[:, :, place] = self._sums[column][:, rows]
        return Sums(numbers[0], numbers[1])


@dataclass
class Failure:
    """A unit that failed."""

    variant: Variant
    recording: str
    reason: str


class Results:
    """The database of a study, for reading.

    Raises ResultsError where there is none.
    """

    def __init__(self, folder: str | Path) -> None:
        path = Path(folder) / DATABASE
        if not path.is_file():
            raise ResultsError(f"{path}: not there; expected a folder of `kestrel study run`")
        self.folder = Path(folder)
        self._connection = sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)
        try:
            self._connection.execute("SELECT 1 FROM unit").fetchone()
        except sqlite3.Error as error:
            raise ResultsError(f"{path}: {error}") from None

    def variants(self) -> list[Variant]:
        """Returns what was run, in the order of the plan."""
        return [Variant(*row) for row in self._rows(
            "SELECT configuration, unit.version, unit.task FROM unit "
            "LEFT JOIN configuration AS plan ON name = configuration "
            "AND plan.version = unit.version AND plan.task = unit.task "
            "WHERE state IN ('done', 'failed') GROUP BY 1, 2, 3 "
            "ORDER BY min(place) IS NULL, min(place), 1, 2, 3")]

    def recordings(self, variant: Variant) -> list[str]:
        """Returns the names of the recordings that are done, in order."""
        return [row[0] for row in self._of(
            variant, "SELECT DISTINCT recording FROM unit WHERE {unit} AND state='done' "
                     "ORDER BY recording")]

    def frames(self, variant: Variant) -> int:
        """Returns the number of images that were processed."""
        rows = self._of(variant, "SELECT coalesce(sum(frames), 0) FROM unit WHERE {unit}")
        return int(next(rows)[0])

    def failures(self) -> list[Failure]:
        """Returns the units that failed, in order."""
        return [Failure(Variant(*row[:3]), row[3], row[4] or "no reason was given")
                for row in self._rows(
                    "SELECT configuration, version, task, recording, reason FROM unit "
                    "WHERE state='failed' ORDER BY configuration, version, recording, piece")]

    def cells(self, variant: Variant) -> Cells:
        """Returns the values of all columns, by recording."""
        cells = Cells(self.recordings(variant))
        add = cells.add
        for recording, truth, quantity, low, high, *sums in self._of(variant, _BINS):
            frames, found, false, error_sum, nees_sum, nees_count, quality_sum = sums
            place = (bool(truth), quantity, low, high)
            if quantity == "quality":
                add(Column("right", *place), recording, found, frames)
                add(Column("said", *place), recording, quality_sum, frames)
                continue
            add(Column("found", *place), recording, found, frames)
            add(Column("false", *place), recording, false, frames)
            add(Column("error_m", *place), recording, error_sum, found)
            add(Column("nees", *place), recording, nees_sum, nees_count)
        for recording, frame_ms in self._of(variant, _TIMES):
            add(Column("frame_ms"), recording, frame_ms, 1)
        for recording, name, value in self._of(variant, _SUMMARIES):
            add(Column(name), recording, value, 1)
        return cells

    def summary(self, variant: Variant, name: str) -> dict[str, float]:
        """Returns a value of the summaries by recording; pieces of one are added."""
        query = ("SELECT recording, sum(value) FROM unit JOIN summary USING (key) "
                 "WHERE {unit} AND state='done' AND name=? GROUP BY recording")
        return {row[0]: float(row[1]) for row in self._of(variant, query, name)}

    def summary_names(self, variant: Variant, prefix: str) -> list[str]:
        """Returns the names of summary values that begin so."""
        return [row[0] for row in self._of(
            variant, "SELECT DISTINCT name FROM unit JOIN summary USING (key) "
                     "WHERE {unit} AND substr(name, 1, ?) = ? ORDER BY name", len(prefix), prefix)]

    def worst(self, variant: Variant, count: int) -> list[tuple[str, str, str, float]]:
        """Returns (recording, frame, what, value) of the first frames of each kind."""
        found: list[tuple[str, str, str, float]] = []
        for what, order in (("false", "DESC"), ("missed", "ASC"), ("error_m", "DESC")):
            found += [(row[0], row[1], row[2], row[3]) for row in self._of(
                variant, "SELECT recording, frame, what, value FROM unit JOIN worst USING (key) "
                f"WHERE {{unit}} AND what=? ORDER BY value IS NULL, value {order}, recording, "
                "time_ns LIMIT ?", what, count)]
        return found

    def detections(self, variant: Variant, recording: str) -> dict[int, tuple[str, int, int]]:
        """Returns (frame, found, false) by time, of the images with anything to tell."""
        return {time: (frame, found, false) for time, frame, found, false in self._of(
            variant, "SELECT time_ns, frame, found, false FROM unit JOIN detection USING (key) "
                     "WHERE {unit} AND recording=? AND state='done'", recording)}

    def _rows(self, query: str, *values: Any) -> Iterator[tuple[Any, ...]]:
        try:
            yield from self._connection.execute(query, values)
        except sqlite3.Error as error:
            raise ResultsError(f"{self.folder / DATABASE}: {error}") from None

    def _of(self, variant: Variant, query: str, *values: Any) -> Iterator[tuple[Any, ...]]:
        """Rows of one variant: {unit} in the query stands for what names it."""
        unit = "configuration=:configuration AND version=:version AND task=:task"
        named = {"configuration": variant.configuration, "version": variant.version,
                 "task": variant.task}
        for number, value in enumerate(values):
            query = query.replace("?", f":value{number}", 1)
            named[f"value{number}"] = value
        try:
            yield from self._connection.execute(query.format(unit=unit), named)
        except sqlite3.Error as error:
            raise ResultsError(f"{self.folder / DATABASE}: {error}") from None


_BINS = """
SELECT recording, coalesce(truth.value, 1), quantity, lower, upper, sum(bin.frames), sum(found),
  sum(false), sum(error_sum), sum(nees_sum), sum(nees_count), sum(quality_sum)
FROM unit JOIN bin ON bin.key = unit.key
  LEFT JOIN summary AS truth ON truth.key = unit.key AND truth.name = 'has_truth'
WHERE {unit} AND state='done'
GROUP BY recording, 2, quantity, lower, upper"""
_TIMES = """
SELECT recording, avg(frame_ms_median) FROM unit JOIN resource ON resource.key = unit.key
WHERE {unit} AND state='done' AND frame_ms_median IS NOT NULL GROUP BY recording"""
_SUMMARIES = f"""
SELECT recording, name, avg(value) FROM unit JOIN summary ON summary.key = unit.key
WHERE {{unit}} AND state='done' AND name IN {_OUTCOMES}
GROUP BY recording, name"""
