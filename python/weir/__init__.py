"""Fluid simulation by real-time methods, with verified accuracy and measured cost.

    import weir
    sim = weir.Simulation("cases/dam_break_2d", set={"grid.cells": [64, 32]})
    sim.run_until(0.2)
    pressure = sim["pressure"]          # looks at the solver's own numbers: [x, y], [Pa]

Scenes are files, cases by their name, or dicts. Bad ones raise BadInput with the text that the command prints; a run that fails raises
NumericalFailure with its step, time and quantity.
"""
import os as _os

if "OMP_WAIT_POLICY" not in _os.environ:  # how long a thread spins for the next loop: libgomp reads it when it is loaded
    _os.environ.setdefault("GOMP_SPINCOUNT", "1000")

from ._weir import BadInput, NumericalFailure, OutputError, StepReport, __version__, build, set_threads, threads
from .fields import Edit, Field, StaleField
from .scene import to_toml
from .scene_plan import Difference, PlannedGrid, PlannedMethod, PlannedQuantity, PlannedValue, ScenePlan, ScenePlanChoice
from .simulation import Probe, Simulation
from .studies import Choice, Claim, CostPoint, Plan, Verdicts, case_folder, cost, plan, validate

__all__ = [
    "BadInput", "Choice", "Claim", "CostPoint", "Difference", "Edit", "Field", "NumericalFailure", "OutputError", "Plan", "PlannedGrid",
    "PlannedMethod", "PlannedQuantity", "PlannedValue", "Probe", "ScenePlan", "ScenePlanChoice", "Simulation", "StaleField", "StepReport", "Verdicts", "build", "case_folder", "cost", "plan", "set_threads", "threads", "to_toml", "validate",
]
