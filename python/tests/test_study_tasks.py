# SPDX-License-Identifier: BSD-3-Clause
"""Whole studies of the command: of hunts and of calibrations, by one worker and by two."""
import csv
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

import kestrel
from kestrel.study import report
from kestrel.study.calibrations import calibrated
from kestrel.study.errors import StudyError
from kestrel.study.plan import read_plan

pytestmark = pytest.mark.skipif(
    shutil.which(os.environ.get("KESTREL_COMMAND", "kestrel")) is None,
    reason="needs the command kestrel")


def run(folder, **study):
    """Runs a study of the recordings in `folder` by one worker and by two; returns its results."""
    (folder / "study.yaml").write_text(yaml.safe_dump({"recordings": ["recordings"], **study}))
    environment = {**os.environ, "PYTHONPATH": str(Path(kestrel.__file__).parents[1])}
    tables = []
    for workers in (1, 2):
        output = folder / f"by{workers}"
        done = subprocess.run(
            [sys.executable, "-m", "kestrel.study", "run", folder / "study.yaml", "--output", output,
             "--workers", str(workers)], env=environment, cwd=folder, capture_output=True, text=True,
            check=False)
        assert done.returncode == 0, done.stderr
        tables.append({path.name: path.read_bytes() for path in output.glob("*.csv")})
    assert tables[0] == tables[1]
    return output


def reported(output, name):
    """Returns the rows of a table of the report."""
    assert report.main([str(output)]) == 0
    with open(output / "report" / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def test_a_hunt(tmp_path, hunt_flight, capsys):
    hunt_flight.write(tmp_path / "recordings" / "field")
    output = run(tmp_path, task="hunt", configurations=[
        {"name": "default"}, {"name": "blind", "set": {"hunt.detector.min_pixels": 100000}}])
    rows = reported(output, "values")
    assert "default -> blind: found" in capsys.readouterr().out
    found, = (row for row in rows if row["value"] == "found, %" and row["images"] == "all images")
    assert float(found["before"]) > 50 and float(found["after"]) == 0
    right, = (row for row in reported(output, "configurations")
              if row["value"] == "class right, %")
    assert float(right["value of all"]) > 50
    assert "each object in view counts" in (output / "report/report.md").read_text()


def test_a_calibration_of_the_mount(tmp_path, capsys):
    kestrel.simulate("calm", frames=80, rate_hz=10, shutter={"rays_per_pixel": 1}).write(
        tmp_path / "recordings" / "flight")
    output = run(tmp_path, task="calibrate", configurations=[
        {"name": "default"}, {"name": "far", "set": {"landing.detector.min_ring_px": 16}}])
    rows = reported(output, "calibrations")
    assert "residual of the calibration" in capsys.readouterr().out
    yaw = [row for row in rows if row["value"] == "yaw of the mount, degrees"]
    assert [row["configuration"] for row in yaw] == ["default", "far"]
    assert all(float(row["stated"]) > 0 and row["spread"] == "-" for row in yaw)
    assert len(rows) == 6, "the lens is no result of it"


def test_a_lens_is_read_from_what_the_command_says(tmp_path):
    camera = tmp_path / "camera.yaml"
    camera.write_text("%YAML:1.0\nintrinsics: [261.98, 261.97, 376.13, 239.94]\n")
    assert calibrated(camera, """focal length: 261.98 x 261.97 +- 0.58 px (0.22 %)
principal point: (376.13, 239.94) +- (0.07, 0.08) px
distortion: equidistant: -0.04588 +- 0.00130
pattern found in 58 of 80 images, 57 views used (1 left out), residual 0.117 px
""") == {"fu_px": 261.98, "fv_px": 261.97, "cu_px": 376.13, "cv_px": 239.94,
         "focal_sigma_px": 0.58, "cu_sigma_px": 0.07, "cv_sigma_px": 0.08, "images_found": 58,
         "images": 80, "images_used": 57, "images_left_out": 1, "residual_px": 0.117}


def test_a_calibration_is_of_a_whole_recording(tmp_path):
    (tmp_path / "f" / "mav0").mkdir(parents=True)
    study = tmp_path / "study.yaml"
    study.write_text("task: calibrate\nrecordings: [f]\npieces: {seconds: 10}\n")
    with pytest.raises(StudyError, match="pieces: a calibration is of a whole recording"):
        read_plan(study)
