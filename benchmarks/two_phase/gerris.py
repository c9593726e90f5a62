"""Writes a problem as a simulation file of Gerris (Popinet 2003, 2009), runs it and reads its cells. Settings are those of Gerris' own tests
(rising, capwave/air-water, capwave/gravity): height functions, density and viscosity of the fraction filtered once, gravity as the jump of
hydrostatic pressure at the interface."""
import math
import pathlib
import re
import shutil
import subprocess

from problems import Frame, Problem, Run

name = "Gerris"
packages = "gerris libgfs-dev pkg-config gcc"


def missing() -> bool:
    """Gerris compiles the expressions of its input: it needs its headers too."""
    found = shutil.which("gerris2D") and shutil.which("pkg-config")
    return not found or subprocess.run(["pkg-config", "--exists", "gerris2D"]).returncode != 0


def version() -> str:
    text = subprocess.run(["gerris2D", "--version"], capture_output=True, text=True)
    return "Gerris " + re.search(r"version (.*)", text.stdout + text.stderr).group(1)


def boxes(p: Problem, side: float) -> tuple[int, int, str]:
    """The domain as a row or a column of square boxes: how many, the edges between them, and their lines."""
    across, up = round(p.size[0] / side), round(p.size[1] / side)
    count, direction = max(across, up), "right" if across > 1 else "top"
    still = "{ BcDirichlet U 0 BcDirichlet V 0 }"
    ends = {0: f"bottom = Boundary {still}", count - 1: f"top = Boundary {still}"} if p.no_slip_ends else {}
    lines = [f"GfsBox {{ {ends.get(i, '')} }}" for i in range(count)]
    lines += [f"{i} {i + 1} {direction}" for i in range(1, count)]
    lines += [f"{i} {i} right" for i in range(1, count + 1)] if p.periodic else []
    return count, len(lines) - count, "\n".join(lines)


def simulation(p: Problem, cells: tuple[int, int]) -> str:
    """In units of the side of a box and seconds: the source by hydrostatic jump does not scale with Gerris' own unit of length.
    That source acts in mixed cells: a surface on grid lines is moved by 10 micrometres, or it would never move."""
    side = min(p.size)
    count, edges, graph = boxes(p, side)
    level = round(math.log2(min(cells)))
    mu = [nu / side**2 * rho for nu, rho in zip(p.viscosity, p.density)]
    liquid = re.sub(r"\b([xy])\b", rf"({side}*\1)", p.liquid + (" + 1e-5" if p.on_grid_lines else ""))
    solve = f"{{ tolerance = {p.tolerance} }}"
    tension = f"VariableCurvature K T\n  SourceTension T {p.sigma / side**3} K" if p.sigma else ""
    friction = f"SourceViscosity BETWEEN(T1, {mu[1]}, {mu[0]}) {solve}" if mu[0] else ""
    longest = f"dtmax = {p.max_dt}" if p.max_dt < math.inf else ""
    return f"""{count} {edges} GfsSimulation GfsBox GfsGEdge {{ x = 0.5 y = 0.5 }} {{
  Global {{
    #define BETWEEN(T, gas, liquid) (gas + CLAMP(T, 0, 1)*(liquid - gas))
  }}
  Time {{ end = {p.end * 1.00001} {longest} }}
  Refine {level}
  VariableTracerVOFHeight T
  VariableFiltered T1 T 1
  InitFraction T ({liquid})
  PhysicalParams {{ alpha = 1./BETWEEN(T1, {p.density[1]}., {p.density[0]}.) }}
  ApproxProjectionParams {solve}
  ProjectionParams {solve}
  {friction}
  {tension}
  VariablePosition Y T y
  SourceTension T {-p.g / side * (p.density[0] - p.density[1])} Y
  OutputTime {{ istep = 1 }} time.txt
  OutputSimulation {{ step = {p.every} }} frame-%.9g.txt {{ format = text variables = T,V precision = %.17g }}
}}
{graph}
"""


def frame(path: pathlib.Path, cells: tuple[int, int], side: float) -> Frame:
    per_side = min(cells)
    f, v = [0.0] * (cells[0] * cells[1]), [0.0] * (cells[0] * cells[1])
    for line in path.read_text().splitlines()[1:]:
        x, y, _, fraction, velocity = map(float, line.split()[:5])
        at = int(x * per_side) + cells[0] * int(y * per_side)
        f[at], v[at] = fraction, side * velocity
    return Frame(float(path.stem.removeprefix("frame-")), f, v)


def run(p: Problem, cells: tuple[int, int], folder: pathlib.Path) -> Run:
    folder.mkdir(parents=True)
    (folder / "input.gfs").write_text(simulation(p, cells))
    done = subprocess.run(["gerris2D", "input.gfs"], cwd=folder, capture_output=True, text=True)
    last = (folder / "time.txt").read_text().splitlines()[-1] if (folder / "time.txt").exists() else ""
    if done.returncode or not last:
        raise RuntimeError(f"stopped: {last or done.stderr.strip().splitlines()[-1]}")
    frames = sorted((frame(path, cells, min(p.size)) for path in folder.glob("frame-*.txt")), key=lambda frame: frame.t)
    seconds, steps = float(re.search(r"cpu: *(\S+)", last).group(1)), int(re.search(r"step: *(\d+)", last).group(1))
    return Run(cells[0], p.size[0] / cells[0], frames, seconds, steps)
