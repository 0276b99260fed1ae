# SPDX-License-Identifier: BSD-3-Clause
"""`kestrel study run` with workers: each unit once, whatever happens."""
import contextlib
import csv
import os
import sqlite3
import subprocess
import time

import pytest
from study.bench import Bench


@pytest.fixture
def bench(tmp_path):
    return Bench(tmp_path)


def units(bench, output="out"):
    """Returns [(recording, state, reason)]."""
    with contextlib.closing(sqlite3.connect(bench.folder / output / "study.db")) as database:
        return database.execute("SELECT recording, state, reason FROM unit ORDER BY 1").fetchall()


def test_tables_are_equal_for_any_workers_and_after_a_kill(bench):
    for number in range(8):
        bench.recording(f"f{number}", "sleep 0.05", start=1000 * number)
    bench.write()
    assert bench.run(workers=1)[0] == 0
    study = subprocess.Popen(bench.command(output="killed", workers=2), env=bench.environment(), cwd=bench.folder,
                             stderr=subprocess.DEVNULL)
    wait_for_a_result(bench)
    study.kill()
    study.wait()
    status, said = bench.run(output="killed", workers=2)
    assert status == 0, said
    assert len(units(bench, "killed")) == 16
    assert bench.tables("killed") == bench.tables("out")


def test_the_options_of_the_run_are_kept(bench):
    bench.recording("f")
    bench.write(arguments=["--altitude", 3], configurations=[
        {"name": "z first"}, {"name": "grid", "set": {"landing.x": [2, 1]}}])
    assert bench.run()[0] == 0
    first = bench.tables()["configuration.csv"]
    with open(bench.folder / "out/configuration.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["name"] for row in rows] == ["z first", "grid landing.x=2", "grid landing.x=1"]
    assert [row["text"] for row in rows] == ["", "landing.x: 2\n", "landing.x: 1\n"]
    assert {row["arguments"] for row in rows} == {'["--altitude", "3"]'}
    bench.write(configurations=[{"name": "z first", "set": {"landing.x": 5}}])
    assert bench.tables()["configuration.csv"] == first, "editing the file changes no result"
    assert bench.run(workers=2)[0] == 0
    assert b"grid" not in bench.tables()["configuration.csv"]
    assert b"landing.x: 5" in bench.tables()["configuration.csv"]


def wait_for_a_result(bench):
    deadline = time.monotonic() + 30
    while count(bench) == 0 and time.monotonic() < deadline:
        time.sleep(0.05)


def count(bench):
    try:
        return len(units(bench, "killed"))
    except sqlite3.Error:
        return 0


def test_failures_are_tried_once_more_and_then_told_in_a_line(bench):
    bench.recording("broken", "broken")
    bench.recording("good")
    bench.recording("shaky", f"once {bench.folder}/tried")
    bench.write(configurations=[{"name": "only"}])
    status, said = bench.run(workers=2)
    assert status == 1
    assert [(name, state) for name, state, _ in units(bench)] == [
        ("broken", "failed"), ("good", "done"), ("shaky", "done")]
    assert sum("broken" in line for line in said) == 1
    assert "expected 2 columns" in units(bench)[0][2]
    (bench.folder / "flights/broken/mav0/behaviour").write_text("")
    assert bench.run(workers=1)[0] == 0, "a recording that was mended is another"
    assert [state for _, state, _ in units(bench)] == ["done"] * 3


def test_a_full_disk_at_the_results_is_told(bench):
    mount = bench.folder / "small"
    mount.mkdir()
    made = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", mount], check=False,
                          capture_output=True)
    if made.returncode:
        pytest.skip("needs to mount a small disk")
    try:
        for number in range(8):
            bench.recording(f"f{number}", frames=500, start=number)
        bench.write()
        status, said = bench.run(output="small/out", workers=1)
        assert status == 1
        assert "disk" in said[-1] and "what it has is kept" in said[-1], said
        assert not any("Traceback" in line for line in said)
        subprocess.run(["mount", "-o", "remount,size=16m", mount], check=True)
        assert bench.run(output="small/out", workers=1)[0] == 0
        assert len(units(bench, "small/out")) == 16
    finally:
        subprocess.run(["umount", mount], check=True)


def test_nothing_is_started_for_a_study_that_is_wrong(bench):
    bench.recording("f")
    bench.write(configurations=[{"name": "a", "set": {"lading.x": 1}}])
    status, said = bench.run()
    assert status == 1
    assert len(said) == 1 and "lading.x: no such option" in said[0]
    assert not os.path.exists(bench.folder / "out")


@pytest.mark.parametrize("where, words", [
    ("udp://host", "where: udp://host, expected local, slurm, or a scheduler as tcp://HOST:8786"),
    ("tcp://127.0.0.1:9", "tcp://127.0.0.1:9: no scheduler there"),
    ("slurm", "no command srun on this computer"),
])
def test_workers_that_are_not_there(bench, monkeypatch, where, words):
    bench.recording("f")
    bench.write()
    monkeypatch.setattr(bench, "environment", lambda: {**Bench.environment(bench), "PATH": "/bin-none"})
    status, said = bench.run("--where", where)
    assert status == 1
    assert len(said) == 1 and words in said[0]
