#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Bags that Debian's rosbag has written give what the recording gives, and rosbag reads Kestrel's.

usage: rosbag.py KESTREL

A simulated flight is written with the message classes of Debian's ROS, in every encoding and every
compression. The table of `kestrel land` on each, without the names of the frames and detect_ms, is
that of the recording to the byte where the encoding keeps the gray values, and within some pixels
where it does not. The same with colours and `kestrel hunt`. Then rosbag reads what `kestrel convert`
has written.
"""

import csv
import io
import math
import os
import subprocess
import sys
import tempfile

import genpy
import rosbag
import yaml
from geometry_msgs.msg import Point, PoseStamped, Quaternion, TransformStamped, Vector3
from PIL import Image as Picture
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from tf2_msgs.msg import TFMessage

LANDING = ["landing", "--scenario", "calm", "--set", "frames=8", "--set", "rate_hz=10"]
HUNT = ["hunt", "--scenario", "descend", "--set", "frames=2", "--set", "rate_hz=10"]
QUICK = ["--seed", "2", "--set", "ground.map_px=256", "--set", "shutter.rays_per_pixel=4"]
OF_THE_BAG = ("frame", "detect_ms")
# What the lens of the neighbours' gray values, or of blocks of 8 pixels, may shift.
TOLERANCE_PX = 1.0


def run(*arguments):
    done = subprocess.run(arguments, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 0, (arguments, done.stderr)


def interleave(*channels):
    data = bytearray(len(channels) * len(channels[0]))
    for i, channel in enumerate(channels):
        data[i :: len(channels)] = channel
    return bytes(data)


class Recording:
    """A recording folder of `kestrel simulate`, read without Kestrel."""

    def __init__(self, folder):
        root = f"{folder}/mav0"
        with open(f"{root}/cam0/sensor.yaml") as file:
            self.camera = yaml.safe_load(file)
        self.frames = [(int(time), f"{root}/cam0/data/{name}") for time, name in table(f"{root}/cam0/data.csv")]
        self.poses = [(int(row[0]), [float(cell) for cell in row[1:]]) for row in table(f"{root}/nav0/data.csv")]


def table(path):
    with open(path, newline="") as file:
        return [row for row in csv.reader(file) if not row[0].startswith("#")]


def stamped(message, time_ns, frame):
    message.header.stamp = genpy.Time(time_ns // 10**9, time_ns % 10**9)
    message.header.frame_id = frame
    return message


def raw(picture, encoding, channels, data):
    width, height = picture.size
    return Image(height=height, width=width, encoding=encoding, step=width * channels, data=data)


def bands(picture):
    return [band.tobytes() for band in picture.convert("RGB").split()]


def mono(picture, encoding):
    return raw(picture, encoding, 1, picture.convert("L").tobytes())


def colored(picture, encoding):
    """bgr8, rgb8, bgra8, rgba8."""
    channels = dict(zip("rgb", bands(picture)), a=bytes([255]) * (picture.width * picture.height))
    order = encoding.rstrip("8")
    return raw(picture, encoding, len(order), interleave(*(channels[channel] for channel in order)))


def bayer(picture, encoding):
    """bayer_rggb8: the colours of the first two pixels of the first row, and of the second."""
    channels, pattern, width = dict(zip("rgb", bands(picture))), encoding[6:10], picture.width
    data = bytearray(width * picture.height)
    for y in range(picture.height):
        row = slice(y * width, (y + 1) * width)
        data[row] = interleave(*(channels[pattern[2 * (y % 2) + x]][row][x::2] for x in (0, 1)))
    return raw(picture, encoding, 1, bytes(data))


def yuv(picture, encoding):
    """The brightness with gray colour."""
    gray = picture.convert("L").tobytes()
    none = bytes([128]) * len(gray)
    is_uyvy = encoding in ("yuv422", "uyvy")
    return raw(picture, encoding, 2, interleave(none, gray) if is_uyvy else interleave(gray, none))


def compressed(picture, encoding):
    stream = io.BytesIO()
    picture.save(stream, encoding, **({"quality": 95} if encoding == "jpeg" else {}))
    return CompressedImage(format=encoding, data=stream.getvalue())


def camera_info(camera):
    (width, height), (fx, fy, cx, cy) = camera["resolution"], camera["intrinsics"]
    model = {"equidistant": "equidistant", "radial-tangential": "plumb_bob"}[camera["distortion_model"]]
    return CameraInfo(
        height=height,
        width=width,
        distortion_model=model,
        D=camera["distortion_coefficients"],
        K=[fx, 0, cx, 0, fy, cy, 0, 0, 1],
        R=[1, 0, 0, 0, 1, 0, 0, 0, 1],
        P=[fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0],
    )


def quaternion(rotation):
    """Of a matrix that turns by less than a half turn about its largest axis."""
    i = max(range(3), key=lambda axis: rotation[axis][axis])
    j, k = (i + 1) % 3, (i + 2) % 3
    root = math.sqrt(1 + rotation[i][i] - rotation[j][j] - rotation[k][k])
    xyz = [0.0] * 3
    xyz[i] = root / 2
    xyz[j] = (rotation[j][i] + rotation[i][j]) / (2 * root)
    xyz[k] = (rotation[k][i] + rotation[i][k]) / (2 * root)
    return Quaternion(*xyz, (rotation[k][j] - rotation[j][k]) / (2 * root))


def mount(camera):
    numbers = camera["T_BS"]["data"]
    rows = [numbers[4 * row : 4 * row + 4] for row in range(3)]
    transform = TransformStamped(child_frame_id="camera")
    transform.header.frame_id = "base_link"
    transform.transform.translation = Vector3(*(row[3] for row in rows))
    transform.transform.rotation = quaternion([row[:3] for row in rows])
    return transform


def pose(cells):
    message = PoseStamped()
    message.pose.position = Point(*cells[:3])
    w, x, y, z = cells[3:7]
    message.pose.orientation = Quaternion(x, y, z, w)
    return message


def write_bag(path, recording, encode, encoding, compression="none"):
    first = recording.frames[0][0]
    messages = [(first, "/tf_static", TFMessage([stamped(mount(recording.camera), first, "base_link")]))]
    for time, cells in recording.poses:
        messages.append((time, "/pose", stamped(pose(cells), time, "map")))
    for time, path_of_image in recording.frames:
        messages.append((time, "/camera/camera_info", stamped(camera_info(recording.camera), time, "camera")))
        image = stamped(encode(Picture.open(path_of_image), encoding), time, "camera")
        topic = "/camera/image_raw" + ("/compressed" if encode is compressed else "")
        messages.append((time, topic, image))
    with rosbag.Bag(path, "w", compression=compression, chunk_threshold=1 << 20) as bag:
        for time, topic, message in sorted(messages, key=lambda each: each[0]):
            bag.write(topic, message, genpy.Time(time // 10**9, time % 10**9))


class Comparison:
    def __init__(self, kestrel, command, folder, simulation):
        self._run = lambda *arguments: run(kestrel, *arguments)
        self._command, self._folder = command, folder
        self._file = {"land": "landing_detections.csv", "hunt": "object_detections.csv"}[command]
        self.flight = f"{folder}/{command}_flight"
        self._run("simulate", *simulation, *QUICK, "--output", self.flight)
        self.recording = Recording(self.flight)
        self._expected = self.result(self.flight)
        assert all(row["u_px"] for row in self._expected), self._expected

    def result(self, source):
        output = f"{self._folder}/out"
        self._run(self._command, source, "--output", output, "--force")
        with open(f"{output}/{self._file}", newline="") as file:
            rows = list(csv.DictReader(file))
        return [{key: row[key] for key in row if key not in OF_THE_BAG} for row in rows]

    def same(self, encode, encoding, compression="none"):
        rows = self._written(encode, encoding, compression)
        assert rows == self._expected, (encoding, compression, rows, self._expected)

    def close(self, encode, encoding):
        rows = self._written(encode, encoding)
        assert len(rows) == len(self._expected), encoding
        shifts = [math.dist(*((float(each["u_px"]), float(each["v_px"])) for each in pair))
                  for pair in zip(rows, self._expected)]
        print(f"{encoding}: shifted by up to {max(shifts):.3f} px")
        assert max(shifts) <= TOLERANCE_PX, (encoding, shifts)

    def _written(self, encode, encoding, compression="none"):
        bag = f"{self._folder}/{encoding}_{compression}.bag"
        write_bag(bag, self.recording, encode, encoding, compression)
        rows = self.result(bag)
        os.remove(bag)
        return rows

    def read_back(self, compression):
        """What `kestrel convert` writes, read by rosbag with the classes of Debian's ROS."""
        path = f"{self._folder}/converted.bag"
        self._run("convert", self.flight, path, "--compression", compression, "--force")
        images, poses = [], 0
        with rosbag.Bag(path) as bag:
            types = {topic: info.msg_type for topic, info in bag.get_type_and_topic_info().topics.items()}
            for topic, message, time in bag.read_messages():
                if topic == "/camera/image_raw":
                    assert time == message.header.stamp
                    images.append((time.to_nsec(), bytes(message.data), message.encoding))
                elif topic == "/camera/camera_info":
                    assert message.K == tuple(camera_info(self.recording.camera).K)
                poses += topic == "/pose"
        assert types == {
            "/camera/image_raw": "sensor_msgs/Image",
            "/camera/camera_info": "sensor_msgs/CameraInfo",
            "/tf_static": "tf2_msgs/TFMessage",
            "/pose": "geometry_msgs/PoseStamped",
        }, types
        for (time, data, encoding), (expected, path_of_image) in zip(images, self.recording.frames):
            assert (time, encoding) == (expected, "mono8")
            assert data == Picture.open(path_of_image).tobytes()
        assert (len(images), poses) == (len(self.recording.frames), len(self.recording.poses))


def main():
    kestrel = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        land = Comparison(kestrel, "land", folder, LANDING)
        for compression in ("none", "bz2", "lz4"):
            land.same(mono, "mono8", compression)
            land.read_back(compression)
        land.same(mono, "8UC1")
        for encoding in ("bgr8", "rgb8", "bgra8", "rgba8"):
            land.same(colored, encoding)
        for encoding in ("yuv422", "uyvy", "yuv422_yuy2", "yuyv"):
            land.same(yuv, encoding)
        land.same(compressed, "png")
        land.close(compressed, "jpeg")
        for pattern in ("rggb", "bggr", "gbrg", "grbg"):
            land.close(bayer, f"bayer_{pattern}8")
        hunt = Comparison(kestrel, "hunt", folder, HUNT)
        for encoding in ("bgr8", "rgb8"):
            hunt.same(colored, encoding)
        hunt.same(compressed, "png")
    print("all bags give what the recordings give")


main()
