#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A bag played through kestrel_node gives the objects and the map of `kestrel hunt` on it.

usage: hunt_node_test.py KESTREL KESTREL_NODE

Starts a ROS master and the node with the task hunt. Every image is sent only after the one before
was answered: what then comes back, and the map that the service saves, are compared with the tables
of `kestrel hunt`.
"""

import os
import sys

import rospy
from node_testing import (Bag, Echo, Messages, call, call_in_vain, compare, diagnosis, master, rows, run,
                          running, wait_until)

SIMULATION = ["--scenario", "sweep", "--set", "frames=25", "--set", "rate_hz=10"]
ORIGIN = "50.1,14.4"
CLASSES = {}  # number of a class, as messages have it: its name


def make_recordings(kestrel, folder):
    bag = f"{folder}/hunt.bag"
    run(kestrel, "simulate", "hunt", "--output", f"{folder}/hunt", *SIMULATION)
    run(kestrel, "convert", f"{folder}/hunt", bag)
    run(kestrel, "hunt", bag, "--output", f"{folder}/out", "--origin", ORIGIN)
    return Bag(bag), rows(f"{folder}/out/object_detections.csv")


def same_class(number, name):
    return CLASSES.setdefault(number, name) == name


def compare_objects(expected, answers):
    """Objects that touch have a row but no position, and no message."""
    located = {stamp: [] for stamp in answers}
    for row in expected:
        stamp = int(row["timestamp_ns"])
        assert stamp in answers, stamp
        if row["p_CO_C_x_m"]:
            located[stamp].append(row)
    for stamp, of_image in located.items():
        detections = answers[stamp].detections
        assert len(detections) == len(of_image), (stamp, len(detections), len(of_image))
        for row, detection in zip(of_image, detections):
            result = detection.results[0]
            position = result.pose.pose.position
            assert same_class(result.id, row["class"]), (stamp, row, CLASSES)
            assert abs(result.score - float(row["class_probability"])) < 1e-4, (stamp, row, result.score)
            compare(
                row,
                {"p_CO_C_x_m": position.x, "p_CO_C_y_m": position.y, "p_CO_C_z_m": position.z},
                stamp,
            )
    return sum(len(of_image) for of_image in located.values())


def compare_map(expected, message):
    assert len(message.detections) == len(expected), (len(message.detections), len(expected))
    for row, mapped in zip(expected, message.detections):
        result = mapped.results[0]
        position = result.pose.pose.position
        assert same_class(result.id, row["class"]), (row, CLASSES)
        assert mapped.header.stamp.to_nsec() == int(row["last_seen_ns"]), row
        compare(row, {"p_x_m": position.x, "p_y_m": position.y, "p_z_m": position.z}, row)


def test_saved_map(folder):
    """The files of the service are those of the command; they are replaced only when allowed."""
    own, commands = f"{folder}/map", f"{folder}/out"
    assert "parameter output" in call_in_vain("save_map")
    rospy.set_param("/kestrel/output", own)
    rospy.set_param("/kestrel/origin", ORIGIN)
    assert call("update") == "taken: output, origin"
    answer = call("save_map")
    assert own in answer and "geojson" in answer, answer
    for name in ("object_map.csv", "object_map.geojson"):
        assert open(f"{own}/{name}").read() == open(f"{commands}/{name}").read(), name
    assert "exists already" in call_in_vain("save_map")
    rospy.set_param("/kestrel/force", True)
    call("update")
    call("save_map")
    return rows(f"{own}/object_map.csv")


def test(kestrel, node, folder):
    bag, expected = make_recordings(kestrel, folder)
    with running(node, folder, "image:=/camera/image_raw", f"poses:={bag.pose_topic()}", "_task:=hunt", "_poses:=topic",
                 "_fly/events/pose_wait_s:=1.0"):
        names = ("detections", "map", "markers", "map_markers", "image_annotated")
        topics = {name: Messages(f"/kestrel/{name}") for name in names}
        diagnostics = Messages("/diagnostics")
        bag.play_in_step(topics["detections"])
        objects = compare_objects(expected, topics["detections"].by_stamp)
        newest = max(topics["detections"].by_stamp)
        wait_until(lambda: newest in topics["map"].by_stamp, "the newest map")
        saved = test_saved_map(folder)
        assert objects > 0 and saved, (objects, saved)
        compare_map(saved, topics["map"].by_stamp[newest])
        wait_until(lambda: newest in topics["image_annotated"].by_stamp, "an annotated image")
        wait_until(lambda: topics["markers"].newest, "markers")
        # Who comes late gets the map, too.
        text = Echo("/kestrel/map_markers").text()
        assert text.count("ns: \"map\"") == len(saved), text
        print(f"{len(bag.images)} images, {objects} detections and {len(saved)} objects of the map agree")
        print(diagnosis(diagnostics))


def main():
    kestrel, node = (os.path.abspath(path) for path in sys.argv[1:3])
    with master() as folder:
        test(kestrel, node, folder)


main()
