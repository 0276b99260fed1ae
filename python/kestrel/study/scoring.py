# SPDX-License-Identifier: BSD-3-Clause
"""The output of one run of `kestrel` as rows of a study."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np

import kestrel

from . import truthless, truthless_hunt
from .frame_score import FrameScore, Row, bins, detections, worst
from .recorded_poses import RecordedPoses, places

_LANDING = "landing_detections.csv"
_HUNT = "object_detections.csv"
_LIGHT_SAMPLES = 20  # images of a recording whose light is measured


def score(recording: str, output: str, task: str, config: str | None = None,
          model: str | None = None) -> dict[str, Any]:
    """Scores what a command wrote for a recording.

    recording: its path; of a closed loop its output. output: folder of the tables. task: 'land',
    'hunt', 'touchdown' or 'fly'. config: file of all options of the run, as `kestrel config` prints
    them, which says what the pad is. model: file of the objects of a hunt; None: the built-in ones.
    Where the recording has truth, it is the measure; else the search of `truthless` or
    `truthless_hunt` is.
    Returns {"frames", "bins", "summary", "worst", "detections", "resource"}; the rows have the
    columns of the study's tables, without the key. Raises kestrel.InputError where a table is
    missing or not valid.
    """
    table = Path(output) / (_HUNT if task == "hunt" else _LANDING)
    rows = [] if task == "fly" and not table.exists() else read_table(table)
    scores, summary = _judge(recording, output, task, rows, config, model)
    times = {row["timestamp_ns"] for row in rows}
    summary["images"] = float(len(times))
    if task != "hunt" and rows:
        summary.update(truthless.track_quality(rows))
    return {"frames": len(times), "bins": bins(scores), "summary": _known(summary),
            "worst": worst(scores), "detections": detections(scores), "resource": _times(rows)}


def _judge(recording: str, output: str, task: str, rows: list[Row],
           config: str | None, model: str | None) -> tuple[list[FrameScore], Row]:
    if task == "hunt":
        if _has_truth(recording, "objects0"):
            return _hunt(recording, output, rows)
        return truthless_hunt.judge(recording, rows, config, model)
    if _has_truth(recording, "landing_pattern0"):
        return _landing(recording, output, rows)
    if task == "fly":  # its images are not kept
        return [], {}
    return truthless.judge(recording, rows, config)


def _known(values: dict[str, float | None]) -> dict[str, float]:
    return {name: float(value) for name, value in sorted(values.items())
            if value is not None and math.isfinite(value)}


def read_table(table: Path) -> list[Row]:
    try:
        with open(table, newline="") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise kestrel.InputError(f"{table}: {error.strerror}") from None
    if not rows or "timestamp_ns" not in rows[0]:
        raise kestrel.InputError(f"{table}: no rows, expected one for every image")
    return rows


def _root(recording: str) -> Path:
    folder = Path(recording)
    return folder / "mav0" if (folder / "mav0").is_dir() else folder


def _has_truth(recording: str, folder: str) -> bool:
    root = _root(recording)
    return (root / folder / "data.csv").exists() and \
        (root / "state_groundtruth_estimate0" / "data.csv").exists()


def _number(text: str | None) -> float | None:
    return float(text) if text else None


def _times(rows: list[Row]) -> dict[str, float | None]:
    """The time of the detection alone, one value an image."""
    by_image = {row["timestamp_ns"]: _number(row.get("detect_ms")) for row in rows}
    known = [value for value in by_image.values() if value is not None]
    if not known:
        return {"frame_ms_median": None, "frame_ms_p99": None}
    return {"frame_ms_median": float(np.median(known)),
            "frame_ms_p99": float(np.percentile(known, 99))}


def _light(recording: str, rows: list[Row]) -> dict[int, float]:
    """The mean gray level (0 to 255) of each image: measured in some, the nearest of which stands
    for those between them. Empty where the images are not files of their own."""
    names = {int(row["timestamp_ns"]): row["frame"] for row in rows}
    times = sorted(names)
    chosen = times[::max(1, len(times) // _LIGHT_SAMPLES)]
    measured = {}
    for time in chosen:
        path = Path(recording) / names[time]
        if path.exists():
            measured[time] = float(kestrel.read_image(path).mean())
    if not measured:
        return {}
    at = np.array(sorted(measured))
    nearest = at[np.abs(at[None, :] - np.array(times)[:, None]).argmin(axis=1)]
    return {time: measured[int(near)] for time, near in zip(times, nearest)}


def _landing(recording: str, output: str, rows: list[Row]) -> tuple[list[FrameScore], Row]:
    light = _light(recording, rows)
    compared = kestrel.compare_landing(recording, output)
    scores = []
    for one, row in zip(compared, rows):
        errors = one.errors
        scores.append(FrameScore(
            one.time_ns, row["frame"], one.is_visible, one.verdict == "found",
            one.verdict == "false",
            math.hypot(errors.lateral_m, errors.depth_m) if errors else None,
            errors.nees if errors else None, _number(row.get("quality")),
            _places(one, light.get(one.time_ns))))
    return scores, _landing_summary(compared)


def _places(one: Any, light: float | None) -> dict[str, float]:
    known: dict[str, float | None] = {
        "light": light, "tilt_deg": None if one.tilt is None else math.degrees(one.tilt)}
    if one.truth is not None:
        known["altitude_m"] = one.truth.altitude_m
        known["visible_fraction"] = one.truth.visible_fraction
        known["speed_mps"] = float(np.linalg.norm(one.truth.velocity_in_world))
    return {name: float(value) for name, value in known.items() if value is not None}


def _landing_summary(compared: list[Any]) -> dict[str, float | None]:
    errors = [one.errors for one in compared if one.errors]
    in_view = [one for one in compared if one.is_visible]
    summary: dict[str, float | None] = {
        "has_truth": 1.0, "in_view": len(in_view),
        "missed": sum(one.verdict != "found" for one in in_view)}
    if errors:
        summary["center_px_median"] = float(np.median([e.center_px for e in errors]))
        summary["center_px_p95"] = float(np.percentile([e.center_px for e in errors], 95))
        summary["lateral_m_median"] = float(np.median([e.lateral_m for e in errors]))
        summary["depth_m_median"] = float(np.median([abs(e.depth_m) for e in errors]))
        world = [float(np.linalg.norm(e.in_world)) for e in errors if e.in_world is not None]
        summary["world_m_median"] = float(np.median(world)) if world else None
    first = next((one for one in compared if one.verdict == "found"), None)
    if first is not None:
        summary["first_found_altitude_m"] = first.truth.altitude_m
    return summary


def _hunt(recording: str, output: str, rows: list[Row]) -> tuple[list[FrameScore], Row]:
    light = _light(recording, rows)
    frames = {int(row["timestamp_ns"]): row["frame"] for row in rows}
    poses = RecordedPoses(kestrel.open_recording(recording))
    compared = kestrel.compare_hunt(recording, output)
    scores = []
    for one in compared:
        detected = bool(one.detected_class)
        scores.append(FrameScore(
            one.time_ns, frames[one.time_ns], one.is_wanted, detected and one.true_id is not None,
            detected and one.true_id is None, one.world_error_m, None,
            one.class_probability if detected else None,
            places(poses.at(one.time_ns)[0], light.get(one.time_ns))))
    wanted = [one for one in compared if one.is_wanted]
    found = [one for one in compared if one.detected_class and one.true_id is not None]
    right = sum(one.detected_class == one.true_class for one in found)
    return scores, {"has_truth": 1.0, "in_view": len(wanted),
                    "missed": sum(not one.detected_class for one in wanted),
                    "class_right": right / len(found) if found else None}
