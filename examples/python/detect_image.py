# SPDX-License-Identifier: BSD-3-Clause
"""Finds the landing pattern in an image: detect_image.py camera.yaml image.png"""
import sys

import kestrel

detector = kestrel.LandingPatternDetector(kestrel.read_calibration(sys.argv[1]))
report = detector.detect(kestrel.read_image(sys.argv[2]))
if report.detection:
    print("seen at", report.detection.center_in_camera, "m in the camera frame")
else:
    print("not seen:", report.reason)
