"""The package is typed, and its stubs say what there is."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest


CALLS = [
    ["mypy", "-p", "pyfreeplay"],
    # `__all__` and disjoint bases are PyO3's own, of no use to a reader of the stubs.
    ["mypy.stubtest", "pyfreeplay._native", "--ignore-missing-stub", "--ignore-disjoint-bases"],
]


@pytest.mark.parametrize("arguments", CALLS)
def test_mypy(arguments: list[str], repository: Path, tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    if arguments[0] == "mypy":
        arguments = [*arguments, "--config-file", str(repository / "python/pyproject.toml")]
    done = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
