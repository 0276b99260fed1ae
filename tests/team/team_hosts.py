#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Usage: team_hosts.py KESTREL [--short] [--keep FOLDER] [--case NAME]...

Five UAVs on five hosts (network namespaces of this machine) fly over one field, each with its own
part of it, a navigation that is off by 1 m and 2 degrees, and a clock 10 s after the last one's. What
connects them loses, delays and cuts (radio.py). At the end the team's maps of all must be the same,
byte by byte, have what each has seen, nothing twice, and no error of more than 0.1 m. Prints a table
with a row for every case: "equal" is the time from the last landing until all have all, the bytes
are those of the UAV that sends most; status 1 when one fails, 77 where there can be no hosts. --short: one flight of
15 s with a bad radio, a restart and a break; no times are judged. --keep: flights are kept there and
used again.
"""

import argparse
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path

import field
from radio import Radio, obstacle

TEAM = 5
SKIPPED = 77
MAX_ERROR_M = 0.1
MAX_RATE = 10_000  # bytes/s of a UAV
CLOCK_STEP_S = 10
STAY_S = 1  # of a UAV that has all, for the others: TeamLink::Finish
MAX_RIVALRY_S = 1  # after a heal
CLAIM = re.compile(r"team: goes for (\w+) at \((-?[\d.]+), (-?[\d.]+)\) m")


class Uav:
    """A program on a host; what it says, with times."""

    def __init__(self, radio, number, recording, output, *, program="fly --hunt", name=None, settings=()):
        self.number, self.output, self.name = number, output, name or f"uav{number}"
        self.host = radio.hosts[number - 1]
        self.sent_before = self.host.sent_bytes()
        self.started = time.monotonic()
        self.said = []
        kestrel, *words = program.split()
        clock = str(CLOCK_STEP_S * number)
        command = ["unshare", "--time", "--monotonic", clock, "--boottime", clock, "--fork", "--kill-child"]
        command += [kestrel, *words, str(recording), "--output", str(output), "--team", "hosts"]
        for setting in [f"team.uav={self.name}", *settings]:
            command += ["--set", setting]
        self.process = subprocess.Popen(
            command,
            preexec_fn=self.host.enter,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            env={**os.environ, "CYCLONEDDS_URI": ""},
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stderr:
            self.said.append((time.monotonic(), line.strip()))

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def wait(self):
        status = self.process.wait(timeout=300)
        self._reader.join()
        self.bytes_per_s = (self.host.sent_bytes() - self.sent_before) / (time.monotonic() - self.started)
        if status != 0:
            raise AssertionError(f"uav{self.number} ended with {status}: " + self.words())

    def words(self):
        return "\n".join(text for _, text in self.said)

    def landed(self):
        """When it had its own map."""
        return (self.output / "object_map.csv").stat().st_mtime

    def had_all(self):
        """When it knew what the team knows."""
        return (self.output / "team_map.csv").stat().st_mtime - STAY_S

    def claims(self, bias):
        """[(time, place or None)], places without the navigation's bias."""
        claims = []
        for at, text in self.said:
            if found := CLAIM.search(text):
                claims.append((at, field.without_bias(float(found[2]), float(found[3]), bias)))
            elif "nothing left to go for" in text:
                claims.append((at, None))
        return claims


class Flight:
    """All UAVs, each on its recording, and a radio; what is said of them when they have landed."""

    def __init__(self, kestrel, flights, recordings, folder, settings=(), hunt=False):
        self.flights, self.recordings, self.folder = flights, recordings, folder
        self.program = f"{kestrel} hunt" if hunt else f"{kestrel} fly --hunt"
        self.settings = ["team.claim=true", *settings]
        self.radio = Radio(TEAM)
        self.uavs, self.starts = {}, 0
        for number in range(1, TEAM + 1):
            self.start(number)

    def start(self, number, **more):
        self.starts += 1
        output = self.folder / f"out{self.starts}"
        self.uavs[number] = Uav(
            self.radio,
            number,
            self.recordings[number],
            output,
            program=self.program,
            settings=self.settings,
            **more,
        )

    def cut(self, sides):
        """Only those of one side hear each other."""
        side_of = {number: i for i, side in enumerate(sides) for number in side}
        self.radio.hears = lambda receiver, sender: side_of[receiver] == side_of[sender]

    def heal(self):
        self.radio.hears = lambda receiver, sender: True
        self.healed = time.monotonic()

    def land(self):
        """Waits for all that are still there; the figures of the flight."""
        living = [uav for uav in self.uavs.values() if uav.process.poll() != -signal.SIGKILL]
        for uav in living:
            uav.wait()
        self.radio.close()
        return Figures(self, living)

    def rivalry_s(self):
        """Seconds, since the last heal, until no two go for one object any more."""
        tracks = {n: uav.claims(self.flights.bias(n)) for n, uav in self.uavs.items()}
        rivalry = 0.0
        moments = sorted(at for track in tracks.values() for at, _ in track if at >= self.healed)
        for begin, end in zip([self.healed, *moments], [*moments, moments[-1] if moments else self.healed]):
            places = [place for place in (self._claim_at(track, begin) for track in tracks.values()) if place]
            near = any(math.dist(a, b) < field.MATCH_M for i, a in enumerate(places) for b in places[:i])
            if near:
                rivalry = max(rivalry, end - self.healed)
        return rivalry

    @staticmethod
    def _claim_at(track, moment):
        return next((place for at, place in reversed(track) if at <= moment), None)


class Figures:
    """What a flight comes to; check() says what is wrong."""

    def __init__(self, flight, living):
        maps = {uav.number: (uav.output / "team_map.csv").read_text() for uav in living}
        self.unequal = [number for number, text in maps.items() if text != maps[living[0].number]]
        self.names = Counter(uav.name for uav in living)
        self.rate = max(uav.bytes_per_s for uav in living)
        self.late_s = max(uav.had_all() for uav in living) - max(uav.landed() for uav in living)
        self._compare(flight, living)
        rows = field.rows_of(living[0].output / "team_map.csv")
        self.holders = [row["holder"] for row in rows if row["holder"]]

    def _compare(self, flight, living):
        truth = field.read_truth(flight.recordings)
        common = flight.flights.bias(min(uav.number for uav in living))
        objects = field.read_map(living[0].output / "team_map.csv", common)
        ids = field.match(objects, truth)
        known = [key for key in ids if key]
        seen = set()
        for uav in living:
            own = field.read_map(uav.output / "object_map.csv", flight.flights.bias(uav.number))
            seen |= {key for key in field.match(own, truth) if key}
        self.objects, self.false = len(objects), ids.count(None)
        self.twice = len(known) - len(set(known))
        self.lost = len(seen - set(known))
        self.error_m = field.mean_error_m(objects, ids, truth)

    def check(self):
        wrong = []
        if self.unequal:
            wrong.append(f"maps of {self.unequal} differ")
        if self.twice or self.lost or self.false:
            wrong.append(f"{self.twice} objects twice, {self.lost} lost, {self.false} false")
        if self.error_m > MAX_ERROR_M:
            wrong.append(f"error {self.error_m:.3f} m")
        if Counter(self.holders) - self.names:
            wrong.append(f"holders {self.holders}")
        return wrong

    def __str__(self):
        return f"{self.objects} | {self.error_m:.3f} | {self.late_s:.2f} | {self.rate / 1000:.1f} | {len(self.holders)}"


def until(flight, seconds):
    start = max(uav.started for uav in flight.uavs.values())
    time.sleep(max(0.0, start + seconds - time.monotonic()))


# The cases: each flies and gives the figures, what else is wrong, and what else is to be said.


def recordings(new_flight):
    """Each is a `kestrel hunt` on its recording, as fast as it can."""
    return new_flight(hunt=True).land(), [], ""


def quiet(new_flight):
    """All hear all."""
    return new_flight().land(), [], ""


def bad_radio(new_flight):
    """A fifth of what is sent is lost, 200 ms of delay."""
    flight = new_flight()
    flight.radio.loss, flight.radio.delay_s = 0.2, 0.2
    return flight.land(), [], ""


def partition(new_flight):
    """Two and three hear each other for 30 s; both halves land before it ends."""
    flight = new_flight(["team.silence_s=60"])
    until(flight, 25)
    flight.cut([{1, 2}, {3, 4, 5}])
    time.sleep(30)
    flight.heal()
    healed = time.time()
    figures = flight.land()
    figures.late_s = max(uav.had_all() for uav in flight.uavs.values()) - healed
    return figures, [], "equal: after the break"


def rivals(new_flight):
    """As before, but they fly on: claims of the other half are free meanwhile."""
    flight = new_flight()
    until(flight, 10)
    flight.cut([{1, 2}, {3, 4, 5}])
    time.sleep(30)
    flight.heal()
    figures = flight.land()
    rivalry_s = flight.rivalry_s()
    wrong = ["two go for one object"] if rivalry_s > MAX_RIVALRY_S else []
    return figures, wrong, f"no two go for one object {rivalry_s:.2f} s after the heal"


def deaf(new_flight):
    """uav1 is heard but hears nobody for 20 s."""
    flight = new_flight()
    until(flight, 10)
    flight.radio.hears = lambda receiver, sender: receiver != 1
    time.sleep(20)
    flight.heal()
    return flight.land(), [], ""


def reboot(new_flight):
    """uav2 dies and starts again, with a map of its own."""
    flight = new_flight()
    until(flight, 20)
    flight.uavs[2].kill()
    time.sleep(2)
    flight.start(2)
    return flight.land(), [], ""


def early(new_flight):
    """uav1 and uav2 die before they have seen much, and start again."""
    flight = new_flight()
    until(flight, 5)
    for number in (1, 2):
        flight.uavs[number].kill()
    time.sleep(2)
    for number in (1, 2):
        flight.start(number)
    return flight.land(), [], ""


def lost(new_flight):
    """uav5 dies for good: what it has seen stays, what it claimed is free."""
    flight = new_flight()
    until(flight, 30)
    flight.uavs[5].kill()
    figures = flight.land()
    rows = field.rows_of(flight.uavs[1].output / "team_map.csv")
    kept = sum("uav5" in row["uavs"].split() for row in rows)
    wrong = [] if kept else ["what uav5 saw is gone"]
    if "uav5" in figures.holders:
        wrong.append("uav5 still holds an object")
    return figures, wrong, f"{kept} objects of the lost one are known"


def namesakes(new_flight):
    """uav3 is called uav2 as well."""
    flight = new_flight()
    flight.uavs[3].kill()
    flight.start(3, name="uav2")
    figures = flight.land()
    silent = [n for n in (2, 3) if "another UAV is called 'uav2'" not in flight.uavs[n].words()]
    return figures, [f"{silent} say nothing of the namesake"] if silent else [], ""


def short(new_flight):
    """A bad radio, one that dies early and starts again, and a partition."""
    flight = new_flight()
    flight.radio.loss, flight.radio.delay_s = 0.2, 0.2
    until(flight, 5)
    flight.uavs[1].kill()
    flight.start(1)
    time.sleep(1)
    flight.cut([{1, 2}, {3, 4, 5}])
    time.sleep(6)
    flight.heal()
    return flight.land(), [], ""


CASES = [recordings, quiet, bad_radio, partition, rivals, deaf, reboot, early, lost, namesakes]
FIELD = field.Field(objects=100, length_m=30, lane_m=5, speed_mps=1.5, frames=200)
SHORT_FIELD = field.Field(objects=30, length_m=16, lane_m=4, speed_mps=2.5, frames=60)


def run(case, kestrel, flights, made, folder, judges_times):
    folder.mkdir()

    def new_flight(settings=(), **more):
        return Flight(kestrel, flights, made, folder, settings, **more)

    figures, wrong, remark = case(new_flight)
    wrong = figures.check() + wrong
    if judges_times and figures.rate > MAX_RATE:
        wrong.append("too many bytes")
    what = case.__doc__.splitlines()[0].rstrip(".")
    print(f"| {case.__name__} | {what} | {figures} | {remark} |", flush=True)
    for text in wrong:
        print(f"{case.__name__} FAILED: {text}", file=sys.stderr)
    return not wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[2])
    parser.add_argument("kestrel", type=Path)
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--case", action="append", choices=[case.__name__ for case in CASES])
    arguments = parser.parse_args()
    if why := obstacle():
        print(f"skipped: no network namespaces here ({why})")
        return SKIPPED
    wanted = arguments.case or [case.__name__ for case in CASES]
    cases = [short] if arguments.short else [case for case in CASES if case.__name__ in wanted]
    flights = SHORT_FIELD if arguments.short else FIELD
    with tempfile.TemporaryDirectory() as scratch:
        kept = arguments.keep or Path(scratch) / "flights"
        kept.mkdir(parents=True, exist_ok=True)
        made = flights.fly(arguments.kestrel, kept, TEAM)
        print("| case | what happens | objects | error, m | equal, s | kB/s at most | claimed | remark |")
        print("|---|---|---|---|---|---|---|---|")
        results = [
            run(case, arguments.kestrel, flights, made, Path(scratch) / case.__name__, not arguments.short)
            for case in cases
        ]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
