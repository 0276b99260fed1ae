# SPDX-License-Identifier: BSD-3-Clause
"""The extension of the package kestrel, which CMake builds."""
import os
import re
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

PROJECT = Path(__file__).resolve().parent


class BuildByCMake(build_ext):
    """Builds the extension in build/pip, which stays: the next build is quick."""

    def build_extension(self, ext):
        folder = PROJECT / "build" / "pip"
        configure = ["cmake", "--preset", "release", "-B", folder, "-DKESTREL_BUILD_PYTHON=ON",
                     "-DKESTREL_BUILD_TESTS=OFF", "-DKESTREL_BUILD_BENCHMARKS=OFF",
                     f"-DPython_EXECUTABLE={sys.executable}"]
        subprocess.run(configure, check=True, cwd=PROJECT)
        build = ["cmake", "--build", folder, "--target", "_kestrel", "--parallel",
                 str(os.cpu_count())]
        subprocess.run(build, check=True)
        built = Path(self.get_ext_fullpath(ext.name))
        built.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(folder / "python" / "kestrel" / built.name), str(built))


version = re.search(r"project\(kestrel VERSION ([\d.]+)", (PROJECT / "CMakeLists.txt").read_text())
setup(version=version.group(1), ext_modules=[Extension("kestrel._kestrel", [])],
      cmdclass={"build_ext": BuildByCMake})
