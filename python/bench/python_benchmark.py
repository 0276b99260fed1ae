# SPDX-License-Identifier: BSD-3-Clause
"""Times detections called from Python: beside C++, beside others' calls on the same image, and two
threads beside one.

    python_benchmark.py [PROGRAM]

PROGRAM: build/release/python/detect_time, which times the same call in C++.
"""
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

import kestrel

ROUNDS = 9
COUNT = 200


def microseconds(call, count=COUNT):
    """Median over rounds of the time of a call."""
    call()
    rounds = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        for _ in range(count):
            call()
        rounds.append((time.perf_counter() - begin) / count * 1e6)
    return statistics.median(rounds)


def tag_image(calibration):
    """A tag of the family 36h11 in the middle of an image, as Kestrel prints it."""
    import cv2

    dictionary = cv2.aruco.Dictionary_get(cv2.aruco.DICT_APRILTAG_36h11)
    image = np.full((480, 752), 200, np.uint8)
    image[190:290, 326:426] = 255
    image[200:280, 336:416] = cv2.aruco.drawMarker(dictionary, 3, 80)
    return image


def compare_tags():
    """Times of one tag in a pinhole image, by each library that is there."""
    import apriltag
    import cv2

    camera = kestrel.CameraIntrinsics(width_px=752, height_px=480, fx_px=400, fy_px=400, cx_px=376,
                                      cy_px=240)
    image = tag_image(camera)
    ours = kestrel.TagBoardDetector(camera, [{"family": "tag36h11", "id": 3, "size_m": 0.5}])
    theirs = apriltag.apriltag("tag36h11")
    dictionary = cv2.aruco.Dictionary_get(cv2.aruco.DICT_APRILTAG_36h11)
    cv2.setNumThreads(1)
    assert ours.detect(image) and theirs.detect(image)
    assert cv2.aruco.detectMarkers(image, dictionary)[1] is not None
    print(f"one tag of 80 px: kestrel {microseconds(lambda: ours.detect(image), 50):.0f} us with its "
          f"pose, libapriltag {microseconds(lambda: theirs.detect(image), 50):.0f} us, cv2.aruco "
          f"{microseconds(lambda: cv2.aruco.detectMarkers(image, dictionary), 50):.0f} us")


def compare_with_cpp(program, detector, frame, calibration):
    """The same call in C++, in turns, so that both have the same machine."""
    with tempfile.TemporaryDirectory() as folder:
        image = Path(folder) / "image.pgm"
        image.write_bytes(b"P5\n752 480\n255\n" + frame.tobytes())
        camera = Path(folder) / "camera.yaml"
        camera.write_text(kestrel.calibration_text(calibration))
        python, cpp = [], []
        for _ in range(ROUNDS):
            python.append(microseconds(lambda: detector.detect(frame), COUNT // 4))
            cpp.append(float(subprocess.run([program, camera, image], check=True,
                                            capture_output=True, text=True).stdout))
    ours, theirs = statistics.median(python), statistics.median(cpp)
    print(f"landing pattern: Python {ours:.1f} us, C++ {theirs:.1f} us, {ours - theirs:+.1f} us")


def compare_threads(detector, frame):
    """Frames per second of two threads over those of one."""

    def work():
        for _ in range(COUNT * 5):
            detector.detect(frame)

    def seconds(count):
        threads = [threading.Thread(target=work) for _ in range(count)]
        begin = time.perf_counter()
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        return time.perf_counter() - begin

    work()
    ratio = statistics.median(2 * seconds(1) / seconds(2) for _ in range(5))
    print(f"two threads: {ratio:.2f} times the frames of one")


def main():
    calibration = kestrel.paper_calibration()
    frame = np.ascontiguousarray(kestrel.simulate("calm")[0].image)
    detector = kestrel.LandingPatternDetector(calibration)
    assert detector.detect(frame)
    blank = np.zeros((48, 64), np.uint8)
    small = kestrel.CameraIntrinsics(width_px=64, height_px=48, fx_px=40, fy_px=40, cx_px=32,
                                     cy_px=24)
    nothing = kestrel.LandingPatternDetector(small)
    print(f"a call on 64 x 48 px, in which nothing is: {microseconds(lambda: nothing.detect(blank)):.1f}"
          " us with what the detector does")
    if len(sys.argv) > 1:
        compare_with_cpp(sys.argv[1], detector, frame, calibration)
    compare_threads(detector, frame)
    compare_tags()


if __name__ == "__main__":
    main()
