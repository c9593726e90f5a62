import os
import pathlib

import pytest

source = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture
def executable():
    """The command of the same build."""
    return os.environ.get("WEIR_EXECUTABLE", str(source / "build/release/weir"))


@pytest.fixture
def tables():
    """The published tables of what accuracy costs."""
    return source / "results/cost"
