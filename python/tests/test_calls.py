# SPDX-License-Identifier: BSD-3-Clause
"""Wrong calls: one line that names function, argument and what was expected."""
import numpy as np
import pytest

import kestrel

IMAGE = np.zeros((4, 4), np.uint8)


@pytest.fixture(scope="module")
def pipeline(calibration):
    return kestrel.LandingPipeline(calibration)


@pytest.mark.parametrize("call, line", [
    (lambda p: p.process(IMAGE), "LandingPipeline.process: 'time_ns' is missing, expected int"),
    (lambda p: p.process(IMAGE, 1.5), "LandingPipeline.process: 'time_ns' is 1.5, expected int"),
    (lambda p: p.process(IMAGE, 1, 2), "LandingPipeline.process: got 3 by position, expected 2 at "
                                       "most (image, time_ns)"),
    (lambda p: p.process(IMAGE, time=1), "LandingPipeline.process: has no argument 'time', "
                                         "expected image, time_ns, camera_index"),
    (lambda p: p.process(IMAGE, 2**80), "LandingPipeline.process: got (ndarray of shape (4, 4), "
                                        f"{2**80}), expected (image, time_ns: int, *, "
                                        "camera_index: int = 0)"),
    (lambda p: p.set_altitude("3 m"), "LandingPipeline.set_altitude: 'altitude_m' is '3 m', "
                                      "expected float or None"),
    (lambda p: kestrel.LandingPipeline("a.yaml"), "LandingPipeline: 'calibration' is 'a.yaml', "
                                                  "expected CameraCalibration or "
                                                "List[CameraCalibration]"),
    (lambda p: kestrel.CameraModel("a.yaml"), "CameraModel: 'camera' is 'a.yaml', expected "
                                              "CameraModel, CameraIntrinsics or CameraCalibration"),
    (lambda p: kestrel.PoseSample(1), "PoseSample: got 1 by position, expected none"),
    (lambda p: kestrel.PoseSample(time_ns="now"), "PoseSample.time_ns: got 'now', expected: int, ns."),
    (lambda p: kestrel.draw(IMAGE, 2), "draw: 'observation' is 2, expected LandingObservation, "
                                       "TargetReport, HuntObservation, FollowObservation or "
                                       "ObjectReport"),
    (lambda p: kestrel.RigidTransform.from_matrix("I"), "RigidTransform.from_matrix: 'matrix' is "
                                                        "'I', expected ndarray[float64[4, 4]]"),
    (lambda p: kestrel.Session("flight", sinks=[3]), "Session: 'sinks' is [3], expected "
                                                     "List[function]"),
])
def test_a_wrong_call_is_one_line(pipeline, call, line):
    with pytest.raises(TypeError) as error:
        call(pipeline)
    assert str(error.value) == line


def test_an_error_inside_a_right_call_stays(calibration):
    with pytest.raises(TypeError, match="image: "):
        kestrel.LandingPatternDetector(calibration).detect("image")


def test_an_altitude_in_millimetres_is_refused(pipeline):
    with pytest.raises(kestrel.InputError, match="altitude_m is 1500, expected metres: 1.5?"):
        pipeline.set_altitude(1500)


def test_a_plain_target_is_a_warning(calibration):
    target = {"kind": "aruco", "aruco": {"family": "aruco_original", "id": 1023}}
    board = [{"family": "aruco_original", "id": 1023, "size_m": 0.5}]
    for make in (lambda: kestrel.make_detector(calibration, target=target),
                 lambda: kestrel.LandingPipeline(calibration, target=target),
                 lambda: kestrel.Session("flight", options={"landing": {"target": target}}),
                 lambda: kestrel.TagBoardDetector(calibration, board)):
        with pytest.warns(UserWarning, match="aruco_original id 1023 is as plain as"):
            make()


def test_unused_keys_of_a_recordings_calibration_are_warnings(flight, tmp_path):
    flight.write(tmp_path / "flight")
    sensor = tmp_path / "flight/mav0/cam0/sensor.yaml"
    sensor.write_text(sensor.read_text() + "lens_shift: 3\n")
    with pytest.warns(UserWarning, match="not used, as not known here: 'lens_shift'"):
        kestrel.open_recording(tmp_path / "flight")
