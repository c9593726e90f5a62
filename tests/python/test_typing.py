"""What is offered is documented, and the stubs of the compiled module name all that it has."""
import ast
import inspect

import weir
from weir import _weir
from conftest import source


def test_everything_has_words():
    for name in weir.__all__:
        thing = getattr(weir, name)
        if callable(thing):
            assert inspect.getdoc(thing), name
    for cls in (weir.Simulation, weir.Field, weir.Edit):
        for name, thing in vars(cls).items():
            if name[0] != "_" and (callable(thing) or isinstance(thing, property)) and name not in ("x", "y", "z"):
                assert inspect.getdoc(thing), f"{cls.__name__}.{name}"


def test_stubs_name_all_there_is():
    stub = ast.parse((source / "python/weir/_weir.pyi").read_text())
    said = {}
    for node in stub.body:
        if isinstance(node, ast.ClassDef):
            said[node.name] = {n.name if isinstance(n, ast.FunctionDef) else n.target.id for n in node.body
                               if isinstance(n, (ast.FunctionDef, ast.AnnAssign))}
        elif isinstance(node, ast.FunctionDef):
            said[node.name] = set()
        elif isinstance(node, ast.AnnAssign):
            said[node.target.id] = set()
    assert set(said) == {n for n in dir(_weir) if not n.startswith("__")} | {"__version__"}
    for name in ("Core", "StepReport"):
        assert said[name] == {n for n in vars(getattr(_weir, name)) if not n.startswith("_")}, name
