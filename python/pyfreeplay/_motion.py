"""A motion as a function of time, sampled into a table."""

from __future__ import annotations

import atexit
import math
import shutil
from pathlib import Path
from tempfile import mkdtemp
from typing import Any, Callable

import numpy as np

from ._errors import InputError
from ._native import Scenario

MOST = 1_000_000
"""Samples at most: a table of 256 MB is the largest that is read."""

_folder: Path | None = None


def _file() -> Path:
    """A name in a folder of this process."""
    global _folder
    if _folder is None:
        _folder = Path(mkdtemp(prefix="pyfreeplay-motion-"))
        atexit.register(shutil.rmtree, _folder, ignore_errors=True)
    return _folder / f"motion-{len(list(_folder.iterdir())) + 1}.csv"


def sampled(
    scenario: Scenario,
    function: Callable[[float], Any],
    body: str | None,
    point: str | None,
    joint: str | None,
    interval: float,
    file: str | Path | None,
) -> Scenario:
    """The scenario with `motion` from a table: `function` at every `interval` (s), joined by a cubic spline."""
    if not callable(function):
        raise TypeError(f"motion: a `{type(function).__name__}` cannot be called; expected a function of time (s)")
    targets = {"body": body, "point": point, "joint": joint}
    named = {key: name for key, name in targets.items() if name is not None}
    if len(named) > 1:
        raise InputError(f"motion: moves one thing, not {' and '.join(named)}")
    duration = float(scenario["simulation.duration"])
    if not (math.isfinite(interval) and 0 < interval <= duration / 3):
        raise InputError(f"interval: is {interval} s; expected more than 0 and at most a third of {duration} s")
    count = math.ceil(duration / interval * (1 - 1e-9)) + 1
    if count > MOST:
        raise InputError(f"interval: asks for {count} samples; expected at most {MOST}")
    names = ["x", "y"] if point else [f"q_{joint}"] if joint else ["x", "y", "phi"]
    lines = ["t," + ",".join(names)]
    for k in range(count):
        t = min(k * interval, duration)
        lines.append(",".join(map(repr, [t, *_values(function(t), names, t)])))
    path = Path(file) if file is not None else _file()
    path.write_text("\n".join(lines) + "\n")
    return scenario.set("motion", {**named, "kind": "table", "file": str(path.resolve())})


def _values(value: Any, names: list[str], t: float) -> list[float]:
    """What a function returned at `t`, if it is what it should be."""
    expected = "a number" if len(names) == 1 else f"{len(names)} numbers ({', '.join(names)})"
    try:
        numbers = np.atleast_1d(np.asarray(value, dtype=float))
    except (TypeError, ValueError):
        numbers = None
    if numbers is None or isinstance(value, (str, bytes, bool)) or numbers.shape != (len(names),):
        raise TypeError(f"motion at t = {t} s: returned {value!r}; expected {expected}")
    if not np.isfinite(numbers).all():
        raise ValueError(f"motion at t = {t} s: returned {value!r}; expected finite numbers")
    return [float(number) for number in numbers]
