# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest

import kestrel


def pixels_of(count):
    return np.random.default_rng(1).uniform([0, 0], [752, 480], (count, 2))


def test_unproject_is_the_inverse_of_project(calibration):
    camera = kestrel.CameraModel(calibration)
    pixels = pixels_of(500)
    rays = camera.unproject(pixels)
    assert rays.shape == (500, 3)
    np.testing.assert_allclose(np.linalg.norm(rays, axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(camera.project(3 * rays), pixels, atol=1e-6)


def test_one_point_is_not_many(calibration):
    camera = kestrel.CameraModel(calibration)
    np.testing.assert_allclose(camera.project([0, 0, 1]), [376, 240])
    assert camera.unproject((376, 240)).shape == (3,)


def test_points_outside_of_the_lens_are_nan(calibration):
    assert np.isnan(kestrel.CameraModel(calibration).project([0, 0, -1])).all()


def test_rays_of_the_table_are_those_of_the_model(calibration):
    pixels = pixels_of(2000).astype(np.float32)
    rays = kestrel.RayTable(calibration).rays(pixels)
    assert rays.dtype == np.float32
    exact = kestrel.CameraModel(calibration).unproject(pixels)
    inside = ~np.isnan(exact).any(axis=1)
    assert inside.sum() > 1500
    error = np.linalg.norm(rays[inside] - exact[inside], axis=1)
    assert error.max() < 0.02 / 261


def test_points_of_another_shape_are_refused(calibration):
    with pytest.raises(TypeError, match=r"pixels: got float64 array of shape \(4, 3\), expected"):
        kestrel.RayTable(calibration).rays(np.zeros((4, 3)))
    with pytest.raises(TypeError, match="points_in_camera: got <U1 array"):
        kestrel.CameraModel(calibration).project(["a", "b", "c"])


def test_a_camera_of_nan_is_refused(calibration):
    broken = calibration.intrinsics.replace(fx_px=math.nan)
    with pytest.raises(kestrel.InputError, match="fx"):
        kestrel.CameraModel(broken)
    with pytest.raises(kestrel.InputError, match="fx"):
        kestrel.LandingPatternDetector(broken)


def test_a_missing_file_is_named():
    with pytest.raises(kestrel.InputError, match="nowhere.yaml"):
        kestrel.read_calibration("nowhere.yaml")


def test_a_calibration_is_written_and_read(calibration, tmp_path):
    file = tmp_path / "camera.yaml"
    file.write_text(kestrel.calibration_text(calibration))
    read = kestrel.read_calibration(file)
    assert read.intrinsics.asdict() == calibration.intrinsics.asdict()
    np.testing.assert_array_equal(
        read.body_from_camera.matrix, calibration.body_from_camera.matrix
    )


def test_transforms_cancel():
    world_from_body = kestrel.RigidTransform(translation=[1, 2, 3], quaternion=[0.5, 0.5, 0.5, 0.5])
    identity = world_from_body @ world_from_body.inverse()
    np.testing.assert_allclose(identity.matrix, np.eye(4), atol=1e-12)
    points = np.arange(6.0).reshape(2, 3)
    moved = points @ world_from_body.rotation.T + world_from_body.translation
    np.testing.assert_allclose(world_from_body @ points, moved)
    again = kestrel.RigidTransform.from_matrix(world_from_body.matrix)
    np.testing.assert_allclose(again.quaternion, world_from_body.quaternion)
    with pytest.raises(kestrel.InputError, match="w, x, y, z of length 1"):
        kestrel.RigidTransform(quaternion=[1, 1, 0, 0])


def test_poses_are_interpolated():
    poses = kestrel.PoseHistory(capacity=10)
    for second in range(3):
        pose = kestrel.RigidTransform(translation=[second, 0, 10])
        sample = kestrel.PoseSample(time_ns=second * 100_000_000, world_from_body=pose)
        assert poses.add(sample) == "ok"
    assert poses.add(sample) == "out of order"
    assert len(poses) == 3
    np.testing.assert_allclose(poses.lookup(150_000_000).translation, [1.5, 0, 10])
    assert poses.lookup(900_000_000) is None
    assert poses.check(900_000_000) == "too new"
