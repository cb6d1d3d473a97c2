"""A machine built in Python, as the mechanism file that it stands for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ._errors import InputError
from ._native import Scenario

Point = Sequence[float]


class Mechanism:
    """Bodies, joints and drives, one call each; keys are those of docs/mechanisms.md.

    >>> import pyfreeplay as fp
    >>> crank = fp.Mechanism("crank", gravity=(0.0, -9.81))
    >>> _ = crank.ground(O=(0.0, 0.0))
    >>> _ = crank.body("arm", points={"O": (0.0, 0.0)}, mass=0.1, inertia=1e-4, center_of_mass=(0.05, 0.0))
    >>> _ = crank.joint("O", "revolute", ring="ground.O", journal="arm.O", clearance=1e-4)
    >>> crank
    <Mechanism 'crank': 1 body, 1 joint, 0 drives>
    >>> fp.check(crank).ok
    True
    """

    def __init__(self, name: str = "mechanism", *, gravity: Point | None = None, seed: int | None = None) -> None:
        self._table: dict[str, Any] = {"name": name}
        if seed is not None:
            self._table["seed"] = seed
        if gravity is not None:
            self._table["environment"] = {"gravity": list(gravity)}

    @classmethod
    def of(cls, scenario: Scenario) -> Mechanism:
        """The machine that a scenario stands for, template or not, to be changed and added to."""
        made = cls()
        made._table = scenario.expand().to_dict()
        return made

    def _add(self, section: str, keys: Mapping[str, Any]) -> Mechanism:
        self._table.setdefault(section, []).append({k: v for k, v in keys.items() if v is not None})
        return self

    def _named(self, section: str, name: str, keys: dict[str, Any]) -> Mechanism:
        if any(one.get("name") == name for one in self._table.get(section, [])):
            raise InputError(f"{section}: `{name}` is there already")
        return self._add(section, {"name": name, **keys})

    def ground(self, **points: Point) -> Mechanism:
        """Points of the ground (m)."""
        self._table.setdefault("ground", {}).setdefault("points", {}).update(points)
        return self

    def body(self, name: str, *, points: Mapping[str, Point], **keys: Any) -> Mechanism:
        """A body: points (m, in its own axes), and mass (kg), inertia (kg m²) and center_of_mass, or a shape; `start` is
        a guess of x, y (m) and angle (rad)."""
        return self._named("body", name, {"points": dict(points), **keys})

    def joint(self, name: str, kind: str, **keys: Any) -> Mechanism:
        """A joint: "revolute" (ring, journal, clearance, …), "prismatic" (base, slider, axis) or "fixed"."""
        return self._named("joint", name, {"kind": kind, **keys})

    def drive(self, joint: str, kind: str = "prescribed", **keys: Any) -> Mechanism:
        """A drive of a joint: "prescribed", "servo", "sampled" or "force"."""
        return self._add("drive", {"joint": joint, "kind": kind, **keys})

    def motion(self, kind: str, **keys: Any) -> Mechanism:
        """What moves: a `joint`, which may be said of several joints, a `body` or a `point`."""
        return self._add("motion", {"kind": kind, **keys})

    def spring(self, **keys: Any) -> Mechanism:
        """A spring between two points or in a joint."""
        return self._add("spring", keys)

    def stop(self, joint: str, **keys: Any) -> Mechanism:
        """A stop of a joint."""
        return self._add("stop", {"joint": joint, **keys})

    def output(self, **keys: Any) -> Mechanism:
        """What results are about: a `body` or a `point`."""
        return self._add("output", keys)

    def sensor(self, column: str, quantity: str, **keys: Any) -> Mechanism:
        """A sensor and its column in recordings."""
        return self._add("sensor", {"column": column, "quantity": quantity, **keys})

    def effect(self, kind: str, **keys: Any) -> Mechanism:
        """What acts on the machine beside what is declared; see `pyfreeplay.effects()`."""
        return self._add("effect", {"kind": kind, **keys})

    def set(self, section: str, **keys: Any) -> Mechanism:
        """Keys of a section that all joints, drives or runs share, such as `set("simulation", duration=0.2)`."""
        table = self._table.setdefault(section, {})
        if not isinstance(table, dict):
            raise InputError(f"{section}: is a list here, not one section")
        table.update(keys)
        return self

    def to_dict(self) -> dict[str, Any]:
        """The mechanism file as a dict."""
        table = dict(self._table)
        motions = table.get("motion")
        # One motion may be of a body or a point; several are of joints.
        if isinstance(motions, list) and len(motions) == 1:
            table["motion"] = motions[0]
        return table

    def scenario(self) -> Scenario:
        """The scenario of this machine; `ScenarioError` says what is wrong with it."""
        return Scenario(self.to_dict())

    def to_toml(self) -> str:
        """The mechanism file, every default filled in."""
        return self.scenario().to_toml()

    def __repr__(self) -> str:
        parts = []
        for section, one, many in (("body", "body", "bodies"), ("joint", "joint", "joints"), ("drive", "drive", "drives")):
            count = len(self._table.get(section, []))
            parts.append(f"{count} {one if count == 1 else many}")
        return f"<Mechanism {self._table.get('name')!r}: {', '.join(parts)}>"
