# SPDX-License-Identifier: BSD-3-Clause
"""Differences between two runs of many recordings, and what chance alone would make of them.

Frames of one recording resemble each other, so chance is that of the recordings: they are drawn
again as a whole for the intervals (bootstrap), and exchanged as a whole for the tests
(permutation). The test looks at all values at once: of all differences the largest that chance
alone makes, in units of their standard deviations, is what a difference must exceed (Westfall and
Young, Resampling-based multiple testing, 1993). So a comparison of two equal things shows a
difference anywhere in it with the probability `alpha`, however many bins it has.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROUNDS = 4000  # of resampling: an adjusted p of 0.05 is known to 0.004
MIN_RECORDINGS = 5  # with fewer, no order of exchange is rarer than 1 in 16
_CHUNK = 4_000_000  # recordings times rounds at a time, which bounds the memory


@dataclass(frozen=True)
class Sums:
    """Values as quotients of sums over recordings, as frames found of frames in view.

    numerator, denominator: float64 of shape (recordings, values).
    """

    numerator: Array
    denominator: Array

    def quotients(self, weights: Array | None = None) -> Array:
        """Returns the values. weights: (rounds, recordings); the result then is (rounds, values).
        NaN where the denominator is zero."""
        if weights is None:
            return _divide(self.numerator.sum(axis=0), self.denominator.sum(axis=0))
        return _divide(weights @ self.numerator, weights @ self.denominator)


@dataclass(frozen=True)
class Differences:
    """The comparison of two runs, value by value: arrays of shape (values,).

    low, high: 95 % interval of after minus before, of each value alone.
    p: probability that chance alone makes a difference as large anywhere among all values; NaN
    where too few recordings have the value.
    """

    before: Array
    after: Array
    low: Array
    high: Array
    p: Array

    @property
    def change(self) -> Array:
        return self.after - self.before


def compare(before: Sums, after: Sums, paired: bool, seed: int = 1,
            rounds: int = ROUNDS) -> Differences:
    """Compares two runs.

    paired: both have the same recordings, in the same order; else they are other flights, and the
    interval is that of two independent groups.
    Returns Differences. The same seed gives the same numbers.
    """
    random = np.random.default_rng(seed)
    low, high = _intervals(before, after, paired, random, rounds)
    p = _adjusted_p(before, after, paired, random, rounds)
    return Differences(before.quotients(), after.quotients(), low, high, p)


def interval(sums: Sums, seed: int = 1, rounds: int = ROUNDS) -> tuple[Array, Array]:
    """Returns the ends of the 95 % intervals of the values: bootstrap over recordings."""
    random = np.random.default_rng(seed)
    count = len(sums.numerator)
    return _percentiles(np.concatenate([
        sums.quotients(_drawn(random, count, size)) for size in _chunks(rounds, count)]))


def _divide(numerator: Array, denominator: Array) -> Array:
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(denominator > 0, numerator / denominator, np.nan)


def _chunks(rounds: int, recordings: int) -> Iterator[int]:
    """Yields numbers of rounds that sum to all."""
    size = max(1, _CHUNK // (recordings + 1))
    for first in range(0, rounds, size):
        yield min(size, rounds - first)


def _drawn(random: np.random.Generator, recordings: int, rounds: int) -> Array:
    """Returns the number of draws of each recording: (rounds, recordings)."""
    if recordings == 0:
        return np.zeros((rounds, 0))
    return random.multinomial(recordings, np.full(recordings, 1 / recordings),
                              size=rounds).astype(float)


def _percentiles(values: Array) -> tuple[Array, Array]:
    """The 2.5 and 97.5 percentiles of each column, NaN left out."""
    ends = np.full((2, values.shape[1]), np.nan)
    for column in range(values.shape[1]):
        known = values[np.isfinite(values[:, column]), column]
        if known.size:
            ends[:, column] = np.percentile(known, [2.5, 97.5])
    return ends[0], ends[1]


def _intervals(before: Sums, after: Sums, paired: bool, random: np.random.Generator,
               rounds: int) -> tuple[Array, Array]:
    count, count_after = len(before.numerator), len(after.numerator)
    differences = []
    for size in _chunks(rounds, max(count, count_after)):
        weights = _drawn(random, count, size)
        other = weights if paired else _drawn(random, count_after, size)
        differences.append(after.quotients(other) - before.quotients(weights))
    return _percentiles(np.concatenate(differences))


def _exchanged(before: Sums, after: Sums, paired: bool, random: np.random.Generator,
               rounds: int) -> tuple[Array, bool]:
    """Differences after an exchange of recordings between before and after, (rounds, values), and
    whether these are all exchanges that there are, which is so with few recordings."""
    both = Sums(np.concatenate([before.numerator, after.numerator]),
                np.concatenate([before.denominator, after.denominator]))
    count, first = len(before.numerator), 0
    is_all = paired and 2**count <= rounds
    differences = []
    for size in _chunks(2**count if is_all else rounds, len(both.numerator)):
        is_after = _all_swaps(first, size, count) if is_all else \
            _swaps(random, size, count) if paired else \
            _deals(random, size, count, len(after.numerator))
        differences.append(both.quotients(is_after) - both.quotients(1 - is_after))
        first += size
    return np.concatenate(differences), is_all


def _all_swaps(first: int, size: int, count: int) -> Array:
    swapped = (np.arange(first, first + size)[:, None] >> np.arange(count)) & 1
    return np.hstack([swapped, 1 - swapped]).astype(float)


def _swaps(random: np.random.Generator, size: int, count: int) -> Array:
    swapped = random.integers(0, 2, (size, count))
    return np.hstack([swapped, 1 - swapped]).astype(float)


def _deals(random: np.random.Generator, size: int, count: int, count_after: int) -> Array:
    is_after = np.repeat([0.0, 1.0], [count, count_after])
    return random.permuted(np.tile(is_after, (size, 1)), axis=1)


def _comparable(before: Sums, after: Sums, paired: bool) -> NDArray[np.bool_]:
    """Returns whether enough recordings have a value."""
    has_before, has_after = before.denominator > 0, after.denominator > 0
    having = (has_before | has_after).sum(axis=0) if paired else \
        np.minimum(has_before.sum(axis=0), has_after.sum(axis=0))
    return np.asarray(having >= MIN_RECORDINGS)


def _adjusted_p(before: Sums, after: Sums, paired: bool, random: np.random.Generator,
                rounds: int) -> Array:
    usable = _comparable(before, after, paired)
    p = np.full(usable.size, np.nan)
    if not usable.any():
        return p
    before, after = (Sums(each.numerator[:, usable], each.denominator[:, usable])
                     for each in (before, after))
    observed = np.nan_to_num(after.quotients() - before.quotients())
    by_chance, is_all = _exchanged(before, after, paired, random, rounds)
    by_chance = np.nan_to_num(by_chance)
    spread = by_chance.std(axis=0)
    varies = spread > 1e-12
    scale = np.where(varies, spread, np.inf)
    largest = np.abs(by_chance / scale).max(axis=1)
    reached = largest[:, None] >= np.abs(observed / scale)[None, :] - 1e-9
    # All exchanges include the identity; drawn ones do not, so the observation is added.
    more = 0 if is_all else 1
    p[usable] = (more + reached.sum(axis=0)) / (more + len(by_chance))
    return p


@dataclass(frozen=True)
class Effect:
    """The effect of a disturbance on an outcome: its change from the middle to three standard
    deviations below and above it, or as far as it was drawn, each with its 95 % interval. `values`:
    of the disturbance itself at the lower end, in the middle and at the upper end."""

    name: str
    values: tuple[float, ...]
    at_minus: float
    minus_low: float
    minus_high: float
    at_plus: float
    plus_low: float
    plus_high: float

    @property
    def cost(self) -> float:
        """The larger of the two changes."""
        return max(abs(self.at_minus), abs(self.at_plus))


def effects(names: list[str], drawn: Array, outcome: Array, seed: int = 1,
            rounds: int = 500) -> list[Effect]:
    """Returns what each disturbance does to an outcome, the dearest first.

    drawn: (flights, disturbances). outcome: (flights,). A quadratic without mixed terms is fitted
    to all disturbances at once; the intervals are a bootstrap over flights. Empty where there are
    fewer than five flights for each coefficient.
    """
    spread = drawn.std(axis=0)
    varied = spread > 0
    if len(outcome) < 5 * (1 + 2 * int(varied.sum())) or not varied.any():
        return []
    middle, spread = drawn[:, varied].mean(axis=0), spread[varied]
    units = (drawn[:, varied] - middle) / spread
    design = np.hstack([np.ones((len(outcome), 1)), units, units**2])
    reach = np.stack([units.min(axis=0).clip(min=-3), units.max(axis=0).clip(max=3)])
    random = np.random.default_rng(seed)
    fits = [_ends(design, outcome, reach)]
    for _ in range(rounds):
        chosen = random.integers(0, len(outcome), len(outcome))
        fits.append(_ends(design[chosen], outcome[chosen], reach))
    low, high = np.percentile(fits[1:], [2.5, 97.5], axis=0)
    values = np.stack([middle + reach[0] * spread, middle, middle + reach[1] * spread], axis=1)
    found = [Effect(name, tuple(map(float, values[place])),
                    *(float(part[end, place]) for end in (0, 1) for part in (fits[0], low, high)))
             for place, name in enumerate(name for name, used in zip(names, varied) if used)]
    return sorted(found, key=lambda effect: -effect.cost)


def _ends(design: Array, outcome: Array, reach: Array) -> Array:
    """The fitted changes at the two ends that the disturbances reach: (2, disturbances)."""
    coefficients = np.linalg.lstsq(design, outcome, rcond=None)[0]
    count = (design.shape[1] - 1) // 2
    slope, bend = coefficients[1:1 + count], coefficients[1 + count:]
    return np.asarray(reach * slope + reach**2 * bend)
