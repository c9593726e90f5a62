"""weir validate, cost and plan from Python: the same numbers as the commands."""
import json
import subprocess

import pytest

import weir


def test_validate_is_what_the_command_says(executable, tmp_path):
    subprocess.run([executable, "validate", "hydrostatic_2d", "--out", tmp_path, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    verdicts = json.loads((tmp_path / "verdicts.json").read_text())
    result = weir.validate("hydrostatic_2d")
    assert result.passed and len(result.claims) == len(verdicts) > 2
    for claim, verdict in zip(result.claims, verdicts):
        assert (claim.measured, claim.passed, claim.why) == (verdict["measured"], verdict["pass"], verdict["why"])
    assert "hydrostatic_2d: Does water at rest" in repr(result)


def test_measured_is_what_a_claim_measured():
    claim = weir.validate("hydrostatic_2d", variants=["half-cell"])["pressure.linf_relative"][0]
    weir.set_threads(1)
    sim = weir.Simulation("hydrostatic_2d", set={"liquid[0].point": [0.5, 0.515625]}, measure="pressure.linf_relative", reference="hydrostatic")
    sim.run()
    weir.set_threads(0)
    assert sim.measured()["pressure.linf_relative"] == claim.measured and sim.measured()["ms_per_step"] > 0
    with pytest.raises(weir.BadInput, match="no metrics were requested"):
        weir.Simulation("hydrostatic_2d").measured()


def test_progress_is_told_and_may_raise():
    class Enough(Exception):
        pass

    seen = []

    def progress(text):
        seen.append(text)
        if len(seen) == 2:
            raise Enough

    with pytest.raises(Enough):
        weir.validate("hydrostatic_2d", progress=progress)
    assert len(seen) == 2


def test_plan_names_a_setting_and_its_command(tables):
    plan = weir.plan("dam_break_martin_moyce", error="5%", tables=tables)
    assert plan.take.error <= 0.05 and plan.take.command.startswith("weir run ") and plan.take.seconds > 0
    assert weir.plan("dam_break_martin_moyce", error=0.05, tables=tables).take.method == plan.take.method
    none = weir.plan("dam_break_martin_moyce", error=1e-9, budget="1us", tables=tables)
    assert none.take is None and none.nearest
    with pytest.raises(weir.BadInput, match="requires --error"):
        weir.plan("dam_break_martin_moyce", tables=tables)


def test_cost_measures_a_method():
    points = weir.cost("stokes_wave")
    assert points and all(p.failure is None for p in points) and all(p.ms_per_step > 0 for p in points)
    with pytest.raises(weir.BadInput, match="has no method"):
        weir.cost("dam_break_martin_moyce", methods=["mac-flop"])


def test_what_is_not_there():
    with pytest.raises(weir.BadInput, match="couete"):
        weir.validate("couete")
    with pytest.raises(weir.BadInput, match='has no variant "levle"; known: level, half-cell'):
        weir.validate("hydrostatic_2d", variants=["levle"])
    with pytest.raises(weir.BadInput, match="is none of"):
        weir.validate("couette", size="huge")
