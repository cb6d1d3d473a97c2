"""What tests share: the program whose results the package must repeat, and small machines."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pyfreeplay as fp
import pytest

REPOSITORY = Path(__file__).resolve().parents[2]


def _binary() -> str | None:
    target = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
    for name in (os.environ.get("FREEPLAY_BIN"), str(target / "release" / "freeplay"), "freeplay"):
        found = name and shutil.which(name)
        if found:
            return found
    return None


@pytest.fixture(scope="session")
def binary() -> str:
    """The program; `cargo build --release` makes it, and FREEPLAY_BIN says where it is."""
    found = _binary()
    if found is None:
        pytest.skip("no freeplay to compare with: cargo build --release")
    return found


@pytest.fixture
def freeplay(binary: str, tmp_path: Path) -> Any:
    """Runs the program with arguments as a line; it must end well."""

    def call(line: str) -> str:
        done = subprocess.run([binary, *line.split()], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return call


SHORT = {"simulation.duration": 0.02, "simulation.tolerance": 1e-4}
"""A rattle has begun, and it takes some milliseconds."""


@pytest.fixture
def short() -> fp.Scenario:
    return fp.Scenario().set(SHORT)


@pytest.fixture
def repository() -> Path:
    return REPOSITORY
