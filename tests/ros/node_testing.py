# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of kestrel_node have in common: a master, the node, messages, a bag played in step."""

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
import threading
import time

import genpy.dynamic
import rosbag
import rosgraph
import roslib.message
import rospy
from std_srvs.srv import Trigger

TIMEOUT_S = 60
AGAIN_S = 1
TOLERANCE = 2e-6  # the tables have 1e-6
# genpy generates classes in global state, and each topic's messages come in a thread of its own.
GENERATION = threading.Lock()


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
    with GENERATION:
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
        self.newest = None
        self.frames = set()
        self._types = {}
        self._subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._take)
        wait_until(lambda: self._subscriber.get_num_connections() > 0, f"the topic {topic}")

    def _take(self, message):
        header = message._connection_header
        if header["type"] not in self._types:
            self._types.update(types_of(header["type"], header["message_definition"]))
            assert self._types[header["type"]]._md5sum == header["md5sum"], header["type"]
        # genpy 0.7.0 makes no working code of some lists in lists: where Python has the type, that.
        installed = roslib.message.get_message_class(header["type"])
        typed = (installed or self._types[header["type"]])()
        typed.deserialize(message._buff)
        self.newest = typed
        if hasattr(typed, "header"):
            self.frames.add(typed.header.frame_id)
            self.by_stamp[typed.header.stamp.to_nsec()] = typed

    def close(self):
        self._subscriber.unregister()


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def run(kestrel, *arguments):
    subprocess.run([kestrel, *arguments], check=True, stderr=subprocess.DEVNULL)


class Bag:
    """The messages of a bag: images, poses, and what is latched, in order of time."""

    LATCHED = ("/tf_static", "/camera/camera_info")
    IMAGES = "/camera/image_raw"

    def __init__(self, path):
        self.path = path
        self.images, self.poses, self.latched = [], [], []
        self.types = {}
        with rosbag.Bag(path) as bag:
            for topic, message, _ in bag.read_messages():
                self.types[topic] = type(message)
                if topic == self.IMAGES:
                    self.images.append(message)
                elif topic in self.LATCHED:
                    self.latched.append((topic, message))
                else:
                    self.poses.append((topic, message))
        stamp = lambda message: message.header.stamp
        self.images.sort(key=stamp)
        self.poses.sort(key=lambda pose: stamp(pose[1]))

    def pose_topic(self):
        return next(topic for topic in self.types if topic in ("/pose", "/odom"))

    def play_in_step(self, answers):
        """Sends each image after the poses that it needs and the answer to the one before."""
        publishers = {
            topic: rospy.Publisher(topic, type, queue_size=1000, latch=topic in self.LATCHED)
            for topic, type in self.types.items()
        }
        for topic, publisher in publishers.items():
            wait_until(lambda: publisher.get_num_connections() > 0, f"the node takes {topic}")
        for topic, message in self.latched:
            publishers[topic].publish(message)
        sent = 0
        for image in self.images:
            while sent < len(self.poses) and (
                sent == 0 or self.poses[sent - 1][1].header.stamp < image.header.stamp
            ):
                topic, message = self.poses[sent]
                publishers[topic].publish(message)
                sent += 1
            publish_until_answered(publishers[self.IMAGES], image, answers)
        for publisher in publishers.values():
            publisher.unregister()


def publish_until_answered(publisher, image, answers):
    """Again and again: calibration, mount and first poses come over connections of their own, and an
    image that is there before them is left out."""
    stamp = image.header.stamp.to_nsec()
    end = time.monotonic() + TIMEOUT_S
    while stamp not in answers.by_stamp:
        assert time.monotonic() < end, f"no answer to the image at {stamp}"
        publisher.publish(image)
        again = time.monotonic() + AGAIN_S
        while stamp not in answers.by_stamp and time.monotonic() < again:
            time.sleep(0.002)


def compare(expected, actual, what):
    for name, value in actual.items():
        assert abs(float(expected[name]) - value) <= TOLERANCE, (what, name, expected[name], value)


def call(service):
    """What the node answers; it must have succeeded."""
    answer = rospy.ServiceProxy(f"/kestrel/{service}", Trigger)()
    assert answer.success, (service, answer.message)
    return answer.message


def call_in_vain(service):
    answer = rospy.ServiceProxy(f"/kestrel/{service}", Trigger)()
    assert not answer.success, (service, answer.message)
    return answer.message


def diagnosis(messages):
    """The newest diagnostics in words."""
    return "; ".join(f"{value.key}: {value.value}" for value in messages.newest.status[0].values)


class Echo:
    """`rostopic echo` of the next message of a topic, as a user looks at it."""

    def __init__(self, topic):
        before = self._listeners(topic)
        self._process = subprocess.Popen(["rostopic", "echo", "-n", "1", topic], text=True,
                                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        wait_until(lambda: self._listeners(topic) > before or self._process.poll() is not None,
                   f"rostopic echo {topic}")

    @staticmethod
    def _listeners(topic):
        subscribers = rosgraph.Master("/kestrel_test").getSystemState()[1]
        return sum(len(nodes) for name, nodes in subscribers if name == topic)

    def text(self):
        try:
            return self._process.communicate(timeout=TIMEOUT_S)[0]
        finally:
            self._process.kill()


@contextlib.contextmanager
def running(program, folder, *arguments):
    """A program, from when it has been started until it is ended; what it said, when that fails."""
    with open(f"{folder}/node.log", "w") as log:
        process = subprocess.Popen([program, *arguments], stdout=log, stderr=log)
    try:
        yield process
    except BaseException:
        print(open(f"{folder}/node.log").read(), file=sys.stderr)
        raise
    finally:
        process.terminate()
        process.wait(timeout=TIMEOUT_S)


@contextlib.contextmanager
def master():
    """A master of its own, and this program as a node of it; gives a folder for what is made."""
    port = free_port()
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
    os.environ["ROS_IP"] = "127.0.0.1"
    with tempfile.TemporaryDirectory() as folder:
        os.environ["ROS_HOME"] = folder
        process = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL)
        try:
            wait_until(rosgraph.is_master_online, "the master")
            rospy.init_node("kestrel_test", anonymous=True)
            yield folder
        finally:
            rospy.signal_shutdown("done")
            process.terminate()
            process.wait(timeout=TIMEOUT_S)
