"""The cases that weir's two_phase and its peers compute, and the measures of their fields. Every program is measured by the same code: from the
liquid fraction f and the vertical velocity v of the cells, at the same times.
Hysing et al. 2009 (rising bubble), Martin & Moyce 1952 (dam break), Prosperetti 1981 (standing wave of two fluids)."""
import csv
import dataclasses
import math
import pathlib
from collections.abc import Callable

cases = pathlib.Path(__file__).resolve().parents[2] / "cases"


@dataclasses.dataclass
class Problem:
    name: str
    case: str                       # the folder in cases/ whose scene weir runs
    size: tuple[float, float]       # of the domain [m]
    density: tuple[float, float]    # of liquid and gas [kg/m^3]
    viscosity: tuple[float, float]  # kinematic [m^2/s]
    sigma: float                    # [N/m]
    g: float                        # [m/s^2]
    end: float                      # [s]
    every: float                    # between measured times [s]
    liquid: str                     # positive in the liquid: an expression in x and y of Python and of C
    grids: list[tuple[int, int]]
    tolerance: float                # of Gerris' projections, as in its own test of this kind
    measure: Callable[["Run"], dict[str, str]]
    settings: list[str] = dataclasses.field(default_factory=list)  # of weir's scene
    max_dt: float = math.inf
    courant: float = 0.25           # of OpenFOAM
    no_slip_ends: bool = False
    periodic: bool = False
    on_grid_lines: bool = False     # the surface at the start: no cell is mixed
    references: str = ""            # what the columns of errors are


@dataclasses.dataclass
class Frame:
    t: float
    f: list[float]  # cell (i, j) at i + nx j
    v: list[float]


@dataclasses.dataclass
class Run:
    nx: int
    h: float
    frames: list[Frame]
    seconds: float
    steps: int

    def drift(self, of_gas: bool) -> float:
        """Largest change of the volume, over the volume at the start."""
        sums = [math.fsum(1 - f if of_gas else f for f in frame.f) for frame in self.frames]
        return max(abs(s / sums[0] - 1) for s in sums)


def gas_mean(run: Run, frame: Frame, of: str) -> float:
    """Mean of the height or of the vertical velocity over the gas."""
    values = frame.v if of == "v" else [(i // run.nx + 0.5) * run.h for i in range(len(frame.f))]
    return math.fsum((1 - f) * x for f, x in zip(frame.f, values)) / math.fsum(1 - f for f in frame.f)


def contour_length(f: list[float], nx: int, h: float) -> float:
    """Length of f = 1/2 on straight lines between the middles of cells. Of the circle at the start it is 0.5% too long with 32 cells per metre, and
    0.3% with 64: sharp fractions make waves of the size of cells."""
    length = 0.0
    for j in range(len(f) // nx - 1):
        for i in range(nx - 1):
            at = nx * j + i
            corners = [(0, 0, f[at]), (1, 0, f[at + 1]), (1, 1, f[at + nx + 1]), (0, 1, f[at + nx])]
            cuts = []
            for (xa, ya, a), (xb, yb, b) in zip(corners, corners[1:] + corners[:1]):
                if (a < 0.5) != (b < 0.5):
                    s = (0.5 - a) / (b - a)
                    cuts.append((xa + s * (xb - xa), ya + s * (yb - ya)))
            for p, q in zip(cuts[::2], cuts[1::2]):
                length += h * math.dist(p, q)
    return length


def circularity(run: Run, frame: Frame) -> float:
    area = run.h**2 * math.fsum(1 - f for f in frame.f)
    return 2 * math.sqrt(math.pi * area) / contour_length(frame.f, run.nx, run.h)


def at(ts: list[float], ys: list[float], t: float) -> float:
    """Linear between samples, constant outside."""
    if t <= ts[0]:
        return ys[0]
    for ta, tb, a, b in zip(ts, ts[1:], ys, ys[1:]):
        if t <= tb:
            return a + (b - a) * (t - ta) / (tb - ta)
    return ys[-1]


def percent(value: float, reference: float) -> str:
    return f"{100 * (value / reference - 1):+.2f}"


def highest(ts: list[float], ys: list[float], reach: int = 5) -> tuple[float, float]:
    """Time and value of the maximum: of the parabola that fits the samples within `reach` of the highest one by least squares."""
    k = min(max(max(range(len(ys)), key=ys.__getitem__), reach), len(ys) - 1 - reach)
    offsets = range(-reach, reach + 1)
    n, m2, m4 = len(offsets), sum(s**2 for s in offsets), sum(s**4 for s in offsets)
    y0, y1, y2 = (sum(s**power * ys[k + s] for s in offsets) for power in (0, 1, 2))
    bend = (n * y2 - m2 * y0) / (n * m4 - m2 * m2)
    slope, middle = y1 / m2, (y0 - bend * m2) / n
    s = -slope / (2 * bend) if bend else 0
    return ts[k] + s * (ts[k + 1] - ts[k]), middle + slope * s / 2


def bubble(run: Run, known: dict[str, float]) -> dict[str, str]:
    ts = [frame.t for frame in run.frames]
    t_max, v_max = highest(ts, [gas_mean(run, frame, "v") for frame in run.frames])
    last = run.frames[-1]
    found = {"y": gas_mean(run, last, "y"), "v": gas_mean(run, last, "v"), "v max": v_max, "t of v max": t_max}
    if "circularity" in known:
        found["circularity"] = min(circularity(run, frame) for frame in run.frames if frame.t > 1)
    return {f"{key} [%]": percent(found[key], reference) for key, reference in known.items()}


def table(name: str) -> list[tuple[float, float]]:
    lines = (cases / "dam_break_gas" / "data" / name).read_text().splitlines()
    return [(float(a), float(b)) for a, b in list(csv.reader(line for line in lines if line[0] != "#"))[1:]]


base, gravity = 0.05715, 9.81  # of the column [m], [m/s^2]


def front(run: Run, frame: Frame) -> float:
    """Where the lowest row of cells has f = 1/2 for the last time."""
    row = frame.f[: run.nx] + [0.0]
    i = max((i for i in range(run.nx) if row[i] >= 0.5), default=0)
    return run.h * (i + 0.5 + (row[i] - 0.5) / max(row[i] - row[i + 1], 1e-12))


def dam(run: Run) -> dict[str, str]:
    """Mean errors over the rows of the tables up to tau = 4.2, with the delay of the gate that cases/dam_break_martin_moyce has."""
    ts = [frame.t for frame in run.frames]
    delay = 0.175 / math.sqrt(2 * gravity / base)
    x = [front(run, frame) / base for frame in run.frames]
    height = [run.h * math.fsum(frame.f[:: run.nx]) / (2 * base) for frame in run.frames]
    zs, hs = table("martin_moyce1952_n2eq2_front.csv"), table("martin_moyce1952_n2eq2_height.csv")[:-2]
    dz = [abs(at(ts, x, t / math.sqrt(2 * gravity / base) - delay) / z - 1) for t, z in zs]
    dh = [abs(at(ts, height, t / math.sqrt(gravity / base) - delay) - z) for t, z in hs]
    return {"front [%]": f"{100 * sum(dz) / len(dz):.2f}", "height [%]": f"{100 * sum(dh) / len(dh):.2f}"}


period = 2 * math.pi / math.sqrt(9.81 * 2 * math.pi * 699 / 701)  # two deep fluids, 700:1 [s]


def wave(run: Run) -> dict[str, str]:
    """Amplitude of the mode over that of the start, less Prosperetti's (values: cases/two_fluid_wave/README.md)."""
    a = []
    for frame in run.frames:
        columns = [run.h * math.fsum(frame.f[i :: run.nx]) for i in range(run.nx)]
        a.append(2 / run.nx * math.fsum(c * math.cos(2 * math.pi * (i + 0.5) / run.nx) for i, c in enumerate(columns)) / 0.01)
    ts = [frame.t for frame in run.frames]
    exact = {0.5: -0.971119, 1: 0.941497, 2: 0.886038}
    return {f"a/a0 at {n} T [%]": f"{100 * (at(ts, a, n * period) - value):+.2f}" for n, value in exact.items()}


problems = [
    Problem("rising bubble, case 1", "rising_bubble", (1, 2), (1000, 100), (0.01, 0.01), 24.5, 0.98, 3.0, 0.02,
            "(x - 0.5)*(x - 0.5) + (y - 0.5)*(y - 0.5) - 0.0625", [(32, 64), (64, 128)], 1e-4,
            lambda run: bubble(run, {"y": 1.0818, "v max": 0.2417, "t of v max": 0.9239, "circularity": 0.9013}), no_slip_ends=True,
            references="Hysing et al. 2009, third code: centre of the bubble at t = 3, largest mean velocity and its time, least circularity."),
    Problem("rising bubble, case 2", "rising_bubble", (1, 2), (1000, 1), (0.01, 0.1), 1.96, 0.98, 1.0, 0.02,
            "(x - 0.5)*(x - 0.5) + (y - 0.5)*(y - 0.5) - 0.0625", [(32, 64), (64, 128)], 1e-4,
            lambda run: bubble(run, {"y": 0.6873, "v": 0.2382, "v max": 0.2502, "t of v max": 0.7316}), courant=0.1, no_slip_ends=True,
            settings=["gas.density = 1.0", "gas.viscosity = 0.1", "effects.surface_tension.sigma = 1.96"],
            references="The same for test case 2: centre and velocity at t = 1, largest mean velocity and its time."),
    Problem("standing wave, 700:1", "two_fluid_wave", (1, 2), (700, 1), (0.001, 0.001), 0, 9.81, 2 * period, period / 40,
            "1 + 0.01*cos(6.283185307179586*x) - y", [(32, 64), (64, 128)], 1e-6, wave, max_dt=0.0025, periodic=True,
            references="Prosperetti 1981: amplitude over the first one, less the exact one, after 1/2, 1 and 2 periods."),
    Problem("dam break in gas, 1000:1", "dam_break_gas", (12 * base, 4 * base), (1000, 1), (0, 0), 0, 9.81, 0.315, 0.005,
            f"({base} - x < {2 * base} - y ? {base} - x : {2 * base} - y)", [(96, 32), (192, 64)], 1e-4, dam, on_grid_lines=True,
            references="Martin & Moyce 1952: mean error of the front, and of the height at the wall (to "
                       "t sqrt(g/a) = 4.2) in units of the first height."),
]
