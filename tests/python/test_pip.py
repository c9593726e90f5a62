"""`pip install` of the tree brings a module that runs from wherever it was put."""
import os
import pathlib
import subprocess
import sys

import pytest
from conftest import source


def test_pip_installs_what_can_be_imported(tmp_path):
    if pathlib.Path(os.environ["WEIR_EXECUTABLE"]).parent != source / "build/release":
        pytest.skip("pip builds in build/release, and this is another build")
    alone = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    said = subprocess.run([sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--quiet", "--target", tmp_path / "at", source],
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=alone)
    assert said.returncode == 0, said.stdout
    program = ("import weir; s = weir.Simulation('dam_break_2d', set={'grid.cells': [32, 16], 'time.end': 0.01}); s.run(); "
               "print(weir.__file__, s['pressure'].shape)")
    ran = subprocess.run([sys.executable, "-c", program], text=True, stdout=subprocess.PIPE, check=True, cwd=tmp_path,
                         env={**alone, "PYTHONPATH": str(tmp_path / "at")})
    assert ran.stdout.split(maxsplit=1) == [str(tmp_path / "at/weir/__init__.py"), "(32, 16)\n"]
