"""The Python package by setuptools: CMake builds it as it builds all else, and the program with it."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path(__file__).resolve().parent


class ByCMake(build_ext):
    def build_extension(self, extension):
        target = Path(self.build_lib).resolve()
        build = SOURCE / "build" / "python-package"
        subprocess.run(
            ["cmake", "-S", SOURCE, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DKEELER_TESTS=OFF",
             "-DKEELER_PYTHON=ON", "-DKEELER_PYTHON_DIR=.", f"-DPython_EXECUTABLE={sys.executable}"],
            check=True,
        )
        subprocess.run(["cmake", "--build", build, "--target", "keeler", "keeler_python"], check=True)
        subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", target], check=True)
        (target / "keeler" / "bin").mkdir(exist_ok=True)
        shutil.copy2(build / "keeler", target / "keeler" / "bin" / "keeler")


setup(
    version=re.search(r"VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text().split("project(")[1]).group(1),
    packages=[],
    ext_modules=[Extension("keeler._core", [])],
    cmdclass={"build_ext": ByCMake},
)
