"""Builds the Python package's module with CMake."""

import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        build = pathlib.Path(self.build_temp).resolve()
        options = [f"-DRELIEF_{name}=OFF" for name in (
            "BUILD_TESTS", "BUILD_APP", "BUILD_EXAMPLES", "BUILD_BENCH", "WITH_GL", "WITH_VIEWER")]
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja",
                        "-DCMAKE_BUILD_TYPE=Release", "-DRELIEF_WITH_PYTHON=ON", "-DRELIEF_LIBRARIES=static",
                        f"-DPython_EXECUTABLE={sys.executable}", *options], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "relief_python"], check=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(build / "python" / "relief" / target.name), str(target))


def version():
    text = (ROOT / "include" / "relief" / "base.h").read_text(encoding="utf-8")
    return ".".join(re.findall(r"#define RLF_VERSION_\w+ (\d+)", text))


setup(version=version(), ext_modules=[Extension("relief._relief", [])],
      cmdclass={"build_ext": CMakeBuild})
