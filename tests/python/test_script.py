"""Programs that readers are shown: they run, and what they measure is what `weir validate` claims."""
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


def test_the_readmes_program(monkeypatch, capsys):
    monkeypatch.chdir(source)
    program = (source / "README.md").read_text().split("```python\n")[1].split("```")[0]
    exec(program, {})
    said = capsys.readouterr().out
    assert "pass" in said and "weir run " in said
