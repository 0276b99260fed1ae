# SPDX-License-Identifier: BSD-3-Clause
"""STUDY.yaml: what is refused before anything starts, and what the rest expands to."""
import shutil

import pytest
from study.bench import FAKE, Bench

from kestrel.study import monte_carlo
from kestrel.study.commands import version_of
from kestrel.study.errors import StudyError
from kestrel.study.plan import read_plan
from kestrel.study.recordings import content_hash, fingerprint
from kestrel.study.store import Store


@pytest.fixture
def bench(tmp_path, monkeypatch):
    monkeypatch.setenv("KESTREL_COMMAND", str(FAKE))
    bench = Bench(tmp_path)
    for number in range(3):
        bench.recording(f"day/f{number}", start=1000 * number)
    return bench


def units(plan, content="c"):
    return [unit for recording in plan.recordings for job in plan.units_of(recording, content)
            for unit in job.units]


@pytest.mark.parametrize("change, words", [
    ({"recordigs": []}, "no key 'recordigs'; did you mean 'recordings'?"),
    ({"task": "fly"}, "task: fly, expected land, hunt, calibrate, simulate"),
    ({"task": None}, "'task' is missing"),
    ({"recordings": ["flights/day/f7"]}, "recordings: flights/day/f7: not there"),
    ({"recordings": ["flights/x*"]}, "recordings: flights/x*: not there"),
    ({"recordings": ["package"]}, "recordings: package: no recording"),
    ({"recordings": None}, "'recordings' is missing"),
    ({"configurations": [{"name": "a", "set": {"landig.x": 1}}]},
     "configurations 1 'a': landig.x: no such option, did you mean landing.x?"),
    ({"configurations": [{"name": "a", "config": "none.yaml"}]}, "none.yaml"),
    ({"configurations": [{"name": "a"}, {"name": "a"}]}, "configurations 2: a second 'a'"),
    ({"configurations": [{"name": "a", "command": "/none/kestrel"}]},
     "/none/kestrel: no such command on this computer"),
    ({"limits": {"seconds": "long"}}, "limits: seconds: 'long', expected a number"),
    ({"limits": {"seconds": 0}}, "limits: seconds: 0, expected more than 0"),
    ({"pieces": {"seconds": 0.1}}, "pieces: expected seconds >= 1"),
    ({"arguments": ["--output=x"]}, "arguments: --output=x: the study gives it itself"),
    ({"gates": ["foud >= 0.9"]}, "gates: 'foud >= 0.9': no measure 'foud'"),
    ({"workers": 0}, "workers: 0, expected 1 or more"),
])
def test_what_is_wrong_is_told_in_a_line(bench, change, words):
    with pytest.raises(StudyError) as error:
        read_plan(bench.write(**change))
    assert words in str(error.value)
    assert "study.yaml" in str(error.value)
    assert "\n" not in str(error.value)


def test_a_file_that_is_no_yaml_is_told_with_its_row(bench):
    path = bench.write()
    path.write_text("task: land\nrecordings: [a\nb: {")
    with pytest.raises(StudyError, match=r"study.yaml:3: no YAML"):
        read_plan(path)


def test_two_recordings_of_one_name_are_refused(bench):
    bench.recording("night/f1")
    paths = ["flights/day/f1", "flights/night/f1"]
    with pytest.raises(StudyError, match=r"'f1' is both .*day/f1 and .*night/f1"):
        read_plan(bench.write(recordings=paths))
    named = read_plan(bench.write(recordings=[paths[0], {"path": paths[1], "name": "dark"}]))
    assert [recording.name for recording in named.recordings] == ["f1", "dark"]


def test_a_folder_and_a_glob_name_recordings_by_where_they_lie(bench):
    for entry in ("flights", "flights/d*/*"):
        plan = read_plan(bench.write(recordings=[entry]))
        assert [recording.name for recording in plan.recordings] == ["day/f0", "day/f1", "day/f2"]


def test_a_grid_is_all_combinations(bench):
    grid = [{"name": "grid", "set": {"landing.x": [1, 2], "landing.y": [3, 4], "landing.z": 5}}]
    plan = read_plan(bench.write(configurations=grid), ["landing.w=true"])
    assert [one.name for one in plan.configurations] == [
        "grid landing.x=1, landing.y=3", "grid landing.x=1, landing.y=4",
        "grid landing.x=2, landing.y=3", "grid landing.x=2, landing.y=4"]
    assert plan.configurations[0].text == "landing.w: true\nlanding.x: 1\nlanding.y: 3\nlanding.z: 5\n"


def test_a_key_is_another_where_recording_options_or_build_are(bench, tmp_path):
    key = units(read_plan(bench.write()))[0]["key"]
    assert units(read_plan(bench.write()))[0]["key"] == key
    assert units(read_plan(bench.write()), "other")[0]["key"] != key
    assert units(read_plan(bench.write(), ["landing.x=9"]))[0]["key"] != key
    assert units(read_plan(bench.write(arguments=["--still"])))[0]["key"] != key
    newer = tmp_path / "kestrel"
    newer.write_text(FAKE.read_text() + "\n")
    newer.chmod(0o755)
    other = [{"name": "before", "command": str(newer)}]
    assert units(read_plan(bench.write(configurations=other)))[0]["key"] != key
    assert version_of(str(newer)) != version_of(str(FAKE))


def test_a_long_recording_is_divided_without_a_frame_twice(bench):
    folder = bench.recording("day/long", frames=25)
    plan = read_plan(bench.write(recordings=[str(folder)], pieces={"seconds": 10, "lead_in_s": 2}))
    pieces = [job.piece for job in plan.units_of(plan.recordings[0], "c")]
    times = [1_000_000_000 * number for number in range(25)]
    counted = [[time for time in times if piece.first_ns <= time < piece.last_ns] for piece in pieces]
    assert sum(counted, []) == times
    assert [len(one) for one in counted] == [10, 10, 5]
    assert pieces[1].lead_in_ns == 8_000_000_000
    assert len({unit["key"] for unit in units(plan)}) == 6


def test_the_hash_is_of_the_content(bench):
    flight = read_plan(bench.write()).recordings[0]
    found, mark = content_hash(flight.path), fingerprint(flight)
    copy = shutil.copytree(flight.path, bench.folder / "copy")
    assert content_hash(copy) == found
    (copy / "results").mkdir()  # not part of the recording
    (copy / "results/landing_detections.csv").touch()
    assert content_hash(copy) == found
    with open(copy / "mav0/cam0/data.csv", "a") as file:
        file.write("9,9.png\n")
    assert content_hash(copy) != found
    flight.path = str(copy)
    assert fingerprint(flight) != mark


DRAW = {"wind": {"uniform": [2, 4], "keys": ["wind.min_mps", "wind.max_mps"]},
        "lag_s": {"normal": [0.1, 0.02]}, "mode": {"choice": ["a", "b"]}}


def flights(draw, seeds=200):
    simulation = monte_carlo.read_simulation({"kind": "touchdown", "scenario": "fast", "seeds": seeds,
                                              "draw": draw})
    return [monte_carlo.simulated_flight(simulation, seed).simulation for seed in simulation["seeds"]]


def test_draws_follow_their_distributions_and_their_seed():
    drawn = [flight["drawn"] for flight in flights(DRAW)]
    winds = [one["wind"] for one in drawn]
    lags = [one["lag_s"] for one in drawn]
    assert 2 <= min(winds) < 2.1 and 3.9 < max(winds) <= 4
    assert sum(lags) / len(lags) == pytest.approx(0.1, abs=4 * 0.02 / len(lags) ** 0.5)
    assert {one["mode"] for one in drawn} == {"a", "b"}
    assert drawn == [flight["drawn"] for flight in flights(DRAW)]
    alone = [flight["drawn"] for flight in flights({"wind": DRAW["wind"]})]
    assert [one["wind"] for one in alone] == winds, "one more name changes no other"
    flight = flights(DRAW)[0]
    assert flight["settings"]["wind.min_mps"] == flight["settings"]["wind.max_mps"] == winds[0]


@pytest.mark.parametrize("draw, words", [
    ({"wind": {"uniform": [1]}}, "draw: wind: uniform: .1., expected .least, most."),
    ({"wind": {"gauss": [1, 2]}}, "draw: wind: no key 'gauss'"),
    ({"wind": {}}, "draw: wind: expected one of uniform, normal, choice"),
])
def test_a_distribution_that_is_none_is_refused(draw, words):
    with pytest.raises(StudyError, match=words):
        flights(draw)


def test_the_store_counts_a_result_once_and_orders_by_content(tmp_path):
    rows = [dict(key=key, recording=key, piece=0, configuration="c", version="v", task="land",
                 seed=None, path="p") for key in "abc"]
    result = {"state": "done", "frames": 1, "summary": {"y": 2.0, "x": 1.0},
              "detections": [{"time_ns": 2, "frame": "2"}, {"time_ns": 1, "frame": "1"}]}
    tables = []
    for name, order in (("one", rows), ("two", [*reversed(rows), rows[0]])):
        with Store(tmp_path / name) as store:
            for row in order:
                store.add(row, result)
            store.commit()
            store.export()
        tables.append({path.name: path.read_bytes() for path in (tmp_path / name).glob("*.csv")})
    assert tables[0] == tables[1]
    assert tables[0]["unit.csv"].count(b"\n") == 4
    assert "resource.csv" not in tables[0]


def test_what_an_earlier_plan_did_is_set_aside_and_comes_back(tmp_path):
    row = dict(key="a", recording="r", piece=0, configuration="c", version="v", task="land",
               seed=None, path="p")
    with Store(tmp_path) as store:
        store.add(row, {"state": "done", "summary": {"x": 1.0}})
        store.retire()
        store.export()
        assert (tmp_path / "summary.csv").read_text() == "key,name,value\n"
        assert store.has("a", "elsewhere")
        store.export()
        assert "elsewhere" in (tmp_path / "unit.csv").read_text()
        assert (tmp_path / "summary.csv").read_text() == "key,name,value\na,x,1.0\n"


def test_options_that_were_edited_set_aside_what_others_found(tmp_path):
    unit = dict(recording="r", piece=0, configuration="c", version="v", task="land", seed=None,
                path="p")
    options = dict(name="c", version="v", task="land", place=0, command="kestrel", arguments="[]",
                   text="landing.x: 1\n")
    with Store(tmp_path) as store:
        store.keep_plan("", [options])
        store.add({**unit, "key": "first"}, {"state": "done"})
        store.add({**unit, "key": "failed"}, {"state": "failed", "reason": "memory"})
        store.keep_plan("", [options])
        assert (store.count("done"), store.count("failed")) == (1, 1)
        store.keep_plan("", [{**options, "text": "landing.x: 2\n"}])
        assert (store.count("done"), store.count("failed"), store.count("old")) == (0, 0, 1)
        store.add({**unit, "key": "second"}, {"state": "done"})
        store.keep_plan("", [options])
        assert store.has("first", "p"), "it is what these options have found"
        store.retire()
        store.export()
    assert (tmp_path / "unit.csv").read_text().count("first") == 1
    assert "second" not in (tmp_path / "unit.csv").read_text()
    table = (tmp_path / "configuration.csv").read_text()
    assert table == ("name,version,task,place,command,arguments,text\n"
                     'c,v,land,0,kestrel,[],"landing.x: 1\n"\n')


def test_two_studies_do_not_share_a_folder(tmp_path):
    with Store(tmp_path), pytest.raises(StudyError, match="another study runs into it"):
        Store(tmp_path)


def test_a_recording_with_a_broken_table_is_not_divided(bench):
    folder = bench.recording("day/broken")
    (folder / "mav0/cam0/data.csv").write_text("#timestamp\nnoon,1.png\n")
    plan = read_plan(bench.write(recordings=[str(folder)], pieces={"seconds": 10}))
    assert [job.piece for job in plan.units_of(plan.recordings[0], "c")] == [None]
