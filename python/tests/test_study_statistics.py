# SPDX-License-Identifier: BSD-3-Clause
"""Differences by chance and real ones in a comparison."""
import numpy as np
import pytest

from kestrel.study.statistics import Sums, compare, effects, interval
from kestrel.study.trajectory import smooth

BINS = 20


def found(random, frames, chance):
    return Sums(random.binomial(frames, chance).astype(float), frames.astype(float))


def fleet(random, recordings):
    """Frames in view, and the chance of finding: flights differ, and have not all bins."""
    frames = random.poisson(20, (recordings, BINS)) * (random.random((recordings, BINS)) < 0.7)
    ease = 2.2 + random.normal(size=(recordings, 1)) + 0.3 * random.normal(size=(recordings, BINS))
    return frames, 1 / (1 + np.exp(-ease))


@pytest.mark.parametrize("paired", [True, False])
def test_equal_things_show_no_difference(paired):
    wrong = 0
    for seed in range(100, 140):
        random = np.random.default_rng(seed)
        frames, chance = fleet(random, 16)
        others = (frames, chance) if paired else fleet(random, 16)
        compared = compare(found(random, frames, chance), found(random, *others), paired,
                           rounds=1000)
        wrong += bool((compared.p < 0.01).any())
    assert wrong <= 2  # 0.4 are expected, and 3 have a probability of 0.01


def test_a_loss_in_one_bin_is_found_there():
    random = np.random.default_rng(3)
    frames, chance = fleet(random, 30)
    before = found(random, frames, chance)
    after = Sums(before.numerator.copy(), before.denominator)
    after.numerator[:, 7] = np.round(0.7 * after.numerator[:, 7])
    compared = compare(before, after, paired=True)
    assert np.flatnonzero(compared.p < 0.01).tolist() == [7]
    assert compared.low[7] < compared.change[7] < compared.high[7] < 0


def test_few_recordings_say_nothing():
    before = Sums(np.full((4, 1), 9.0), np.full((4, 1), 10.0))
    after = Sums(np.zeros((4, 1)), np.full((4, 1), 10.0))
    assert np.isnan(compare(before, after, paired=True).p).all()


def test_intervals_hold_the_truth_as_often_as_they_say():
    held = 0
    for seed in range(200):
        random = np.random.default_rng(seed)
        chance = np.clip(random.normal(0.8, 0.1, (25, 1)), 0, 1)
        low, high = interval(found(random, np.full((25, 1), 40), chance), rounds=400)
        held += low[0] <= 0.797 <= high[0]  # the mean of what is clipped
    assert 0.88 * 200 <= held <= 0.99 * 200


def test_the_seed_is_all_that_chance_depends_on():
    random = np.random.default_rng(1)
    before, after = (found(random, *fleet(random, 12)) for _ in range(2))
    first, again, other = (compare(before, after, False, seed, rounds=500) for seed in (5, 5, 6))
    np.testing.assert_array_equal(first.p, again.p)
    np.testing.assert_array_equal(first.low, again.low)
    assert not np.array_equal(first.low, other.low)


def test_the_dearest_disturbance_is_named_first():
    random = np.random.default_rng(1)
    drawn = random.normal(size=(200, 3)) * [2.0, 0.01, 5.0]
    outcome = 0.2 + 0.01 * drawn[:, 0]**2 + 4 * drawn[:, 1] + 0.05 * random.normal(size=200)
    wind, delay, nothing = effects(["wind", "delay", "nothing"], drawn, outcome)
    assert (wind.name, delay.name, nothing.name) == ("wind", "delay", "nothing")
    assert wind.at_plus == pytest.approx(0.36, abs=0.1)  # 0.01 * 6^2
    assert wind.plus_low < 0.36 < wind.plus_high
    assert delay.at_plus == pytest.approx(0.12, abs=0.04)
    assert nothing.plus_low < 0 < nothing.plus_high
    assert effects(["wind"], drawn[:10, :1], outcome[:10]) == []


def circle(times_s):
    angle = 0.5 * times_s
    return np.stack([8 * np.cos(angle), 8 * np.sin(angle), 0 * angle], axis=1)


def test_a_trajectory_bridges_gaps_as_well_as_it_says():
    random = np.random.default_rng(0)
    times_s = np.arange(400) / 20
    true = circle(times_s)
    measured = true + 0.05 * random.normal(size=true.shape)
    measured[150:190] = np.nan
    measured[300:304] += [3, 0, 0]  # something else, four images long
    trajectory = smooth(times_s, measured, np.full(400, 0.05**2))
    error = np.linalg.norm(trajectory.position - true, axis=1)
    assert not trajectory.taken[300:304].any() and trajectory.taken[310:].all()
    assert error[20:150].max() < 0.15
    assert (error[150:190] < 4 * trajectory.sigma_m[150:190]).all()
    assert trajectory.sigma_m[170] > 2 * trajectory.sigma_m[100]


def test_a_standing_target_is_known_long_before_it_is_seen():
    random = np.random.default_rng(0)
    times_s = np.arange(200) / 20
    true = np.tile([1.0, 2.0, 0.0], (200, 1))
    measured = true + 0.05 * random.normal(size=true.shape)
    measured[:100] = np.nan
    standing = smooth(times_s, measured, np.full(200, 0.05**2))
    measured[100:] += circle(times_s)[100:]
    driving = smooth(times_s, measured, np.full(200, 0.05**2))
    assert standing.sigma_m[0] < 0.2 and np.linalg.norm(standing.position[0] - true[0]) < 0.3
    assert driving.sigma_m[0] > 1


def test_a_few_detections_are_no_trajectory():
    measured = np.full((50, 3), np.nan)
    measured[10:14] = 0
    assert np.isinf(smooth(np.arange(50) / 20, measured, np.full(50, 0.01)).sigma_m).all()
