"""Laws and motions that are functions of Python."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pyfreeplay as fp
import pytest

FAST = {"simulation.duration": 0.015, "simulation.tolerance": 1e-3, "joints.clearance": 5e-5}


@pytest.fixture
def fast() -> fp.Scenario:
    return fp.Scenario().set(FAST)


def test_a_law_is_asked_and_obeyed(fast: fp.Scenario) -> None:
    """Hertz's law in Python against the one that is built in."""
    built_in = fast.set({"contact.law": "hertz", "contact.stiffness": 1e9})
    run = fp.run(fast, law=lambda depth, rate: 1e9 * depth**1.5)
    theirs = fp.run(built_in)
    assert run.summary["peak_contact_force_N"] > 0 or len(run) > 0
    # The powers may differ in the last digit, and steps are told by other estimates: alike, until chaos has its way.
    for name in ("x", "ecc_A1", "force_A1"):
        scale = np.abs(theirs[name]).max()
        assert np.abs(run[name] - theirs[name])[:8].max() <= 1e-3 * scale, name


def test_laws_may_differ_by_joint(fast: fp.Scenario) -> None:
    asked: list[float] = []

    def soft(depth: float, rate: float) -> float:
        asked.append(depth)
        return 1e8 * depth**1.5

    names = json.loads(json.dumps([j["joint"] for j in fp.run(fast).summary["joints"]]))
    fp.run(fast, law={names[0]: soft})
    assert asked and min(asked) > 0


def boom(depth: float, rate: float) -> float:
    raise ZeroDivisionError("mine")


@pytest.mark.parametrize(
    "law, exception, message",
    [
        (boom, ZeroDivisionError, "mine"),
        (lambda depth, rate: "strong", TypeError, r"law of joint \w\d at penetration .* returned 'strong'; expected"),
        (lambda depth, rate: None, TypeError, "returned None"),
        (lambda depth, rate: True, TypeError, "returned True"),
        (lambda depth, rate: np.zeros(2), TypeError, "returned array"),
        (lambda depth, rate: math.nan, ValueError, "returned NaN; expected a finite force in N"),
        (lambda depth: depth, TypeError, "positional argument"),
        (3.0, TypeError, "law of joint A1: a `float` cannot be called"),
        ({"Z9": boom}, ValueError, "'Z9' is no joint with clearance under a law; there are: A1, A2"),
        ({"A1": 1}, TypeError, "law of joint A1: a `int` cannot be called"),
    ],
)
def test_laws_that_raise_or_return_nonsense(fast: fp.Scenario, law: Any, exception: Any, message: str) -> None:
    for call in (fp.run, fp.evaluate):
        with pytest.raises(exception, match=message):
            call(fast, law=law)  # type: ignore[operator]


def test_a_machine_without_clearance_takes_no_law(fast: fp.Scenario) -> None:
    with pytest.raises(ValueError, match="no joint with clearance under a law"):
        fp.run(fast.set("contact.law", "ideal"), law=boom)


def test_a_motion_is_followed() -> None:
    machine = fp.Scenario().set({"simulation.duration": 0.1, "contact.law": "ideal"})

    def eight(t: float) -> tuple[float, float, float]:
        return 0.03 * math.sin(9 * t), 0.03 * math.sin(18 * t), 0.5

    run = fp.run(machine.with_motion(eight))
    asked = np.array([eight(t) for t in run["t"]])
    assert np.abs(run["x"] - asked[:, 0]).max() < 1e-8 and np.abs(run["y"] - asked[:, 1]).max() < 1e-8


def test_a_motion_of_a_joint_is_followed() -> None:
    machine = fp.Scenario({"mechanism": {"kind": "four-bar"}, "simulation": {"duration": 0.1}})
    machine = machine.set("contact.law", "ideal")
    run = fp.run(machine.with_motion(lambda t: 0.3 + 9 * t * t, joint="O"))
    assert np.abs(run["q_O" if "q_O" in run.columns else "qO"] - (0.3 + 9 * run["t"] ** 2)).max() < 1e-8


@pytest.mark.parametrize(
    "motion, exception, message",
    [
        (lambda t: (0.0, 0.0), TypeError, r"motion at t = 0.0 s: returned \(0.0, 0.0\); expected 3 numbers"),
        (lambda t: "abc", TypeError, "returned 'abc'"),
        (lambda t: (0.0, 0.0, math.nan), ValueError, "expected finite numbers"),
        (lambda t: np.zeros((3, 1)), TypeError, "expected 3 numbers"),
        (lambda t: 1 / 0, ZeroDivisionError, "division"),
        ("circle", TypeError, "a `str` cannot be called"),
    ],
)
def test_motions_that_raise_or_return_nonsense(motion: Any, exception: Any, message: str) -> None:
    with pytest.raises(exception, match=message):
        fp.Scenario().with_motion(motion)
    for keys, wrong in [({"interval": 0.0}, "interval"), ({"body": "a", "joint": "b"}, "moves one thing")]:
        with pytest.raises(fp.InputError, match=wrong):
            fp.Scenario().with_motion(lambda t: (0.0, 0.0, 0.5), **keys)
