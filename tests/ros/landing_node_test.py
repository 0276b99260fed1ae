#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A bag played through kestrel_node gives the detections and the track of `kestrel land` on it.

usage: landing_node_test.py KESTREL KESTREL_NODE

Starts a ROS master and the node. First every image is sent only after the one before was answered:
what then comes back is compared with the tables of `kestrel land`. Then `rosbag play` plays the bag
as a camera would. The messages are read by the definitions that the node sends with them, which
checks these, too.
"""

import os
import subprocess
import sys

import rospy
from node_testing import (Bag, Echo, Messages, call, call_in_vain, compare, diagnosis, master, rows, run,
                          running, wait_until)

SIMULATION = ["--scenario", "calm", "--set", "frames=30", "--set", "rate_hz=10"]


def by_stamp(table):
    return {int(row["timestamp_ns"]): row for row in table}


def make_recordings(kestrel, folder):
    bag = f"{folder}/flight.bag"
    run(kestrel, "simulate", "landing", "--output", f"{folder}/flight", *SIMULATION)
    run(kestrel, "convert", f"{folder}/flight", bag)
    run(kestrel, "land", bag, "--output", f"{folder}/out")
    detections, track = (rows(f"{folder}/out/landing_{name}.csv") for name in ("detections", "track"))
    return Bag(bag), by_stamp(detections), by_stamp(track)


def compare_detections(expected, answers):
    found = 0
    for stamp, row in expected.items():
        detections = answers[stamp].detections
        assert len(detections) == int(row["detected"]), (stamp, row)
        if not detections:
            continue
        found += 1
        result = detections[0].results[0]
        position = result.pose.pose.position
        compare(
            row,
            {
                "p_CP_C_x_m": position.x,
                "p_CP_C_y_m": position.y,
                "p_CP_C_z_m": position.z,
                "sigma_x_m": result.pose.covariance[0] ** 0.5,
                "sigma_z_m": result.pose.covariance[14] ** 0.5,
            },
            stamp,
        )
    return found


def compare_track(expected, answers):
    compared = 0
    for stamp, row in expected.items():
        if not row["p_x_m"]:
            continue
        track = answers[stamp]
        position, velocity = track.pose.pose.position, track.twist.twist.linear
        compare(
            row,
            {"p_x_m": position.x, "p_y_m": position.y, "p_z_m": position.z, "v_z_mps": velocity.z},
            stamp,
        )
        speed = (float(row["v_x_mps"]) ** 2 + float(row["v_y_mps"]) ** 2) ** 0.5
        assert abs(velocity.x - speed) < 1e-5 and abs(velocity.y) < 1e-5, (stamp, row, velocity)
        compared += 1
    return compared


def test_in_step(bag, expected, expected_track):
    names = ("detections", "target_pose", "track", "prediction", "markers", "image_annotated")
    topics = {name: Messages(f"/kestrel/{name}") for name in names}
    topics["diagnostics"] = Messages("/diagnostics")
    echo = Echo("/kestrel/target_pose")
    bag.play_in_step(topics["detections"])
    newest = max(expected)
    wait_until(lambda: newest in topics["track"].by_stamp, "the newest track")
    found = compare_detections(expected, topics["detections"].by_stamp)
    tracked = compare_track(expected_track, topics["track"].by_stamp)
    assert found > 0 and tracked > 0, (found, tracked)
    assert topics["detections"].frames == {"camera_optical_frame"}, topics["detections"].frames
    wait_until(lambda: len(topics["target_pose"].by_stamp) == found, "all target poses")
    wait_until(lambda: newest in topics["prediction"].by_stamp, "a prediction")
    assert len(topics["prediction"].by_stamp[newest].poses) == 21
    wait_until(lambda: newest in topics["image_annotated"].by_stamp, "an annotated image")
    wait_until(lambda: topics["diagnostics"].newest, "diagnostics")
    text = echo.text()
    assert "frame_id: \"camera_optical_frame\"" in text and "covariance:" in text, text
    print(f"{len(bag.images)} images, {found} detections and {tracked} states of the track agree")
    for messages in topics.values():
        messages.close()


def test_services():
    call("stop")
    call("start")
    assert "no map" in call_in_vain("save_map")
    rospy.set_param("/kestrel/landing/detector/min_quality", 7)
    assert "min_quality" in call_in_vain("reset")
    assert "min_quality" in call_in_vain("update")
    rospy.set_param("/kestrel/landing/detector/min_quality", 0.9)
    rospy.set_param("/kestrel/landing/tracker/gate", 20)
    answer = call("update")
    assert answer.startswith("taken: landing.detector.min_quality; "), answer
    assert answer.endswith("reset: landing.tracker.gate"), answer
    call("reset")
    assert call("update") == "nothing has changed"


def test_rosbag_play(bag, expected):
    """As from a camera: the images come when they were taken, and nobody waits for the node."""
    detections, diagnostics = Messages("/kestrel/detections"), Messages("/diagnostics")
    subprocess.run(["rosbag", "play", "--quiet", "--delay=1", bag.path], check=True,
                   stdout=subprocess.DEVNULL)
    wait_until(lambda: detections.by_stamp, "an answer to rosbag play")
    assert set(detections.by_stamp) <= set(expected)
    print(f"rosbag play: {len(detections.by_stamp)} of {len(expected)} images answered")
    print(diagnosis(diagnostics))


def test(kestrel, node, folder):
    bag, expected, expected_track = make_recordings(kestrel, folder)
    with running(node, folder, "image:=/camera/image_raw", f"poses:={bag.pose_topic()}", "_poses:=topic",
                 "_fly/events/pose_wait_s:=1.0"):
        test_in_step(bag, expected, expected_track)
        test_services()
    # The options of all commands, of which the node has some.
    with open(f"{folder}/options.yaml", "w") as file:
        subprocess.run([kestrel, "config"], check=True, stdout=file)
    with running(node, folder, "image:=/camera/image_raw", "_poses:=none", f"_config:={folder}/options.yaml"):
        test_rosbag_play(bag, expected)


def main():
    kestrel, node = (os.path.abspath(path) for path in sys.argv[1:3])
    with master() as folder:
        test(kestrel, node, folder)


main()
