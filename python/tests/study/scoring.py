# SPDX-License-Identifier: BSD-3-Clause
"""Stands in for kestrel.study.scoring in tests of the engine: rows of what fake_kestrel writes."""
import csv
from pathlib import Path


def score(recording, output, task, config=None):
    with open(Path(output) / "landing_detections.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    found = sum(row["detected"] == "1" for row in rows)
    return {
        "frames": len(rows),
        "bins": [{"quantity": "all", "lower": 0, "upper": 1, "frames": len(rows), "found": found,
                  "false": 0}],
        "summary": {"found_share": found / len(rows), "false": 0},
        "worst": [],
        "detections": [{"time_ns": int(row["timestamp_ns"]), "frame": row["frame"],
                        "found": int(row["detected"]), "false": 0} for row in rows],
        "resource": {"frame_ms_median": 1.0},
    }
