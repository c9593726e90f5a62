"""A simulation: scene in, steps, fields and probes out."""
import collections.abc
import math
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from . import _weir, scene as _scene
from ._weir import StepReport
from .fields import Edit, Field

_reported = tuple(name for name, is_count in _weir.step_quantities)
_report_dtype = np.dtype([("step", np.int64), ("time", float)] + [(name, np.int64 if is_count else float) for name, is_count in _weir.step_quantities])


@dataclass(frozen=True)
class Probe:
    """What a probe has measured: row i of `values` was taken at `times[i]` [s] and has one entry a column. `positions` are those of the
    columns' samples where they have any [m]."""

    name: str
    kind: str
    columns: list
    times: np.ndarray
    values: np.ndarray
    positions: np.ndarray

    def __getitem__(self, column):
        """A column by its number, or by its name with or without the unit."""
        if isinstance(column, str):
            names = [name.split(" [")[0] for name in self.columns]
            if column not in self.columns and column not in names:
                raise KeyError(f'probe "{self.name}" has no column "{column}"; it has {", ".join(self.columns)}')
            column = self.columns.index(column) if column in self.columns else names.index(column)
        return self.values[:, column]


class _Probes(collections.abc.Mapping):
    def __init__(self, core):
        self._core = core

    def __getitem__(self, name):
        return Probe(name=name, **self._core.probe(name))

    def __iter__(self):
        return iter(self._core.probe_names())

    def __len__(self):
        return len(self._core.probe_names())


class Simulation:
    """A scene that runs.

    scene    a file, a folder with a scene.toml, the name of a case, or a dict of what a file would say
    set      changes of keys: {"grid.cells": [64, 32], "effects.gravity.g": [0, -1.6]}, as --set of the command makes them
    backend  of particles: "threads", "opencl", "reference", as --backend
    measure  metrics of the run, as claims name them, against `reference`; read them with measured()

    Raises BadInput with every mistake at its line. Steps let other threads of Python run; Ctrl-C ends a run between two steps.
    """

    def __init__(self, scene: "str | os.PathLike | dict", set: "dict | None" = None, backend: "str | None" = None,
                 measure: "str | list[str] | None" = None, reference: str = ""):
        changes = [(key, _scene.value(v)) for key, v in (set or {}).items()]
        if backend is not None:
            changes.append(("scheme.backend", _scene.value(backend)))
        if isinstance(scene, (str, os.PathLike)):
            self._core = _weir.Core.from_file(os.fspath(scene), changes)
        else:
            self._core = _weir.Core.from_text(_scene.to_toml(scene), "scene", changes)
        self._observers = []
        if measure:
            self._core.measure([measure] if isinstance(measure, str) else list(measure), reference)

    # --- time
    def step(self, count: int = 1) -> StepReport:
        """So many steps of the size that scene and solver want; the report of the last. Ctrl-C waits for all of them."""
        if count < 1:
            raise ValueError(f"{count} steps are none: at least 1")
        if not self._observers:
            return self._core.step(count)
        for _ in range(count):
            report = self._core.step(1)
            self._look_on(report)
        return report

    def observe(self, call: "Callable[[Simulation, StepReport], object]", every: "int | str" = "frame") -> None:
        """From here on call(sim, report) after each frame, or after every so many steps, however the simulation is driven. It may steer:
        set(), edit(). What it raises comes out of the call that stepped."""
        if every != "frame" and not (isinstance(every, int) and every >= 1):
            raise ValueError(f'every is "frame" or a number of steps, not {every!r}')
        self._observers.append((every, call))

    def _look_on(self, report):
        for every, call in list(self._observers):
            if self._core.at_frame if every == "frame" else self._core.steps % every == 0:
                call(self, report)

    def run_until(self, t: float, on_step: "Callable[[Simulation, StepReport], object] | None" = None,
                  on_frame: "Callable[[Simulation], object] | None" = None) -> np.ndarray:
        """Steps until time t [s] is reached exactly, for which the last one or two are shortened. on_step(sim, report) is called after
        every step, on_frame(sim) at frames: True ends the run there. Returns the reports as a structured array (step, time, dt, cfl,
        iterations, ...)."""
        core, rows = self._core, []
        if not math.isfinite(t):
            raise _weir.BadInput(f"run_until({t}): a run goes on until a finite time [s]")
        while not core.reached(t):
            report = core.step_until(t)
            if self._observers:
                self._look_on(report)
            rows.append((core.steps, core.time) + tuple(getattr(report, name) for name in _reported))
            stop = on_step(self, report) if on_step else False
            stop = (on_frame(self) if on_frame and core.at_frame else False) or stop
            if stop is True:
                break
        return np.array(rows, dtype=_report_dtype)

    def run(self, on_step: "Callable[[Simulation, StepReport], object] | None" = None,
            on_frame: "Callable[[Simulation], object] | None" = None) -> np.ndarray:
        """Steps to the end of the scene; as run_until."""
        stopped = [False]

        def watch(sim, report):
            stopped[0] = sim.finished or (on_step is not None and on_step(sim, report) is True)
            return stopped[0]

        return self.run_until(self.end_time, watch, on_frame)

    def frames(self) -> "Iterator[Simulation]":
        """Steps from frame to frame: after the first step that reaches each multiple of output.every. At each, the first one too, the
        simulation itself."""
        yield self
        while not self.finished:
            self.step()
            while not (self._core.at_frame or self.finished):
                self.step()
            yield self

    def set(self, key: str, value: object, at: "float | None" = None) -> None:
        """Changes a key of the scene while it runs, now or at the time `at` [s], which a step then hits: sim.set("effects.gravity.g",
        [0, -1.6]). Keys that may change are marked so in the manual; others raise BadInput with the reason."""
        self._core.set(key, _scene.value(value), at)

    # --- interactive forcing
    @property
    def editable(self) -> "list[str]":
        """The fields that edit() takes."""
        return self._core.editable()

    def edit(self, name: str) -> Edit:
        """A field to be written: `with sim.edit("velocity") as u: u.x[3, :] = 1`. What is in the arrays at the end of the block takes the
        field's place, all of it or nothing, and the solver makes good what every step leaves behind: a velocity on a grid comes out free
        of divergence and at rest at walls. BadInput where a value is not finite or cannot be."""
        return Edit(self._core, self[name])

    def add_particles(self, position: "npt.ArrayLike", velocity: "npt.ArrayLike" = 0.0, set: "str | None" = None) -> None:
        """New particles at places [m], a row each, with a velocity [m/s], of each or of all. Markers bring liquid with them."""
        position = np.atleast_2d(np.asarray(position, float))
        if position.shape[1] != self.dim:
            raise ValueError(f"a place has {self.dim} coordinates, not {position.shape[1]}")
        self._core.add_particles(set or self._particles(), position, np.broadcast_to(np.asarray(velocity, float), position.shape))

    def remove_particles(self, which: "npt.ArrayLike", set: "str | None" = None) -> None:
        """Takes out particles: a mask over all of them, or their places in the arrays."""
        which = np.asarray(which)
        if which.dtype == bool and which.shape != self[(set or self._particles()) + ".position"].x.shape:
            raise ValueError("a mask has one entry a particle")
        which = np.flatnonzero(which) if which.dtype == bool else which.ravel()
        if which.size and which.min() < 0:
            raise IndexError("places of particles count from 0")
        self._core.remove_particles(set or self._particles(), [int(i) for i in which])

    def _particles(self):
        for field in self._core.fields():
            if field[1] == "position" and field[0] in ("particles", "markers"):
                return field[0]
        raise _weir.BadInput(f'solver "{self.solver}" has no particles that come and go')

    time = property(lambda self: self._core.time, doc="Simulated time [s].")
    end_time = property(lambda self: self._core.end_time, doc="The scene's end [s].")
    steps = property(lambda self: self._core.steps, doc="Steps so far.")
    finished = property(lambda self: self._core.finished, doc="The scene's end is reached, or nothing changes any more.")
    next_dt = property(lambda self: self._core.next_dt, doc="Size of the step to come [s].")

    # --- what there is
    def __getitem__(self, name: str) -> Field:
        """A field by its name, or of a set of particles as "markers.position" where the name alone could be several."""
        matches = [f for f in self._core.fields() if name in (f[1], f"{f[0]}.{f[1]}" if f[0] else f[1])]
        if not matches:
            raise KeyError(f'solver "{self.solver}" shows no field "{name}" in this scene; it shows {", ".join(self.keys())}')
        set, own, unit, where, components = matches[0]
        return Field(self._core, set, own, unit, where, range(components))

    def __contains__(self, name):
        return any(name in (f[1], f"{f[0]}.{f[1]}" if f[0] else f[1]) for f in self._core.fields())

    def keys(self) -> "list[str]":
        """Names of the fields."""
        return [f"{f[0]}.{f[1]}" if f[0] else f[1] for f in self._core.fields()]

    @property
    def probes(self) -> "collections.abc.Mapping[str, Probe]":
        """What the scene's probes have measured, by name."""
        return _Probes(self._core)

    @property
    def integrals(self) -> "dict[str, float]":
        """Sums and extrema over the domain, by name."""
        return self._core.integrals()

    def measured(self) -> "dict[str, float]":
        """The metrics of the run as it stands, and what it cost: ms_per_step, seconds_per_second."""
        return self._core.measured()

    solver = property(lambda self: self._core.solver, doc="The solver's name.")
    scene = property(lambda self: self._core.scene, doc="The scene as it was understood, defaults filled in: TOML.")
    dim = property(lambda self: self._core.dim, doc="2 or 3.")
    warnings = property(lambda self: self._core.warnings, doc="What a user should know of the run so far.")
    threads = property(lambda self: self._core.threads, doc="Threads that a step takes.")
    nbytes = property(lambda self: self._core.bytes, doc="Memory that the solver holds [bytes].")

    def centres(self, axis: "int | str") -> np.ndarray:
        """Places of the cells' centres along an axis, 0 to 2 or "x" to "z" [m]."""
        axis = "xyz".index(axis) if isinstance(axis, str) else axis
        _, cells, origin, spacing = self._core.grid
        return origin[axis] + (np.arange(cells[axis]) + 0.5) * spacing[axis]

    # --- files and pictures
    def save(self, file: "str | os.PathLike") -> None:
        """A checkpoint, from which restore() and `weir run --restart` go on bit for bit."""
        self._core.save(os.fspath(file))

    def restore(self, file: "str | os.PathLike") -> None:
        """Goes on from a checkpoint of the same scene."""
        self._core.restore(os.fspath(file))

    def write_frame(self, folder: "str | os.PathLike") -> list:
        """Adds a frame in the scene's format, fields, precision and compression (its `output` table) to the series in a folder. The first
        frame begins new series. Returns their index files (grid.pvd, ...)."""
        return self._core.write_frame(os.fspath(folder))

    def picture(self, field: str = "", size: int = 900) -> bytes:
        """A picture of the moment as PNG bytes."""
        return self._core.picture(field, size)

    def _repr_png_(self):
        return self.picture(size=600)

    def __repr__(self):
        return f'<weir.Simulation {self.solver}, {self.dim}D, t = {self.time:.6g} s of {self.end_time:.6g} s, {self.steps} steps>'
