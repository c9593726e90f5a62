"""Runs a scene of cases/ with weir and reads its frames (VTK image data, appended raw, uncompressed)."""
import array
import json
import os
import pathlib
import re
import resource
import subprocess

from problems import Frame, Problem, Run, cases

name = "weir"


def arrays(path: pathlib.Path) -> dict[str, array.array]:
    """The arrays of a frame by name."""
    head, data = path.read_bytes().split(b'<AppendedData encoding="raw">', 1)
    data = data[data.index(b"_") + 1 :]
    found = {}
    for tag in re.findall(rb"<DataArray[^>]*>", head):
        key = dict(re.findall(r'(\w+)="([^"]*)"', tag.decode()))
        start = int(key["offset"])
        count = int.from_bytes(data[start : start + 4], "little")
        found[key["Name"]] = array.array("d", data[start + 4 : start + 4 + count])
    return found


def user_seconds() -> float:
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def run(p: Problem, cells: tuple[int, int], folder: pathlib.Path, program: pathlib.Path) -> Run:
    settings = p.settings + [f"grid.cells = {list(cells)}", f"grid.size = [{p.size[0]!r}, {p.size[1]!r}]", f"time.end = {p.end!r}",
                             f'output = {{ every = {p.every!r}, at = "exact", fields = ["fraction", "velocity"], compression = "none" }}']
    command = [program, "run", cases / p.case / "scene.toml", "--quiet", "--threads", "1", "--out", folder]
    for line in settings:
        key, value = line.split(" = ", 1)
        command += ["--set", f"{key}={value}"]
    before = user_seconds()
    subprocess.run(command, check=True, capture_output=True, text=True, env=os.environ | {"OMP_NUM_THREADS": "1"})
    seconds = user_seconds() - before
    frames = []
    for t, file in re.findall(r'timestep="([^"]*)".*?file="([^"]*)"', (folder / "grid.pvd").read_text()):
        fields = arrays(folder / file)
        velocity = fields["velocity"]
        width = len(velocity) // len(fields["fraction"])
        frames.append(Frame(float(t), list(fields["fraction"]), list(velocity[1::width])))
    steps = json.loads((folder / "run.json").read_text())["steps"]["count"]
    return Run(cells[0], p.size[0] / cells[0], frames, seconds, steps)


def version(program: pathlib.Path) -> str:
    return subprocess.run([program, "--version"], capture_output=True, text=True).stdout.splitlines()[0]
