# SPDX-License-Identifier: BSD-3-Clause
"""Plain values: pickled, copied, printed."""
import copy
import enum
import json
import pickle

import numpy as np
import pytest

import kestrel


def same(a, b):
    """True when two values have equal fields, whatever is in them."""
    if isinstance(a, np.ndarray):
        return np.array_equal(a, b)
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(map(same, a, b))
    if hasattr(a, "asdict"):
        return same(a.asdict(), b.asdict())
    if isinstance(a, kestrel.PadView):
        return same(a.shape, b.shape)
    if isinstance(a, kestrel.ObjectModel):
        return a.to_yaml() == b.to_yaml()
    return a == b


@pytest.fixture(scope="module")
def results(calibration, drawn, hunt_flight, flight):
    pipeline = kestrel.LandingPipeline(flight.calibration)
    for event in flight.events():
        if isinstance(event, kestrel.PoseSample):
            pipeline.add_pose(event)
        else:
            seen = pipeline.process(event.image, event.time_ns)
    hunt = kestrel.HuntPipeline(hunt_flight.calibration)
    return [
        calibration,
        calibration.body_from_camera,
        kestrel.LandingPatternDetector(calibration).detect(drawn),
        seen,
        hunt.process(hunt_flight[0].image, 0),
        event,
        flight.poses()[0],
        flight.true_patterns[0],
        kestrel.TargetHint(altitude_m=3, rotation_in_camera=[1, 0, 0, 0]),
        kestrel.TargetMeasurement(time_ns=5, position_in_world=[1, 2, 3]),
    ]


def test_values_are_pickled(results):
    for value in results:
        assert same(pickle.loads(pickle.dumps(value)), value)
        assert same(copy.deepcopy(value), value)


def test_a_pickled_result_is_drawn_alike(calibration, drawn):
    report = kestrel.LandingPatternDetector(calibration).detect(drawn)
    again = pickle.loads(pickle.dumps(report))
    np.testing.assert_array_equal(kestrel.draw(drawn, again), kestrel.draw(drawn, report))


def test_values_do_not_change(calibration):
    with pytest.raises(AttributeError):
        calibration.intrinsics.fx_px = 3
    with pytest.raises(ValueError):
        calibration.body_from_camera.translation[0] = 3
    changed = calibration.intrinsics.replace(fx_px=3)
    assert changed.fx_px == 3 and calibration.intrinsics.fx_px == 261


def test_fields_are_checked():
    with pytest.raises(TypeError, match="PoseSample has no field 'time', it has time_ns"):
        kestrel.PoseSample(time=3)
    with pytest.raises(TypeError, match="PoseSample.time_ns: got 'now'"):
        kestrel.PoseSample(time_ns="now")
    with pytest.raises(TypeError, match="CameraIntrinsics.distortion_model: got 'fish'"):
        kestrel.CameraIntrinsics(distortion_model="fish")


def test_texts_say_what_one_wants_to_see(results, calibration):
    text = repr(kestrel.LandingPatternDetector(calibration))
    assert text == "<LandingPatternDetector: a pad of 1 m in images of 752 x 480 px>"
    report = repr(results[2])
    assert "found at (" in report and " m away, quality " in report
    assert "in the world" in repr(results[3])
    for value in results:
        assert len(repr(value)) < 400 and "0x" not in repr(value)


def test_an_array_of_a_result_outlives_it(calibration, drawn):
    position = kestrel.LandingPatternDetector(calibration).detect(drawn).detection.center_in_camera
    covariance = kestrel.LandingPatternDetector(calibration).detect(drawn).detection.covariance
    kept = position.copy(), covariance.copy()
    for _ in range(50):
        kestrel.LandingPatternDetector(calibration).detect(drawn)
    assert np.array_equal(position, kept[0]) and np.array_equal(covariance, kept[1])


def test_an_enum_is_equal_to_its_word_and_prints_as_it(results):
    method = results[2].detection.method
    assert method is kestrel.DetectionMethod.RING
    assert isinstance(method, enum.Enum) and method == "ring"
    assert str(method) == f"{method}" == "ring"
    assert json.dumps({"method": method}) == '{"method": "ring"}'
    assert kestrel.PoseStatus("out of order") is kestrel.PoseStatus.OUT_OF_ORDER
    assert pickle.loads(pickle.dumps(method)) is method
    pinhole = kestrel.CameraIntrinsics(distortion_model=kestrel.DistortionModel.NONE)
    assert pinhole.distortion_model is kestrel.CameraIntrinsics(distortion_model="none").distortion_model
