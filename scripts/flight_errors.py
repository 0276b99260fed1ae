# SPDX-License-Identifier: BSD-3-Clause
"""What the accuracy scripts share: a simulated flight, and what `kestrel land` makes of it."""

import csv
import subprocess
from pathlib import Path


def simulate(kestrel, folder, *options):
    """Renders a recording; one that is there already is used again."""
    if not Path(folder).exists():
        subprocess.run([kestrel, "simulate", "landing", "--output", folder, *options], check=True)


def errors(kestrel, recording, output, *options):
    """Errors of the whole flight under the titles of `kestrel evaluate`, as text."""
    land = [kestrel, "land", recording, "--output", output, "--force", "--predict", "0.5,1.0", *options]
    subprocess.run(land, check=True, stdout=subprocess.DEVNULL)
    subprocess.run([kestrel, "evaluate", recording, output, "--force"], check=True, stdout=subprocess.DEVNULL)
    rows = {}
    for table in ("errors", "track", "prediction"):
        with open(Path(output) / "evaluation" / f"{table}.csv", newline="") as file:
            rows |= {(table, row[next(iter(row))]): row for row in csv.DictReader(file)}
    return {
        "position RMS, m": rows["errors", "all"]["world RMS, m"],
        "yaw median, degrees": rows["errors", "all"]["yaw median, degrees"],
        "velocity RMS, m/s": rows["track", "all"]["velocity RMS, m/s"],
        "prediction 0.5 s, 95 %, m": rows["prediction", "0.5"]["95 %, m"],
        "prediction 1 s, 95 %, m": rows["prediction", "1"]["95 %, m"],
    }
