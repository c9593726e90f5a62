"""weir validate, cost and plan: what the commands print, as objects."""
import os
import pathlib
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from . import _weir, scene as _scene
from .scene_plan import ScenePlan, scene_plan


@dataclass(frozen=True)
class Claim:
    """One judged claim: what was measured, the interval that it must lie in, and why."""

    variant: str
    metric: str
    criterion: str
    at: str
    measured: float
    low: float
    high: float
    passed: bool
    verdict: str  # "pass", "FAIL", or "open": an open target, not met for the reason in `not_reached`
    why: str
    not_reached: str
    note: str
    seconds: float


@dataclass(frozen=True)
class Verdicts:
    """What came out of a case."""

    case: str
    question: str
    blind_to: str
    source: str
    passed: bool
    seconds: float
    claims: list

    def __getitem__(self, metric):
        """The claims about a metric, "variant: metric" where variants differ."""
        return [c for c in self.claims if metric in (c.metric, f"{c.variant}: {c.metric}")]

    def __repr__(self):
        lines = [f"{self.case}: {self.question}"]
        for c in self.claims:
            name = f"{c.variant}: {c.metric}" if c.variant else c.metric
            lines.append(f"  {c.verdict:6} {name}{' at ' + c.at if c.at else ''} = {c.measured:.4g} in [{c.low:g}, {c.high:g}]")
        return "\n".join(lines)


@dataclass(frozen=True)
class CostPoint:
    """A method at one setting: its error and its price. error is nan where it failed; `failure` says why."""

    method: str
    setting: str
    error: float
    also: dict
    seconds_per_second: float
    ms_per_step: float
    spread: float
    repeats: int
    steps: int
    bytes: int
    threads: int
    failure: str
    on_front: bool


@dataclass(frozen=True)
class Choice:
    """A setting of a cost table, priced for this machine, and the command that runs it."""

    method: str
    setting: float
    error: float
    seconds: float
    ms_per_step: float
    threads: int
    command: str


@dataclass(frozen=True)
class Plan:
    """Which setting to take; None where none reaches what is asked, and then the nearest ones. `prices`: where milliseconds come from."""

    take: Choice
    nearest: list
    prices: str


def validate(case: "str | os.PathLike", size: str = "ci", variants: "Sequence[str]" = (), out: "str | os.PathLike | None" = None,
             progress: "Callable[[str], object] | None" = None) -> Verdicts:
    """Runs a case, or those of its variants that are named, and evaluates its claims. Frames go to the folder `out`; without one they are not kept. progress(text) before each run."""
    with tempfile.TemporaryDirectory() as scratch:
        result = _weir.validate(str(case), size, list(variants), str(out or scratch), progress)
    return Verdicts(**{**result, "claims": [Claim(**claim) for claim in result["claims"]]})


def cost(case: "str | os.PathLike", size: str = "ci", methods: "Sequence[str]" = (),
         progress: "Callable[[str], object] | None" = None) -> "list[CostPoint]":
    """Cost of accuracy: every method of a study (or those named) at every configuration, as CostPoints."""
    return [CostPoint(**point) for point in _weir.cost(str(case), size, list(methods), progress)]


def plan(case: "str | os.PathLike | dict", error: "str | float | Sequence" = "", budget: "str | float" = "", frame: "str | float" = "",
         tables: "str | os.PathLike" = "", *, of: "str | Sequence[str]" = (), with_: "str | Sequence[str]" = (), set: "dict | None" = None,
         out: "str | os.PathLike | None" = None, time_limit: "str | float" = "",
         progress: "Callable[[str], object] | None" = None) -> "Plan | ScenePlan":
    """Recommends a configuration for an error and a budget of computing time per frame ("16ms", or a number of seconds).

    Without `of`: of a case, from the tables of `weir cost`; error is "2%" or a number. Returns a Plan.
    With `of`: of any scene, as `weir plan SCENE --of` does. A ladder of grids is run on one thread. Returns a ScenePlan.

    case        a scene file, a case, or with `out` a dict, which is written to `out`/scene.toml
    of          quantities, such as "right.height.max"
    error       largest error: "5%" of the quantity's range or value, "2mm", or a number in its unit; one, or one per quantity
    budget      computing time per frame on one thread; infinite if empty
    frame       simulated time per frame; a sixtieth of a second if empty
    with_       further methods, such as ["tallcell", "shallow_water"]
    set         changes of keys, as of Simulation
    out         folder of plan.json, plan.svg, index.html and the kept runs; without it nothing is kept, and a second call runs everything again
    time_limit  computing time of one run at most; 120 s if empty
    progress    progress(text) before each run; what it raises ends the plan

    Raises BadInput where the scene is wrong, a quantity is unknown, another plan uses `out`, or an option does not fit.
    """
    quantities = [of] if isinstance(of, str) else list(of)
    if not quantities:
        if with_ or set or out is not None or time_limit:
            raise _weir.BadInput("weir.plan: with_, set, out and time_limit require of: a quantity of the scene")
        return _study_plan(case, error, budget, frame, tables)
    if str(tables):
        raise _weir.BadInput("weir.plan: tables belong to the study of a case; a quantity of a scene (of) is measured here")
    errors = list(error) if isinstance(error, (list, tuple)) else [error] if error != "" else []
    options = {"budget": _seconds(budget), "frame": _seconds(frame), "time_limit": _seconds(time_limit), "out": str(out or ""),
               "with": with_ if isinstance(with_, str) else ",".join(with_)}
    changes = [(key, _scene.value(v)) for key, v in (set or {}).items()]
    return scene_plan(*_weir.plan_scene(_file(case, out), quantities, [_text(e) for e in errors], options, changes, progress))


def _study_plan(case, error, budget, frame, tables):
    result = _weir.plan(str(case), _text(error), _seconds(budget), _seconds(frame), str(tables))
    return Plan(take=result["take"] and Choice(**result["take"]), nearest=[Choice(**c) for c in result["nearest"]], prices=result["prices"])


def _file(scene, out):
    """The file of a scene, which a command can name."""
    if isinstance(scene, (str, os.PathLike)):
        return os.fspath(scene)
    if not out:
        raise _weir.BadInput("weir.plan: a scene as a dict requires out, the folder into which it is written")
    file = pathlib.Path(out) / "scene.toml"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(_scene.to_toml(scene))
    return str(file)


def case_folder(name: "str | os.PathLike") -> pathlib.Path:
    """The folder of a case by its name: its scene, its claims and the data that it is compared with."""
    return _weir.case_folder(str(name))


def _text(v):
    return v if isinstance(v, str) else repr(float(v))


def _seconds(v):
    """A time as the command takes it: numbers are seconds."""
    return v if isinstance(v, str) else f"{float(v)!r}s"
