"""weir validate, cost and plan: what the commands print, as objects."""
import os
import pathlib
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from . import _weir


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


def plan(case: "str | os.PathLike", error: "str | float" = "", budget: "str | float" = "", frame: "str | float" = "",
         tables: "str | os.PathLike" = "") -> Plan:
    """Recommends a configuration for an error ("2%") and a budget of computing time per frame ("16ms"), from the tables of `weir cost`."""
    result = _weir.plan(str(case), _text(error), _text(budget), _text(frame), str(tables))
    return Plan(take=result["take"] and Choice(**result["take"]), nearest=[Choice(**c) for c in result["nearest"]], prices=result["prices"])


def case_folder(name: "str | os.PathLike") -> pathlib.Path:
    """The folder of a case by its name: its scene, its claims and the data that it is compared with."""
    return _weir.case_folder(str(name))


def _text(v):
    return v if isinstance(v, str) else repr(float(v))
