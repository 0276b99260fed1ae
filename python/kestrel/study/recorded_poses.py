# SPDX-License-Identifier: BSD-3-Clause
"""Poses of the UAV and of its camera at the times of a recording's images."""

from __future__ import annotations

import numpy as np

import kestrel

_SIGMA_M = 0.03  # of the navigation from image to image, and per metre of distance:
_SIGMA_RAD = 0.005


def navigation_variance(distance_m: float) -> float:
    """Returns the variance (m^2, per axis) of the world position of something at this distance, as
    far as it comes from the navigation."""
    return _SIGMA_M**2 + (_SIGMA_RAD * distance_m)**2


def tilt_deg(body: kestrel.RigidTransform | None) -> float | None:
    """Returns the angle between the UAV's up and the world's, None where the pose is not known."""
    if body is None:
        return None
    return float(np.degrees(np.arccos(np.clip(body.rotation[2, 2], -1, 1))))


def places(body: kestrel.RigidTransform | None, light: float | None) -> dict[str, float]:
    """Returns the bins' values of an image of a hunt: the height above the world's z = 0, the tilt,
    the light, as far as they are known."""
    known = {} if light is None else {"light": light}
    tilt = tilt_deg(body)
    if body is not None and tilt is not None:
        known["altitude_m"] = float(max(0, body.translation[2]))
        known["tilt_deg"] = tilt
    return known


class RecordedPoses:
    """Poses of a recording, interpolated."""

    def __init__(self, source: kestrel.Recording) -> None:
        samples = source.poses()
        self._history = kestrel.PoseHistory(capacity=max(1, len(samples)))
        for sample in samples:
            self._history.add(sample)
        self._mount = source.calibration.body_from_camera
        self._offset_ns = round(1e9 * (source.calibration.clock_offset_s or 0))

    def at(self, time_ns: int) -> tuple[kestrel.RigidTransform | None,
                                        kestrel.RigidTransform | None]:
        """Returns the poses of body and camera in the world at an image's time; None where the
        recording has none, or no mount."""
        body = self._history.lookup(time_ns + self._offset_ns) if len(self._history) else None
        return body, body @ self._mount if body is not None and self._mount is not None else None
