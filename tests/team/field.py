# SPDX-License-Identifier: BSD-3-Clause
"""Flights of a team over one field, and how its map compares with what lies there."""

import csv
import math
import subprocess
from dataclasses import dataclass
from pathlib import Path

CAMERA = """sensor_type: camera
T_BS:
  cols: 4
  rows: 4
  data: [0, -1, 0, 0.08, -1, 0, 0, 0, 0, 0, -1, -0.08, 0, 0, 0, 1]
rate_hz: 4
resolution: [640, 360]
camera_model: pinhole
intrinsics: [400, 400, 319.5, 179.5]
distortion_model: none
distortion_coefficients: []
"""
MATCH_M = 0.5  # from an object of the map to what lies there; these are 1 m apart at least


@dataclass
class Field:
    """Discs of three colours on a field, and flights over parts of it that overlap."""

    objects: int
    length_m: float
    lane_m: float
    speed_mps: float
    frames: int
    rate_hz: float = 4

    def bias(self, uav):
        """Of the UAV's navigation: where the true origin lies in its world (m), and the turn (rad)."""
        side = 2 * math.pi * uav / 5
        return math.cos(side), math.sin(side), math.radians(2 if uav % 2 else -2)

    def settings(self, uav, team_size):
        each = self.objects // 3
        x, y, yaw = self.bias(uav)
        return {
            "field_seed": 7,
            "frames": self.frames,
            "rate_hz": self.rate_hz,
            "shutter.rays_per_pixel": 2,
            "ground.map_px": 1024,
            "banners": 0,
            "vehicles": 0,
            "objects.red": self.objects - 2 * each,
            "objects.green": each,
            "objects.blue": each,
            "objects.yellow": 0,
            "objects.orange": 0,
            "objects.orange_bars": 0,
            "objects.distractors": 0,
            "flight.length_m": self.length_m,
            "flight.width_m": (team_size + 1) * self.lane_m,
            "flight.lane_m": self.lane_m,
            "flight.first_lane": uav - 1,
            "flight.speed_mps": self.speed_mps,
            "navigation.origin_x_m": x,
            "navigation.origin_y_m": y,
            "navigation.world_yaw_deg": math.degrees(yaw),
            "navigation.mount_error_deg": 0,
            "navigation.clock_offset_min_s": 0,
            "navigation.clock_offset_max_s": 0,
        }

    def fly(self, kestrel, folder, team_size):
        """Renders the flight of each UAV, where it is not there yet; the recordings by number."""
        (folder / "camera.yaml").write_text(CAMERA)
        recordings = {}
        for uav in range(1, team_size + 1):
            recordings[uav] = folder / f"flight{uav}"
            if recordings[uav].exists():
                continue
            settings = [f"--set={key}={value}" for key, value in self.settings(uav, team_size).items()]
            command = [kestrel, "simulate", "hunt", "--seed", str(uav), "--camera"]
            command += [folder / "camera.yaml", "--output", recordings[uav], *settings]
            subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
        return recordings


def rows_of(path):
    with Path(path).open(newline="") as file:
        return list(csv.DictReader(file))


def read_truth(recordings):
    """id -> (colour, x, y) of what was in view of any of the flights."""
    colors, truth = {}, {}
    for recording in recordings.values():
        for row in rows_of(recording / "mav0/objects0/objects.csv"):
            colors[row["#id []"]] = row["class []"]
        for row in rows_of(recording / "mav0/objects0/data.csv"):
            place = float(row["p_WO_W_x [m]"]), float(row["p_WO_W_y [m]"])
            truth[row["id []"]] = (colors[row["id []"]], *place)
    return truth


def without_bias(x, y, bias):
    """A place in the navigation's world as one in the true world."""
    x0, y0, yaw = bias
    cosine, sine = math.cos(yaw), math.sin(yaw)
    return cosine * (x - x0) + sine * (y - y0), cosine * (y - y0) - sine * (x - x0)


def read_map(path, bias):
    """[(colour, x, y)] of a map's rows, in the true world."""
    return [
        (row["class"], *without_bias(float(row["p_x_m"]), float(row["p_y_m"]), bias))
        for row in rows_of(path)
    ]


def match(objects, truth):
    """The id of what each object of the map is; None: nothing lies there."""
    ids = []
    for color, x, y in objects:
        distances = [
            (math.hypot(x - true_x, y - true_y), key)
            for key, (true_color, true_x, true_y) in truth.items()
            if true_color == color
        ]
        distance, key = min(distances, default=(math.inf, None))
        ids.append(key if distance < MATCH_M else None)
    return ids


def mean_error_m(objects, ids, truth):
    """Mean distance from the truth after the best common turn and shift."""
    pairs = [((x, y), truth[key][1:]) for (_, x, y), key in zip(objects, ids) if key]
    count = len(pairs)
    middle = [[sum(pair[side][axis] for pair in pairs) / count for axis in (0, 1)] for side in (0, 1)]
    cross = dot = 0.0
    for (x, y), (true_x, true_y) in pairs:
        a, b = x - middle[0][0], y - middle[0][1]
        c, d = true_x - middle[1][0], true_y - middle[1][1]
        dot += a * c + b * d
        cross += a * d - b * c
    turn = math.atan2(cross, dot)
    total = 0.0
    for (x, y), (true_x, true_y) in pairs:
        a, b = x - middle[0][0], y - middle[0][1]
        c = math.cos(turn) * a - math.sin(turn) * b + middle[1][0]
        d = math.sin(turn) * a + math.cos(turn) * b + middle[1][1]
        total += math.hypot(c - true_x, d - true_y)
    return total / count
