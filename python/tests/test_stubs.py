# SPDX-License-Identifier: BSD-3-Clause
"""The types that mypy and editors see."""
import os
import subprocess
import sys
from pathlib import Path

import pytest

import kestrel

PROJECT = Path(__file__).resolve().parents[2]
STUB = PROJECT / "python" / "kestrel" / "_kestrel.pyi"


def test_the_stub_is_that_of_the_extension():
    environment = {**os.environ, "PYTHONPATH": str(Path(kestrel.__file__).parents[1])}
    printed = subprocess.run([sys.executable, PROJECT / "scripts" / "python-stubs"], check=True,
                             env=environment, capture_output=True, text=True).stdout
    assert printed == STUB.read_text(), "scripts/python-stubs says how to make it"


def test_what_programs_import_and_the_examples_have_types(tmp_path):
    pytest.importorskip("mypy")
    package = PROJECT / "python" / "kestrel"
    environment = {**os.environ, "MYPYPATH": str(PROJECT / "python")}
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir",
         tmp_path, package / "__init__.py", package / "tables.py", STUB,
         *(PROJECT / "examples/python").glob("*.py")],
        env=environment, capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stdout


def test_every_name_has_a_docstring():
    for name in dir(kestrel):
        if not name.startswith("_") and name != "tables":
            assert getattr(kestrel, name).__doc__, name
