# SPDX-License-Identifier: BSD-3-Clause
"""The verdict of a comparison, in one line."""

from __future__ import annotations

from .comparison import MEASURES, Change, Comparison
from .reported_study import Study
from .words import number, place, signed, title

_NAMED_BINS = 4
_MAIN = ("found", "landed", "rms_after_m", "residual_px")
_TELLING = 1.25  # times the change of all images


def verdict(study: Study, comparison: Comparison) -> tuple[str, str]:
    """Returns ('worse', 'better' or '', one line)."""
    after = study.name(comparison.after)
    if comparison.is_single:
        return "", f"{after}: {_overview(comparison)}"
    pair = f"{study.name(comparison.before)} -> {after}"
    worse, better = comparison.of("worse"), comparison.of("better")
    if not comparison.is_enough:
        return "", (f"{_tendency(comparison)}, too few to prove ({comparison.too_few}): {pair}: "
                    f"{_overview(comparison)}")
    if not worse and not better:
        return "", f"No difference: {pair}: {_overview(comparison)}{_doubt(comparison)}"
    word = "Worse" if not better else "Better" if not worse else "Better and worse"
    if all(one.column.measure == "frame_ms" for one in worse + better):
        word = "Slower" if worse else "Faster"
    named = "; ".join(f"{kind}: {_named(rows)}" for kind, rows in (("worse", worse),
                                                                  ("better", better)) if rows)
    return ("worse" if worse else "better"), f"{word}: {pair}: {_overview(comparison)}; {named}"


def _tendency(comparison: Comparison) -> str:
    """In how many recordings more, or less, was found: what few recordings show."""
    changes = [after - before for before, after, _ in comparison.shares.values()]
    counts = {"Worse": sum(change < 0 for change in changes),
              "Better": sum(change > 0 for change in changes)}
    told = [f"{word} in {_of(count, len(changes))}" for word, count in counts.items() if count]
    if not told:
        return "No difference"
    return " and ".join([told[0], *(word.lower() for word in told[1:])])


def _of(count: int, whole: int) -> str:
    if count < whole:
        return f"{count} of {whole}"
    return {1: "the one recording", 2: "both"}.get(whole, f"all {whole}")


def _doubt(comparison: Comparison) -> str:
    """The answer to the question that an interval raises."""
    is_open = any(one.column.measure == "found" and one.column.quantity == "all"
                  and (one.high < 0 or one.low > 0) for one in comparison.changes)
    return "; too few of them changed to rule chance out" if is_open else ""


def _overview(comparison: Comparison) -> str:
    """The main values over all; and of how many recordings."""
    shown = [one for one in comparison.changes if one.column.quantity == "all"
             and one.column.measure in _MAIN]
    parts = [_values(one, comparison) for one in shown]
    return ", ".join([*parts, f"{comparison.recordings} recordings"])


def _values(one: Change, comparison: Comparison) -> str:
    words, unit = title(one.column), MEASURES[one.column.measure].unit
    if comparison.is_single:
        return f"{words} {number(one.after, one.column.measure)} {unit}"
    return (f"{words} {number(one.before, one.column.measure)} -> "
            f"{number(one.after, one.column.measure)} {unit} "
            f"({signed(one.difference, one.column.measure)}, 95 %: "
            f"{signed(one.low, one.column.measure)} to {signed(one.high, one.column.measure)})")


def _named(rows: list[Change]) -> str:
    """The bins that changed, with the change."""
    told = [one for one in rows if _is_telling(one, rows)]
    words = [f"{title(one.column)} in {place(one.column)} "
             f"({signed(one.difference, one.column.measure)})" for one in told[:_NAMED_BINS]]
    more = len(rows) - len(words)
    return ", ".join(words) + (f", and {more} more" if more > 0 else "")


def _is_telling(one: Change, rows: list[Change]) -> bool:
    """Returns whether a bin locates the change: it changed clearly more than all images together did."""
    whole = [other for other in rows if other.column.quantity == "all"
             and (other.column.measure, other.column.has_truth)
             == (one.column.measure, one.column.has_truth)]
    if one in whole or not whole:
        return True
    return abs(one.difference) > _TELLING * abs(whole[0].difference)
