# SPDX-License-Identifier: BSD-3-Clause
"""Follows the landing pattern in a video or a recording: follow_video.py flight [camera.yaml]

Poses of the UAV, where the source has some, place it in the world and predict where it will be.
"""
import sys

import kestrel

recording = kestrel.open_recording(sys.argv[1], camera=(sys.argv + [None])[2])
pipeline = kestrel.LandingPipeline(recording.calibration)
for event in recording.events():
    if isinstance(event, kestrel.PoseSample):
        pipeline.add_pose(event)
        continue
    seen = pipeline.process(event.image, event.time_ns)
    soon = pipeline.predict(event.time_ns + 500_000_000)
    if soon:
        print(event.name, "in half a second at", soon.position.round(2), "m in the world")
    elif seen.detection:
        print(event.name, seen.detection.center_in_camera.round(2), "m in the camera frame")
    else:
        print(event.name, seen.report.reason)
