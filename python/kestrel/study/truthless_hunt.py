# SPDX-License-Identifier: BSD-3-Clause
"""A hunt on a recording without truth: what a second search of the same images, and the places of
all detections together, say of it.

The search has the default thresholds or lower ones, whatever those of the run are. Detections of
search and run that are of one place, or of one path, are one object. It exists if it was seen often
enough, of the images that have it in view; an image that has it in view is one in which it should
be found. A place that is in view again and again, and has nothing there, makes a detection false.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

import kestrel

from .frame_score import FrameScore, Row
from .recorded_poses import RecordedPoses, navigation_variance, places
from .trajectory import smooth

Array = NDArray[np.float64]

# Options of the search, which override the defaults.
_SEARCH = {"min_pixels": 20, "max_gap": 0.5}
_MERGED = "merged"  # shape of discs that touch: they have no position
_LINK_S = 1.0  # between detections of one path
_LINK_M = 0.15
_LINK_MPS = 2.0  # speed of an object, between two detections
_PLACE_M = 0.3  # between standing objects
_MIN_SEEN = 5  # detections of an object that exists, and views that make one doubtful
_MIN_SEEN_SHARE = 0.2  # of the images that have it in view
_MAX_SIGMA_M = 0.15  # of a place that is known
_MIN_AREA_PX = 50  # of an object that should be found, and
_MIN_REACH_PX = 5.0  # distance of a detection of it: as `kestrel evaluate`
_BESIDE_PX = 100.0  # beyond the border: the centre of an object that is half in view
_GRAY_OF_BGR = np.array([0.114, 0.587, 0.299])  # ITU-R BT.601, as of gray images
_CIRCLE = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(0, 2 * np.pi, np.pi / 12)])


@dataclass
class _Seen:
    """A detection: in the image (px), in the world (m; None without), its variance per axis."""

    center_px: Array
    semi_major_px: float
    name: str
    probability: float
    place: Array | None
    variance: float

    @property
    def reach_px(self) -> float:
        return max(_MIN_REACH_PX, self.semi_major_px)

    def is_at(self, other: _Seen) -> bool:
        return bool(np.linalg.norm(self.center_px - other.center_px) <= self.reach_px)


@dataclass
class _Image:
    """An image of the recording, and what run and search have in it."""

    index: int
    time_ns: int
    name: str
    world_from_camera: kestrel.RigidTransform
    where: dict[str, float]
    live: list[_Seen]
    searched: list[_Seen]
    merged: list[_Seen]


@dataclass(eq=False)
class _Object:
    """Detections of one place or path, and where it is in all images."""

    seen: list[tuple[_Image, _Seen]] = field(default_factory=list)
    position: Array = field(default_factory=lambda: np.empty((0, 3)))
    sigma_m: Array = field(default_factory=lambda: np.empty(0))
    radius_m: float = 0.1
    in_view: int = 0

    def __len__(self) -> int:
        return len(self.seen)

    @property
    def path(self) -> Array:
        return np.array([seen.place for _, seen in self.seen])

    @property
    def sigma_of_one_m(self) -> float:
        return float(np.sqrt(np.median([seen.variance for _, seen in self.seen])))

    @property
    def stands(self) -> bool:
        """Returns whether first and last third of its path are at one place."""
        third = len(self) // 3
        if third == 0:
            return True
        first, last = (np.median(part, axis=0) for part in (self.path[:third], self.path[-third:]))
        return float(np.linalg.norm(last - first)) <= _LINK_M + 3 * self.sigma_of_one_m

    @property
    def exists(self) -> bool:
        return len(self) >= _MIN_SEEN and len(self) >= _MIN_SEEN_SHARE * self.in_view

    @property
    def is_doubtful(self) -> bool:
        """Returns whether it had its chances to be seen again, and was not."""
        return not self.exists and self.in_view >= _MIN_SEEN


@dataclass
class _Projection:
    """An object in an image."""

    object: _Object
    center_px: Array
    off_px: float  # three standard deviations of its place
    is_wanted: bool

    def distance_px(self, seen: _Seen) -> float | None:
        """Returns the distance of a detection of it; None of one of something else."""
        distance = float(np.linalg.norm(seen.center_px - self.center_px))
        return distance if distance <= seen.reach_px + self.off_px else None


def judge(recording: str, rows: list[Row], config: str | None = None,
          model: str | None = None) -> tuple[list[FrameScore], Row]:
    """Judges the rows of object_detections.csv by the recording's images and poses alone.

    config: file of the run's options, which says how high the ground is. model: file of the
    objects; None: the built-in ones.
    Returns the scores, where `asked` is that an object is in view, `false` a detection of nothing
    that exists, and `error_m` the distance from the place by all detections; and a summary:
    `in_view`, `missed` (the estimate), `missed_seen` (of these the search found so many: surely
    missed), `unjudged` (detections that were in view too rarely to say), `class_right` (share of
    the detections that have the class of most of their object).
    Without poses or a calibration there are no scores.
    """
    detections = sum(bool(row["class"]) for row in rows)
    source = kestrel.open_recording(recording, format="bgr")
    try:
        lens = source.calibration.intrinsics
    except kestrel.InputError:  # the run had another, or none
        return [], {"has_truth": 0.0, "detections": detections}
    detector = kestrel.ObjectDetector(lens, kestrel.ObjectModel(model) if model else None,
                                      options=None, **_SEARCH)
    images = _search(source, detector, rows, _Ground(config))
    if not images:
        return [], {"has_truth": 0.0, "detections": detections}
    objects = _joined(_paths(images))
    projections = _project_all(detector.camera, images, objects)
    return _scores(images, objects, projections)


class _Ground:
    """The ground of a run's options."""

    def __init__(self, config: str | None) -> None:
        hunt = (yaml.safe_load(Path(config).read_text()) or {}).get("hunt", {}) if config else {}
        self._is_flat = bool(hunt.get("is_ground_flat", True))
        self._height_m = float(hunt.get("ground_height_m", 0))

    def hint(self, camera: kestrel.RigidTransform) -> dict[str, Any]:
        """Returns what the detector is told of the ground below a camera."""
        height = float(camera.translation[2]) - self._height_m
        if not self._is_flat or height <= 0:
            return {}
        return {"up_in_camera": camera.rotation[2], "camera_height_m": height}


def _search(source: kestrel.Recording, detector: kestrel.ObjectDetector, rows: list[Row],
            ground: _Ground) -> list[_Image]:
    by_time: dict[int, list[Row]] = {}
    for row in rows:
        by_time.setdefault(int(row["timestamp_ns"]), []).append(row)
    poses = RecordedPoses(source)
    images: list[_Image] = []
    for frame in source:
        body, camera = poses.at(frame.time_ns)
        if camera is None or frame.time_ns not in by_time:
            continue
        report = detector.detect(frame.image, **ground.hint(camera))
        detected = [row for row in by_time[frame.time_ns] if row["class"]]
        images.append(_Image(
            len(images), frame.time_ns, frame.name, camera, places(body, _gray_level(frame.image)),
            [_live(row, camera) for row in detected if row["shape"] != _MERGED],
            [_found(one, report.model, camera) for one in report.detections],
            [_live(row, camera) for row in detected if row["shape"] == _MERGED]))
    return images


def _gray_level(image: NDArray[np.uint8]) -> float:
    return float(image.mean(axis=(0, 1)) @ _GRAY_OF_BGR)


def _live(row: Row, camera: kestrel.RigidTransform) -> _Seen:
    place = None
    variance = 0.0
    if row["p_WO_W_x_m"]:
        place = np.array([float(row[f"p_WO_W_{axis}_m"]) for axis in "xyz"])
        distance = float(np.linalg.norm(place - camera.translation))
        variance = float(row["sigma_m"] or 0)**2 + navigation_variance(distance)
    return _Seen(np.array([float(row["u_px"]), float(row["v_px"])]), float(row["semi_major_px"]),
                 row["class"], float(row["class_probability"]), place, variance)


def _found(one: kestrel.ObjectDetection, model: kestrel.ObjectModel,
           camera: kestrel.RigidTransform) -> _Seen:
    place = None
    variance = 0.0
    if one.location is not None:
        place = camera @ one.location.position
        variance = float(np.trace(one.location.covariance)) / 3 + navigation_variance(
            float(np.linalg.norm(one.location.position)))
    return _Seen(one.center_px, one.ellipse.semi_major, model.class_names[one.class_index],
                 one.class_probability, place, variance)


def _paths(images: list[_Image]) -> list[_Object]:
    """Links each detection with the nearest one that was seen shortly before."""
    done: list[_Object] = []
    going: list[_Object] = []
    for image in images:
        oldest_ns = image.time_ns - int(1e9 * _LINK_S)
        done += [path for path in going if path.seen[-1][0].time_ns < oldest_ns]
        going = [path for path in going if path.seen[-1][0].time_ns >= oldest_ns]
        linked: set[int] = set()
        fresh = _placed(image)
        for _, path, k in sorted(_links(image, going, fresh), key=lambda link: link[0]):
            if k not in linked and path.seen[-1][0] is not image:
                path.seen.append((image, fresh[k]))
                linked.add(k)
        going += [_Object([(image, seen)]) for k, seen in enumerate(fresh) if k not in linked]
    return done + going


def _placed(image: _Image) -> list[_Seen]:
    """The detections of search and run, one of each object."""
    alone = [seen for seen in image.live if not any(seen.is_at(other) for other in image.searched)]
    return [seen for seen in image.searched + alone if seen.place is not None]


def _links(image: _Image, paths: list[_Object],
           fresh: list[_Seen]) -> list[tuple[float, _Object, int]]:
    links = []
    for path in paths:
        before, last = path.seen[-1]
        most = _LINK_M + _LINK_MPS * 1e-9 * (image.time_ns - before.time_ns)
        for k, seen in enumerate(fresh):
            distance = float(np.linalg.norm(_place(seen) - _place(last)))
            if distance <= most + 3 * np.sqrt(seen.variance):
                links.append((distance, path, k))
    return links


def _place(seen: _Seen) -> Array:
    assert seen.place is not None
    return seen.place


def _joined(paths: list[_Object]) -> list[_Object]:
    """Joins the paths at one place: a standing object that was out of view for a while."""
    objects: list[_Object] = []
    standing: list[tuple[Array, _Object]] = []
    for path in sorted(paths, key=len, reverse=True):
        if not path.stands:
            objects.append(path)
            continue
        center = np.median(path.path, axis=0)
        distances = [float(np.linalg.norm(center - other)) for other, _ in standing]
        if min(distances, default=np.inf) <= _PLACE_M + path.sigma_of_one_m:
            standing[int(np.argmin(distances))][1].seen += path.seen
        else:
            objects.append(path)
            standing.append((center, path))
    for one in objects:
        one.seen.sort(key=lambda pair: pair[0].index)
    return objects


def _project_all(camera: kestrel.CameraModel, images: list[_Image],
                 objects: list[_Object]) -> list[list[_Projection]]:
    """Returns the objects in each image, and counts for each the images that have it in view."""
    for one in objects:
        _locate(one, images)
        _measure(one, camera)
    result = []
    for image in images:
        projections = [_project(one, image, camera) for one in _near(objects, image, camera)]
        for projection in projections:
            projection.object.in_view += projection.is_wanted
        result.append(projections)
    return result


def _near(objects: list[_Object], image: _Image, camera: kestrel.CameraModel) -> list[_Object]:
    """Returns the objects that are in an image, or beside it, as far as their places are known."""
    known = [one for one in objects if one.sigma_m[image.index] <= max(_MAX_SIGMA_M, one.radius_m)]
    if not known:
        return []
    centers = np.array([one.position[image.index] for one in known])
    pixels = camera.project(image.world_from_camera.inverse() @ centers)
    size = np.array([camera.intrinsics.width_px, camera.intrinsics.height_px])
    with np.errstate(invalid="ignore"):  # what the lens does not show is NaN
        inside = ((pixels > -_BESIDE_PX) & (pixels < size + _BESIDE_PX)).all(axis=1)
    return [one for one, is_near in zip(known, inside) if is_near]


def _locate(one: _Object, images: list[_Image]) -> None:
    if one.stands:
        center = np.median(one.path, axis=0)
        spread = 1.4826 * np.median(np.abs(one.path - center)) if len(one) > 1 else 0.0
        one.position = np.tile(center, (len(images), 1))
        one.sigma_m = np.full(len(images), max(float(spread), one.sigma_of_one_m))
        return
    measured = np.full((len(images), 3), np.nan)
    variance = np.ones(len(images))
    for image, seen in one.seen:
        measured[image.index], variance[image.index] = _place(seen), seen.variance
    times_s = 1e-9 * np.array([image.time_ns - images[0].time_ns for image in images])
    path = smooth(times_s, measured, variance)
    one.position, one.sigma_m = path.position, path.sigma_m


def _measure(one: _Object, camera: kestrel.CameraModel) -> None:
    """Sets the radius: that of a flat circle which looks as large as what was detected."""
    radii = []
    for image, seen in one.seen:
        center, *circle = camera.project(image.world_from_camera.inverse() @ (
            _place(seen) + one.radius_m * np.vstack([np.zeros(3), _CIRCLE])))
        size = np.linalg.norm(circle - center, axis=1).max()
        if np.isfinite(size) and size > 0:
            radii.append(one.radius_m * seen.semi_major_px / size)
    if radii:
        one.radius_m = float(np.median(radii))


def _project(one: _Object, image: _Image, camera: kestrel.CameraModel) -> _Projection:
    outline = one.position[image.index] + one.radius_m * np.vstack([np.zeros(3), _CIRCLE])
    center, *circle = camera.project(image.world_from_camera.inverse() @ outline)
    pixels = np.array(circle)
    size = np.array([camera.intrinsics.width_px, camera.intrinsics.height_px])
    with np.errstate(invalid="ignore"):
        is_whole = bool(((pixels > -0.5) & (pixels < size - 0.5)).all())
    radius_px = float(np.nanmax(np.linalg.norm(pixels - center, axis=1), initial=0))
    off_px = 3 * float(one.sigma_m[image.index]) / one.radius_m * radius_px
    return _Projection(one, center, off_px, is_whole and _area_px(pixels) >= _MIN_AREA_PX)


def _area_px(outline: Array) -> float:
    x, y = outline.T
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def _scores(images: list[_Image], objects: list[_Object],
            projections: list[list[_Projection]]) -> tuple[list[FrameScore], Row]:
    doubtful = {id(seen) for one in objects if one.is_doubtful for _, seen in one.seen}
    names = {id(one): _common_name(one) for one in objects}
    scores: list[FrameScore] = []
    missed_seen = unjudged = right = found = 0
    for image, shown in zip(images, projections):
        real = [projection for projection in shown if projection.object.exists]
        matched = _match(real, image.live)
        for k, projection in enumerate(real):
            score = FrameScore(image.time_ns, image.name, where=dict(image.where))
            score.asked = projection.is_wanted and not _is_at_any(projection, image.merged)
            if k in matched:
                _take(image.live[matched[k]], projection.object.position[image.index], score)
                found += 1
                right += image.live[matched[k]].name == names[id(projection.object)]
            elif score.asked:
                missed_seen += _is_at_any(projection, image.searched)
            scores.append(score)
        for k, seen in enumerate(image.live):
            if k in matched.values():
                continue
            if _is_false(seen, image, doubtful):
                scores.append(FrameScore(image.time_ns, image.name, false=True,
                                         quality=seen.probability, where=dict(image.where)))
            else:
                unjudged += 1
    missed = sum(score.asked and not score.found for score in scores)
    return scores, {"has_truth": 0.0, "in_view": sum(score.asked for score in scores),
                    "missed": missed, "missed_seen": missed_seen, "unjudged": unjudged,
                    "class_right": right / found if found else None}


def _common_name(one: _Object) -> str:
    names = [seen.name for _, seen in one.seen]
    return max(sorted(set(names)), key=names.count)


def _match(projections: list[_Projection], live: list[_Seen]) -> dict[int, int]:
    """Returns the detection of each object that has one, the nearest pairs first."""
    pairs = sorted((distance, k, n) for k, projection in enumerate(projections)
                   for n, seen in enumerate(live)
                   if (distance := projection.distance_px(seen)) is not None)
    matched: dict[int, int] = {}
    for _, k, n in pairs:
        if k not in matched and n not in matched.values():
            matched[k] = n
    return matched


def _is_at_any(projection: _Projection, seen: list[_Seen]) -> bool:
    return any(projection.distance_px(one) is not None for one in seen)


def _take(seen: _Seen, position: Array, score: FrameScore) -> None:
    score.found, score.quality = True, seen.probability
    if seen.place is not None:
        score.error_m = float(np.linalg.norm(seen.place - position))


def _is_false(seen: _Seen, image: _Image, doubtful: set[int]) -> bool:
    """Returns whether a detection of no known object is of a place that had nothing when it was in
    view again."""
    same = [seen, *(other for other in image.searched if seen.is_at(other))]
    return any(id(one) in doubtful for one in same)
