# SPDX-License-Identifier: BSD-3-Clause
"""The examples, each on a simulated flight of a few frames."""
import json
import os
import subprocess
import sys
from pathlib import Path

import nbclient
import nbformat
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


@pytest.fixture(scope="module")
def photo(tmp_path_factory):
    """An image with tag 3."""
    folder = tmp_path_factory.mktemp("photo")
    tag = {"kind": "apriltag", "apriltag": {"id": 3}}
    assert kestrel.simulate("calm", frames=10, rate_hz=10, target=tag).write(folder / "flight")
    return min((folder / "flight/mav0/cam0/data").iterdir()).rename(folder / "photo.png")


def run_block(index):
    """Runs a program of the page."""
    page = (EXAMPLES.parents[1] / "docs/python.md").read_text()
    exec(page.split("```python\n")[index].split("```")[0], {})


def test_the_first_programs_of_the_page_find_their_tags(photo, monkeypatch, capsys):
    monkeypatch.chdir(photo.parent)
    run_block(1)
    assert "tag36h11 3 at [" in capsys.readouterr().out
    run_block(2)
    assert "found at" in capsys.readouterr().out


def test_list_tags(photo):
    assert run("list_tags.py", photo).startswith("tag36h11 3 at [")


def test_detect_image(recording):
    cam0 = recording / "mav0/cam0"
    image = min((cam0 / "data").iterdir())
    assert "m in the camera frame" in run("detect_image.py", cam0 / "sensor.yaml", image)


def test_follow_video(recording):
    assert "in half a second at" in run("follow_video.py", recording).splitlines()[-1]


FIGURES = """
import json
rms_cm = {name: 100 * np.sqrt((rows.east_m**2 + rows.north_m**2).mean()) for name, rows in places.items()}
print(json.dumps({"found": {name: rows.found.mean() for name, rows in results.items()}, "rms_cm": rms_cm,
                  "undistortion_px": table_1.max().tolist()}))
"""


def test_notebook_repeats_the_paper(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(Path(kestrel.__file__).parents[1]))
    notebook = nbformat.read(EXAMPLES / "paper.ipynb", as_version=4)
    notebook.cells.append(nbformat.v4.new_code_cell(FIGURES))
    nbclient.NotebookClient(notebook, timeout=300).execute()
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    assert sum("image/png" in output.get("data", {}) for output in outputs) == 2
    figures = json.loads(outputs[-1].text)
    assert min(figures["found"].values()) > 0.98
    calm, aggressive, late = figures["rms_cm"].values()
    assert calm < 2 and aggressive < 5 and late > 2 * aggressive
    algorithm_2, ray_table = figures["undistortion_px"]
    assert 0.01 < algorithm_2 < 0.1
    assert ray_table < 0.001
