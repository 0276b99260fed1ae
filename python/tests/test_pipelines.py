# SPDX-License-Identifier: BSD-3-Clause
import time

import numpy as np
import pytest

import kestrel


def fly(pipeline, flight):
    """Passes all of a flight to a pipeline; returns what it saw in each frame."""
    seen = []
    for event in flight.events():
        if isinstance(event, kestrel.PoseSample):
            assert pipeline.add_pose(event) == "ok"
        else:
            seen.append(pipeline.process(event.image, event.time_ns))
    return seen


def test_a_landing_is_followed_in_the_world(flight):
    pipeline = kestrel.LandingPipeline(flight.calibration)
    seen = fly(pipeline, flight)
    assert len(seen) == len(flight) == 10
    for observation, truth in zip(seen, flight.true_patterns):
        assert observation.time_ns == truth.time_ns
        assert observation
        place = truth.world_from_pattern.translation
        error = observation.center_in_world - place
        assert np.abs(error[:2]).max() < 0.3 and abs(error[2]) < 1, "the navigation's errors"
    assert seen[-1].track_state == "tracking"
    soon = pipeline.predict(seen[-1].time_ns + 500_000_000)
    assert soon.position.shape == (3,) and soon.position_sigma_m > 0
    assert pipeline.predict(0) is None


def test_two_cameras_make_one_track(flight):
    pipeline = kestrel.LandingPipeline([flight.calibration, flight.calibration])
    for event in flight.events():
        if isinstance(event, kestrel.PoseSample):
            pipeline.add_pose(event)
            continue
        first = pipeline.process(event.image, event.time_ns)
        second = pipeline.process(event.image, event.time_ns, camera_index=1)
        assert (first.camera, second.camera) == (0, 1)
        assert second.fate in ("started", "accepted")
    assert pipeline.camera_fault(0) is None and pipeline.camera_fault(1) is None
    with pytest.raises(kestrel.InputError, match="camera is 2, expected less than 2"):
        pipeline.process(event.image, event.time_ns, camera_index=2)


def test_a_detector_of_ones_own_choice(flight):
    detector = kestrel.make_detector(flight.calibration, {"target.kind": "helipad"})
    pipeline = kestrel.LandingPipeline(flight.calibration, detector=detector)
    assert "a pad of 1.17 m" in repr(pipeline)
    assert not pipeline.process(flight[0].image, flight[0].time_ns)


def test_a_pad_of_ones_own(calibration):
    """A white dot, 4 m below."""

    def find(image, hint):
        rows, columns = np.nonzero(image > 200)
        if len(rows) == 0:
            return None
        ray = camera.unproject([columns.mean(), rows.mean()])
        pose = kestrel.RigidTransform(translation=4 * ray / ray[2], quaternion=[0, 1, 0, 0])
        return kestrel.TargetDetection(
            center_px=[columns.mean(), rows.mean()], camera_from_target=pose, method="other",
            covariance=1e-4 * np.eye(6), quality=0.9, heading_symmetry=0)

    camera = kestrel.CameraModel(calibration)
    shape = kestrel.TargetShape(diameter_m=0.5, board_size_m=0.5)
    detector = kestrel.OwnPadDetector(calibration, shape, find)
    pipeline = kestrel.LandingPipeline(calibration, detector=detector)
    image = np.zeros((480, 752), np.uint8)
    assert pipeline.process(image, 0).report.reason == "the function has found nothing"
    image[300:310, 400:410] = 255
    found = pipeline.process(image, 1).detection
    assert found.method == "other"
    np.testing.assert_allclose(found.center_px, [404.5, 304.5])
    broken = kestrel.OwnPadDetector(calibration, shape, lambda image, hint: 1 / 0)
    assert "ZeroDivisionError" in broken.detect(image).reason


def test_ctrl_c_in_a_function_of_ones_own_is_for_the_program(calibration):
    def interrupted(image, hint):
        raise KeyboardInterrupt

    shape = kestrel.TargetShape(diameter_m=0.5, board_size_m=0.5)
    detector = kestrel.OwnPadDetector(calibration, shape, interrupted)
    with pytest.raises(KeyboardInterrupt):
        detector.detect(np.zeros((480, 752), np.uint8))
        time.sleep(5)


def test_a_hunt_has_a_map(hunt_flight):
    pipeline = kestrel.HuntPipeline(hunt_flight.calibration, map={"confirm_count": 1})
    seen = fly(pipeline, hunt_flight)
    found = [observation for observation in seen if observation.report.detections]
    assert found and found[0].in_world[0].position.shape == (3,)
    assert found[0].report.model.class_names[0] == "red"
    objects = pipeline.confirmed()
    assert objects and kestrel.class_of(objects[0], kestrel.ObjectModel())


def test_a_tracker_predicts_straight_motion():
    tracker = kestrel.TargetTracker(turn_noise=0, start_turn_sigma_radps=0, sway_sigma_m=0)
    for i in range(40):
        fate = tracker.add(kestrel.TargetMeasurement(
            time_ns=i * 50_000_000, position_in_world=[2 * 0.05 * i, 1, 0],
            covariance=1e-4 * np.eye(3)))
    assert fate == "accepted"
    assert tracker.state_at(39 * 50_000_000) == "tracking"
    soon = tracker.predict(2_450_000_000)
    np.testing.assert_allclose(soon.position, [4.9, 1, 0], atol=0.05)
    assert abs(soon.speed - 2) < 0.05
    assert tracker.predict(60_000_000_000) is None


def test_a_map_counts_an_object_once(tmp_path):
    model = kestrel.ObjectModel()
    objects = kestrel.ObjectMap(model)
    disc = kestrel.ObjectMeasurement(position=[3, 1, 0], covariance=0.01 * np.eye(3),
                                     color_probabilities=[0.95] + [0] * 15)
    for i in range(5):
        objects.update(i * 100_000_000, [disc])
    (found,) = objects.confirmed()
    np.testing.assert_allclose(found.position, [3, 1, 0], atol=1e-6)
    assert found.detections == 5 and kestrel.class_of(found, model) == "red"
    file = tmp_path / "map.json"
    kestrel.save_objects(str(file), [found])
    assert kestrel.load_objects(str(file))[0].asdict().keys() == found.asdict().keys()
    assert '"FeatureCollection"' in kestrel.geojson([found], model, 24.4, 54.4)
    # It should have been seen and was not: in the end it is gone.
    for i in range(5, 60):
        objects.update(i * 100_000_000, [], shows=lambda each: each.id == found.id)
    assert objects.objects() == []


def test_a_team_shares_its_map():
    model = kestrel.ObjectModel()
    objects = kestrel.ObjectMap(model)
    disc = kestrel.ObjectMeasurement(position=[3, 1, 0], covariance=0.01 * np.eye(3),
                                     color_probabilities=[0.95] + [0] * 15)
    for i in range(5):
        objects.update(i * 100_000_000, [disc])
    first, second = kestrel.TeamMap("alpha"), kestrel.TeamMap("bravo", rate_bytes_per_s=20000)
    first.share(objects.confirmed(), 500_000_000)
    for tick in range(1, 40):
        now = tick * 100_000_000
        for sender, receiver in ((first, second), (second, first)):
            for message in sender.tick(now):
                receiver.hear(message, now)
    assert second.uavs(now) == ["alpha", "bravo"]
    (heard,) = second.objects(now)
    assert heard.uavs == ["alpha"]
    np.testing.assert_allclose(heard.object.position, [3, 1, 0], atol=0.1)
    second.hear(b"nonsense", now)
    with pytest.raises(kestrel.InputError, match="name"):
        kestrel.TeamMap("not a name")
