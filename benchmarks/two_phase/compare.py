#!/usr/bin/env python3
"""compare.py [--weir PROGRAM] [--only WORD] [--coarse]: weir's two_phase beside Gerris and OpenFOAM's interFoam and interIsoFoam: errors against
published references, CPU time on one thread, steps and drift of the volume, as Markdown (results/two_phase_peers.md). Peers that are not
installed are left out with a message. In all about 10 minutes of one processor."""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

import gerris
import openfoam
import weir
from problems import Problem, Run, problems

explanation = """
Every program computes the same scene on the same cells. One code measures them, from the liquid fraction and the vertical velocity of the cells, at
times that the steps of all programs meet exactly. CPU is the time of the solver's process on one thread with its output: user time, and the process
clock of Gerris without the compilation of its input. Other work ran on the machine meanwhile: repeated times differ by up to 15%.

- `weir`: the scenes of `cases/` with other cells. The dam has more gas above: the domain is 12 by 4 bases.
- Gerris: settings of its own tests `rising` and `capwave`: height functions, density and viscosity of the fraction filtered once, gravity as the
  jump of hydrostatic pressure, its own CFL number, tolerance 1e-4 (wave: 1e-6). Its boxes are squares of 2^n cells, so all grids are. With
  gravity as a plain source the coarse wave is 2.8 instead of -7.1 off at 2 T, and the coarse dam's front 7.5 instead of 2.1.
- interFoam: schemes and solvers of the tutorial `laminar/damBreak`: MULES, compression 1, linearUpwind, implicit Euler, p_rgh to 1e-7. The Courant
  number is at most 0.25 and the step at most the capillary one (Brackbill et al. 1992). With viscosity it has a momentum predictor: the largest
  velocity of bubbles has a larger error without it. The Courant number of bubble 2 is 0.1: with 0.25 the largest velocity of interIsoFoam is 5%
  low on the finer grid. C-N: Crank-Nicolson 0.9 in place of Euler.
- interIsoFoam: isoAdvector, schemes and solvers of the tutorial `interIsoFoam/damBreak`, the same steps.
- The wave's step is at most 2.5 ms in all programs.
- The table of the dam break ranks neither grids nor programs below 5% (`cases/dam_break_martin_moyce/README.md`)."""
root = pathlib.Path(__file__).resolve().parents[2]
parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--weir", type=pathlib.Path, default=root / "build/release/weir")
parser.add_argument("--only", default="", help="cases and programs (case:program) whose names contain this word")
parser.add_argument("--coarse", action="store_true", help="the coarser grid only")
wanted = parser.parse_args()


def programs() -> dict:
    """Name of each installed program -> what runs a problem on cells in a folder."""
    found = {"weir": lambda p, cells, folder: weir.run(p, cells, folder, wanted.weir)}
    if gerris.missing():
        print(f"Gerris is not installed or incomplete (Debian: {gerris.packages}): left out", file=sys.stderr)
    else:
        found["Gerris"] = gerris.run
    if openfoam.missing():
        print(f"OpenFOAM is not installed (Debian: {openfoam.packages}): left out", file=sys.stderr)
    else:
        for name in openfoam.configurations:
            found[name] = lambda p, cells, folder, name=name: openfoam.run(p, cells, folder, name)
    return found


def row(p: Problem, cells: tuple[int, int], name: str, call) -> tuple[list[str], str]:
    """Columns of errors, and the line."""
    start = f"| {cells[0]} x {cells[1]} | {name} |"
    with tempfile.TemporaryDirectory() as folder:
        try:
            run: Run = call(p, cells, pathlib.Path(folder) / "run")
        except (RuntimeError, subprocess.CalledProcessError) as error:
            return [], f"{start} {error} |"
    errors = p.measure(run)
    drift = run.drift("bubble" in p.name)
    return list(errors), f"{start} {' | '.join(errors.values())} | {run.seconds:.1f} | {run.steps} | {drift:.0e} |"


def section(p: Problem, found: dict) -> None:
    print(f"\n## {p.name[0].upper()}{p.name[1:]}\n{p.references}\n", flush=True)
    begun = False
    for cells in p.grids[: 1 if wanted.coarse else None]:
        for name, call in found.items():
            if wanted.only not in f"{p.name}:{name}":
                continue
            columns, line = row(p, cells, name, call)
            if columns and not begun:
                print(f"| cells | program | {' | '.join(columns)} | CPU [s] | steps | volume drift |\n|{'---|' * (5 + len(columns))}")
                begun = True
            print(line, flush=True)


def main() -> None:
    found = programs()
    versions = [weir.version(wanted.weir)]
    versions += [peer.version() for peer, key in ((gerris, "Gerris"), (openfoam, "interFoam")) if key in found]
    processor = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text()).group(1)
    print("# Liquid and gas: `two_phase` and its peers")
    print(f"Written by `benchmarks/two_phase/compare.py`: {'; '.join(versions)}; {processor}.")
    print(explanation)
    for p in problems:
        if any(wanted.only in f"{p.name}:{name}" for name in found):
            section(p, found)


main()
