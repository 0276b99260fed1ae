# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a report, by matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .comparison import MEASURES, QUANTITIES, Change
from .results import Column
from .statistics import Effect
from .words import bin_label

_COLORS = ("#35506b", "#d97706", "#15803d", "#9333ea", "#be123c", "#0891b2")
_TONES = {"worse": "#c2410c", "better": "#15803d", "no difference": "#60738a",
          "too few": "#b8c2cc", "other images": "#b8c2cc"}
_MOST_CHANGES = 40

# The bins of a measure by variant: (column, value, low, high).
Values = dict[str, list[tuple[Column, float, float, float]]]


def _figures() -> Any:
    """Returns pyplot without a display; raises ImportError where matplotlib is not there."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot

    return matplotlib.pyplot


def _save(figure: Any, file: Path) -> None:
    figure.savefig(file, dpi=110, metadata={"Software": None})
    _figures().close(figure)


def plot_rates(values: Values, file: Path) -> None:
    """Draws the share of images that were found, with 95 % intervals: by altitude, and by every
    other quantity that there is."""
    quantities = [name for name in QUANTITIES if name != "all" and any(
        column.quantity == name for rows in values.values() for column, *_ in rows)]
    if not quantities:
        return
    plots = _figures()
    columns = min(2, len(quantities))
    rows = -(-len(quantities) // columns)
    figure, axes = plots.subplots(rows, columns, figsize=(5.2 * columns, 3.1 * rows),
                                  squeeze=False, layout="constrained")
    for axis in axes.flat[len(quantities):]:
        axis.axis("off")
    for axis, quantity in zip(axes.flat, quantities):
        _rate_panel(axis, values, quantity)
    axes.flat[0].legend(fontsize=8, loc="lower left")
    _save(figure, file)


def _rate_panel(axis: Any, values: Values, quantity: str) -> None:
    bins = sorted({(column.lower, column.upper) for rows in values.values()
                   for column, *_ in rows if column.quantity == quantity})
    for number, (name, rows) in enumerate(values.items()):
        there = [row for row in rows if row[0].quantity == quantity]
        x = np.array([bins.index((row[0].lower, row[0].upper)) for row in there])
        middle, low, high = (100 * np.array([row[i] for row in there]) for i in (1, 2, 3))
        axis.errorbar(x + 0.12 * (number - (len(values) - 1) / 2), middle,
                      np.abs(np.array([middle - low, high - middle])), fmt="o", capsize=3,
                      markersize=4, color=_COLORS[number % len(_COLORS)], label=name)
    labels = [bin_label(Column("found", True, quantity, *edges)) for edges in bins]
    axis.set_xticks(range(len(bins)), labels, fontsize=8)
    axis.set_xlim(-0.6, len(bins) - 0.4)
    axis.set_xlabel(QUANTITIES[quantity])
    axis.set_ylabel("found, %")
    axis.set_ylim(min(axis.get_ylim()[0], 90), 101)
    axis.grid(axis="y", alpha=0.3)


def plot_changes(changes: Sequence[Change], file: Path) -> None:
    """Draws the changes of what was found, bin by bin, with their 95 % intervals."""
    shown = [one for one in changes if one.column.measure == "found"][:_MOST_CHANGES]
    if not shown:
        return
    figure, axis = _figures().subplots(figsize=(8, 1.3 + 0.26 * len(shown)), layout="constrained")
    for row, one in enumerate(shown):
        middle, low, high = 100 * one.difference, 100 * one.low, 100 * one.high
        axis.plot([low, high], [row, row], color=_TONES[one.verdict], linewidth=2)
        axis.plot(middle, row, "o", color=_TONES[one.verdict], markersize=5)
    axis.axvline(0, color="#1c2733", linewidth=0.8)
    axis.set_yticks(range(len(shown)), [_change_label(one) for one in shown], fontsize=8)
    axis.invert_yaxis()
    axis.set_xlabel("found, after minus before, percentage points (coloured: significant)")
    axis.grid(axis="x", alpha=0.3)
    _save(figure, file)


def _change_label(one: Change) -> str:
    place = QUANTITIES[one.column.quantity]
    if one.column.quantity != "all":
        place += f": {bin_label(one.column)}"
    return place if one.column.has_truth else f"{place} (estimated)"


def plot_effects(effects: dict[str, list[Effect]], file: Path) -> None:
    """Draws what each disturbance costs from minus to plus three standard deviations, the dearest
    first: a panel for each outcome."""
    shown = {name: rows for name, rows in effects.items() if rows}
    if not shown:
        return
    most = max(map(len, shown.values()))
    figure, axes = _figures().subplots(1, len(shown), figsize=(6.2 * len(shown), 1.2 + 0.6 * most),
                                       squeeze=False, layout="constrained")
    for axis, (name, rows) in zip(axes.flat, shown.items()):
        _effect_panel(axis, name, rows)
    _save(figure, file)


def _effect_panel(axis: Any, name: str, rows: list[Effect]) -> None:
    scale = MEASURES[name].scale
    for row, effect in enumerate(rows):
        for value, low, high, color, offset in (
                (effect.at_minus, effect.minus_low, effect.minus_high, _COLORS[0], -0.17),
                (effect.at_plus, effect.plus_low, effect.plus_high, _COLORS[1], 0.17)):
            axis.barh(row + offset, scale * value, 0.3, color=color,
                      alpha=0.3 if low <= 0 <= high else 1)
            axis.plot([scale * low, scale * high], [row + offset] * 2, color="#1c2733",
                      linewidth=1)
    axis.axvline(0, color="#1c2733", linewidth=0.8)
    axis.set_yticks(range(len(rows)), [_effect_label(effect) for effect in rows], fontsize=8)
    axis.invert_yaxis()
    axis.set_xlabel(f"change of: {MEASURES[name].title}, {MEASURES[name].unit}")
    axis.grid(axis="x", alpha=0.3)


def _effect_label(effect: Effect) -> str:
    low, middle, high = (f"{value:.3g}" for value in effect.values)
    return f"{effect.name}\n{middle} to {low} (blue), to {high} (orange)"
