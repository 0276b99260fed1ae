# SPDX-License-Identifier: BSD-3-Clause
"""The examples, each on a simulated flight of a few frames."""
import os
import subprocess
import sys
from pathlib import Path

import pytest

import kestrel

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "python"


def run(name, *arguments):
    environment = {**os.environ, "PYTHONPATH": str(Path(kestrel.__file__).parents[1])}
    return subprocess.run([sys.executable, EXAMPLES / name, *arguments], env=environment,
                          capture_output=True, text=True, check=True).stdout


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    folder = tmp_path_factory.mktemp("example") / "flight"
    assert kestrel.simulate("calm", frames=10, rate_hz=10).write(folder)
    return folder


def test_detect_image(recording):
    cam0 = recording / "mav0/cam0"
    image = min((cam0 / "data").iterdir())
    assert "m in the camera frame" in run("detect_image.py", cam0 / "sensor.yaml", image)


def test_follow_video(recording):
    assert "in half a second at" in run("follow_video.py", recording).splitlines()[-1]
