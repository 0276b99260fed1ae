# SPDX-License-Identifier: BSD-3-Clause
"""The trajectory of a target, from detections before and after: a filter and the smoother of Rauch, Tung
and Striebel (1965), for constant velocity with white noise of acceleration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Noise of acceleration, m^2/s^3, from a pad that stands to a car in a curve; the most likely
# counts.
_NOISES = (1e-4, 1e-2, 0.1, 1.0, 10.0, 100.0)
_GATE = 25.0  # squared distance in standard deviations above which a detection is of something else
_RESTART = 10  # of these in a row: the pad is where they are
_START_SPEED_MPS = 10.0


@dataclass
class Trajectory:
    """Smoothed positions at N times.

    position, velocity: (N, 3), m and m/s. sigma_m: (N,), standard deviation per axis, infinite
    where nothing is known. taken: (N,), whether the detection of this time is part of it.
    """

    position: Array
    velocity: Array
    sigma_m: Array
    taken: NDArray[np.bool_]


@dataclass
class _Filtered:
    """The filter's states: at each time before (predicted) and after its detection."""

    first: int
    state: Array  # (n, 2, 3): position and velocity, three axes
    covariance: Array  # (n, 2, 2): alike in all axes
    predicted_state: Array
    predicted_covariance: Array
    taken: NDArray[np.bool_]
    log_likelihood: float


def smooth(times_s: Array, measured: Array, variance: Array, least: int = 5) -> Trajectory:
    """Returns the trajectory through detections.

    times_s: (N,), increasing. measured: (N, 3), m; NaN where nothing was detected. variance: (N,),
    per axis, m^2. least: a trajectory of fewer detections than this is none.
    """
    count = len(times_s)
    result = Trajectory(np.zeros((count, 3)), np.zeros((count, 3)), np.full(count, np.inf),
                        np.zeros(count, bool))
    has = np.isfinite(measured).all(axis=1)
    if has.sum() < least:
        return result
    best: list[tuple[_Filtered, float]] = []
    best_likelihood = -np.inf
    for noise in _NOISES:
        parts = _filter_all(times_s, measured, has, variance, noise)
        likelihood = sum(part.log_likelihood for part in parts)
        if likelihood > best_likelihood:
            best_likelihood, best = likelihood, [(part, noise) for part in parts]
    for part, noise in best:
        if part.taken.sum() >= least:
            _smooth_part(times_s, part, noise, result)
    return result


def _step(seconds: float, noise: float) -> tuple[Array, Array]:
    """Transition and noise of a step, forward or backward in time."""
    length = abs(seconds)
    transition = np.array([[1.0, seconds], [0.0, 1.0]])
    cross = np.sign(seconds) * length**2 / 2
    return transition, noise * np.array([[length**3 / 3, cross], [cross, length]])


def _filter_all(times_s: Array, measured: Array, has: NDArray[np.bool_], variance: Array,
                noise: float) -> list[_Filtered]:
    """The filter over all times; where detections leave the track for good, another part begins."""
    parts, first = [], int(np.argmax(has))
    while True:
        part, restart = _filter(times_s, measured, has, variance, noise, first)
        parts.append(part)
        if restart is None:
            return parts
        first = restart


def _filter(times_s: Array, measured: Array, has: NDArray[np.bool_], variance: Array, noise: float,
            first: int) -> tuple[_Filtered, int | None]:
    count = len(times_s) - first
    states, covariances = np.zeros((count, 2, 3)), np.zeros((count, 2, 2))
    predicted_states, predicted_covariances = states.copy(), covariances.copy()
    taken = np.zeros(count, bool)
    state = np.stack([measured[first], np.zeros(3)])
    covariance = np.diag([variance[first], _START_SPEED_MPS**2])
    taken[0] = True
    log_likelihood = 0.0
    rejected: list[int] = []
    for i in range(count):
        k = first + i
        if i > 0:
            transition, added = _step(times_s[k] - times_s[k - 1], noise)
            state, covariance = transition @ state, transition @ covariance @ transition.T + added
        predicted_states[i], predicted_covariances[i] = state, covariance
        if i > 0 and has[k]:
            error, spread = measured[k] - state[0], covariance[0, 0] + variance[k]
            distance = float(error @ error / spread)
            log_likelihood -= 0.5 * (min(distance, _GATE) + 3 * np.log(spread))
            if distance < _GATE:
                gain = covariance[:, 0] / spread
                state = state + np.outer(gain, error)
                covariance = covariance - np.outer(gain, covariance[0])
                taken[i], rejected = True, []
            else:
                rejected.append(k)
        states[i], covariances[i] = state, covariance
        if len(rejected) == _RESTART:
            end = rejected[0] - first
            return _Filtered(first, states[:end], covariances[:end], predicted_states[:end],
                             predicted_covariances[:end], taken[:end], log_likelihood), rejected[0]
    return _Filtered(first, states, covariances, predicted_states, predicted_covariances, taken,
                     log_likelihood), None


def _smooth_part(times_s: Array, part: _Filtered, noise: float, result: Trajectory) -> None:
    """Runs back over a part of the filter's states, and on beyond its beginning."""
    count = len(part.state)
    state, covariance = part.state[-1], part.covariance[-1]
    _keep(result, part.first + count - 1, state, covariance)
    for i in range(count - 2, -1, -1):
        k = part.first + i
        transition, _ = _step(times_s[k + 1] - times_s[k], noise)
        gain = part.covariance[i] @ transition.T @ np.linalg.inv(part.predicted_covariance[i + 1])
        state = part.state[i] + gain @ (state - part.predicted_state[i + 1])
        covariance = part.covariance[i] + gain @ (
            covariance - part.predicted_covariance[i + 1]) @ gain.T
        _keep(result, k, state, covariance)
    result.taken[part.first:part.first + count] |= part.taken
    for k in range(part.first - 1, -1, -1):
        transition, added = _step(times_s[k] - times_s[part.first], noise)
        _keep(result, k, transition @ state, transition @ covariance @ transition.T + added)


def _keep(result: Trajectory, k: int, state: Array, covariance: Array) -> None:
    """Takes a state over, unless another part knows more of this time."""
    sigma = float(np.sqrt(max(covariance[0, 0], 0)))
    if sigma < result.sigma_m[k]:
        result.position[k], result.velocity[k], result.sigma_m[k] = state[0], state[1], sigma
