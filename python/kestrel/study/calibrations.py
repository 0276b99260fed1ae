# SPDX-License-Identifier: BSD-3-Clause
"""The results of `kestrel calibrate` as numbers."""
import re
from pathlib import Path

import yaml

_NUMBER = r"(-?[\d.]+(?:e-?\d+)?)"
# Lines of its output, and the names of the numbers in them.
_LINES = (
    (re.compile(rf"roll {_NUMBER} \+- {_NUMBER}, pitch {_NUMBER} \+- {_NUMBER}, "
                rf"yaw {_NUMBER} \+- {_NUMBER} degrees"),
     ("roll_deg", "roll_sigma_deg", "pitch_deg", "pitch_sigma_deg", "yaw_deg", "yaw_sigma_deg")),
    (re.compile(rf"clock offset: {_NUMBER} \+- {_NUMBER} s"), ("clock_offset_s", "clock_sigma_s")),
    (re.compile(rf"RMS: {_NUMBER} m before, {_NUMBER} m after, in (\d+) images \((\d+) left"),
     ("rms_before_m", "rms_after_m", "images_used", "images_left_out")),
    (re.compile(rf"focal length: {_NUMBER} x {_NUMBER} \+- {_NUMBER} px"),
     ("fu_px", "fv_px", "focal_sigma_px")),
    (re.compile(rf"principal point: \({_NUMBER}, {_NUMBER}\) \+- \({_NUMBER}, {_NUMBER}\) px"),
     ("cu_px", "cv_px", "cu_sigma_px", "cv_sigma_px")),
    (re.compile(rf"pattern found in (\d+) of (\d+) images, (\d+) views used \((\d+) left out\), "
                rf"residual {_NUMBER} px"),
     ("images_found", "images", "images_used", "images_left_out", "residual_px")),
)


def calibrated(camera, log):
    """Returns {name: value} of a calibration: the lens from the file `camera`, mount and clock from
    what was said."""
    found = {}
    for pattern, names in _LINES:
        said = pattern.search(log)
        if said:
            found.update(zip(names, map(float, said.groups())))
    sensor = yaml.safe_load(Path(camera).read_text().removeprefix("%YAML:1.0"))
    found.update(zip(("fu_px", "fv_px", "cu_px", "cv_px"), map(float, sensor["intrinsics"])))
    return found
