# SPDX-License-Identifier: BSD-3-Clause
"""The rows of a study that are made of a run's output, with and without truth."""
import shutil

import pytest

import kestrel
from kestrel.study import scoring


@pytest.fixture(scope="module")
def landing(tmp_path_factory):
    """A flight down over a pad that drives, and what was found in it."""
    folder = tmp_path_factory.mktemp("landing")
    kestrel.simulate("figure8", frames=40, rate_hz=10, shutter={"rays_per_pixel": 1},
                     flight={"start_altitude_m": 8}).write(folder / "flight")
    kestrel.Session(folder / "flight", output=str(folder / "output")).run()
    return folder


@pytest.fixture(scope="module")
def missing(landing, tmp_path_factory):
    """The same output without the detections of ten images in a row."""
    output = tmp_path_factory.mktemp("missing")
    lines = (landing / "output" / "landing_detections.csv").read_text().splitlines()
    for number in range(16, 26):
        frame, time = lines[number].split(",")[:2]
        lines[number] = f"{frame},{time},0" + "," * (lines[0].count(",") - 2)
    (output / "landing_detections.csv").write_text("\n".join(lines) + "\n")
    return output


def copied(source, tmp_path_factory, *truths):
    """Copies a flight without these folders of truth."""
    flight = tmp_path_factory.mktemp("unknown") / "flight"
    shutil.copytree(source / "flight", flight)
    for truth in truths:
        shutil.rmtree(flight / "mav0" / truth)
    return flight


@pytest.fixture(scope="module")
def without_truth(landing, tmp_path_factory):
    flight = copied(landing, tmp_path_factory, "landing_pattern0", "state_groundtruth_estimate0")
    (flight / "mav0" / "scene.yaml").unlink()
    return flight


def of(rows, quantity):
    return [row for row in rows if row["quantity"] == quantity]


def test_truth_gives_the_counts_of_evaluate(landing):
    flight, output = landing / "flight", landing / "output"
    result = scoring.score(str(flight), str(output), "land")
    images = kestrel.evaluate(flight, output).tables[0].rows[0]
    whole, = of(result["bins"], "all")
    assert [whole["frames"], whole["false"]] == [int(images[3]), int(images[5])]
    assert result["frames"] == 40 == result["summary"]["images"]
    for quantity in ("altitude_m", "tilt_deg", "light", "speed_mps"):
        rows = of(result["bins"], quantity)
        assert sum(row["frames"] for row in rows) == whole["frames"], quantity
        assert sum(row["found"] for row in rows) == whole["found"], quantity
    assert 0 < whole["error_sum"] / whole["found"] < 0.3
    assert whole["nees_count"] == whole["found"]
    said = of(result["bins"], "quality")
    assert sum(row["frames"] for row in said) == whole["found"] + whole["false"]
    assert result["resource"]["frame_ms_median"] > 0


def test_what_was_not_found_is_missed(landing, missing):
    result = scoring.score(str(landing / "flight"), str(missing), "land")
    complete = scoring.score(str(landing / "flight"), str(landing / "output"), "land")
    assert result["summary"]["missed"] == complete["summary"]["missed"] + 10
    assert [row["what"] for row in result["worst"]].count("missed") == 4
    heights = [row["value"] for row in result["worst"] if row["what"] == "missed"]
    assert heights == sorted(heights)
    lost = {row["frame"] for row in result["detections"] if not row["found"]}
    assert {row["frame"] for row in result["worst"] if row["what"] == "missed"} <= lost
    assert result["summary"]["longest_gap_s"] >= 1


def test_misses_are_estimated_without_truth(landing, missing, without_truth):
    true = scoring.score(str(landing / "flight"), str(missing), "land")
    result = scoring.score(str(without_truth), str(missing), "land")
    summary = result["summary"]
    assert summary["has_truth"] == 0 and true["summary"]["has_truth"] == 1
    assert abs(summary["missed"] - true["summary"]["missed"]) <= 2
    assert summary["missed_seen"] >= 8
    assert abs(summary["in_view"] - true["summary"]["in_view"]) <= 3
    whole, = of(result["bins"], "all")
    assert whole["false"] == 0 and whole["frames"] == summary["in_view"]
    true_heights = [row["frames"] for row in of(true["bins"], "altitude_m")]
    heights = [row["frames"] for row in of(result["bins"], "altitude_m")]
    assert sum(abs(a - b) for a, b in zip(heights, true_heights)) <= 6


def test_a_detection_away_from_the_trajectory_is_false(landing, without_truth, tmp_path):
    lines = (landing / "output" / "landing_detections.csv").read_text().splitlines()
    columns = lines[0].split(",")
    cells = lines[20].split(",")
    assert cells[2] == "1"
    for name, off in (("u_px", 60), ("p_CP_C_x_m", 1.5)):
        cells[columns.index(name)] = str(float(cells[columns.index(name)]) + off)
    lines[20] = ",".join(cells)
    (tmp_path / "landing_detections.csv").write_text("\n".join(lines) + "\n")
    result = scoring.score(str(without_truth), str(tmp_path), "land")
    false = [row for row in result["worst"] if row["what"] == "false"]
    assert [row["frame"] for row in false] == [cells[0]]


def test_a_score_is_the_same_each_time(without_truth, missing):
    first, again = (scoring.score(str(without_truth), str(missing), "land") for _ in range(2))
    assert first == again


def test_a_hunt_has_rows(hunt_flight, tmp_path):
    hunt_flight.write(tmp_path / "field")
    kestrel.Session(tmp_path / "field", hunt=True, output=str(tmp_path / "output")).run()
    result = scoring.score(str(tmp_path / "field"), str(tmp_path / "output"), "hunt")
    detection = kestrel.evaluate(tmp_path / "field", tmp_path / "output", hunt=True).tables[0]
    whole, = of(result["bins"], "all")
    total = dict(zip(detection.columns, detection.rows[-1]))
    assert whole["frames"] == int(total["wanted"])
    assert sum(row["frames"] for row in of(result["bins"], "altitude_m")) == whole["frames"]
    assert sum(row["found"] for row in result["detections"]) >= whole["found"] > 0


@pytest.fixture(scope="module")
def field(tmp_path_factory):
    """A flight over objects, some of which drive, and what was found in it."""
    folder = tmp_path_factory.mktemp("field")
    kestrel.simulate("sweep", hunt=True, frames=60, rate_hz=6).write(folder / "flight")
    kestrel.Session(folder / "flight", hunt=True, output=str(folder / "output")).run()
    return folder


@pytest.fixture(scope="module")
def unknown_field(field, tmp_path_factory):
    return copied(field, tmp_path_factory, "objects0")


def test_misses_of_a_hunt_are_estimated_without_truth(field, unknown_field):
    truth, estimate = (scoring.score(str(flight), str(field / "output"), "hunt")
                       for flight in (field / "flight", unknown_field))
    (true,), (estimated,) = of(truth["bins"], "all"), of(estimate["bins"], "all")
    assert truth["summary"]["has_truth"] == 1 and estimate["summary"]["has_truth"] == 0
    assert true["found"] > 50
    assert estimated["frames"] == pytest.approx(true["frames"], rel=0.1)
    share = [row["found"] / row["frames"] for row in (true, estimated)]
    assert share[1] == pytest.approx(share[0], abs=0.05)
    assert estimated["false"] <= true["false"] + 2
    assert estimate["summary"]["class_right"] > 0.9


def test_rows_taken_from_a_hunt_are_missed(field, unknown_field, tmp_path):
    whole = scoring.score(str(unknown_field), str(field / "output"), "hunt")["summary"]
    lines = (field / "output" / "object_detections.csv").read_text().splitlines()
    columns = lines[0].split(",")
    red = [number for number, line in enumerate(lines)
           if line.split(",")[columns.index("class")] == "red"]
    assert len(red) > 10
    for number in red:
        values = lines[number].split(",")
        lines[number] = ",".join([*values[:2], *[""] * (len(columns) - 2)])
    (tmp_path / "object_detections.csv").write_text("\n".join(lines) + "\n")
    without = scoring.score(str(unknown_field), str(tmp_path), "hunt")["summary"]
    assert without["missed"] >= whole["missed"] + 0.7 * len(red)
    assert without["missed_seen"] >= 0.9 * (without["missed"] - whole["missed"])


def test_a_detection_where_nothing_is_has_no_object(field, unknown_field, tmp_path):
    """One row is moved a metre aside, where other images see only the ground."""
    lines = (field / "output" / "object_detections.csv").read_text().splitlines()
    columns = lines[0].split(",")
    number = next(n for n, line in enumerate(lines)
                  if n > 100 and line.split(",")[columns.index("class")] == "red")
    values = lines[number].split(",")
    for name, off in (("u_px", 90), ("p_WO_W_x_m", 1.0)):
        values[columns.index(name)] = str(float(values[columns.index(name)]) + off)
    lines[number] = ",".join(values)
    (tmp_path / "object_detections.csv").write_text("\n".join(lines) + "\n")
    rows = scoring.score(str(unknown_field), str(tmp_path), "hunt")
    before = scoring.score(str(unknown_field), str(field / "output"), "hunt")
    assert of(rows["bins"], "all")[0]["false"] == of(before["bins"], "all")[0]["false"] + 1
    assert rows["worst"][0]["what"] == "false"


def test_a_flight_whose_images_are_not_kept_has_its_track(landing, tmp_path):
    shutil.copy(landing / "output" / "landing_detections.csv", tmp_path)
    result = scoring.score(str(tmp_path), str(tmp_path), "fly")
    assert result["bins"] == [] and result["frames"] == 40
    assert result["summary"]["jumps"] == 0 and 0.5 < result["summary"]["found_share"] <= 1
    assert scoring.score(str(tmp_path), str(tmp_path / "none"), "fly")["frames"] == 0


def test_a_missing_table_is_one_line(tmp_path):
    with pytest.raises(kestrel.InputError, match="landing_detections.csv: No such file"):
        scoring.score(str(tmp_path), str(tmp_path), "land")
    (tmp_path / "landing_detections.csv").write_text("frame,timestamp_ns\n")
    with pytest.raises(kestrel.InputError, match="no rows"):
        scoring.score(str(tmp_path), str(tmp_path), "land")
