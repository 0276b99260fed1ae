# SPDX-License-Identifier: BSD-3-Clause
"""A place for studies of a stand-in for `kestrel`: recordings, STUDY.yaml, and the program."""
import os
import subprocess
import sys
from pathlib import Path

import yaml

HERE = Path(__file__).resolve().parent
MODULES = HERE.parents[1] / "kestrel" / "study"
FAKE = HERE / "fake_kestrel"
TWO = [{"name": "before"}, {"name": "after", "set": {"landing.x": 2}}]


class Bench:
    """A folder with recordings and studies."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.package = self.folder / "package"
        self._install()

    def _install(self):
        """Links the package, with the scoring that stands in for its own."""
        study = self.package / "kestrel" / "study"
        study.mkdir(parents=True)
        (self.package / "kestrel" / "__init__.py").touch()
        for module in MODULES.glob("*.py"):
            if module.name != "scoring.py":
                (study / module.name).symlink_to(module)
        (study / "scoring.py").symlink_to(HERE / "scoring.py")

    def recording(self, name, behaviour="", frames=3, start=0):
        """Writes a recording; returns its folder."""
        folder = self.folder / "flights" / name
        (folder / "mav0/cam0").mkdir(parents=True)
        (folder / "mav0/behaviour").write_text(behaviour)
        rows = [f"{start + 1_000_000_000 * number},{number}.png" for number in range(frames)]
        (folder / "mav0/cam0/data.csv").write_text("\n".join([f"#{name}", *rows]) + "\n")
        return folder

    def write(self, **study):
        """Writes STUDY.yaml and returns its path."""
        path = self.folder / "study.yaml"
        study = {"task": "land", "recordings": ["flights"], "configurations": TWO, **study}
        path.write_text(yaml.safe_dump({key: value for key, value in study.items() if value is not None}))
        return path

    def command(self, *arguments, output="out", workers=1):
        return [sys.executable, "-m", "kestrel.study", "run", str(self.folder / "study.yaml"), "--output",
                str(self.folder / output), "--workers", str(workers), *arguments]

    def environment(self):
        path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
        return {**os.environ, "PATH": path, "PYTHONPATH": str(self.package), "KESTREL_COMMAND": str(FAKE)}

    def run(self, *arguments, **more):
        """Runs the study to its end; returns (status, lines on stderr)."""
        # Python looks in the current folder first, where another package of this name may lie.
        run = subprocess.run(self.command(*arguments, **more), env=self.environment(), cwd=self.folder,
                             text=True, capture_output=True, check=False, timeout=120)
        return run.returncode, run.stderr.splitlines()

    def tables_alone(self, recordings, unit_s, workers):
        """Writes recordings whose units take unit_s, and a study of them; returns its tables as workers of this
        computer make them."""
        for number in range(recordings):
            self.recording(f"flight{number:02d}", f"sleep {unit_s}", start=1000 * number)
        self.write()
        status, said = self.run(output="alone", workers=workers)
        assert status == 0, said
        return self.tables("alone")

    def tables(self, output="out"):
        """Returns {name: bytes} of the tables."""
        return {path.name: path.read_bytes() for path in (self.folder / output).glob("*.csv")}
