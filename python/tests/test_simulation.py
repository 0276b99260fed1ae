# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import kestrel


def test_a_flight_is_an_iterator_of_frames(flight):
    frames = list(flight)
    assert len(frames) == len(flight) == 10
    np.testing.assert_array_equal(frames[3].image, flight[3].image)
    np.testing.assert_array_equal(flight[-1].image, frames[-1].image)
    with pytest.raises(IndexError):
        flight[10]
    assert [frame.time_ns for frame in frames] == [each.time_ns for each in flight.true_patterns]
    assert flight.poses()[0].time_ns < frames[0].time_ns
    assert not frames[0].image.flags.writeable


def test_the_seed_is_all_that_chance_depends_on():
    first, again, other = (kestrel.simulate("calm", seed=seed)[0].image
                           for seed in (5, 5, 6))
    assert np.array_equal(first, again) and not np.array_equal(first, other)


def test_settings_are_those_of_the_command():
    assert len(kestrel.simulate("calm", frames=30, rate_hz=10)) == 30
    with pytest.raises(kestrel.InputError, match="unknown key 'frame'"):
        kestrel.simulate("calm", frame=3)
    with pytest.raises(kestrel.InputError, match="clam"):
        kestrel.simulate("clam")
    assert "calm" in kestrel.scenarios() and "sweep" in kestrel.scenarios(hunt=True)


def test_a_view_from_below_is_refused(calibration):
    with pytest.raises(kestrel.InputError):
        kestrel.render_pattern(calibration, kestrel.RigidTransform(translation=[0, 0, 4]))
    with pytest.raises(kestrel.InputError, match="did you mean 'outer_diameter_m'"):
        kestrel.render_pattern(
            calibration, kestrel.RigidTransform(translation=[0, 0, 4], quaternion=[0, 1, 0, 0]),
            {"outer_diameter": 2})


def test_a_lens_is_calibrated():
    flight = kestrel.simulate("stills", frames=14, stills={
        "min_altitude_m": 0.7, "max_altitude_m": 2.2, "max_tilt_deg": 50})
    lens = kestrel.calibrate_lens(flight, model="equidistant")
    assert abs(lens.intrinsics.fx_px / 261 - 1) < 0.03 and lens.used > 8
    with pytest.raises(kestrel.InputError):
        kestrel.calibrate_lens([flight[0].image])
    with pytest.raises(TypeError, match="expected a gray image"):
        kestrel.calibrate_lens([3])


def test_a_mount_is_calibrated(calibration):
    """A camera 3 degrees off, which looks at a standing target from all sides."""
    turn = np.deg2rad(3) / 2
    wrong = kestrel.RigidTransform(quaternion=[np.cos(turn), np.sin(turn), 0, 0])
    given = kestrel.MountAndClock(body_from_camera=calibration.body_from_camera)
    true = wrong @ calibration.body_from_camera
    poses, sightings = [], []
    for i in range(300):
        time = i * 50_000_000
        angle = 0.05 * i
        heading = kestrel.RigidTransform(
            translation=[3 * np.cos(angle), 3 * np.sin(angle), 5],
            quaternion=[np.cos(angle / 2), 0, 0, np.sin(angle / 2)])
        poses.append(kestrel.PoseSample(time_ns=time, world_from_body=heading))
        center = (heading @ true).inverse() @ [0, 0, 0]
        sightings.append(kestrel.TargetSighting(time_ns=time, center_in_camera=center, sigma_m=0.01))
    found = kestrel.calibrate_flight(sightings, poses, given, clock=False)
    assert abs(np.rad2deg(found.angles[0]) - 3) < 0.1
    assert found.estimate.clock_offset_s == 0
    assert found.rms_after_m < 0.1 * found.rms_before_m
