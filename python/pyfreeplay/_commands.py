"""The commands, each a function."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import Any, Callable, Union

from . import _native, _worker
from ._errors import InputError, RunError, Unfinished
from ._executor import spread
from ._mechanism import Mechanism
from ._native import Scenario
from ._results import Calibration, Check, Comparison, Place, Prediction, Run, SelfTest, Sweep

Source = Union[Scenario, Mechanism, Mapping[str, Any], str, Path, None]
"""A scenario, or what one is made of."""
Law = Union[Callable[[float, float], float], Mapping[str, Callable[[float, float], float]]]
"""Force (N) over penetration (m) and its rate (m/s), for all joints or by the name of the joint."""
Name = Union[str, Path]


def _scenario(source: Source) -> Scenario:
    if isinstance(source, Scenario):
        return source
    return source.scenario() if isinstance(source, Mechanism) else Scenario(source)


def _paths(given: Name | Iterable[Name], what: str) -> list[Path]:
    names = [given] if isinstance(given, (str, Path)) else list(given)
    if not all(isinstance(name, (str, Path)) for name in names):
        raise InputError(f"{what}: expected names of files, not {names!r}")
    return [Path(name) for name in names]


def run(scenario: Source = None, *, out: Name | None = None, force: bool = False, law: Law | None = None) -> Run:
    """Simulate a scenario.

    With `out`, everything that `freeplay run` writes goes into that folder, too. A `law` in Python is asked at every
    instant of contact: a run takes about six times as long as with one of `pyfreeplay.laws()`.

    Raises `ScenarioError` before anything is simulated, and `RunError` for a run that breaks down or does not balance;
    its `run` holds what was simulated until then.
    """
    made = _scenario(scenario)
    result = Run(_native.run(made, out, force, law), made)
    if result.halted or result.faults:
        raise RunError(result.halted or "; ".join(result.faults), result)
    return result


def evaluate(
    scenario: Source = None, figures: Iterable[str] | None = None, *, law: Law | None = None
) -> dict[str, float]:
    """Simulate for some figures of `summary.json` alone (by default all that a sweep's table has).

    It draws nothing and looks for no chaos: the fastest way to a number, for optimisers and samplers.
    """
    made = _scenario(scenario)
    # Only what every run has: figures without a value are refused where they are asked for by name.
    names = list(figures) if figures is not None else [n for n in _native.figures(made) if n != "step_error_m_s"]
    return dict(zip(names, map(_number, _native.evaluate(made, names, law))))


def _number(text: str) -> float:
    return int(text) if text.lstrip("-").isdigit() else float(text)


def check(scenario: Source = None) -> Check:
    """Everything that can be said without simulating."""
    return Check(_native.check(_scenario(scenario)))


def compare(
    scenario: Source = None,
    *,
    steps: Sequence[float] = (1e-4, 5e-5, 2e-5, 1e-5, 5e-6),
    starts: int = 8,
    laws: Iterable[str] | None = None,
    out: Name | None = None,
    force: bool = False,
) -> Comparison:
    """One motion under the contact law, under the physics engine's own contacts, and without clearance; or, with
    `laws`, under each of these laws (["all"] for every one)."""
    place = Place(out)
    named = None if laws is None else ",".join(laws)
    text = ",".join(repr(float(step)) for step in steps)
    return Comparison(_native.compare(_scenario(scenario), place.path, force, text, starts, named), place)


def _vary(vary: Mapping[str, Any] | Iterable[str]) -> list[str]:
    """What `--vary` takes: of a dict, texts with `..` are ranges, everything else lists of values."""
    if not isinstance(vary, Mapping):
        return [str(text) for text in vary]
    texts = []
    for path, values in vary.items():
        if not isinstance(values, str):
            values = _native.in_line(path, values)
        texts.append(f"{path}={values}")
    return texts


def sweep(
    scenario: Source,
    vary: Mapping[str, Any] | Iterable[str],
    *,
    out: Name | None = None,
    executor: Executor | None = None,
    shard: str = "1/1",
    threads: int | None = None,
    force: bool = False,
) -> Sweep:
    """Run many variants, one row of a table each.

    `vary` has values by path: a list or array, or a text as `freeplay sweep --vary` takes it, such as `"1e-5..1e-3:log:20"`.
    Runs are made by `threads` of this process (by default as many as a cluster's queue gave, or one for each core), or by the workers of an `executor` (`concurrent.futures`, Dask's
    `client.get_executor()`, or any other). Rows are kept in `out` as they are finished, and the same call goes on where
    it was; the table is the same whoever makes it, byte for byte.

    Raises `Unfinished` where workers are lost for good; what they made is kept.
    """
    if threads is not None and threads < 1:
        raise InputError(f"threads: is {threads}; expected at least 1")
    made = _scenario(scenario)
    texts = _vary(vary)
    plan = _native.Plan(made, texts, shard, True)
    place = Place(out)
    if executor is None:
        return Sweep(plan.sweep(place.path, force, threads), place)
    if threads is not None:
        raise InputError("threads: the executor says how many; leave it out")
    rows = _native.Rows(plan, place.path, force)
    try:
        job = (made._parts(), texts, _native.__version__, _native.__rapier_version__)
        runs = [(run, plan.mark(run)) for run in rows.missing()]
        lost = spread(executor, _worker.rows, job, runs, lambda run, row: rows.add(run[0], row))
        if lost is not None:
            raise Unfinished(f"{lost}; {rows.interrupted()}", *rows.progress()) from lost
        return Sweep(rows.finish(), place)
    finally:
        rows.close()


def merge(parts: Iterable[Name], out: Name, *, partial: bool = False, force: bool = False) -> Sweep:
    """Join the parts that sweeps with `shard` made."""
    return Sweep(_native.merge(_paths(parts, "parts"), out, force, partial), Place(out))


def calibrate(
    rig: Source,
    data: Name | Iterable[Name],
    *,
    validate: Name | Iterable[Name] = (),
    without: Iterable[str] = (),
    out: Name | None = None,
    force: bool = False,
) -> Calibration:
    """Find out what a declared model lacks, from recorded runs of the machine."""
    place = Place(out)
    runs, others = _paths(data, "data"), _paths(validate, "validate")
    text = _native.calibrate(_scenario(rig), runs, others, list(without), place.path, force)
    return Calibration(text, place)


def predict(
    model: Source,
    data: Name,
    *,
    out: Name | None = None,
    window: float | None = None,
    fit: float | None = None,
    start: float | None = None,
    force: bool = False,
) -> Prediction:
    """Drive a model by a recorded log's commands, and say how far it is off. `window`, `fit` and `start` (s) are those of
    machines that nothing holds."""
    place = Place(out)
    (run,) = _paths(data, "data")
    return Prediction(_native.predict(_scenario(model), run, place.path, force, [window, fit, start]), place)


def _named(all_of_them: list[dict[str, Any]], name: str | None, what: str) -> Any:
    if name is None:
        return all_of_them
    for one in all_of_them:
        if one["name"] == name:
            return one
    raise InputError(f"`{name}` is no {what}; there are {', '.join(one['name'] for one in all_of_them)}")


def effects(name: str | None = None) -> Any:
    """The effects that a scenario can give a machine: a list of dicts, or the one of this name."""
    return _named(json.loads(_native.effects()), name, "effect")


def laws(name: str | None = None) -> Any:
    """The contact laws that a scenario can choose from: a list of dicts, or the one of this name."""
    return _named(json.loads(_native.laws()), name, "law")


def self_test(
    count: int = 100,
    *,
    seed: int = 1,
    machines: Iterable[str] = (),
    hidden: Iterable[str] = (),
    trials: Name | None = None,
    executor: Executor | None = None,
) -> SelfTest:
    """Hide known effects in synthetic recordings, calibrate each (a minute or two), and say how often the answer is right.

    `trials` is a table (JSON lines) of finished trials, which is added to and gone on from.
    """
    wanted = _native.self_test_trials(seed, count, list(machines), list(hidden))
    if not wanted:
        raise InputError("hidden, machines: no trial is one of these")
    version = f"{_native.__version__} ({_build()})"
    table = Path(trials) if trials is not None else None
    known: dict[int, str] = {}
    if table is not None and table.exists():
        for number, line in enumerate(table.read_text().splitlines(), 1):
            row = json.loads(line)
            if row["version"] != version:
                raise InputError(f"{table}:{number}: a trial of {row['version']}, and this is {version}")
            known[row["seed"]] = line

    def keep(trial: tuple[int, str], row: str) -> None:
        if trial[0] not in known and table is not None:
            with table.open("a") as file:
                file.write(row + "\n")
        known[trial[0]] = row

    missing = [trial for trial in wanted if trial[0] not in known]
    if executor is None:
        for trial in missing:
            keep(trial, _worker.trials(version, [trial])[0])
    else:
        lost = spread(executor, _worker.trials, version, missing, keep, 1)
        if lost is not None:
            finished = len(wanted) - sum(trial[0] not in known for trial in wanted)
            raise Unfinished(f"{lost}; finished trials are kept", finished, len(wanted)) from lost
    return SelfTest([known[seed] for seed, _ in wanted])


def _build() -> str:
    """The first digits of the hash of what computes."""
    return hashlib.sha256(Path(_native.__file__).read_bytes()).hexdigest()[:8]
