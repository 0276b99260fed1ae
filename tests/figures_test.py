#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/figures on a page of its own."""

import re, shutil, subprocess, sys, tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent
PAGE = """Measured by `scripts/race`, checked: `ratio` within a factor of 1.5.

| who | ratio |
|---|---|
| peer | 1.00 |
"""
RACE = "printf '| who | ms | ratio |\\n|---|---|---|\\n| peer | 3 | 1.20 |\\n| we | 2 | 0.50 |\\n'\n"

with tempfile.TemporaryDirectory() as folder:
    root = Path(folder)
    shutil.copytree(SOURCE / "docs", root / "docs")
    (root / "scripts").mkdir()
    shutil.copy(SOURCE / "scripts/figures", root / "scripts")
    (root / "scripts/race").write_text(RACE)
    (root / "scripts/race").chmod(0o755)
    page, readme = root / "docs/figures.md", root / "README.md"
    readme.write_text("<!-- figures -->\n<!-- end -->\n")
    page.write_text(re.sub(r", checked: .* of [\d.]+(?=\.)", "", page.read_text()) + PAGE)
    figures = lambda *a: subprocess.run([sys.executable, root / "scripts/figures", *a], stderr=subprocess.PIPE, text=True)

    assert "its table is not that of" in figures("--check").stderr
    assert "has no command of rice" in figures("rice").stderr
    assert figures("race").returncode == 0
    assert page.read_text().endswith("| peer | 1.20 |\n| we | 0.50 |\n"), page.read_text()
    assert (SOURCE / "README.md").read_text().count(readme.read_text()) == 1, readme.read_text()
    assert figures("--check").returncode == 0
    page.write_text(page.read_text().replace("| we | 0.50 |", "| we | 0.80 |"))
    assert "we, 0.80, ratio: 0.80 is written, 0.50 was measured" in figures("--check").stderr
