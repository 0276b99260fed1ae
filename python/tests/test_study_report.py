# SPDX-License-Identifier: BSD-3-Clause
"""The report of a study, of results with known differences."""
import csv
import sqlite3

import numpy as np
import pytest

import study_results
from kestrel.study import report
from kestrel.study.gates import GateError, check, parse_gates
from kestrel.study.reported_study import read_study


def fleet(first=0, count=12, **options):
    return {f"flight{k:02d}": study_results.flight(first + k, **options) for k in range(count)}


def rows_of(folder, name):
    with open(folder / "report" / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture
def before():
    return fleet()


@pytest.fixture
def worse(tmp_path, before):
    """A study whose second configuration loses half of what it sees from 9 to 14 m."""
    after = {name: study_results.lose(scores, 9, 14, 0.5, k)
             for k, (name, scores) in enumerate(before.items())}
    return study_results.write(tmp_path / "study", {"b default": before, "a other": after})


def test_what_got_worse_is_named(worse, capsys):
    assert report.main([str(worse)]) == 0
    verdict = capsys.readouterr().out.splitlines()[0]
    assert verdict.startswith("Worse: b default -> a other: found 9")
    assert "altitude 9 to 14" in verdict and "altitude 6 to 9" not in verdict
    assert (worse / "report" / "report.md").read_text().splitlines()[0] == f"**{verdict}**"
    values = {(row["value"], row["images"]): row for row in rows_of(worse, "values")}
    assert values["found, %", "altitude 9 to 14"]["verdict"] == "worse"
    assert values["found, %", "altitude 2 to 6"]["verdict"] == "no difference"
    assert float(values["found, %", "altitude 2 to 6"]["change"]) == 0
    assert values["position error, m", "altitude 9 to 14"]["verdict"] == "other images"


@pytest.mark.parametrize("count, said", [
    (1, "Worse in the one recording, too few to prove (1 recording, 8 are the least): "),
    (2, "Worse in both, too few to prove (2 recordings, 8 are the least): "),
    (5, "Worse in all 5, too few to prove (5 recordings, 8 are the least): ")])
def test_too_few_recordings_are_not_judged(tmp_path, capsys, count, said):
    flights = fleet(count=count)
    lossy = {name: study_results.lose(scores, 2, 14, 0.5, k)
             for k, (name, scores) in enumerate(flights.items())}
    folder = study_results.write(tmp_path / "few", {"b": flights, "a": lossy})
    assert report.main([str(folder)]) == 0
    assert capsys.readouterr().out.startswith(said)
    assert report.main([str(folder), "--gate", "nothing worse"]) == 1
    told = capsys.readouterr().out
    assert f"gate 'nothing worse': NOT met (not judged: {said.split('(')[1].split(')')[0]})" in told
    page = (folder / "report" / "report.md").read_text()
    assert "Not judged: b -> a" in page and "Nothing significant" not in page


def test_lost_frames_are_named(worse, before):
    report.main([str(worse)])
    lost = rows_of(worse, "lost")
    assert int(lost[0]["images"]) >= int(lost[-1]["images"]) >= 1
    scores = {score.frame: score for score in before[lost[0]["lost in"]]}
    first = scores[lost[0]["frames"].split(" to ")[0]]
    assert first.found and 9 <= first.where["altitude_m"] < 14
    assert not (worse / "report" / "won.csv").exists()


def test_a_report_is_the_same_each_time(worse, tmp_path):
    report.main([str(worse), "--output", str(tmp_path / "one")])
    report.main([str(worse), "--output", str(tmp_path / "two")])
    files = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert "report.html" in files and "values.csv" in files
    for name in files:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_twenty_studies_without_a_change_say_so(tmp_path, capsys):
    """Each compares two halves of a fleet: other flights, the same software."""
    for number in range(20):
        for half in (0, 1):
            study_results.write(tmp_path / f"{number}_{half}", {
                "default": fleet(1000 * number + 100 * half)})
        assert report.main([str(tmp_path / f"{number}_1"), "--against",
                            str(tmp_path / f"{number}_0"), "--gate", "nothing worse"]) in (0, 1)
    verdicts = [line for line in capsys.readouterr().out.splitlines() if "default ->" in line]
    assert len(verdicts) == 20
    assert sum(line.startswith("No difference") for line in verdicts) >= 19


@pytest.mark.parametrize("gate, is_met", [
    ("failed <= 0", True), ("found >= 0.5", True), ("found in altitude_m 0..2 >= 0.85", True),
    ("found in altitude_m 2..6 change >= -0.01", True), ("frame_ms <= 5", True),
    ("nothing worse", False), ("found change >= -0.01", False),
    ("found in altitude_m 9..14 >= 0.9", False), ("landed >= 0.9", False)])  # was not measured
def test_gates_hold_or_not(tmp_path, gate, is_met):
    flights = fleet(count=8)
    folder = study_results.write(tmp_path / "study", {
        "a": flights, "b": {name: study_results.lose(scores, 9, 14, 0.7, k)
                            for k, (name, scores) in enumerate(flights.items())}})
    comparison = read_study(str(folder)).comparisons[0]
    assert check(parse_gates([gate])[0], comparison, failed=0).is_met == is_met


def test_a_gate_of_the_plan_decides_the_exit_status(tmp_path, before):
    folder = study_results.write(tmp_path / "study", {"a": before},
                                 plan="gates: [found >= 0.5]")
    assert report.main([str(folder)]) == 0
    assert report.main([str(folder), "--gate", "found >= 0.99"]) == 1


@pytest.mark.parametrize("gate, said", [
    ("fuond >= 0.9", "no measure 'fuond', expected found, false"),
    ("found > 0.9", "expected 'nothing worse', or as 'found >= 0.95'"),
    ("found in height 2..6 >= 0.9", "no quantity 'height'"),
    ("found >= much", "'much' is no number")])
def test_a_wrong_gate_is_one_line(worse, capsys, gate, said):
    assert report.main([str(worse), "--gate", gate]) == 1
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1 and said in lines[0] and gate in lines[0]
    with pytest.raises(GateError):
        parse_gates([gate])


def test_input_at_fault_is_one_line(tmp_path, worse, capsys):
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "study.db").write_text("no database at all, but long enough to be read")
    for arguments, said in (([str(tmp_path)], "study.db: not there"),
                            ([str(tmp_path / "broken")], "file is not a database"),
                            ([str(worse), "--after", "best"], "no configuration 'best'")):
        assert report.main(arguments) == 1
        lines = capsys.readouterr().err.splitlines()
        assert len(lines) == 1 and said in lines[0]


def test_failures_are_told_and_counted(tmp_path, before, capsys):
    after = dict(before, flight03=None)
    folder = study_results.write(tmp_path / "study", {"a": before, "b": after})
    assert report.main([str(folder), "--gate", "failed <= 0"]) == 1
    said = capsys.readouterr().out
    assert "1 units failed" in said and "NOT met (1)" in said
    assert rows_of(folder, "failed") == [{"configuration": "b", "recording": "flight03",
                                          "reason": "mav0/cam0/data.csv: not there"}]


def test_slower_is_not_worse(tmp_path, before, capsys):
    folder = study_results.write(tmp_path / "old", {"default": before}, frame_ms=4.0)
    new = study_results.write(tmp_path / "new", {"default": before}, frame_ms=5.0)
    report.main([str(new), "--against", str(folder)])
    assert capsys.readouterr().out.startswith("Slower: ")


def test_disturbances_are_ordered_by_what_they_cost(tmp_path):
    random = np.random.default_rng(1)
    folder = tmp_path / "study"
    for k in range(60):
        wind, lag = random.normal(4, 2), random.normal(0.1, 0.02)
        study_results.write(folder, {"default": {f"seed {k:06d}": study_results.flight(k, 5)}},
                            summary={"landed": 1.0, "touchdown_m": 0.05 * abs(wind) + 0.1 * lag,
                                     "draw.wind_mps": wind, "draw.lag_s": lag})
    assert report.main([str(folder), "--gate", "landed >= 1"]) == 0
    assert [row["disturbance"] for row in rows_of(folder, "disturbances")] == ["wind_mps", "lag_s"]


def test_results_are_only_read(worse):
    stamp = (worse / "study.db").read_bytes()
    report.main([str(worse)])
    assert (worse / "study.db").read_bytes() == stamp
    with sqlite3.connect(worse / "study.db") as database:
        assert database.execute("SELECT count(*) FROM unit").fetchone() == (24,)
