"""Simulations from Python: scenes in, steps, fields, probes; what is refused, and that nothing crashes."""
import gc
import os
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import weir

dam = {
    "solver": "mac_water",
    "dim": 2,
    "grid": {"cells": [32, 16], "size": [1.0, 0.5]},
    "time": {"end": 0.2},
    "fluid": {"density": 1000.0},
    "liquid": [{"shape": "box", "min": [0.0, 0.0], "max": [0.25, 0.25]}],
    "effects": {"gravity": {"g": [0.0, -9.81]}},
    "output": {"every": 0.05},
    "probes": [{"name": "front", "kind": "front", "axis": "x"}, {"name": "level", "kind": "gauge", "at": [0.01, 0.0]}],
}


def changed(**keys):
    return {**dam, **keys}


def test_runs_to_the_end():
    sim = weir.Simulation(dam)
    assert (sim.time, sim.steps, sim.finished, sim.solver, sim.dim) == (0, 0, False, "mac_water", 2)
    reports = sim.run()
    assert sim.finished and sim.time == pytest.approx(0.2) and sim.steps == len(reports) > 3
    assert np.all(np.diff(reports["time"]) > 0) and reports["dt"].sum() == pytest.approx(0.2)
    assert np.all(reports["iterations"] > 0)


def test_run_until_is_exact_and_may_be_stopped():
    sim = weir.Simulation(dam)
    sim.run_until(0.03)
    assert sim.time == pytest.approx(0.03, abs=1e-12)
    seen = []
    sim.run_until(0.2, on_step=lambda s, report: seen.append(report.dt) or len(seen) == 2)
    assert len(seen) == 2 and sim.time < 0.2
    assert sim.run_until(sim.time).shape == (0,)


def test_frames_come_as_the_scene_says():
    exact = weir.Simulation(changed(output={"every": 0.05, "at": "exact"}))
    assert [round(sim.time, 9) for sim in exact.frames()] == [0, 0.05, 0.1, 0.15, 0.2]
    alone = weir.Simulation(changed(output={}))
    times = [0.0, *alone.run()["time"]]
    expected = [0.0] + [next(t for t in times if t >= k / 20 - 1e-12) for k in range(1, 5)]
    assert [sim.time for sim in weir.Simulation(dam).frames()] == expected  # the steps of a run without frames


def test_a_file_a_case_and_a_dict_are_the_same_scene(tmp_path):
    file = tmp_path / "scene.toml"
    file.write_text(weir.to_toml(dam))
    one, two = weir.Simulation(dam), weir.Simulation(file)
    one.run(), two.run()
    assert np.array_equal(one["level_set"], two["level_set"])
    case = weir.Simulation("dam_break_2d", set={"grid.cells": [32, 16], "time.end": 0.01})
    case.run()
    assert case["pressure"].shape == (32, 16)


def test_results_do_not_depend_on_threads():
    def level_set(count):
        weir.set_threads(count)
        sim = weir.Simulation(dam)
        sim.run()
        return sim["level_set"].copy()

    one, two = level_set(1), level_set(2)
    weir.set_threads(0)
    assert np.array_equal(one, two)


# --- fields
def test_fields_are_the_solvers_own_numbers():
    sim = weir.Simulation(dam)
    sim.step()
    p = sim["pressure"]
    a, b = np.asarray(p), np.asarray(p)
    assert a.shape == p.shape == (32, 16) and a.dtype == np.float64 and p.unit == "Pa"
    assert np.shares_memory(a, b) and not a.flags.owndata and not a.flags.writeable
    assert a.strides == (8, 8 * 32)  # x fastest
    with pytest.raises(ValueError):
        a[0, 0] = 1
    with pytest.raises(ValueError):
        np.asarray(p.copy(), dtype=float)  # a copy may be written ...
        a.setflags(write=True)  # ... the solver's numbers may not


def test_axes_are_those_of_space():
    sim = weir.Simulation(changed(grid={"cells": [32, 16], "size": [1.0, 0.5]}))
    phi = np.asarray(sim["level_set"])
    x, y = np.meshgrid(sim.centres("x"), sim.centres("y"), indexing="ij")
    inside = (x < 0.25) & (y < 0.25)
    assert np.array_equal(phi < 0, inside)


def test_vectors_and_faces():
    sim = weir.Simulation(dam)
    sim.run_until(0.05)
    velocity = sim["velocity"]
    assert velocity.components == 2 and len(velocity) == 2
    u = np.asarray(velocity.x)
    assert velocity.where == "face" and u.shape == (33, 16) and velocity.y.shape == (32, 17)
    assert velocity.cells().shape == (32, 16, 2) and np.array_equal(velocity.cells()[..., 0], (u[1:] + u[:-1]) / 2)
    with pytest.raises(ValueError, match="arrays of different shapes"):
        np.asarray(velocity)
    assert repr(velocity) == '<field "velocity" [m/s] face (33, 16) and (32, 17)>'
    assert np.array_equal(velocity[0], u) and np.max(np.abs(velocity.y)) > 0
    with pytest.raises(AttributeError, match='"velocity" has no component z'):
        velocity.z
    markers = sim["markers.position"]
    assert markers.where == "particle" and np.asarray(markers).shape == (markers.x.shape[0], 2)


def test_arithmetic():
    sim = weir.Simulation(dam)
    sim.step()
    p = sim["pressure"]
    assert np.array_equal(2 * p + 1, 2 * np.asarray(p) + 1) and np.max(p) > 0 and p[3, 4] == np.asarray(p)[3, 4]
    with pytest.raises(TypeError):
        np.add(np.asarray(p), 1, out=p)


def test_a_stale_field_raises():
    sim = weir.Simulation(dam)
    p = sim["pressure"]
    sim.step()
    with pytest.raises(weir.StaleField, match="stepped on; ask for it again"):
        np.asarray(p)
    with pytest.raises(weir.StaleField):
        p.shape
    u = sim["velocity"]
    sim.step()
    with pytest.raises(weir.StaleField):
        np.asarray(u.x)
    with pytest.raises(weir.StaleField):
        np.asarray(u[1])
    assert repr(p) == '<stale field "pressure">'
    assert sim["pressure"].shape == (32, 16)


def test_no_step_while_an_array_looks_on():
    sim = weir.Simulation(dam)
    row = np.asarray(sim["pressure"])[3]  # a slice keeps what it is a slice of
    with pytest.raises(BufferError, match="1 array still references the current fields"):
        sim.step()
    assert sim.steps == 0 and row.shape == (16,)
    kept = row.copy()
    del row
    sim.step()
    assert sim.steps == 1 and kept.shape == (16,)


def test_an_array_outlives_its_simulation():
    sim = weir.Simulation(changed(grid={"cells": [256, 128], "size": [1.0, 0.5]}))
    p = np.asarray(sim["level_set"])
    before = p.copy()
    del sim
    gc.collect()
    scrap = [np.random.rand(256, 128) for _ in range(20)]  # would land on what had been freed
    assert np.array_equal(p, before) and len(scrap) == 20


def test_particles_of_a_particle_solver():
    sim = weir.Simulation("dam_break_particles", set={"time.end": 0.01})
    sim.run()
    x = np.asarray(sim["position"])
    assert x.ndim == 2 and np.all(np.isfinite(x)) and x.shape[0] > 100


# --- probes, integrals, checkpoints, pictures
def test_probes_and_integrals():
    sim = weir.Simulation(dam)
    reports = sim.run()
    front = sim.probes["front"]
    assert list(sim.probes) == ["front", "level"] and front.times.shape == (len(reports) + 1,)
    assert front.values.shape == (len(front.times), 1) and front[0][-1] > front[0][0]
    name = front.columns[0]
    assert np.array_equal(front[name], front[0]) and np.array_equal(front[name.split(" [")[0]], front[0])
    with pytest.raises(KeyError, match='no column "depht"'):
        front["depht"]
    with pytest.raises(KeyError, match='no probe "bow"'):
        sim.probes["bow"]
    assert sim.integrals["volume"] == pytest.approx(0.0625, rel=0.05)


def test_a_checkpoint_goes_on_bit_for_bit(tmp_path):
    through = weir.Simulation(dam)
    through.run()
    first = weir.Simulation(dam)
    first.run_until(0.1)
    first.save(tmp_path / "half.checkpoint")
    second = weir.Simulation(dam)
    second.restore(tmp_path / "half.checkpoint")
    second.run()
    exact = weir.Simulation(dam)
    exact.run_until(0.1)
    exact.run()
    assert second.steps == exact.steps and np.array_equal(second["level_set"], exact["level_set"])
    assert through.time == second.time


def test_pictures_and_frames(tmp_path):
    sim = weir.Simulation(dam)
    sim.run_until(0.1)
    png = sim._repr_png_()
    assert png[:8] == b"\x89PNG\r\n\x1a\n" and len(png) > 1000
    sim.write_frame(tmp_path)
    sim.step()
    names = {os.path.basename(f) for f in sim.write_frame(tmp_path)}
    assert "grid.pvd" in names and (tmp_path / "grid.pvd").exists()


def test_frames_follow_the_output_table_of_the_scene(tmp_path):
    """As `weir run` writes them: only the named fields, in single precision, without compression, and the surface beside them."""
    scene = changed(output={"fields": ["pressure"], "precision": "single", "compression": "none", "surface": "level_set"})
    names = {os.path.basename(f) for f in weir.Simulation(scene).write_frame(tmp_path / "python")}
    assert names == {"grid.pvd", "markers.pvd", "liquid_surface.pvd"}
    text = (tmp_path / "python" / "frames" / "grid_000000.vti").read_bytes().split(b"<AppendedData")[0].decode()
    arrays = re.findall(r'<DataArray type="(\w+)" Name="(\w+)"', text)
    assert [a for a in arrays if a[1] != "TimeValue"] == [("Float32", "pressure")] and "compressor" not in text


def test_keys_change_while_it_runs():
    """On the moon from the start, and from half way on: as the scene would say it."""
    sim = weir.Simulation(dam)
    sim.set("effects.gravity.g", [0.0, -1.6])
    sim.run()
    moon = weir.Simulation(changed(effects={"gravity": {"g": [0.0, -1.6]}}))
    moon.run()
    assert np.array_equal(sim["level_set"], moon["level_set"])
    later, written = weir.Simulation(dam), weir.Simulation(changed(changes=[{"time": 0.1, "key": "effects.gravity.g", "value": [0.0, -1.6]}]))
    later.set("effects.gravity.g", [0.0, -1.6], at=0.1)
    later.run(), written.run()
    assert np.array_equal(later["level_set"], written["level_set"]) and not np.array_equal(later["level_set"], moon["level_set"])
    with pytest.raises(weir.BadInput, match="grid.cells"):
        sim.set("grid.cells", [3, 3])


# --- what is refused
def test_a_dict_is_refused_as_a_file_is(tmp_path):
    wrong = changed(solver="mac_water", grid={"cells": [32, -16], "size": [1.0, 0.5]}, time={"end": "soon"},
                    effects={"gravitation": {"g": [0.0, -9.81]}})
    file = tmp_path / "scene"
    file.write_text(weir.to_toml(wrong))
    said = []
    for scene in (wrong, file):
        with pytest.raises(weir.BadInput) as error:
            weir.Simulation(scene)
        said.append(str(error.value).replace(str(file), "scene"))
    assert said[0] == said[1]
    assert said[0].endswith("3 problems") or "\n3 problems" in said[0]
    assert 'unknown effect "gravitation"' in said[0] and isinstance(error.value, ValueError)


def test_what_is_no_scene():
    with pytest.raises(TypeError, match="a scene is a path"):
        weir.Simulation(3)
    with pytest.raises(TypeError, match="not complex"):
        weir.Simulation(changed(title=1j))
    with pytest.raises(weir.BadInput, match="dam_brake_2d"):
        weir.Simulation("dam_brake_2d")
    with pytest.raises(KeyError, match="shows no field"):
        weir.Simulation(dam)["presure"]
    with pytest.raises(weir.BadInput, match="grid.cels"):
        weir.Simulation(dam, set={"grid.cels": [3, 3]})


def test_a_numerical_failure_tells_its_step():
    """One sweep of conjugate gradients misses the tolerance, where the cases' default stops the run."""
    sim = weir.Simulation(dam, set={"scheme.poisson.method": "cg", "scheme.poisson.max_iterations": 1})
    with pytest.raises(weir.NumericalFailure, match="pressure") as error:
        sim.run()
    assert error.value.step >= 1 and error.value.quantity and error.value.time >= 0
    assert isinstance(error.value, ArithmeticError)


# --- threads, signals, price
def test_other_threads_run_while_it_steps():
    sim = weir.Simulation(changed(grid={"cells": [512, 256], "size": [1.0, 0.5]}))
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        sim.step()
        before = counted[0]
        sim.step()
        assert counted[0] > before
    finally:
        done.set()
        thread.join()


def test_two_threads_do_not_step_at_once():
    sim = weir.Simulation(changed(grid={"cells": [512, 256], "size": [1.0, 0.5]}))
    errors, steps = [], []

    def run():
        for _ in range(4):
            try:
                steps.append(sim.step())
            except RuntimeError as error:
                errors.append(str(error))

    threads = [threading.Thread(target=run) for _ in range(2)]
    [t.start() for t in threads], [t.join() for t in threads]
    assert sim.steps == len(steps) and all("another thread" in e for e in errors) and len(steps) + len(errors) == 8


def test_ctrl_c_ends_a_run():
    code = ("import weir\n"
            "sim = weir.Simulation('dam_break_2d', set={'time.end': 1e4})\n"
            "print('begun', flush=True)\n"
            "try:\n    sim.run()\nexcept KeyboardInterrupt:\n    print('interrupted at step', sim.steps)\n")
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "begun\n"
        time.sleep(0.5)
        child.send_signal(signal.SIGINT)
        out, _ = child.communicate(timeout=60)
    assert out.startswith("interrupted at step") and child.returncode == 0


def test_a_step_from_python_costs_little():
    """At most 20 microseconds more than a step of the library itself: of the same steps, called one by one and in one call. Of this
    process's own time: what others do on the machine is no overhead."""
    sim = weir.Simulation({"solver": "mac", "dim": 2, "grid": {"cells": [2, 2], "size": [1.0, 1.0]}, "time": {"end": 1e6, "dt": 1e-3}})
    count = 500

    def one_by_one():
        for _ in range(count):
            sim.step()

    def at_once():
        sim.step(count)

    more = min(seconds(one_by_one) for _ in range(20)) - min(seconds(at_once) for _ in range(20))
    assert more / count < 20e-6 and sim.steps == 40 * count


def seconds(f):
    start = time.process_time()
    f()
    return time.process_time() - start


# --- interactive forcing
drop = changed(grid={"cells": [32, 32], "size": [1.0, 1.0]}, liquid=[{"shape": "sphere", "centre": [0.5, 0.5], "radius": 0.2}], effects={}, probes=[])


def test_a_velocity_is_written_and_made_good():
    """The library's tests say what is made good; here it is the same field, in the shapes in which it is shown."""
    sim = weir.Simulation(drop, set={"scheme.reseed": False})
    assert sim.editable == ["velocity"]
    before = sim["markers.position"].x.copy()
    stale = sim["velocity"]
    with sim.edit("velocity") as u:
        assert u.x.shape == (33, 32) and u.y.shape == (32, 33) and u.x.flags.writeable
        u.x, u[1][...] = 1.0, 0.5
    with pytest.raises(weir.StaleField):
        stale.x.shape
    sim.step()
    assert np.mean(sim["markers.position"].x) - np.mean(before) == pytest.approx(sim.time, abs=1e-12)  # they change places in the array


def test_an_edit_is_all_or_nothing():
    sim = weir.Simulation("dam_break_particles", set={"time.end": 0.01})
    before = sim["velocity"].copy()
    with pytest.raises(ZeroDivisionError):
        with sim.edit("velocity") as u:
            u.x = 1 / 0
    with pytest.raises(weir.BadInput, match="not finite at 7"):
        with sim.edit("velocity") as u:
            u.x[7] = np.nan
    with pytest.raises(weir.BadInput, match="known: particles.position, particles.velocity"):
        with sim.edit("density"):
            pass
    with pytest.raises(BufferError):
        look = sim["velocity"].x[:3]
        with sim.edit("velocity") as u:
            u.x = 1
    del look
    assert np.array_equal(before, sim["velocity"])


def test_nothing_changes_inside_the_block_of_an_edit():
    """The end of the block would undo it."""
    sim = weir.Simulation("dam_break_particles", set={"time.end": 0.01})
    before = sim["velocity"].copy()
    for change in (lambda: sim.step(), lambda: sim.run(), lambda: sim.set("time.end", 0.02), lambda: sim.remove_particles([0]),
                   lambda: sim.edit("position").__enter__(), lambda: sim.edit("velocity").__enter__()):
        with pytest.raises(weir.BadInput, match='"particles.velocity" is being edited'):
            with sim.edit("velocity") as u:
                u.x = 1
                change()
    assert sim.steps == 0 and np.array_equal(before, sim["velocity"])
    late = sim.edit("velocity")
    sim.step()
    with pytest.raises(weir.StaleField):
        with late as u:
            u.x = 1
    with sim.edit("velocity") as u:
        u.x = 0.25
    assert np.all(np.array(sim["velocity"].x) == 0.25)


def test_smoke_is_written_as_an_array():
    sim = weir.Simulation({"solver": "mac", "dim": 2, "grid": {"cells": [8, 8], "size": [1.0, 1.0]}, "time": {"end": 1.0},
                           "initial": {"smoke": {"name": "ball", "centre": [0.5, 0.5], "radius": 10.0, "value": 0.25}}})
    with sim.edit("smoke") as smoke:
        smoke[2, 3] = 1.0
        assert np.max(smoke) == 1
    expected = np.full((8, 8), 0.25)
    expected[2, 3] = 1
    assert np.array_equal(sim["smoke"], expected)


def test_particles_come_and_go():
    sim = weir.Simulation("dam_break_particles", set={"time.end": 0.01})
    count = sim["id"].shape[0]
    sim.add_particles([[0.9, 0.9]] if sim.dim == 2 else [[0.9, 0.9, 0.1]])
    assert sim["id"].shape[0] == count + 1
    sim.remove_particles(np.asarray(sim["id"]) < 10)
    assert sim["id"].shape[0] == count - 9 and np.min(sim["id"]) == 10
    sim.remove_particles([0])
    sim.step()
    with pytest.raises(weir.BadInput, match="the domain is"):
        sim.add_particles(np.full((1, sim.dim), 99.0))
    with pytest.raises(ValueError, match="coordinates"):
        sim.add_particles([[0.5]])
    with pytest.raises(ValueError, match="one entry a particle"):
        sim.remove_particles(np.array([True, False]))


def test_observers_look_on_and_steer():
    sim = weir.Simulation(dam, set={"output.at": "exact"})
    frames, steps = [], []
    sim.observe(lambda s, report: frames.append(round(s.time, 9)))
    sim.observe(lambda s, report: steps.append((s.steps, report.dt)), every=2)
    sim.observe(lambda s, report: s.set("effects.gravity.g", [0.0, -1.6]) if s.steps == 4 else None, every=4)
    sim.step(5)
    sim.run()
    assert frames == [0.05, 0.1, 0.15, 0.2] and [n for n, _ in steps] == list(range(2, sim.steps + 1, 2))
    assert "g = [0, -1.6]" in sim.scene
    with pytest.raises(ValueError, match="number of steps"):
        sim.observe(print, every=0)
    late = weir.Simulation(dam)

    def enough(s, report):
        raise StopIteration

    late.observe(enough, every=3)
    with pytest.raises(StopIteration):
        late.run_until(0.1)
    assert late.steps == 3


@pytest.mark.parametrize("t", [float("nan"), float("inf"), float("-inf")])
def test_run_until_takes_finite_times(t):
    sim = weir.Simulation(dam)
    with pytest.raises(weir.BadInput, match="finite time"):
        sim.run_until(t)
    assert sim.steps == 0
