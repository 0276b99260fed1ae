# SPDX-License-Identifier: BSD-3-Clause
"""Values and bins in words."""

from __future__ import annotations

import numpy as np

from .comparison import MEASURES, QUANTITIES
from .results import Column

MINUS = "\u2212"


def bin_label(column: Column) -> str:
    """Returns a bin in words: '2 to 6', '14 and more', 'all'."""
    if column.quantity == "all":
        return "all"
    if np.isinf(column.upper):
        return "whole" if column.quantity == "visible_fraction" else f"{column.lower:g} and more"
    return f"{column.lower:g} to {column.upper:g}"


def title(column: Column) -> str:
    """Returns the name of a measure: 'found', 'found (estimated)'."""
    words = MEASURES[column.measure].title.split(",")[0].split(" for ")[0]
    return words if column.has_truth else f"{words} (estimated)"


def place(column: Column) -> str:
    """Returns the bin of a column: 'all images', 'altitude 2 to 6'."""
    if column.quantity == "all":
        return "all images"
    return f"{QUANTITIES[column.quantity].split(',')[0]} {bin_label(column)}"


def number(value: float, measure: str) -> str:
    """Returns a value of a measure; '-' where it is not known."""
    known = MEASURES[measure]
    return "-" if np.isnan(value) else f"{known.scale * value:.{known.decimals}f}"


def signed(value: float, measure: str) -> str:
    """Returns a difference with its sign."""
    text = number(value, measure)
    if text == "-":
        return text
    if float(text) == 0:
        return text.lstrip("-")
    return text.replace("-", MINUS) if text.startswith("-") else f"+{text}"
