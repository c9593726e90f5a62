"""pip install --no-build-isolation . : the compiled half is built by CMake, as ./weir.sh python builds it."""
import pathlib
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

source = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        build = source / "build/release"
        subprocess.check_call(["cmake", "--preset", "release", "-DWEIR_PYTHON=ON", f"-DPython3_EXECUTABLE={sys.executable}"]
                              + ([] if (build / "build.ninja").exists() else ["-DWEIR_TESTS=OFF", "-DWEIR_BENCHMARKS=OFF"]), cwd=source)
        subprocess.check_call(["cmake", "--build", build, "--target", "weir_python"], cwd=source)
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        [built] = (build / "python/weir").glob("_weir.*.so")
        self.copy_file(str(built), str(target))


setup(ext_modules=[Extension("weir._weir", [])], cmdclass={"build_ext": CMakeBuild})
