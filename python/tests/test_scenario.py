"""Scenarios: what they are made of, and what is said of what is wrong."""

from __future__ import annotations

import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pyfreeplay as fp
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

MINIMAL = {"mechanism": {"kind": "3rpr"}}


def test_text_file_and_dict_are_the_same(tmp_path: Path) -> None:
    text = '[mechanism]\nkind = "3rpr"\n[joints]\nclearance = 1e-4\n'
    (tmp_path / "m.toml").write_text(text)
    made = [
        fp.Scenario.from_toml(text),
        fp.Scenario(tmp_path / "m.toml"),
        fp.Scenario(str(tmp_path / "m.toml")),
        fp.Scenario({**MINIMAL, "joints": {"clearance": 1e-4}}),
        fp.Scenario(MINIMAL).set("joints.clearance", 1e-4),
    ]
    assert len({scenario.to_toml() for scenario in made}) == 1
    assert len(set(made)) == 1 and made[0] != fp.Scenario(MINIMAL)
    assert fp.Scenario(made[0].to_dict()) == made[0]
    assert fp.Scenario.from_toml(made[0].to_toml()) == made[0]


def test_values_are_set_and_read_by_path() -> None:
    scenario = fp.Scenario()
    widths = [1e-4, 2e-4, 1e-4, 1e-4, 1e-4, 1e-4]
    changed = scenario.set("joints.clearance", widths).set({"drive.mode": "servo", "seed": 7})
    assert changed["joints.clearance"] == widths and changed["drive.mode"] == "servo"
    assert scenario["drive.mode"] == "prescribed" and "joints.clearance" in scenario
    assert "joints.color" not in scenario
    with pytest.raises(KeyError, match="joints.color"):
        scenario["joints.color"]
    assert changed.set("environment.gravity", np.array([0.0, -9.81]))["environment.gravity"] == [0.0, -9.81]
    assert changed.set("joints.clearance", np.float32(0.5)  * 1e-3)["joints.clearance"] == pytest.approx(5e-4)


def test_what_is_set_again_replaces_what_was_set_before() -> None:
    machine = fp.Scenario().set("motion.radius", 0.04).set("motion.radius", 0.05)
    assert machine["motion.radius"] == 0.05
    payload = machine.set("effect", [{"kind": "payload", "mass_kg": 1.0}]).set("effect.0.mass_kg", 2.0)
    assert payload["effect.0.mass_kg"] == 2.0
    again = payload.set("effect", [{"kind": "payload", "mass_kg": 3.0}])
    assert again["effect.0.mass_kg"] == 3.0 and again["motion.radius"] == 0.05


def test_effects_and_joints_are_set_by_name() -> None:
    loaded = fp.Scenario().set("effect", [{"kind": "payload", "mass_kg": 0.5}])
    assert loaded["effect.0.mass_kg"] == 0.5
    described = fp.Scenario().expand()
    name = described["joint.0.name"]
    assert described.set(f"joint.{name}.clearance", 3e-4)[f"joint.{name}.clearance"] == 3e-4


def test_it_is_shown_in_a_line() -> None:
    assert repr(fp.Scenario().set("seed", 2)) == "<Scenario \"default\" from built-in default, 1 value set>"
    assert repr(fp.Scenario(MINIMAL)) == '<Scenario "default" from a dict>'


def test_files_beside_a_file_are_found_from_anywhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = "".join(f"{t / 10},0.{t:02},0.0,0.5\n" for t in range(8))
    (tmp_path / "m.csv").write_text("t,x,y,phi\n" + rows)
    (tmp_path / "m.toml").write_text(
        '[mechanism]\nkind = "3rpr"\n[motion]\nkind = "table"\nfile = "m.csv"\n[simulation]\nduration = 0.02\n'
    )
    monkeypatch.chdir(tmp_path)
    scenario = pickle.loads(pickle.dumps(fp.Scenario("m.toml")))
    monkeypatch.chdir("/")
    assert scenario == fp.Scenario(tmp_path / "m.toml") and fp.run(scenario).summary["steps"] > 0


def test_problems_have_file_line_and_key(tmp_path: Path) -> None:
    (tmp_path / "wrong.toml").write_text('[mechanism]\nkind = "3rpr"\n[joints]\nclearence = 1e-4\nfriction = -1\n')
    with pytest.raises(fp.ScenarioError) as caught:
        fp.Scenario(tmp_path / "wrong.toml")
    error = caught.value
    assert (error.file, error.line, error.key) == (str(tmp_path / "wrong.toml"), 4, "joints.clearence")
    assert "did you mean `clearance`?" in error.problems[0].help and isinstance(error, ValueError)
    again = pickle.loads(pickle.dumps(error))
    assert again.problems == error.problems and str(again) == str(error)
    with pytest.raises(fp.ScenarioError, match="missing.toml: cannot be read"):
        fp.Scenario(tmp_path / "missing.toml")
    with pytest.raises(fp.ScenarioError) as caught:
        fp.Scenario.from_toml("[mechanism]\nkind = 3rpr\n", name="mine")
    assert (caught.value.file, caught.value.line, caught.value.problems[0].column) == ("mine", 2, 8)


WRONG: list[tuple[Any, str]] = [
    ({**MINIMAL, "joints": {"clearence": 1e-4}}, "^dict: unknown key `joints.clearence`; did you mean `clearance`"),
    ({**MINIMAL, "joints": {"clearance": "wide"}}, "dict: joints.clearance"),
    ({**MINIMAL, "joints": {"clearance": math.nan}}, "dict: joints.clearance: is NaN; expected a finite number"),
    ({**MINIMAL, "joints": {"clearance": np.array([1e-4, np.nan])}}, "joints.clearance.1: is NaN"),
    ({**MINIMAL, "joints": {"clearance": np.full((2, 3), 1e-4)}}, "joints.clearance"),
    ({**MINIMAL, "joints": {"clearance": [1e-4] * 5}}, "joints.clearance"),
    ({**MINIMAL, "joints": {"clearance": np.array([1j])}}, "joints.clearance.0: is of type `complex`"),
    ({**MINIMAL, "joints": {"clearance": np.array(["a"])}}, "joints.clearance"),
    ({**MINIMAL, "joints": {"clearance": None}}, "joints.clearance: is of type `NoneType`"),
    ({**MINIMAL, "joints": {3: 1.0}}, "joints: the key 3 is no text"),
    ({**MINIMAL, "seed": 2**64}, "seed: is beyond the range of 64 bits"),
    ({**MINIMAL, "name": object()}, "name: is of type `object`"),
    ({**MINIMAL, "name": "a\x1bb"}, "name: holds the character U.001B"),
    ({}, "mechanism.kind: is missing"),
]


@pytest.mark.parametrize("source, message", WRONG)
def test_wrong_dicts_are_refused_by_name(source: Any, message: str) -> None:
    with pytest.raises(fp.InputError, match=message) as caught:
        fp.Scenario(source)
    assert "toml:" not in str(caught.value)


def test_what_is_no_scenario_at_all() -> None:
    for source in (3, [1, 2], object()):
        with pytest.raises(TypeError, match="a scenario is made of"):
            fp.Scenario(source)  # type: ignore[arg-type]
    endless: list[Any] = []
    endless.append(endless)
    with pytest.raises(fp.InputError, match="without end"):
        fp.Scenario({**MINIMAL, "name": endless})
    for arguments in [("a",), ({"a": 1}, 2)]:
        with pytest.raises(TypeError, match="a path and a value"):
            fp.Scenario().set(*arguments)
    with pytest.raises(fp.ScenarioError, match="--set joints.clearence") as caught:
        fp.Scenario().set("joints.clearence", 1)
    assert (caught.value.file, caught.value.line) == (None, None)


@given(
    clearance=st.floats(1e-7, 4e-3),
    friction=st.floats(0, 0.5),
    seed=st.integers(0, 2**63 - 1),
    name=st.text(st.characters(min_codepoint=32, max_codepoint=126), min_size=1, max_size=20),
)
@settings(max_examples=60, deadline=None)
def test_values_come_back_to_the_last_digit(clearance: float, friction: float, seed: int, name: str) -> None:
    values = {"joints.clearance": clearance, "joints.friction": friction, "seed": seed, "name": name}
    try:
        scenario = fp.Scenario().set(values)
    except fp.ScenarioError as error:
        assert error.problems[0].key == "name"
        return
    assert {path: scenario[path] for path in values} == values
    assert fp.Scenario(scenario.to_dict()) == scenario == pickle.loads(pickle.dumps(scenario))


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.binary(max_size=4),
    lambda children: st.lists(children, max_size=3) | st.dictionaries(st.text(max_size=8), children, max_size=3),
    max_leaves=8,
)
KEYS = st.sampled_from(["joints", "motion", "body", "joint", "simulation", "contact", "effect", "name", "x"])


@given(st.dictionaries(KEYS, JSON, max_size=4))
@settings(max_examples=200, deadline=None)
def test_any_dict_is_a_scenario_or_an_exception(source: dict[str, Any]) -> None:
    try:
        fp.Scenario({**MINIMAL, **source})
    except fp.InputError as error:
        assert str(error)


@given(st.text(max_size=30), JSON)
@settings(max_examples=200, deadline=None)
def test_anything_may_be_set_or_is_an_exception(path: str, value: Any) -> None:
    try:
        fp.Scenario().set(path, value)
    except (fp.InputError, TypeError) as error:
        assert str(error)
