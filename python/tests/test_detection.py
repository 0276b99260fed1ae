# SPDX-License-Identifier: BSD-3-Clause
import json

import numpy as np
import pytest

import kestrel


def test_the_pattern_is_found_where_it_was_drawn(calibration, drawn, below):
    report = kestrel.LandingPatternDetector(calibration).detect(drawn)
    assert report
    found = report.detection
    np.testing.assert_allclose(found.center_in_camera, below.translation, atol=0.02)
    expected = kestrel.CameraModel(calibration).project(below.translation)
    np.testing.assert_allclose(found.center_px, expected, atol=0.1)
    assert found.quality > 0.9
    assert (np.linalg.eigvalsh(found.covariance) > 0).all()
    assert report.diagnostics.candidates["found"] >= 1


def test_a_miss_says_why(calibration):
    report = kestrel.LandingPatternDetector(calibration).detect(np.zeros((480, 752), np.uint8))
    assert not report
    assert report.detection is None
    assert report.reached == "binarize"
    assert report.reason and report.reason in repr(report)


def test_a_part_of_an_array_is_searched_without_a_copy(calibration, drawn):
    large = np.zeros((600, 1000), np.uint8)
    large[20:500, 30:782] = drawn
    detector = kestrel.LandingPatternDetector(calibration)
    whole = detector.detect(drawn).detection
    part = detector.detect(large[20:500, 30:782]).detection
    np.testing.assert_array_equal(part.center_px, whole.center_px)


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda image: image.astype(float), "got float64 array of shape .480, 752."),
        (lambda image: image.astype(np.int8), "got int8 array"),
        (lambda image: image[::-1], "strides .-752, 1."),
        (lambda image: np.repeat(image, 2, axis=1)[:, ::2], "strides .1504, 2."),
        (lambda image: np.asfortranarray(image), "strides .1, 480."),
        (lambda image: np.stack([image] * 3, axis=2), "shape .480, 752, 3."),
        (lambda image: image[0], "shape .752,."),
        (lambda image: image.tolist(), "got list"),
        (lambda image: None, "got NoneType"),
        (lambda image: image[:0], "shape .0, 752."),
    ],
)
def test_an_image_of_another_kind_is_refused(calibration, image, make, message):
    with pytest.raises(TypeError, match="image: " + ".*" + message + ".*expected a gray image"):
        kestrel.LandingPatternDetector(calibration).detect(make(image))


def test_an_image_of_another_size_is_refused(calibration):
    with pytest.raises(kestrel.InputError, match="640.*480.*752"):
        kestrel.LandingPatternDetector(calibration).detect(np.zeros((480, 640), np.uint8))


def test_options_are_keywords_a_dict_or_a_file(calibration, tmp_path):
    size = {"outer_diameter_m": 0.6, "ring_width_m": 0.06, "arm_width_m": 0.06,
            "arm_half_length_m": 0.23, "board_size_m": 0.9}
    file = tmp_path / "kestrel.yaml"
    file.write_text(json.dumps({"landing": {"detector": {"pattern": size}}}))
    flat = {"pattern." + name: value for name, value in size.items()}
    for detector in (
        kestrel.LandingPatternDetector(calibration, pattern=size),
        kestrel.LandingPatternDetector(calibration, {"pattern": size}),
        kestrel.LandingPatternDetector(calibration, flat),
        kestrel.LandingPatternDetector(calibration, file),
    ):
        assert detector.shape.diameter_m == 0.6


def test_the_groups_of_the_command_in_a_file_are_left_alone(calibration, tmp_path):
    file = tmp_path / "kestrel.yaml"
    file.write_text("fly:\n  rate_hz: 20\nlanding:\n  detector:\n    min_qualiti: 0.5\n")
    with pytest.raises(kestrel.InputError, match="kestrel.yaml:5: .*did you mean .*min_quality"):
        kestrel.LandingPatternDetector(calibration, str(file))


@pytest.mark.parametrize(
    "options, message",
    [
        ({"min_qualiti": 0.9}, "did you mean 'min_quality'"),
        ({"min_quality": "high"}, "min_quality: got 'high' .str., expected a finite number"),
        ({"min_quality": float("nan")}, "min_quality: got nan"),
        ({"min_quality": True}, "min_quality: got True"),
        ({"pattern": 3}, "pattern: got 3, expected a dict of options"),
        ({"min_quality": 2}, "min_quality"),
    ],
)
def test_a_wrong_option_is_named(calibration, options, message):
    with pytest.raises(kestrel.InputError, match=message):
        kestrel.LandingPatternDetector(calibration, options)
    with pytest.raises(kestrel.InputError, match=message):
        kestrel.LandingPatternDetector(calibration, **options)


def test_detectors_of_all_kinds(calibration, tmp_path):
    tag = {"family": "tag36h11", "id": 3, "size_m": 0.5}
    board = tmp_path / "board.yaml"
    board.write_text(json.dumps({"tags": [tag]}))
    assert kestrel.TagBoardDetector(calibration, [tag]).shape.tags[0].id == 3
    assert kestrel.TagBoardDetector(calibration, board).shape.tags[0].size_m == 0.5
    assert kestrel.HelipadDetector(calibration, height_m=2, width_m=1.2, stroke_m=0.27,
                                   frame="none", board_size_m=3).shape.board_size_m == 3
    small = {"id": 1, "size_m": 0.1, "x_m": 0.25, "y_m": 0.25}
    assert len(kestrel.RingWithTagsDetector(calibration, [small]).shape.tags) == 1
    assert "apriltag" in kestrel.target_kinds()
    made = kestrel.make_detector(calibration, target={"kind": "apriltag", "apriltag": tag})
    assert made.shape.tags[0].family == "tag36h11"
    with pytest.raises(kestrel.InputError, match="tag36h12"):
        kestrel.TagBoardDetector(calibration, [{**tag, "family": "tag36h12"}])


def test_a_hint_and_what_is_drawn(calibration, drawn, below):
    detector = kestrel.LandingPatternDetector(calibration)
    hint = kestrel.TargetHint(center_in_camera=below.translation, altitude_m=4,
                               up_in_camera=[0, 0, -1])
    report = detector.detect(drawn, hint)
    picture = kestrel.draw(drawn, report)
    assert picture.shape == (480, 752, 3) and picture.dtype == np.uint8
    # Outlines are coloured.
    assert (picture.max(axis=2) != picture.min(axis=2)).sum() > 300
    with pytest.raises(kestrel.InputError, match="result of a detector"):
        kestrel.draw(drawn, kestrel.TargetReport())


def test_objects_are_found(hunt_flight):
    frames = list(hunt_flight)
    assert len(frames) == 4
    detector = kestrel.ObjectDetector(hunt_flight.calibration)
    reports = [detector.detect(frame.image) for frame in frames]
    assert sum(len(report.detections) for report in reports) > 0
    picture = kestrel.draw(frames[0].image, reports[0])
    assert picture.shape == (720, 1280, 3)
    with pytest.raises(TypeError, match="expected a colour image"):
        detector.detect(frames[0].image[:, :, 0])
    with pytest.raises(kestrel.InputError, match="did you mean 'min_pixels'"):
        kestrel.ObjectDetector(hunt_flight.calibration, min_pixel=3)


@pytest.fixture(scope="module")
def tag_image():
    tag = {"kind": "apriltag", "apriltag": {"id": 3, "size_m": 0.5}}
    return kestrel.simulate("calm", frames=10, rate_hz=10, target=tag)[0].image


def test_all_tags_of_an_image_are_found(tag_image):
    wide = np.hstack([tag_image, tag_image])
    tags = kestrel.detect_tags(wide, ["aruco_4x4_50", "tag36h11"])
    assert [(tag.family, tag.id) for tag in tags] == [("tag36h11", 3)] * 2
    assert tags[0].corners_px.shape == (4, 2) and tags[0].decision_margin > 10
    apart = np.abs(tags[0].corners_px - tags[1].corners_px).max(axis=0)
    np.testing.assert_allclose(apart, [tag_image.shape[1], 0], atol=0.3)
    assert "tag36h11 id 3 at (" in repr(tags[0])


def test_the_corners_turn_with_the_image(tag_image):
    before = kestrel.detect_tags(tag_image, ["tag36h11"])[0].corners_px
    turned = np.ascontiguousarray(np.rot90(tag_image, -1))
    after = kestrel.detect_tags(turned, ["tag36h11"])[0].corners_px
    expected = np.stack([tag_image.shape[0] - 1 - before[:, 1], before[:, 0]], axis=1)
    np.testing.assert_allclose(after, expected, atol=0.1)


def test_the_corners_are_in_the_order_of_the_pose(tag_image):
    corners = kestrel.detect_tags(tag_image, ["tag36h11"])[0].corners_px
    tag = {"family": "tag36h11", "id": 3, "size_m": 0.5}
    calibration = kestrel.paper_calibration()
    pose = kestrel.TagBoardDetector(calibration, [tag]).detect(tag_image).detection.camera_from_target
    places = 0.25 * np.array([[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]])
    expected = kestrel.CameraModel(calibration).project(pose @ places)
    np.testing.assert_allclose(corners, expected, atol=1)


def test_a_colour_image_has_the_tags_of_its_luminance(tag_image):
    color = np.stack([tag_image] * 3, axis=2)
    assert [tag.id for tag in kestrel.detect_tags(color, ["tag36h11"])] == [3]


def test_wrong_calls_of_detect_tags(tag_image):
    with pytest.raises(kestrel.InputError, match="'tag36h12', did you mean 'tag36h11'"):
        kestrel.detect_tags(tag_image, ["tag36h12"])
    with pytest.raises(TypeError, match="detect_tags: 'families' is 'tag36h11'"):
        kestrel.detect_tags(tag_image, "tag36h11")
    with pytest.raises(TypeError, match="image: got uint8 array of shape .0, 0."):
        kestrel.detect_tags(np.zeros((0, 0), np.uint8), ["tag36h11"])
    with pytest.raises(TypeError, match="image: got float64 array"):
        kestrel.detect_tags(np.full((48, 64), np.nan), ["tag36h11"])
    assert kestrel.detect_tags(np.zeros((1, 1), np.uint8), ["tag36h11"]) == []
    assert "tag36h11" in kestrel.tag_families()


@pytest.mark.parametrize("size_m", [float("nan"), 0, -1])
def test_a_tag_of_no_size_is_refused(calibration, size_m):
    with pytest.raises(kestrel.InputError, match="size_m"):
        kestrel.make_detector(calibration, target={"kind": "apriltag", "apriltag": {"size_m": size_m}})
