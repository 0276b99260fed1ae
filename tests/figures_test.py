#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/figures on pages and commands of its own."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FIGURES = Path(__file__).resolve().parent.parent / "scripts/figures"

CONFIG = """
[run.race]
command = "scripts/race"
needs = ["data"]

[run.flights]
command = "scripts/flights"
only_named = true

[figures.speed]
columns = ["who", "ms", "ratio"]
tolerance = 1.5
compare = ["ratio"]
rows = [
  { run = "race", where = { who = "peer" } },
  { run = "race", where = { who = "we" }, cells = ["ours", "{ms} ms", "{ratio}"] },
]

[figures.flights]
columns = ["what", "figure"]
rows = [
  { run = "flights", join = "range", cells = ["found, each", "{found} of {frames}"] },
  { run = "flights", join = "list", cells = ["time", "{time} s"] },
]
"""

PAGE = """# Page

<!-- figures: speed -->

| who | ms | ratio |
|---|---|---|
| peer | 4.0 | 1.00 |
| ours | 2.0 ms | 0.50 |

<!-- end -->

Text after it.

<!-- figures: flights -->

| what | figure |
|---|---|
| found, each | 9 of 10 |
| time | 1.5 s |

<!-- end -->
"""

RACE = """#!/bin/sh
echo run >>runs
echo 'Speed, and what else it prints:'
echo '| who | ms | ratio |'
echo '|---|---|---|'
echo '| peer | 5.0 | 1.00 |'
echo '| we | 3.0 | RATIO |'
"""

FLIGHTS = """#!/bin/sh
echo '| flight | frames | found | time |'
echo '|---|---|---|---|'
echo '| calm | 1,000 | 998 | 1.5 |'
echo '| fast | 900 | 900 | 2.0 |'
"""


class FiguresTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        (self.root / "docs").mkdir()
        (self.root / "data").mkdir()
        self.write("README.md", PAGE)
        self.write("docs/figures.toml", CONFIG)
        self.write("scripts/race", RACE.replace("RATIO", "0.60"))
        self.write("scripts/flights", FLIGHTS)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)

    def page(self):
        return (self.root / "README.md").read_text()

    def run_figures(self, *arguments):
        """Status and lines on stderr, without those that say what is run."""
        command = [sys.executable, FIGURES, "--root", self.root, *arguments]
        done = subprocess.run(command, capture_output=True, text=True)
        faults = [line for line in done.stderr.splitlines() if not line.startswith("figures: scripts/")]
        return done.returncode, faults

    def expect_one_fault(self, fault, *arguments):
        status, faults = self.run_figures(*arguments)
        self.assertEqual((status, faults), (1, ["figures: " + fault]))

    def test_writes_between_the_markers_and_twice_the_same(self):
        self.assertEqual(self.run_figures("speed", "flights"), (0, []))
        expected = PAGE.replace("| peer | 4.0 | 1.00 |", "| peer | 5.0 | 1.00 |")
        expected = expected.replace("| ours | 2.0 ms | 0.50 |", "| ours | 3.0 ms | 0.60 |")
        expected = expected.replace("9 of 10", "900 to 998 of 900 to 1,000").replace("1.5 s", "1.5, 2.0 s")
        self.assertEqual(self.page(), expected)
        self.assertEqual(self.run_figures("speed", "flights"), (0, []))
        self.assertEqual(self.page(), expected)
        self.assertEqual(self.run_figures("--check"), (0, []))

    def test_runs_only_when_named_what_says_so(self):
        self.assertEqual(self.run_figures(), (0, []))
        self.assertIn("9 of 10", self.page())
        self.assertIn("| ours | 3.0 ms | 0.60 |", self.page())

    def test_unknown_name(self):
        self.expect_one_fault("there are no figures 'sped', expected some of speed, flights", "sped")
        self.expect_one_fault("there are no figures 'sped', expected some of speed, flights", "--check", "sped")

    def test_writes_nothing_when_a_row_is_missing(self):
        self.write("scripts/race", RACE.replace("we", "they"))
        self.expect_one_fault("speed: run.race printed no row with ['who', 'ms', 'ratio'] where {'who': 'we'}", "speed")
        self.assertEqual(self.page(), PAGE)

    def test_writes_nothing_without_its_data(self):
        (self.root / "data").rmdir()
        self.expect_one_fault("speed: run.race needs data", "speed")
        self.assertEqual(self.page(), PAGE)

    def test_within_tolerance_it_measures_once(self):
        self.assertEqual(self.run_figures("--check"), (0, []))
        self.assertEqual((self.root / "runs").read_text(), "run\n")

    def test_out_of_tolerance_twice(self):
        self.write("scripts/race", RACE.replace("RATIO", "0.76"))
        self.expect_one_fault(
            "README.md: speed: 'ours', ratio: 0.50 is written, 0.76 was measured, expected within a factor of 1.5",
            "--check",
        )
        self.assertEqual((self.root / "runs").read_text(), "run\nrun\n")

    def test_faster_than_written_is_out_of_tolerance_too(self):
        self.write("scripts/race", RACE.replace("RATIO", "0.33"))
        self.assertEqual(self.run_figures("--check")[0], 1)

    def test_out_of_tolerance_once_is_noise(self):
        noisy = RACE.replace("RATIO", "$(if [ $(wc -l <runs) = 1 ]; then echo 0.90; else echo 0.55; fi)")
        self.write("scripts/race", noisy.replace("echo '| we | 3.0 | ", 'echo "| we | 3.0 | ').replace("fi) |'", 'fi) |"'))
        self.assertEqual(self.run_figures("--check"), (0, []))

    def test_marker_that_nobody_knows(self):
        self.write("docs/more.md", PAGE.replace("figures: speed", "figures: sped"))
        self.expect_one_fault("docs/more.md:3: there are no figures 'sped' in docs/figures.toml", "--check")

    def test_marker_without_an_end(self):
        self.write("docs/more.md", "Text.\n\n<!-- figures: speed -->\n")
        self.expect_one_fault("docs/more.md:3: expected '<!-- end -->' after it", "--check")

    def test_figures_without_a_document(self):
        self.write("README.md", PAGE[PAGE.index("Text") :])
        self.expect_one_fault("docs/figures.toml: figures.speed are in no document", "--check")

    def test_command_that_is_gone(self):
        (self.root / "scripts/race").unlink()
        self.expect_one_fault("docs/figures.toml: run.race: there is no scripts/race", "--check")
        self.write("docs/figures.toml", CONFIG.replace("scripts/race", "{build}/bench/race"))
        self.expect_one_fault("docs/figures.toml: run.race: no CMake file makes the program race", "--check")
        self.write("bench/race.cmake", "add_executable(race race.cc)\n")
        self.assertNotIn("no CMake file", self.run_figures("--check")[1][0])

    def test_form(self):
        for rows, fault in {
            "| ours | 2.0 |": "no command writes the row | ours | 2.0 |",
            "": "rows are missing, or out of order",
            "| ours | 2.0 ms | 0.50 |\n| peer | 4.0 | 1.00 |": "rows are missing, or out of order",
        }.items():
            self.write("README.md", PAGE.replace("| ours | 2.0 ms | 0.50 |\n", rows and rows + "\n"))
            self.expect_one_fault(f"README.md:3: speed: {fault}", "--check")

    def test_form_of_the_header(self):
        self.write("README.md", PAGE.replace("| who | ms | ratio |", "| who | s | ratio |"))
        self.expect_one_fault("README.md:3: speed: expected the table | who | ms | ratio |", "--check")

    def test_table_of_figures_without_a_marker(self):
        table = "| lens | error |\n|---|---|\n| wide | 0.03 % |\n"
        self.write("docs/more.md", table)
        self.expect_one_fault(
            "docs/more.md:1: a table of figures, expected '<!-- figures: NAME -->' or "
            "'<!-- by hand YYYY-MM-DD: reason -->' before it",
            "--check",
        )
        self.write("docs/more.md", "<!-- by hand 2026-01-31: by a ruler -->\n\n" + table)
        self.assertEqual(self.run_figures("--check"), (0, []))

    def test_table_of_settings_needs_no_marker(self):
        self.write("docs/more.md", "| option | default |\n|---|---|\n| `min_ring_px` | 6 |\n")
        self.assertEqual(self.run_figures("--check"), (0, []))

    def test_config_at_fault(self):
        self.write("docs/figures.toml", CONFIG.replace('run = "race"', 'run = "rice"'))
        self.expect_one_fault(
            "docs/figures.toml: figures.speed: no run 'rice', expected some of race, flights", "--check"
        )
        self.write("docs/figures.toml", CONFIG.replace("needs", "wants"))
        status, faults = self.run_figures("--check")
        self.assertEqual((status, len(faults)), (1, 1))
        self.assertIn("docs/figures.toml: ", faults[0])
        self.assertIn("wants", faults[0])

    def test_benchmarks_as_json(self):
        self.write("scripts/flights", """#!/bin/sh
echo '{"context": {}, "benchmarks": [
  {"name": "Hear/2", "cpu_time": 0.0512, "time_unit": "ms"}, {"name": "See", "cpu_time": 3, "objects": 100.0}]}'
""")
        config = CONFIG[: CONFIG.index("[figures.flights]")] + """
[figures.flights]
columns = ["what", "figure"]
rows = [{ run = "flights", where = { name = "Hear/.*" }, cells = ["to hear", "{cpu_time} {time_unit}"] }]
"""
        self.write("docs/figures.toml", config)
        self.assertEqual(self.run_figures("flights"), (0, []))
        self.assertIn("| to hear | 0.0512 ms |\n\n<!-- end -->", self.page())


if __name__ == "__main__":
    unittest.main()
