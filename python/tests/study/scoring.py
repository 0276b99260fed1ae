# SPDX-License-Identifier: BSD-3-Clause
"""Stands in for kestrel.study.scoring in tests of the engine: rows of what fake_kestrel writes."""
import csv
import os
import time
from pathlib import Path


def misbehave(recording):
    """Does what the recording's file `mav0/behaviour` says after "score"."""
    behaviour = (Path(recording) / "mav0/behaviour").read_text().strip()
    if behaviour == "score hang":
        time.sleep(1000)
    if behaviour == "score memory":
        memory = b"x" * 500_000_000
        time.sleep(1000)
        print(len(memory))
    if behaviour == "score crash":
        os.abort()
    if behaviour == "score error":
        raise ValueError("no table\nof this name")
    print("a library prints this")


def score(recording, output, task, config=None, model=None):
    misbehave(recording)
    processed = (Path(recording) / "mav0/cam0/data.csv").read_text().count("png")
    with open(Path(output) / "landing_detections.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    found = sum(row["detected"] == "1" for row in rows)
    return {
        "frames": len(rows),
        "bins": [{"quantity": "all", "lower": 0, "upper": 1, "frames": len(rows), "found": found,
                  "false": 0}],
        "summary": {"found_share": found / len(rows), "false": 0, "processed": processed},
        "worst": [],
        "detections": [{"time_ns": int(row["timestamp_ns"]), "frame": row["frame"],
                        "found": int(row["detected"]), "false": 0} for row in rows],
        "resource": {"frame_ms_median": 1.0},
    }
