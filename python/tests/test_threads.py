# SPDX-License-Identifier: BSD-3-Clause
"""Threads, memory and references."""
import gc
import sys
import threading

import numpy as np

import kestrel


def test_the_interpreter_runs_while_a_detector_works(calibration, image):
    detector = kestrel.LandingPatternDetector(calibration)
    expected = detector.detect(image).detection.center_px
    results = {}

    def work(name):
        results[name] = [detector.detect(image).detection.center_px for _ in range(50)]

    threads = [threading.Thread(target=work, args=(name,)) for name in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for centers in results.values():
        assert len(centers) == 50
        for center in centers:
            np.testing.assert_array_equal(center, expected)


def test_threads_wait_for_each_other_in_a_pipeline(flight):
    pipeline = kestrel.LandingPipeline(flight.calibration)
    frame = flight[0]
    threads = [
        threading.Thread(target=lambda: [pipeline.process(frame.image, frame.time_ns)
                                         for _ in range(20)])
        for _ in range(3)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert pipeline.process(frame.image, frame.time_ns)


def test_threads_share_the_frames_of_a_source():
    frames = iter(kestrel.simulate("calm", frames=10, rate_hz=10))
    taken = []
    threads = [threading.Thread(target=lambda: taken.extend(frame.time_ns for frame in frames))
               for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(taken) == len(set(taken)) == 10


def resident_kb():
    with open("/proc/self/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))


def test_ten_thousand_detections_leave_memory_and_references_as_they_are(calibration, drawn):
    part = np.ascontiguousarray(drawn)
    detector = kestrel.LandingPatternDetector(calibration)

    def detect(count):
        for _ in range(count):
            report = detector.detect(part)
        return report

    def references():
        gc.collect()
        return [sys.getrefcount(each) for each in (part, detector, kestrel.TargetReport, None)]

    detect(500)
    before, memory = references(), resident_kb()
    report = detect(10_000)
    assert report
    del report
    after, grown = references(), resident_kb() - memory
    assert after[:3] == before[:3]
    assert abs(after[3] - before[3]) < 50
    assert grown < 1024, f"{grown} kB more"
