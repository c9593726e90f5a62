"""Writes a problem as a case of OpenFOAM's interFoam (compression of the interface, MULES) or interIsoFoam (isoAdvector, Roenby et al. 2016), runs
it and reads its fields. Schemes and solvers are those of the tutorials interFoam/laminar/damBreak and interIsoFoam/damBreak of that version."""
import array
import math
import os
import pathlib
import re
import shutil
import subprocess

from problems import Frame, Problem, Run
from weir import user_seconds

packages = "openfoam"
crank_nicolson = ", C-N"  # ends the name of a solver that runs with Crank-Nicolson 0.9 in place of the tutorials' implicit Euler
configurations = ["interFoam", "interFoam" + crank_nicolson, "interIsoFoam"]
environment = os.environ | {"WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam"), "OMP_NUM_THREADS": "1"}
fractions = {
    "interFoam": "nAlphaCorr 2; nAlphaSubCycles 1; cAlpha 1; MULESCorr yes; nLimiterIter 5; solver smoothSolver; smoother symGaussSeidel; "
                 "tolerance 1e-8; relTol 0;",
    "interIsoFoam": "isoFaceTol 1e-6; surfCellTol 1e-6; nAlphaBounds 3; snapTol 1e-12; clip true; nAlphaSubCycles 1; cAlpha 1;",
}
pressures = {"interFoam": "solver PCG; preconditioner DIC;", "interIsoFoam": "solver GAMG; smoother DICGaussSeidel;"}
convections = {"interFoam": "linearUpwind grad(U)", "interIsoFoam": "limitedLinearV 1"}
compressions = {"interFoam": "linear", "interIsoFoam": "interfaceCompression"}


def missing() -> bool:
    return not shutil.which("interFoam") or not shutil.which("blockMesh")


def version() -> str:
    text = subprocess.run(["interFoam", "-help"], capture_output=True, text=True, env=environment).stdout
    return "OpenFOAM v" + re.search(r"OpenFOAM\D*(\d+)", text).group(1)


def mesh(p: Problem, cells: tuple[int, int]) -> str:
    (w, h), deep = p.size, 1
    corners = " ".join(f"({x} {y} {z})" for z in (0, deep) for x, y in ((0, 0), (w, 0), (w, h), (0, h)))
    left, right = "(0 4 7 3)", "(1 2 6 5)"
    sides = f"""left {{ type cyclic; neighbourPatch right; faces ({left}); }} right {{ type cyclic; neighbourPatch left; faces ({right}); }}""" \
        if p.periodic else f"sides {{ type wall; faces ({left} {right}); }}"
    return f"""vertices ({corners});
blocks (hex (0 1 2 3 4 5 6 7) ({cells[0]} {cells[1]} 1) simpleGrading (1 1 1));
boundary ({sides} ends {{ type wall; faces ((0 1 5 4) (3 7 6 2)); }} planes {{ type empty; faces ((0 3 2 1) (4 5 6 7)); }});"""


def field(p: Problem, dimensions: str, inside: str, sides: str, ends: str) -> str:
    side = "left { type cyclic; } right { type cyclic; }" if p.periodic else f"sides {{ {sides} }}"
    return f"dimensions [{dimensions}]; internalField {inside}; boundaryField {{ {side} ends {{ {ends} }} planes {{ type empty; }} }}"


def start(p: Problem, cells: tuple[int, int], samples: int = 16) -> list[float]:
    """Fractions at t = 0: the part of 16 x 16 points of the cell that is liquid."""
    liquid = compile(re.sub(r"\((.*) \? (.*) : (.*)\)", r"(\2 if \1 else \3)", p.liquid), "liquid", "eval")
    h, part = p.size[0] / cells[0], [(k + 0.5) / samples for k in range(samples)]
    names = {"cos": math.cos}
    count = lambda i, j: sum(eval(liquid, names, {"x": (i + a) * h, "y": (j + b) * h}) > 0 for b in part for a in part)
    return [count(i, j) / samples**2 for j in range(cells[1]) for i in range(cells[0])]


def write(p: Problem, cells: tuple[int, int], folder: pathlib.Path, configuration: str, f: list[float]) -> None:
    solver = configuration.removesuffix(crank_nicolson)
    ddt = "Euler" if solver == configuration else "CrankNicolson 0.9"
    h = p.size[0] / cells[0]
    capillary = math.sqrt(sum(p.density) * h**3 / (4 * math.pi * p.sigma)) if p.sigma else math.inf
    longest = min(capillary, p.max_dt, 1)
    friction = "yes" if p.viscosity[0] else "no"
    slip, wall = "type slip;", "type noSlip;" if p.no_slip_ends else "type slip;"
    flux = "type fixedFluxPressure; value uniform 0;"
    phase = [f"{{ transportModel Newtonian; nu {nu}; rho {rho}; }}" for nu, rho in zip(p.viscosity, p.density)]
    linear = pressures["interFoam"]
    files = {
        "system/controlDict": f"""application {solver}; startFrom startTime; startTime 0; stopAt endTime; endTime {p.end!r};
deltaT {min(longest, 1e-3)}; writeControl adjustable; writeInterval {p.every!r}; writeFormat binary; writePrecision 12;
timeFormat general; timePrecision 9; adjustTimeStep yes; maxCo {p.courant}; maxAlphaCo {p.courant}; maxDeltaT {longest};""",
        "system/blockMeshDict": mesh(p, cells),
        "system/fvSchemes": f"""ddtSchemes {{ default {ddt}; }} gradSchemes {{ default Gauss linear; }}
divSchemes {{ div(rhoPhi,U) Gauss {convections[solver]}; div(phi,alpha) Gauss vanLeer; div(phirb,alpha) Gauss {compressions[solver]};
div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear; }}
laplacianSchemes {{ default Gauss linear corrected; }} interpolationSchemes {{ default linear; }} snGradSchemes {{ default corrected; }}""",
        "system/fvSolution": f"""solvers {{ "alpha.water.*" {{ {fractions[solver]} }} "pcorr.*" {{ {linear} tolerance 1e-10; relTol 0; }}
p_rgh {{ {pressures[solver]} tolerance 1e-7; relTol 0.05; }} p_rghFinal {{ $p_rgh; relTol 0; }}
"U.*" {{ solver smoothSolver; smoother symGaussSeidel; tolerance 1e-6; relTol 0; }} }}
PIMPLE {{ momentumPredictor {friction}; nOuterCorrectors 1; nCorrectors 3; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0; }}""",
        "constant/transportProperties": f"phases (water air); water {phase[0]} air {phase[1]} sigma {p.sigma};",
        "constant/turbulenceProperties": "simulationType laminar;",
        "constant/g": f"dimensions [0 1 -2 0 0 0 0]; value (0 {-p.g} 0);",
        "0/U": field(p, "0 1 -1 0 0 0 0", "uniform (0 0 0)", slip, wall),
        "0/p_rgh": field(p, "1 -1 -2 0 0 0 0", "uniform 0", flux, flux),
        "0/alpha.water": field(p, "0 0 0 0 0 0 0", f"nonuniform List<scalar> {len(f)}({' '.join(map(repr, f))})", *["type zeroGradient;"] * 2),
    }
    kinds = {"0/U": "volVectorField", "0/p_rgh": "volScalarField", "0/alpha.water": "volScalarField", "constant/g": "uniformDimensionedVectorField"}
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        head = f"FoamFile {{ version 2.0; format ascii; class {kinds.get(path, 'dictionary')}; object {pathlib.Path(path).name}; }}\n"
        (folder / path).write_text(head + text + "\n")


def values(path: pathlib.Path, count: int) -> array.array:
    data = path.read_bytes()
    start = data.index(b"(", data.index(b"List<", data.index(b"internalField"))) + 1
    return array.array("d", data[start : start + 8 * count])


def run(p: Problem, cells: tuple[int, int], folder: pathlib.Path, configuration: str) -> Run:
    f, count = start(p, cells), cells[0] * cells[1]
    write(p, cells, folder, configuration, f)
    subprocess.run(["blockMesh"], cwd=folder, check=True, capture_output=True, env=environment)
    before = user_seconds()
    done = subprocess.run([configuration.removesuffix(crank_nicolson)], cwd=folder, capture_output=True, text=True, env=environment)
    seconds = user_seconds() - before
    (folder / "log").write_text(done.stdout + done.stderr)
    times = re.findall(r"^Time = (\S+)$", done.stdout, re.MULTILINE)
    if done.returncode:
        raise RuntimeError(f"stopped at t = {times[-1] if times else 0}")
    numbers = (path for path in folder.iterdir() if re.fullmatch(r"[0-9.e+-]+", path.name) and path.name != "0")
    folders = sorted(numbers, key=lambda path: float(path.name))
    frames = [Frame(0.0, f, [0.0] * count)]
    frames += [Frame(float(path.name), list(values(path / "alpha.water", count)), list(values(path / "U", 3 * count)[1::3])) for path in folders]
    return Run(cells[0], p.size[0] / cells[0], frames, seconds, len(times))
