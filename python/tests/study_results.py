# SPDX-License-Identifier: BSD-3-Clause
"""Results of studies that nobody flew, for tests of the report."""
import math

import numpy as np
from kestrel.study.frame_score import FrameScore, bins, detections, worst
from kestrel.study.store import Store

SECOND = 1_000_000_000


def flight(seed, frames=120, chance=0.95, has_truth=True):
    """Returns the scores of a flight that comes down from 16 m; `chance` is that of finding."""
    random = np.random.default_rng(seed)
    at_ease = chance - 0.05 * random.random()
    scores = []
    for number in range(frames):
        altitude = 16 * (1 - number / frames)
        found = random.random() < at_ease
        scores.append(FrameScore(
            number * SECOND // 20, f"cam0/data/{number:06d}.png", True, bool(found), False,
            0.1 * random.random() if found else None, random.chisquare(3) if found else None,
            0.9 + 0.1 * random.random() if found else None,
            {"altitude_m": altitude, "tilt_deg": 20 * random.random(), "visible_fraction": 1.0}))
    return scores


def lose(scores, low, high, share, seed=0):
    """Returns the scores without some of what was found between two heights."""
    random = np.random.default_rng(seed)
    kept = []
    for score in scores:
        lost = low <= score.where["altitude_m"] < high and random.random() < share
        kept.append(FrameScore(score.time_ns, score.frame, score.asked, score.found and not lost,
                               False, None if lost else score.error_m,
                               None if lost else score.nees, None if lost else score.quality,
                               score.where))
    return kept


def write(folder, runs, frame_ms=4.0, summary=None, plan=None):
    """Writes a study. runs: {configuration: {recording: scores}}; scores may be None: it failed."""
    with Store(folder) as store:
        store.keep_plan(plan or "", [
            {"name": name, "version": "1.0", "task": "land", "place": place, "command": "kestrel",
             "arguments": "[]", "text": ""} for place, name in enumerate(runs)])
        for configuration, flights in runs.items():
            for recording, scores in flights.items():
                unit = {"key": f"{configuration}/{recording}", "recording": recording, "piece": 0,
                        "configuration": configuration, "version": "1.0", "task": "land",
                        "seed": None, "path": recording}
                store.add(unit, _result(scores, frame_ms, summary))
        store.commit()
        store.export()
    return folder


def _result(scores, frame_ms, summary):
    if scores is None:
        return {"state": "failed", "reason": "mav0/cam0/data.csv: not there"}
    missed = sum(score.asked and not score.found for score in scores)
    return {"state": "done", "frames": len(scores), "bins": bins(scores), "worst": worst(scores),
            "detections": detections(scores),
            "summary": {"has_truth": 1.0, "in_view": float(len(scores)), "missed": float(missed),
                        "images": float(len(scores)), **(summary or {})},
            "resource": {"frame_ms_median": frame_ms if not math.isnan(frame_ms) else None}}
