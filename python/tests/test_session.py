# SPDX-License-Identifier: BSD-3-Clause
"""Sessions over recordings, beside the command where KESTREL_COMMAND names it."""
import os
import subprocess

import numpy as np
import pytest

import kestrel

COMMAND = os.environ.get("KESTREL_COMMAND")
needs_command = pytest.mark.skipif(not COMMAND, reason="KESTREL_COMMAND names no command")


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    folder = tmp_path_factory.mktemp("flights") / "landing"
    assert kestrel.simulate("calm", frames=10, rate_hz=10).write(folder)
    return folder


@pytest.fixture(scope="module")
def hunt_recording(tmp_path_factory):
    folder = tmp_path_factory.mktemp("flights") / "hunt"
    assert kestrel.simulate("sweep", hunt=True, frames=4).write(folder)
    return folder


def without_times(csv):
    """The rows of a table without the columns that are times of this run."""
    rows = [line.split(",") for line in csv.splitlines()]
    kept = [i for i, name in enumerate(rows[0]) if not name.endswith("_ms")]
    return [[row[i] for i in kept] for row in rows]


@needs_command
def test_the_table_is_that_of_the_command(recording, tmp_path):
    subprocess.run([COMMAND, "land", recording, "--output", tmp_path], check=True,
                   capture_output=True)
    table = kestrel.ResultTable()
    kestrel.Session(recording, sinks=[table]).run()
    assert without_times(table.csv()) == without_times(
        (tmp_path / "landing_detections.csv").read_text())


@needs_command
def test_the_hunt_is_that_of_the_command(hunt_recording, tmp_path):
    subprocess.run([COMMAND, "hunt", hunt_recording, "--output", tmp_path / "command"],
                   check=True, capture_output=True)
    kestrel.Session(hunt_recording, hunt=True, output=str(tmp_path / "python")).run()
    for name in ("object_detections.csv", "object_map.csv"):
        command, python = ((tmp_path / each / name).read_text() for each in ("command", "python"))
        assert without_times(command) == without_times(python)


@needs_command
def test_what_is_followed_is_that_of_the_command(recording, tmp_path):
    subprocess.run([COMMAND, "follow", recording, "--box", "340,210,60,60", "--at", "2", "--output", tmp_path],
                   check=True, capture_output=True)
    table = kestrel.ResultTable()
    seen = []
    kestrel.Session(recording, follow=(340, 210, 60, 60), follow_at="2", sinks=[table, seen.append]).run()
    assert without_times(table.csv()) == without_times((tmp_path / "follow_track.csv").read_text())
    assert [each.seen.region is None for each in seen[:4]] == [True, True, False, False]
    last = seen[-1].seen
    assert last.region.state == "following" and last.place.covariance.shape == (3, 3)
    assert kestrel.draw(seen[-1].frame.image, last).shape == (480, 752, 3)


def test_one_task_at_a_time(recording):
    with pytest.raises(kestrel.InputError, match="hunt, follow"):
        kestrel.Session(recording, hunt=True, follow=(1, 2, 30, 40))


@needs_command
def test_a_simulated_flight_is_that_of_the_command(recording, tmp_path):
    subprocess.run([COMMAND, "simulate", "landing", "--scenario", "calm", "--set", "frames=10", "--set", "rate_hz=10",
                    "--output", tmp_path / "flight"], check=True, capture_output=True)
    for image in sorted((recording / "mav0/cam0/data").iterdir()):
        assert image.read_bytes() == (tmp_path / "flight/mav0/cam0/data" / image.name).read_bytes()


def test_sinks_get_each_frame(recording):
    seen = []
    summary = kestrel.Session(recording, sinks=[seen.append]).run()
    assert "10 frames, pattern found in 10" in summary
    assert len(seen) == 10 and all(observation.seen for observation in seen)
    assert seen[0].frame.image.shape == (480, 752)
    assert kestrel.draw(seen[0].frame.image, seen[0].seen).shape == (480, 752, 3)


def test_sinks_get_the_frames_of_all_cameras(tmp_path):
    folder = tmp_path / "flight"
    second = {"second.fov_deg": 60, "second.rate_hz": 5}
    assert kestrel.simulate("calm", frames=8, rate_hz=10, **second).write(folder)
    seen = []
    summary = kestrel.Session(folder, sinks=[seen.append], output=str(tmp_path / "result")).run()
    cameras = [observation.frame.camera for observation in seen]
    assert cameras.count(0) == 8 and cameras.count(1) == 4
    assert all(each.seen.camera == each.frame.camera for each in seen)
    assert "cam1" in summary
    assert (tmp_path / "result" / "landing_detections_cam1.csv").exists()


def test_a_simulated_flight_needs_no_disk():
    seen = []
    kestrel.Session(kestrel.simulate("calm", frames=8, rate_hz=10), sinks=[seen.append]).run()
    assert [observation.seen.center_in_world is not None for observation in seen] == [True] * 8


def test_a_table_is_a_dataframe(recording):
    pandas = pytest.importorskip("pandas")
    table = kestrel.ResultTable()
    assert table.dataframe().empty
    kestrel.Session(recording, sinks=[table]).run()
    frame = table.dataframe()
    assert isinstance(frame, pandas.DataFrame) and len(frame) == 10
    assert frame["quality"].min() > 0.7
    assert np.isfinite(frame["p_WP_W_x_m"]).all()


def test_an_error_of_a_sink_ends_the_run(recording):
    frames = []

    def sink(observation):
        frames.append(observation.frame.name)
        if len(frames) == 3:
            raise ZeroDivisionError("of the sink")

    with pytest.raises(ZeroDivisionError, match="of the sink"):
        kestrel.Session(recording, sinks=[sink]).run()
    assert len(frames) == 3


def test_a_sink_stops_the_run(recording):
    frames = []
    session = kestrel.Session(recording, sinks=[lambda seen: (frames.append(seen), session.stop())])
    assert "1 frame," in session.run()


def test_a_live_session_plays_a_recording(recording):
    seen, events = [], []
    session = kestrel.Session(recording, sinks=[seen.append], live=True, on_event=events.append)
    assert "source ended" in session.run() or seen
    assert len(seen) >= 5 and seen[0].latency_s > 0
    assert all(isinstance(event, str) for event in events)


def test_a_simulated_flight_lands(tmp_path):
    """The options are those of `kestrel fly`, in a file as it reads them."""
    options = tmp_path / "kestrel.yaml"
    options.write_text("fly: {sim_autopilot: {pilot: {start_altitude_m: 3}}}\n")
    table = kestrel.ResultTable()
    end = kestrel.Session("sim:standing", sinks=[table], live=True, autopilot="sim:px4", guide=True,
                          options=options).run()
    assert end.startswith("landed")
    assert sum(row.split(",")[2] == "1" for row in table.csv().splitlines()[1:]) > 20


def test_a_flight_goes_on_without_a_sink_that_fails(recording, capfd):
    with pytest.raises(ZeroDivisionError):
        kestrel.Session(recording, sinks=[lambda seen: 1 / 0], live=True).run()
    assert "goes on without it" in capfd.readouterr().err


def test_the_results_are_evaluated(recording, tmp_path):
    kestrel.Session(recording, output=str(tmp_path)).run()
    report = kestrel.evaluate(recording, tmp_path)
    assert report.tables and report.tables[0].columns
    assert report.to_markdown().startswith("#")
    with pytest.raises(kestrel.InputError, match="replace"):
        kestrel.Session(recording, output=str(tmp_path)).run()


@pytest.mark.parametrize(
    "arguments, message",
    [
        ({"source": "nowhere"}, "nowhere"),
        ({"source": "flight", "options": {"landin": {}}}, "did you mean 'landing'"),
        ({"source": "flight", "autopilot": "udpin://0.0.0.0:14550"}, "expected live=True"),
        ({"source": "flight", "options": "nowhere.yaml"}, "nowhere.yaml"),
        ({"source": "sim:standing"}, "expected live=True"),
        ({"source": "sim:standing", "live": True}, "autopilot='sim:ardupilot'"),
        ({"source": "flight", "live": True, "options": {"fly": {"rate_hz": -1}}}, "fly.rate_hz"),
        ({"source": "sim:nowhere", "live": True, "autopilot": "sim:px4"}, "nowhere"),
    ],
)
def test_a_wrong_argument_is_named(arguments, message):
    with pytest.raises(kestrel.InputError, match=message):
        kestrel.Session(**arguments).run()
    with pytest.raises(TypeError, match="source: got 3"):
        kestrel.Session(3).run()
