#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Usage: study_benchmark.py KESTREL FOLDER [--recordings N] [--empty N]

What studies cost, with `import kestrel` of the PYTHONPATH. First N (100000) units that do nothing,
and a tenth of them. Then N (200) short recordings in FOLDER, copies of ten simulated flights, with
three configurations, by one worker and by two, and once more while the study is killed five times; the
tables are compared. Prints two tables: units/s and the largest memory of client and scheduler, and the
time against that of the units.
"""
import argparse
import os
import resource
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

FLIGHTS = 10
CONFIGURATIONS = """configurations:
  - name: default
  - name: coarse
    set: {landing.detector.min_ring_px: 30}
  - name: fine
    set: {landing.detector.min_ring_px: 16}
"""


# The paper's lens on a quarter of the pixels to a side: quick to render.
CAMERA = """sensor_type: camera
rate_hz: 5
resolution: [188, 120]
camera_model: pinhole
intrinsics: [65.25, 65.25, 94, 60]
distortion_model: equidistant
distortion_coefficients: [-0.0448, 0.0686053, -0.072277, 0.027011955]
"""


def simulate(kestrel, folder, count):
    """Makes recordings: a few simulated flights, copied, and each copy told apart by its scene.yaml."""
    camera = folder / "camera.yaml"
    camera.write_text(CAMERA)
    for number in range(1, count + 1):
        seed = (number - 1) % FLIGHTS + 1
        first, flight = (folder / "flights" / f"{one:04d}" for one in (seed, number))
        if not first.exists():
            subprocess.run([kestrel, "simulate", "landing", "--scenario", "calm", "--seed", str(seed), "--set",
                            "frames=10", "--set", "rate_hz=5", "--set", "shutter.rays_per_pixel=2", "--set",
                            "ground.map_px=256", "--camera", camera,
                            "--output", first], check=True, stderr=subprocess.DEVNULL)
        if not flight.exists():
            shutil.copytree(first, flight)
            with open(flight / "scene.yaml", "a") as scene:
                scene.write(f"# copy {number}\n")


def write(folder, text):
    path = folder / "study.yaml"
    path.write_text(text)
    return path


def command(study, output, workers):
    return [sys.executable, "-m", "kestrel.study", "run", study, "--output", output, "--workers", str(workers)]


def timed(study, output, workers):
    start = time.monotonic()
    run = subprocess.run(command(study, output, workers), stderr=subprocess.PIPE, text=True, check=False)
    if run.returncode != 0:
        sys.exit(run.stderr)
    return time.monotonic() - start


def numbers(output, query):
    database = sqlite3.connect(output / "study.db")
    try:
        return database.execute(query).fetchone()
    finally:
        database.close()


def tables(output):
    return {path.name: path.read_bytes() for path in output.glob("*.csv")}


def units_done(output):
    try:
        return numbers(output, "SELECT count(*) FROM unit")[0]
    except sqlite3.Error:
        return 0  # it is not there yet


def kill_and_go_on(study, output, count):
    """Kills the study five times, each time with another sixth of its units done, and goes on."""
    for number in range(1, 6):
        run = subprocess.Popen(command(study, output, 2), stderr=subprocess.DEVNULL)
        while units_done(output) < number * count // 6:
            time.sleep(0.05)
        run.send_signal((signal.SIGKILL, signal.SIGTERM)[number % 2])
        run.wait()
        print(f"killed with {units_done(output)} units done", file=sys.stderr)
    timed(study, output, 2)


def measure_units(kestrel, folder, count):
    simulate(kestrel, folder, count)
    start_up = timed(write(folder, "task: nothing\nunits: 1\n"), folder / "start", 1)
    study = write(folder, f"task: land\nrecordings: [flights]\n{CONFIGURATIONS}")
    print("| workers | units | s | start and end, s | units alone / workers, s | ratio | overhead of a unit, ms |")
    print("|---|---|---|---|---|---|---|", flush=True)
    for workers in (1, 2):
        output = folder / f"by{workers}"
        wall = timed(study, output, workers)
        units, alone = numbers(output, "SELECT count(*), sum(seconds) FROM resource")
        work = wall - start_up
        print(f"| {workers} | {units} | {wall:.1f} | {start_up:.1f} | {alone / workers:.1f} | "
              f"{work * workers / alone:.3f} | {1e3 * (work * workers - alone) / units:.1f} |", flush=True)
    kill_and_go_on(study, folder / "killed", units)
    equal = tables(folder / "by1") == tables(folder / "by2") == tables(folder / "killed")
    print(f"\ntables of 1 worker, of 2, and after five kills: {'equal' if equal else 'different'}")


def memory_mb(pid):
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmHWM"):
            return int(line.split()[1]) / 1e3
    return 0.0


def measure_empty(folder, count):
    """Client and scheduler as processes of their own, so that each has its memory."""
    study = write(folder, f"task: nothing\nunits: {count}\n")
    options = {**os.environ, "DASK_DISTRIBUTED__SCHEDULER__TRANSITION_LOG_LENGTH": "1000",
               "DASK_DISTRIBUTED__SCHEDULER__EVENTS_LOG_LENGTH": "1000"}
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": options}
    scheduler = subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1",
                                  "--port", "18786", "--no-dashboard"], **quiet)
    workers = subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_worker", "tcp://127.0.0.1:18786",
                                "--nworkers", "2", "--nthreads", "1", "--no-dashboard", "--local-directory",
                                folder], **quiet)
    try:
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        start = time.monotonic()
        run = subprocess.run([*command(study, folder / f"empty{count}", 1), "--where", "tcp://127.0.0.1:18786"],
                             stderr=subprocess.PIPE, text=True, check=False)
        seconds = time.monotonic() - start
        client = max(before, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss) / 1e3
        if run.returncode != 0:
            sys.exit(run.stderr)
        print(f"| {count} | {seconds:.0f} | {count / seconds:.0f} | {client:.0f} | {memory_mb(scheduler.pid):.0f} |",
              flush=True)
    finally:
        workers.terminate()
        scheduler.terminate()
        workers.wait()
        scheduler.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kestrel")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--recordings", type=int, default=200)
    parser.add_argument("--empty", type=int, default=100_000)
    arguments = parser.parse_args()
    os.environ["KESTREL_COMMAND"] = os.path.abspath(arguments.kestrel)
    arguments.folder.mkdir(parents=True, exist_ok=True)
    if arguments.empty:
        print("| empty units | s | units/s | client, MB | scheduler, MB |\n|---|---|---|---|---|", flush=True)
        for count in (arguments.empty // 10, arguments.empty):
            measure_empty(arguments.folder, count)
    if arguments.recordings:
        measure_units(arguments.kestrel, arguments.folder, arguments.recordings)


if __name__ == "__main__":
    main()
