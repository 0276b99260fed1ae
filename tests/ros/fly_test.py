#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""`kestrel fly --ros` tells a system of ROS 1 what a flight sees, and says so where there is no master.

usage: fly_test.py KESTREL
"""

import os
import subprocess
import sys

from node_testing import Messages, master, running, run, wait_until

SIMULATION = ["--scenario", "calm", "--set", "frames=30", "--set", "rate_hz=10"]


def fly(kestrel, folder, *arguments):
    return [kestrel, "fly", f"{folder}/flight", "--ros", *arguments]


def hear_a_flight(kestrel, folder):
    command = fly(kestrel, folder, "--loop")
    with running(command[0], folder, *command[1:]):
        detections, track, static = (Messages(topic) for topic in ("/kestrel/detections", "/kestrel/track",
                                                                   "/tf_static"))
        wait_until(lambda: any(message.detections for message in detections.by_stamp.values()), "a detection")
        wait_until(lambda: track.by_stamp, "a track")
        wait_until(lambda: static.newest, "the mount")
        assert detections.frames == {"camera_optical_frame"}, detections.frames
        assert track.frames == {"map"}, track.frames
        assert static.newest.transforms[0].child_frame_id == "camera_optical_frame"
        found = next(message for message in detections.by_stamp.values() if message.detections)
        assert found.detections[0].results[0].pose.pose.position.z > 0


def miss_the_master(kestrel, folder):
    elsewhere = os.environ | {"ROS_MASTER_URI": "http://127.0.0.1:1"}
    done = subprocess.run(fly(kestrel, folder), env=elsewhere, text=True, stderr=subprocess.PIPE)
    assert done.returncode == 1, done.returncode
    assert "--ros: no ROS master at http://127.0.0.1:1; start roscore" in done.stderr, done.stderr


def main():
    kestrel = sys.argv[1]
    with master() as folder:
        run(kestrel, "simulate", "landing", "--output", f"{folder}/flight", *SIMULATION)
        hear_a_flight(kestrel, folder)
        miss_the_master(kestrel, folder)


if __name__ == "__main__":
    main()
