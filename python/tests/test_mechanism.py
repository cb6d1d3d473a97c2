"""Machines built in Python are the files that describe them."""

from __future__ import annotations

from pathlib import Path

import pyfreeplay as fp
import pytest


def four_bar() -> fp.Mechanism:
    """The machine of docs/mechanisms.md."""
    m = fp.Mechanism("mine", gravity=(0.0, -9.81))
    m.ground(O=(0.0, 0.0), D=(0.2, 0.0))

    def bar(name: str, ends: str, length: float, start: tuple[float, float, float]) -> None:
        shape = {"kind": "bar", "from": ends[0], "to": ends[1], "diameter": 0.012, "density": 7850.0}
        m.body(name, points={ends[0]: (0.0, 0.0), ends[1]: (length, 0.0)}, shape=shape, start=start)

    bar("crank", "OA", 0.06, (0.0, 0.0, 0.8))
    bar("coupler", "AB", 0.18, (0.04, 0.04, 0.5))
    bar("rocker", "DB", 0.13, (0.2, 0.0, 1.6))
    m.joint("O", "revolute", ring="ground.O", journal="crank.O")
    m.joint("A", "revolute", ring="crank.A", journal="coupler.A", clearance=2e-4)
    m.joint("B", "revolute", ring="rocker.B", journal="coupler.B", clearance=2e-4)
    m.joint("D", "revolute", ring="ground.D", journal="rocker.D")
    return m.motion("line", joint="O", velocity=12.566)


def test_it_is_the_machine_of_the_docs(repository: Path) -> None:
    page = (repository / "docs/mechanisms.md").read_text()
    (block,) = (b.split("```")[0] for b in page.split("```toml\n")[1:] if b.startswith('name = "mine"'))
    assert four_bar().to_toml() == fp.Scenario.from_toml(block).to_toml()


def test_it_runs_and_its_parts_are_counted() -> None:
    m = four_bar().set("simulation", duration=0.02)
    assert repr(m) == "<Mechanism 'mine': 3 bodies, 4 joints, 0 drives>"
    assert fp.check(m).ok and "ecc_A" in fp.run(m).columns


def test_everything_else_that_a_file_may_say() -> None:
    m = four_bar().drive("O", "servo", stiffness=400.0, damping=1.5)
    m.spring(between=["rocker.B", "ground.O"], stiffness=10.0, damping=0.1)
    m.stop("D", range=[-3.0, 3.0], stiffness=1e3, damping=1.0)
    m.output(body="rocker").sensor("q_O", "position", of="O").effect("payload", body="rocker", mass_kg=0.1)
    scenario = m.scenario()
    assert scenario["drive.O.stiffness"] == 400.0 and scenario["effect.0.mass_kg"] == 0.1
    assert fp.check(scenario).ok


def test_templates_can_be_taken_apart() -> None:
    template = fp.Scenario({"mechanism": {"kind": "four-bar"}, "simulation": {"duration": 0.02}})
    m = fp.Mechanism.of(template)
    assert fp.run(m).summary["impacts"] == fp.run(template).summary["impacts"]


def test_mistakes_name_what_is_wrong() -> None:
    with pytest.raises(fp.ScenarioError, match="joint.4.rinng"):
        four_bar().joint("X", "revolute", rinng="ground.O", journal="crank.O").scenario()
    with pytest.raises(fp.InputError, match="body: `crank` is there already"):
        four_bar().body("crank", points={})
    with pytest.raises(fp.ScenarioError, match="points"):
        four_bar().body("y", points={"P": (1.0, 2.0, 3.0)}, mass=1.0, inertia=1.0).scenario()
    with pytest.raises(fp.InputError, match="motion: is a list here"):
        four_bar().set("motion", kind="line")
