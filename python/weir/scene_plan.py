"""weir plan SCENE --of QUANTITY: plan.json as objects."""
import json
import math
from dataclasses import dataclass


@dataclass(frozen=True)
class PlannedValue:
    """A quantity on one grid: its value (of curves and pictures the root mean square) and the bound of its error, in the unit of the
    quantity; nan where they are not known. `unknown`: why there is no value."""

    value: float
    error_at_most: float
    unknown: str


@dataclass(frozen=True)
class PlannedGrid:
    """One run of a method: cells along each axis, their width [m], computing time on one thread [s], in all and per frame, and one value
    per quantity. `failure`: why its values are not known, or None."""

    cells: list
    h: float
    seconds: float
    steps: int
    seconds_per_frame: float
    values: list
    warnings: list
    failure: "str | None"


@dataclass(frozen=True)
class PlannedQuantity:
    """The uncertainty of a quantity on the finest grid of a method, in `unit`: the band, and its parts of the grids, the time step and the
    markers' seeds. nan: not known. `order` is the observed order of accuracy within its limits. `convergence`: "asymptotic", "converges
    faster than its order", "differences do not shrink", "oscillates" or "grids do not differ". `refused`: why nothing is recommended from
    it, or "". `not_refined`: keys of the model that no grid refines, and how much they move the value."""

    quantity: str
    unit: str
    band: float
    band_of_grid: float
    band_of_step: float
    band_of_seeds: float
    observed_order: float
    order: float
    convergence: str
    refused: str
    not_refined: list


@dataclass(frozen=True)
class Difference:
    """Distance of a method's series from that of the scene's own method (root mean square), the sum of both bands, and their ratio z. A
    method with z > 1 solves other equations."""

    series: str
    distance: float
    bands: float
    z: float


@dataclass(frozen=True)
class PlannedMethod:
    """One method of a plan, its grids from coarse to fine. `fails`: why it was not run, or "". `chaotic_after`: time [s] after which single
    values cannot be predicted, or None. `apart`: the difference from the scene's own method, or None. Times in seconds of computing."""

    method: str
    solver: str
    formal_order: float
    fails: str
    left_out: str
    seconds: float
    seconds_estimated: float
    other_equations: bool
    chaotic_after: "float | None"
    grids: list
    quantities: list
    apart: "Difference | None"

    def __getitem__(self, quantity):
        """The uncertainty of a quantity by its name."""
        for q in self.quantities:
            if q.quantity == quantity:
                return q
        raise KeyError(f'no quantity "{quantity}"; asked: {", ".join(q.quantity for q in self.quantities)}')


@dataclass(frozen=True)
class ScenePlanChoice:
    """The recommended method, the number of its grid, computing time per frame on one thread [s], and the command that runs it."""

    method: str
    grid: int
    seconds_per_frame: float
    command: str


@dataclass(frozen=True)
class ScenePlan:
    """What a ladder of grids says of a scene: methods (the scene's own first) and the recommended configuration, None where none meets the
    request. print(plan) prints the table of the command."""

    scene: str
    asked: list
    frame: float
    budget: float
    methods: list
    take: "ScenePlanChoice | None"
    text: str

    def __getitem__(self, method):
        """A method by its name."""
        for m in self.methods:
            if m.method == method:
                return m
        raise KeyError(f'no method "{method}"; planned: {", ".join(m.method for m in self.methods)}')

    def __str__(self):
        return self.text


def scene_plan(text: str, printed: str) -> ScenePlan:
    """A plan from the text of plan.json and from what the command prints."""
    read = json.loads(text)
    return ScenePlan(scene=read["scene"], asked=[a["quantity"] for a in read["asked"]], frame=read["frame"],
                     budget=math.inf if read["budget"] is None else read["budget"], methods=[_method(m) for m in read["methods"]],
                     take=read["take"] and ScenePlanChoice(**read["take"]), text=printed)


def _method(m):
    return PlannedMethod(**{**m, "grids": [_grid(g) for g in m["grids"]], "quantities": [_quantity(q) for q in m["quantities"]],
                            "apart": Difference(**_numbers(m["apart"], "z", none=math.inf)) if "apart" in m else None})


def _grid(g):
    return PlannedGrid(**{**g, "values": [PlannedValue(**_numbers(v, "value", "error_at_most")) for v in g["values"]]})


def _quantity(q):
    bands = {"band_of_grid": math.nan, "observed_order": math.nan, "order": math.nan, "convergence": ""}
    return PlannedQuantity(**_numbers({**bands, **q}, "band"))


def _numbers(row, *keys, none=math.nan):
    """JSON has no nan and no infinity: they are null."""
    return {key: none if key in keys and value is None else value for key, value in row.items()}
