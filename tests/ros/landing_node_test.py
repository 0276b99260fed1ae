#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A bag played through kestrel_node gives the detections and the track of `kestrel land` on it.

usage: landing_node_test.py KESTREL KESTREL_NODE

Starts a ROS master and the node. First every image is sent only after the one before was answered:
what then comes back is compared with the tables of `kestrel land`. Then `rosbag play` plays the bag
as a camera would. The messages are read by the definitions that the node sends with them, which
checks these, too.
"""

import contextlib
import csv
import inspect
import os
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time

import genpy.dynamic
import rosbag
import rosgraph
import rospy
from std_srvs.srv import Trigger

TIMEOUT_S = 30
TOLERANCE = 2e-6  # the tables have 1e-6
SIMULATION = ["--scenario", "calm", "--set", "frames=50", "--set", "rate_hz=10"]


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_until(is_done, what):
    end = time.monotonic() + TIMEOUT_S
    while not is_done():
        if time.monotonic() > end:
            raise AssertionError(f"timeout: {what}")
        time.sleep(0.002)


def types_of(name, definition):
    """The classes that a definition says; genpy 0.7.0 forgets formats of lists in lists."""
    types = genpy.dynamic.generate_dynamic(name, definition)
    module = sys.modules[types[name].__module__]
    for numbers in re.findall(r"_get_struct_(\w+)\(\)", inspect.getsource(module)):
        if not hasattr(module, f"_get_struct_{numbers}"):
            format = struct.Struct(f"<{numbers}")
            setattr(module, f"_get_struct_{numbers}", lambda format=format: format)
    return types


class Messages:
    """All messages of a topic by their stamps, of whatever type."""

    def __init__(self, topic):
        self.by_stamp = {}
        self.frames = set()
        self._types = {}
        self._subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._take)

    def _take(self, message):
        header = message._connection_header
        if header["type"] not in self._types:
            self._types.update(types_of(header["type"], header["message_definition"]))
            assert self._types[header["type"]]._md5sum == header["md5sum"], header["type"]
        typed = self._types[header["type"]]()
        typed.deserialize(message._buff)
        if hasattr(typed, "header"):
            self.frames.add(typed.header.frame_id)
            self.by_stamp[typed.header.stamp.to_nsec()] = typed

    def close(self):
        self._subscriber.unregister()

    def is_connected(self):
        return self._subscriber.get_num_connections() > 0


def rows(path):
    with open(path, newline="") as file:
        return {int(row["timestamp_ns"]): row for row in csv.DictReader(file)}


def make_recordings(kestrel, folder):
    bag = f"{folder}/flight.bag"
    run = lambda *arguments: subprocess.run([kestrel, *arguments], check=True, stderr=subprocess.DEVNULL)
    run("simulate", "landing", "--output", f"{folder}/flight", *SIMULATION)
    run("convert", f"{folder}/flight", bag)
    run("land", bag, "--output", f"{folder}/out")
    return bag, rows(f"{folder}/out/landing_detections.csv"), rows(f"{folder}/out/landing_track.csv")


def play_in_step(bag_path, detections):
    """Sends the bag's messages, each image after the poses that it needs and the last answer."""
    with rosbag.Bag(bag_path) as bag:
        messages = [(topic, message) for topic, message, _ in bag.read_messages()]
    latched = {"/tf_static", "/camera/camera_info"}
    publishers = {}
    for topic, message in messages:
        if topic not in publishers:
            publishers[topic] = rospy.Publisher(
                topic, type(message), queue_size=1000, latch=topic in latched
            )
    for topic, publisher in publishers.items():
        wait_until(lambda: publisher.get_num_connections() > 0, f"the node takes {topic}")
    images, poses = [], []
    for topic, message in messages:
        if topic == "/camera/image_raw":
            images.append(message)
        elif topic in latched:
            publishers[topic].publish(message)
        else:
            poses.append((message.header.stamp, topic, message))
    poses.sort(key=lambda pose: pose[0])
    images.sort(key=lambda image: image.header.stamp)
    time.sleep(0.5)  # calibration, mount and the first poses come over connections of their own
    sent = 0
    for image in images:
        first = sent
        while sent < len(poses) and (sent == 0 or poses[sent - 1][0] < image.header.stamp):
            publishers[poses[sent][1]].publish(poses[sent][2])
            sent += 1
        if first == 0:
            time.sleep(0.5)
        publishers["/camera/image_raw"].publish(image)
        stamp = image.header.stamp.to_nsec()
        wait_until(lambda: stamp in detections.by_stamp, f"an answer to the image at {stamp}")
    for publisher in publishers.values():
        publisher.unregister()
    return len(images)


def compare(expected, actual, what):
    for name, value in actual.items():
        assert abs(float(expected[name]) - value) <= TOLERANCE, (what, name, expected[name], value)


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


def call(service):
    answer = rospy.ServiceProxy(f"/kestrel/{service}", Trigger)()
    assert answer.success, (service, answer.message)


@contextlib.contextmanager
def running(node, folder, *arguments):
    """The node, from when it has been started until it is ended; what it said, when that fails."""
    with open(f"{folder}/node.log", "w") as log:
        process = subprocess.Popen([node, "image:=/camera/image_raw", *arguments], stdout=log, stderr=log)
    try:
        yield
    except BaseException:
        print(open(f"{folder}/node.log").read(), file=sys.stderr)
        raise
    finally:
        process.terminate()
        process.wait(timeout=10)


def test_in_step(bag, expected, expected_track):
    topics = {
        name: Messages(f"/kestrel/{name}")
        for name in ("detections", "target_pose", "track", "prediction", "markers", "image_annotated")
    }
    topics["diagnostics"] = Messages("/diagnostics")
    for name, messages in topics.items():
        wait_until(messages.is_connected, f"the topic {name}")
    images = play_in_step(bag, topics["detections"])
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
    wait_until(lambda: topics["diagnostics"].by_stamp, "diagnostics")
    print(f"{images} images, {found} detections and {tracked} states of the track agree")
    for messages in topics.values():
        messages.close()


def test_services():
    call("stop")
    call("start")
    rospy.set_param("/kestrel/landing/detector/min_quality", 7)
    refused = rospy.ServiceProxy("/kestrel/reset", Trigger)()
    assert not refused.success and "min_quality" in refused.message, refused
    rospy.delete_param("/kestrel/landing/detector/min_quality")
    call("reset")


def test_rosbag_play(bag, expected):
    """As from a camera: the images come when they were taken, and nobody waits for the node."""
    detections, diagnostics = Messages("/kestrel/detections"), Messages("/diagnostics")
    wait_until(detections.is_connected, "the topic detections")
    subprocess.run(["rosbag", "play", "--quiet", "--delay=1", bag], check=True,
                   stdout=subprocess.DEVNULL)
    wait_until(lambda: detections.by_stamp, "an answer to rosbag play")
    assert set(detections.by_stamp) <= set(expected)
    print(f"rosbag play: {len(detections.by_stamp)} of {len(expected)} images answered")
    print_diagnostics(diagnostics)


def test(kestrel, node, folder):
    bag, expected, expected_track = make_recordings(kestrel, folder)
    with running(node, folder, f"poses:={pose_topic(bag)}", "_poses:=topic",
                 "_fly/events/pose_wait_s:=1.0"):
        test_in_step(bag, expected, expected_track)
        test_services()
    with running(node, folder, "_poses:=none"):
        test_rosbag_play(bag, expected)


def pose_topic(bag_path):
    with rosbag.Bag(bag_path) as bag:
        return next(name for name in bag.get_type_and_topic_info().topics if name in ("/pose", "/odom"))


def print_diagnostics(messages):
    time.sleep(1.1)
    newest = messages.by_stamp[max(messages.by_stamp)].status[0]
    print("; ".join(f"{value.key}: {value.value}" for value in newest.values))


def main():
    kestrel, node = (os.path.abspath(path) for path in sys.argv[1:3])
    port = free_port()
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
    os.environ["ROS_IP"] = "127.0.0.1"
    with tempfile.TemporaryDirectory() as folder:
        os.environ["ROS_HOME"] = folder
        master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL)
        try:
            wait_until(rosgraph.is_master_online, "the master")
            rospy.init_node("kestrel_test", anonymous=True)
            test(kestrel, node, folder)
        finally:
            rospy.signal_shutdown("done")
            master.terminate()
            master.wait(timeout=10)


main()
