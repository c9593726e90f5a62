"""weir.plan of a scene: the same numbers as `weir plan SCENE --of` writes."""
import json
import math
import subprocess

import pytest

import weir

sloshing = {
    "title": "Sloshing", "solver": "mac_water", "dim": 2,
    "grid": {"cells": [20, 12], "size": [1.0, 0.6]}, "time": {"end": 1.0}, "fluid": {"density": 1000.0},
    "liquid": [{"shape": "plane", "point": [0.5, 0.3], "normal": [0.1, 1.0]}],
    "effects": {"gravity": {"g": [0.0, -9.81]}},
    "probes": [{"name": "right", "kind": "gauge", "at": [0.98, 0.0], "every": 0.01}],
}


@pytest.fixture
def scene(tmp_path):
    file = tmp_path / "sloshing.toml"
    file.write_text(weir.to_toml(sloshing))
    return file


def test_a_plan_has_the_numbers_of_plan_json(executable, scene, tmp_path):
    asked = ["--of", "right.height.max", "--of", "kinetic_energy.mean@0.2..", "--error", "10%", "--with", "shallow_water,tallcell"]
    done = subprocess.run([executable, "plan", scene, *asked, "--out", tmp_path / "command"], text=True, stdout=subprocess.PIPE)
    said = json.loads((tmp_path / "command/plan.json").read_text())
    plan = weir.plan(scene, of=["right.height.max", "kinetic_energy.mean@0.2.."], error="10%",
                     with_=["shallow_water", "tallcell"],
                     out=tmp_path / "python")
    assert json.loads((tmp_path / "python/plan.json").read_text())["asked"] == said["asked"]
    assert (tmp_path / "python/plan.svg").exists()
    assert [m.method for m in plan.methods] == [m["method"] for m in said["methods"]] == ["mac_water", "shallow_water", "tallcell"]
    for method, m in zip(plan.methods, said["methods"]):
        assert [g.cells for g in method.grids] == [g["cells"] for g in m["grids"]] and len(method.grids) >= 3
        for grid, g in zip(method.grids, m["grids"]):
            assert [v.value for v in grid.values] == [v["value"] for v in g["values"]], "results do not depend on who runs them"
            assert [v.error_at_most for v in grid.values] == [math.nan if v["error_at_most"] is None else v["error_at_most"] for v in g["values"]]
        for quantity, q in zip(method.quantities, m["quantities"]):
            assert (quantity.band, quantity.convergence, quantity.refused) == (q["band"], q["convergence"], q["refused"])
    assert plan["mac_water"]["right.height.max"].unit == "m"
    assert plan["shallow_water"].apart.z > 1 and plan["shallow_water"].other_equations
    assert done.returncode == 0 and plan.take.command.startswith("weir run ")
    assert plan[plan.take.method].grids[plan.take.grid].values[0].error_at_most < 0.05
    assert str(plan).startswith("asked: right.height.max, to 10% of its range")


def test_kept_runs_answer_a_second_question(scene, tmp_path):
    seen = []
    weir.plan(scene, of="right.height.max", error="5%", out=tmp_path / "kept")
    runs = sorted(f.name for f in (tmp_path / "kept/runs").iterdir())
    plan = weir.plan(scene, of="right.height.max", error=0.01, budget=0.1, out=tmp_path / "kept", progress=seen.append)
    assert sorted(f.name for f in (tmp_path / "kept/runs").iterdir()) == runs and seen
    assert plan.budget == 0.1 and plan.take.seconds_per_frame <= 0.1


def test_a_dict_is_a_scene_with_a_folder(tmp_path):
    plan = weir.plan(sloshing, of="right.height.max", error="10%", set={"time.end": 0.2}, out=tmp_path / "dict")
    assert plan.take and str(tmp_path / "dict/scene.toml") in plan.take.command and "time.end=0.2" in plan.take.command
    with pytest.raises(weir.BadInput, match="a dict requires out"):
        weir.plan(sloshing, of="right.height.max", error="5%")


def test_nothing_is_kept_without_a_folder(scene, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    weir.plan(scene, of="right.height.max", error="5%", set={"time.end": 0.1})
    assert [f.name for f in tmp_path.iterdir()] == ["sloshing.toml"]


def test_progress_may_end_a_plan(scene):
    class Enough(Exception):
        pass

    def progress(text):
        raise Enough

    with pytest.raises(Enough):
        weir.plan(scene, of="right.height.max", error="5%", progress=progress)


def test_what_does_not_fit_is_refused(scene, tables):
    with pytest.raises(weir.BadInput, match="right.height, right.depth"):
        weir.plan(scene, of="left.height", error="5%")
    with pytest.raises(weir.BadInput, match="5 parsecs"):
        weir.plan(scene, of="right.height", error="5 parsecs")
    with pytest.raises(weir.BadInput, match="require of"):
        weir.plan("dam_break_martin_moyce", error="5%", with_="pbf")
    with pytest.raises(weir.BadInput, match="measured here"):
        weir.plan(scene, of="right.height", error="5%", tables=tables)
