# SPDX-License-Identifier: BSD-3-Clause
"""Times detections called from Python: beside C++, beside others' calls on the same image, and two
threads beside one.

    python_benchmark.py [PROGRAM]

PROGRAM: build/release/python/detect_time, which times the same call in C++.
"""
import multiprocessing
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


def tag_image():
    """A tag of the family 36h11 on a white wall, in the middle of an image."""
    import cv2

    dictionary = cv2.aruco.Dictionary_get(cv2.aruco.DICT_APRILTAG_36h11)
    image = np.full((480, 752), 230, np.uint8)
    image[200:280, 336:416] = cv2.aruco.drawMarker(dictionary, 3, 80)
    return image


def compare_tags():
    """Times of one tag in a pinhole image, by each library that is there."""
    import apriltag
    import cv2

    camera = kestrel.CameraIntrinsics(width_px=752, height_px=480, fx_px=400, fy_px=400, cx_px=376,
                                      cy_px=240)
    image = tag_image()
    ours = kestrel.TagBoardDetector(camera, [{"family": "tag36h11", "id": 3, "size_m": 0.5}])
    theirs = apriltag.apriltag("tag36h11")
    dictionary = cv2.aruco.Dictionary_get(cv2.aruco.DICT_APRILTAG_36h11)
    cv2.setNumThreads(1)
    assert ours.detect(image) and theirs.detect(image)
    assert cv2.aruco.detectMarkers(image, dictionary)[1] is not None
    print(f"one tag of 80 px: kestrel {microseconds(lambda: ours.detect(image), 50):.0f} us with its "
          f"pose, libapriltag {microseconds(lambda: theirs.detect(image), 50):.0f} us, cv2.aruco "
          f"{microseconds(lambda: cv2.aruco.detectMarkers(image, dictionary), 50):.0f} us")


def compare_with_cpp(program, name, camera, frame):
    """The same call in C++, in turns, so that both have the same machine."""
    detector = kestrel.LandingPatternDetector(camera)
    with tempfile.TemporaryDirectory() as folder:
        image = Path(folder) / "image.pgm"
        image.write_bytes(f"P5\n{frame.shape[1]} {frame.shape[0]}\n255\n".encode() + frame.tobytes())
        calibration = Path(folder) / "camera.yaml"
        calibration.write_text(kestrel.calibration_text(camera))
        python, cpp = [], []
        for _ in range(ROUNDS):
            python.append(microseconds(lambda: detector.detect(frame), COUNT // 4))
            cpp.append(float(subprocess.run([program, calibration, image], check=True,
                                            capture_output=True, text=True).stdout))
    ours, theirs = statistics.median(python), statistics.median(cpp)
    print(f"{name}: Python {ours:.1f} us, C++ {theirs:.1f} us, {ours - theirs:+.1f} us")


def seconds(make, work):
    """Time that two threads or two processes take for the same work."""
    workers = [make(target=work) for _ in range(2)]
    begin = time.perf_counter()
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return time.perf_counter() - begin


def compare_threads(detector, frame):
    """Frames per second of two threads over those of one; of two processes, what the machine has."""

    def work():
        for _ in range(COUNT * 5):
            detector.detect(frame)

    threads, processes = [], []
    for _ in range(5):
        begin = time.perf_counter()
        work()
        one = time.perf_counter() - begin
        threads.append(2 * one / seconds(threading.Thread, work))
        processes.append(2 * one / seconds(multiprocessing.Process, work))
    print(f"frames of two threads {statistics.median(threads):.2f} times those of one, of two "
          f"processes {statistics.median(processes):.2f} times")


def main():
    calibration = kestrel.paper_calibration()
    frame = np.ascontiguousarray(kestrel.simulate("calm")[0].image)
    detector = kestrel.LandingPatternDetector(calibration)
    assert detector.detect(frame)
    if len(sys.argv) > 1:
        compare_with_cpp(sys.argv[1], "landing pattern in 752 x 480 px", calibration, frame)
        small = kestrel.CameraIntrinsics(width_px=64, height_px=48, fx_px=40, fy_px=40, cx_px=32,
                                         cy_px=24)
        compare_with_cpp(sys.argv[1], "nothing in 64 x 48 px", small, np.zeros((48, 64), np.uint8))
    compare_threads(detector, frame)
    compare_tags()


if __name__ == "__main__":
    main()
