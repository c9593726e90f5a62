"""The script of docs/example: it fits on a page, it runs, and what it measures is what `weir validate` claims."""
import os
import subprocess
import sys

import weir
from conftest import source


def test_dam_break_script(tmp_path):
    script = source / "docs/example/dam_break.py"
    code = script.read_text().split('"""', 2)[2]
    assert len([line for line in code.splitlines() if line.strip()]) <= 25
    picture = tmp_path / "fronts.png"
    said = subprocess.run([sys.executable, script, picture], check=True, text=True, stdout=subprocess.PIPE,
                          env={**os.environ, "MPLCONFIGDIR": str(tmp_path)}).stdout.split()
    errors = dict(zip(said[::2], map(float, said[1::2])))
    assert picture.read_bytes()[:4] == b"\x89PNG" and list(errors) == ["flip", "apic", "pic"]
    [claim] = weir.validate("dam_break_martin_moyce", variants=["mac-pic-front"])["front.mean_error"]
    assert claim.passed and claim.measured == errors["pic"]
