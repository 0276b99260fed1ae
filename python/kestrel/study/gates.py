# SPDX-License-Identifier: BSD-3-Clause
"""Gates of a study: what must hold, as

    gates:
      - nothing worse
      - failed <= 0
      - found >= 0.95
      - found in altitude_m 2..6 >= 0.9
      - found change >= -0.01
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

from .comparison import MEASURES, QUANTITIES, Comparison

_PATTERN = re.compile(
    r"(?P<measure>\w+)(?: in (?P<quantity>\w+) (?P<low>[^ ]+?)\.\.(?P<high>[^ ]*))?"
    r"(?P<change> change)? (?P<sign><=|>=) (?P<limit>[^ ]+)")
_EXPECTED = ("expected 'nothing worse', or as 'found >= 0.95', 'found change >= -0.01', "
             "'found in altitude_m 2..6 >= 0.9'")
_NOTHING_WORSE = "nothing worse"


class GateError(ValueError):
    """A gate that is none; the message is one line."""


@dataclass(frozen=True)
class Gate:
    """A condition on a comparison."""

    text: str
    measure: str
    quantity: str
    low: float
    high: float
    is_change: bool
    is_least: bool
    limit: float


@dataclass
class Outcome:
    """A gate, whether it is met, and the value in words."""

    text: str
    is_met: bool
    said: str


def parse_gates(texts: Iterable[str]) -> list[Gate]:
    """Returns the gates of a list of texts. Raises GateError that names the one that is wrong."""
    if isinstance(texts, (str, dict)):
        raise GateError(f"gates: {texts!r}, expected a list")
    return [_parse(str(text)) for text in texts or []]


def _number(text: str, gate: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise GateError(f"gates: '{gate}': '{text}' is no number") from None


def _parse(text: str) -> Gate:
    if text == _NOTHING_WORSE:
        return Gate(text, _NOTHING_WORSE, "all", 0, 0, False, False, 0)
    match = _PATTERN.fullmatch(" ".join(text.split()))
    if match is None:
        raise GateError(f"gates: '{text}': {_EXPECTED}")
    known = [*MEASURES, "failed"]
    if match["measure"] not in known:
        raise GateError(f"gates: '{text}': no measure '{match['measure']}', expected "
                        f"{', '.join(known)}")
    quantity = match["quantity"] or "all"
    if quantity not in QUANTITIES:
        raise GateError(f"gates: '{text}': no quantity '{quantity}', expected "
                        f"{', '.join(QUANTITIES)}")
    low = _number(match["low"], text) if match["low"] else -math.inf
    high = _number(match["high"], text) if match["high"] else math.inf
    return Gate(text, match["measure"], quantity, low, high, bool(match["change"]),
                match["sign"] == ">=", _number(match["limit"], text))


def check(gate: Gate, comparison: Comparison, failed: int) -> Outcome:
    """Holds a gate against a comparison, whose `after` it is about.

    failed: units of it that failed. A gate of a value that was not measured is not met. Of a value
    that recordings with and without truth have, both count.
    """
    if gate.measure == _NOTHING_WORSE:
        if not comparison.is_enough and not comparison.is_single:
            return Outcome(gate.text, False, f"not judged: {comparison.too_few}")
        worse = len(comparison.of("worse"))
        return Outcome(gate.text, worse == 0, f"{worse} worse")
    if gate.measure == "failed":
        return _outcome(gate, [float(failed)])
    values = [one.difference if gate.is_change else one.after for one in comparison.changes
              if (one.column.measure, one.column.quantity, one.column.lower, one.column.upper)
              == (gate.measure, gate.quantity, gate.low, gate.high)]
    return _outcome(gate, [value for value in values if not math.isnan(value)])


def _outcome(gate: Gate, values: list[float]) -> Outcome:
    if not values:
        return Outcome(gate.text, False, "was not measured")
    is_met = all(value >= gate.limit if gate.is_least else value <= gate.limit
                 for value in values)
    return Outcome(gate.text, is_met, ", ".join(f"{value:.4g}" for value in values))
