# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import kestrel


@pytest.fixture(scope="session")
def calibration():
    return kestrel.paper_calibration()


@pytest.fixture(scope="session")
def flight():
    """A simulated landing of a few frames."""
    return kestrel.simulate("calm", frames=10, rate_hz=10)


@pytest.fixture(scope="session")
def image(flight):
    """A frame with the pattern in it."""
    return flight[0].image


@pytest.fixture(scope="session")
def hunt_flight():
    return kestrel.simulate("sweep", hunt=True, frames=4)


@pytest.fixture(scope="session")
def below():
    """The pose of the pattern 4 m below a camera that looks straight down."""
    return kestrel.RigidTransform(translation=[0.5, 0.2, 4], quaternion=[0, 1, 0, 0])


@pytest.fixture(scope="session")
def drawn(calibration, below):
    return kestrel.render_pattern(calibration, below)


@pytest.fixture
def writable(image):
    return np.array(image)
