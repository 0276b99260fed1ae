# SPDX-License-Identifier: BSD-3-Clause
"""A unit of work: its limits, and what a broken recording or a missing version costs."""
import functools
import http.server
import importlib.util
import io
import os
import threading

import pytest
from study.bench import FAKE, Bench

from kestrel.study import scorer
from kestrel.study.errors import StudyError
from kestrel.study.plan import read_plan
from kestrel.study.recordings import content_hash, fingerprint
from kestrel.study.unit import run_job


@pytest.fixture
def bench(tmp_path, monkeypatch):
    monkeypatch.setenv("KESTREL_COMMAND", str(FAKE))
    bench = Bench(tmp_path)
    monkeypatch.setattr(scorer, "PACKAGES", bench.package)
    monkeypatch.setattr(scorer, "_of_thread", threading.local())
    return bench


def results(bench, **change):
    """Returns the results of all units of the study, without workers."""
    plan = read_plan(bench.write(**change))
    found = []
    for recording in plan.recordings:
        for job in plan.units_of(recording, "c"):
            found += [result for _, result in run_job(job)[1]]
    return found


ONE = [{"name": "before"}]


def test_a_result_has_rows_and_what_it_took(bench):
    bench.recording("f", "sleep 0.2")
    result, = results(bench, configurations=ONE)
    assert result["state"] == "done"
    assert result["frames"] == 3
    assert result["resource"]["seconds"] > 0.2
    assert result["resource"]["memory_mb"] > 1


@pytest.mark.parametrize("behaviour, reason", [
    ("hang", "took longer than 2 s (limits.seconds)"),
    ("memory", "needed more than 300 MB (limits.memory_mb)"),
    ("crash", "ended by the signal SIGABRT"),
    ("score hang", "the scoring took longer than 2 s (limits.seconds)"),
    ("score memory", "the scoring needed more than 300 MB (limits.memory_mb)"),
    ("score crash", "the scoring was ended by the signal SIGABRT"),
    ("score error", "ValueError: of this name"),
])
def test_what_goes_wrong_is_a_reason_of_one_line(bench, behaviour, reason):
    bench.recording("f", behaviour)
    bench.recording("good")
    limits = {"seconds": 2 if "hang" in behaviour else 60, "memory_mb": 300}
    result, good = results(bench, configurations=ONE, limits=limits)
    assert result["state"] == "failed"
    assert result["reason"] == reason
    assert ("Traceback" in result["resource"]["log"]) == (behaviour == "score error")
    assert good["state"] == "done"


def test_a_broken_recording_costs_its_own_units(bench):
    bench.recording("broken", "broken")
    bench.recording("good")
    found = results(bench)
    assert [result["state"] for result in found] == ["failed", "failed", "done", "done"]
    assert found[0]["reason"].endswith("broken/mav0/cam0/data.csv:3: expected 2 columns")


def test_a_version_that_a_worker_lacks_is_named(bench, tmp_path):
    bench.recording("f")
    older = tmp_path / "kestrel"
    older.write_bytes(FAKE.read_bytes())
    older.chmod(0o755)
    plan = read_plan(bench.write(configurations=[{"name": "older", "command": str(older)}]))
    job, = plan.units_of(plan.recordings[0], "c")
    older.write_bytes(FAKE.read_bytes() + b"\n")
    (_, other), = run_job(job)[1]
    assert other["state"] == "lacking"
    assert other["reason"].startswith(f"{older}: is 1.0+")
    assert f"on this computer, expected {plan.configurations[0].version}" in other["reason"]
    older.unlink()
    (_, missing), = run_job(job)[1]
    assert missing["reason"] == f"{older}: no such command on this computer"


def test_a_recording_that_a_worker_does_not_see(bench):
    folder = bench.recording("f")
    plan = read_plan(bench.write(configurations=ONE))
    folder.rename(bench.folder / "gone")
    job, = plan.units_of(plan.recordings[0], "c")
    (_, result), = run_job(job)[1]
    assert result["reason"] == f"{folder}: not there on this worker"


def test_the_lead_in_of_a_piece_is_processed_and_not_counted(bench):
    bench.recording("f", frames=25)
    pieces = results(bench, configurations=ONE, pieces={"seconds": 10, "lead_in_s": 2})
    assert [piece["summary"]["processed"] for piece in pieces] == [10, 12, 7]
    counted = [row["time_ns"] for piece in pieces for row in piece["detections"]]
    assert counted == [10**9 * number for number in range(25)]


def test_a_url_is_fetched_and_its_copy_goes(bench, monkeypatch, tmp_path):
    folder = bench.recording("f")
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(scratch))
    result, = results(bench, configurations=ONE, recordings=[f"file://{folder}"])
    here, = results(bench, configurations=ONE, recordings=[str(folder)])
    assert result["detections"] == here["detections"]
    assert os.listdir(scratch) == []


class _Page(http.server.SimpleHTTPRequestHandler):
    """A folder as Apache shows it: with links to sort it, and to the folder above."""

    def list_directory(self, path):
        above = self.path.rstrip("/").rpartition("/")[0] + "/"
        names = [f"{entry.name}/" if entry.is_dir() else entry.name for entry in os.scandir(path)]
        links = "".join(f'<a href="{link}">x</a>' for link in ["?C=N;O=D", above, *names])
        self.send_response(200)
        self.end_headers()
        return io.BytesIO(links.encode())

    def log_message(self, *said):
        pass


@pytest.fixture
def web(bench):
    """The URL of the bench's folder."""
    server = http.server.ThreadingHTTPServer(
        ("127.0.0.1", 0), functools.partial(_Page, directory=str(bench.folder)))
    serving = threading.Thread(target=server.serve_forever)
    serving.start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    serving.join()
    server.server_close()


@pytest.mark.parametrize("where", ["flights", "flights/", "flights/*"])
def test_recordings_of_a_web_server(bench, web, where):
    pytest.importorskip("aiohttp")
    folders = [bench.recording(name, start=start) for name, start in (("f", 0), ("g", 5))]
    plan = read_plan(bench.write(recordings=[f"{web}/{where}"]))
    assert [(one.name, one.path) for one in plan.recordings] == [
        (name, f"{web}/flights/{name}") for name in "fg"]
    served = results(bench, configurations=ONE, recordings=[f"{web}/{where}"])
    here = results(bench, configurations=ONE, recordings=[str(folder) for folder in folders])
    assert [one["detections"] for one in served] == [one["detections"] for one in here]
    before = fingerprint(plan.recordings[0])
    with open(folders[0] / "mav0/cam0/data.csv", "a") as file:
        file.write("9000000000,9.png\n")
    assert fingerprint(plan.recordings[0]) != before


def test_urls_that_cannot_be_read_are_told_in_a_line(bench, web):
    pytest.importorskip("aiohttp")
    expected = {f"{web}/none": "not there", "http://127.0.0.1:9/f": "Cannot connect to host"}
    if importlib.util.find_spec("s3fs") is None:
        expected["s3://flights/today"] = "Install s3fs to access S3"
    for url, words in expected.items():
        with pytest.raises(StudyError) as error:
            read_plan(bench.write(recordings=[url]))
        assert f"{url}: {words}" in str(error.value) and "\n" not in str(error.value)


def test_a_url_is_another_recording_when_its_file_has_changed(bench):
    folder = bench.recording("f")
    flight, = read_plan(bench.write(recordings=[f"file://{folder}"])).recordings
    first = fingerprint(flight)
    content_hash(folder)  # reading it changes nothing
    assert fingerprint(flight) == first
    with open(folder / "mav0/cam0/data.csv", "a") as file:
        file.write("9000000000,9.png\n")
    assert fingerprint(flight) != first
