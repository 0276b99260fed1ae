# SPDX-License-Identifier: BSD-3-Clause
"""RegionTracker follows what is marked."""
import numpy as np
import pytest

import kestrel

PERIOD_NS = 50_000_000


def scene(x):
    """A patch of noise at column x, None: nowhere, over smooth ground."""
    random = np.random.default_rng(5)
    patch = np.kron(random.integers(0, 255, (10, 8, 3)), np.ones((5, 5, 1)))
    image = np.tile(np.linspace(80, 160, 320)[None, :, None], (240, 1, 3))
    if x is not None:
        image[100:150, x:x + 40] = patch
    return image.astype(np.uint8)


def test_a_marked_region_is_followed_and_reported_as_lost():
    tracker = kestrel.RegionTracker()
    tracker.mark(scene(100), 0, (100, 100, 40, 50))
    for i in range(1, 20):
        report = tracker.track(scene(100 + 3 * i), i * PERIOD_NS)
        assert report.state == kestrel.RegionState.FOLLOWING
        x, y, width, height = report.box_px
        assert x == pytest.approx(100 + 3 * i, abs=3) and y == pytest.approx(100, abs=3)
    for i in range(20, 40):
        report = tracker.track(scene(None), i * PERIOD_NS)
    assert report.state == "lost" and report.probability == 0


def test_a_box_outside_of_the_image_is_refused():
    with pytest.raises(kestrel.InputError, match="expected one within the image of 320 x 240"):
        kestrel.RegionTracker().mark(scene(100), 0, (400, 10, 20, 20))
