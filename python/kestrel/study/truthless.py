# SPDX-License-Identifier: BSD-3-Clause
"""A run on a recording without truth: what a slower search of the same images, and the smoothed
trajectory of the pad, say of it.

The search has no limit of time, no hint of where the pad is and the default thresholds, whatever
those of the run are. A trajectory through all detections, smoothed from both directions of time,
says where the pad was in the images in which nothing was found; these are searched again, there. An
image in which the trajectory has a quarter of the pad in view is one in which it should be found:
so a miss of both run and search is counted, too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import kestrel

from .frame_score import FrameScore, Row
from .recorded_poses import RecordedPoses, navigation_variance, tilt_deg
from .trajectory import Trajectory, smooth

Array = NDArray[np.float64]

# Options of the search, which override those of the run.
_SEARCH = {"min_ring_px": 6.0, "min_quality": 0.7, "max_search_ms": 0.0}
_MIN_VISIBLE = 0.25  # as `kestrel evaluate`
_MAX_SIGMA_M = 0.5  # of a trajectory that says whether the pad is in view
_NEIGHBOR_S = 0.5  # between detections that are neighbours
_JUMP_M = 0.5
_DISC = np.array([[r * np.cos(a), r * np.sin(a), 0.0]  # of radius 1
                  for r in (0.15, 0.4, 0.65, 0.9) for a in np.arange(0, 2 * np.pi, np.pi / 12)])


@dataclass
class _Seen:
    """A detection: in the camera (m), in the image (px), its standard deviation (m)."""

    center: Array
    center_px: Array
    sigma_m: float


@dataclass
class _Image:
    """An image of the recording, and what run and search have in it."""

    time_ns: int
    name: str
    light: float
    world_from_camera: kestrel.RigidTransform | None
    tilt_deg: float | None
    live: _Seen | None
    quality: float | None
    searched: _Seen | None

    def best(self) -> _Seen | None:
        return self.searched or self.live


def judge(recording: str, rows: list[Row],
          config: str | None = None) -> tuple[list[FrameScore], Row]:
    """Judges the rows of landing_detections.csv by the recording's images alone.

    config: file of the run's options, which says what the pad is.
    Returns the scores, where `asked` is that the trajectory has the pad in view, `false` a
    detection away from it and `error_m` the distance from it; and a summary: `in_view`, `missed`
    (the estimate), `missed_seen` (of these the search found so many: surely missed), `unjudged`
    (detections where there is no trajectory), `judged` (share of the images for which there is
    one).
    """
    source = kestrel.open_recording(recording)
    try:
        lens = source.calibration.intrinsics
    except kestrel.InputError:  # the run had another, or none
        return [], {"has_truth": 0.0}
    detector = kestrel.make_detector(lens, config, detector=_SEARCH)
    images = _search(source, detector, rows)
    in_world = sum(image.world_from_camera is not None for image in images) > len(images) / 2
    trajectory = _trajectory(images, in_world)
    views = [_View(image, trajectory, k, in_world, detector) for k, image in enumerate(images)]
    _search_again(source, detector, views)
    scores = [view.score() for view in views]
    return scores, _summary(views, scores)


def _search(source: kestrel.Recording, detector: kestrel.TargetDetector,
            rows: list[Row]) -> list[_Image]:
    by_time = {int(row["timestamp_ns"]): row for row in rows}
    body_poses = RecordedPoses(source)
    images = []
    for frame in source:
        row = by_time.get(frame.time_ns)
        if row is None:
            continue
        body, camera = body_poses.at(frame.time_ns)
        report = detector.detect(frame.image, _level_hint(camera))
        images.append(_Image(frame.time_ns, frame.name, float(frame.image.mean()), camera,
                             tilt_deg(body), _live(row),
                             float(row["quality"]) if row["quality"] else None,
                             _seen(report.detection)))
    return images


def _level_hint(camera: kestrel.RigidTransform | None) -> kestrel.TargetHint:
    """Returns the direction of up, or None: it steadies the tilt of far pads."""
    if camera is None:
        return kestrel.TargetHint()
    return kestrel.TargetHint(up_in_camera=camera.rotation[2])


def _seen(detection: kestrel.TargetDetection | None) -> _Seen | None:
    if detection is None:
        return None
    return _Seen(detection.center_in_camera, detection.center_px,
                 float(np.linalg.norm(detection.sigma_in_camera) / np.sqrt(3)))


def _live(row: Row) -> _Seen | None:
    if row["detected"] != "1" or not row["p_CP_C_x_m"]:
        return None
    center, sigma = ([float(row[f"{name}_{axis}_m"]) for axis in "xyz"]
                     for name in ("p_CP_C", "sigma"))
    return _Seen(np.array(center), np.array([float(row["u_px"]), float(row["v_px"])]),
                 float(np.linalg.norm(sigma) / np.sqrt(3)))


def _trajectory(images: list[_Image], in_world: bool) -> Trajectory:
    """The pad's in the world; without poses in the camera, where it bridges only short gaps."""
    measured = np.full((len(images), 3), np.nan)
    variance = np.ones(len(images))
    for k, image in enumerate(images):
        seen, camera = image.best(), image.world_from_camera
        if seen is None or (in_world and camera is None):
            continue
        distance = float(np.linalg.norm(seen.center))
        measured[k] = camera @ seen.center if in_world and camera is not None else seen.center
        variance[k] = seen.sigma_m**2 + navigation_variance(distance)
    times_s = 1e-9 * np.array([image.time_ns - images[0].time_ns for image in images])
    return smooth(times_s, measured, variance)


class _View:
    """Returns the place of the pad in an image by the trajectory, or None."""

    def __init__(self, image: _Image, trajectory: Trajectory, k: int, in_world: bool,
                 detector: kestrel.TargetDetector) -> None:
        self.image = image
        self.sigma_m = float(trajectory.sigma_m[k])
        self.speed_mps = float(np.linalg.norm(trajectory.velocity[k])) if in_world else None
        self.is_known = self.sigma_m <= _MAX_SIGMA_M
        self.visible = 0.0
        position = trajectory.position[k]
        self.radius_m = 0.5 * detector.shape.diameter_m
        disc = position + self.radius_m * _DISC
        self.altitude_m = float(np.linalg.norm(position))
        if in_world:
            camera = image.world_from_camera
            if camera is None:
                self.is_known = False
                return
            self.altitude_m = float(max(0.0, camera.translation[2] - position[2]))
            position, disc = camera.inverse() @ position, camera.inverse() @ disc
        # Without poses the pad's tilt is not known: it is taken to face the camera.
        self.center: Array = position
        if self.is_known:
            self._project(detector.camera, disc)

    def _project(self, camera: kestrel.CameraModel, disc: Array) -> None:
        size = np.array([camera.intrinsics.width_px, camera.intrinsics.height_px])
        pixels = camera.project(disc)
        with np.errstate(invalid="ignore"):  # what the lens does not show is NaN
            inside = (pixels > -0.5).all(axis=1) & (pixels < size - 0.5).all(axis=1)
        self.visible = float(inside.mean())
        self.center_px = camera.project(self.center[None])[0]
        distances = np.linalg.norm(pixels - self.center_px, axis=1)
        self.radius_px = float(np.nanmax(distances, initial=0))

    def agrees(self, seen: _Seen) -> bool:
        """Returns whether a detection is at the place: by the rule of `kestrel evaluate`, widened by what
        the trajectory may be off."""
        off_px = 3 * self.sigma_m / self.radius_m * self.radius_px
        reach_px = max(4.0, 0.15 * self.radius_px) + off_px
        return bool(np.linalg.norm(seen.center_px - self.center_px) <= reach_px)

    @property
    def asked(self) -> bool:
        return self.is_known and self.visible >= _MIN_VISIBLE

    def searched(self) -> bool:
        """Returns whether the search has the pad there."""
        return self.image.searched is not None and self.agrees(self.image.searched)

    def score(self) -> FrameScore:
        image, score = self.image, FrameScore(self.image.time_ns, self.image.name)
        score.where = {"light": image.light}
        if image.tilt_deg is not None:
            score.where["tilt_deg"] = image.tilt_deg
        if not self.is_known:
            return score
        score.asked = self.asked
        score.where["altitude_m"] = self.altitude_m
        score.where["visible_fraction"] = self.visible
        if self.speed_mps is not None:
            score.where["speed_mps"] = self.speed_mps
        if image.live is not None:
            score.quality = image.quality
            score.found = self.agrees(image.live)
            score.false = not score.found
            if score.found:
                score.error_m = float(np.linalg.norm(image.live.center - self.center))
        return score


def _search_again(source: kestrel.Recording, detector: kestrel.TargetDetector,
                  views: list[_View]) -> None:
    """Searches the images in which the pad should be and neither run nor search has it, there."""
    wanted = {view.image.time_ns: view for view in views
              if view.asked and view.image.live is None and not view.searched()}
    if not wanted:
        return
    for frame in source:
        view = wanted.get(frame.time_ns)
        if view is None:
            continue
        hint = _level_hint(view.image.world_from_camera).replace(
            center_in_camera=view.center, center_sigma_m=max(0.1, view.sigma_m))
        view.image.searched = _seen(detector.detect(frame.image, hint).detection)


def _summary(views: list[_View], scores: list[FrameScore]) -> Row:
    missed = [view for view, score in zip(views, scores) if score.asked and not score.found]
    return {"has_truth": 0.0, "in_view": sum(score.asked for score in scores),
            "missed": len(missed), "missed_seen": sum(view.searched() for view in missed),
            "unjudged": sum(view.image.live is not None and not view.is_known for view in views),
            "judged": float(np.mean([view.is_known for view in views])) if views else 0.0}


def track_quality(rows: list[Row]) -> dict[str, float | None]:
    """Returns what the rows of landing_detections.csv say by themselves.

    `found_share`: images with a detection; `longest_gap_s`: between two detections; `jumps`:
    detections more than half a metre from the straight line between their neighbours in the world,
    and `neighbor_m_median`, `neighbor_m_p95`: how far they are from it.
    """
    found = [row for row in rows if row["detected"] == "1"]
    times = 1e-9 * np.array([int(row["timestamp_ns"]) for row in found])
    placed = [row for row in found if row["p_WP_W_x_m"]]
    off = _neighbor_errors(placed)
    quality: dict[str, float | None] = {"found_share": len(found) / len(rows)}
    quality["longest_gap_s"] = float(np.diff(times).max()) if len(times) > 1 else None
    if off.size:
        quality["jumps"] = float((off > _JUMP_M).sum())
        quality["neighbor_m_median"] = float(np.median(off))
        quality["neighbor_m_p95"] = float(np.percentile(off, 95))
    return quality


def _neighbor_errors(rows: list[Row]) -> Array:
    """Distances of detections from the line between those before and after, where both are near."""
    if len(rows) < 3:
        return np.empty(0)
    times = 1e-9 * np.array([int(row["timestamp_ns"]) for row in rows])
    places = np.array([[float(row[f"p_WP_W_{axis}_m"]) for axis in "xyz"] for row in rows])
    before, after = np.diff(times)[:-1], np.diff(times)[1:]
    share = (before / (before + after))[:, None]
    between = places[:-2] + share * (places[2:] - places[:-2])
    near = (before <= _NEIGHBOR_S) & (after <= _NEIGHBOR_S)
    return np.asarray(np.linalg.norm(places[1:-1] - between, axis=1)[near])
