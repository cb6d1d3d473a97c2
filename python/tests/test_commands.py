"""The other commands: what they return is what the program writes."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pyfreeplay as fp
import pytest
from pyfreeplay import _native, _worker


def without_times(value: Any) -> Any:
    """A result without what depends on the computer and the folder."""
    if isinstance(value, dict):
        # The last sentence of a comparison's answer says how long it took.
        dropped = {"wall_s", "folder", "seconds", "wall_s_per_simulated_s", "answer"}
        return {key: without_times(one) for key, one in value.items() if key not in dropped}
    return [without_times(one) for one in value] if isinstance(value, list) else value


def test_check_says_what_the_program_says(freeplay: Any) -> None:
    checked = fp.check()
    assert checked.ok and checked.report == json.loads(freeplay("check --json"))
    assert repr(checked).startswith("<Check: ok") and "ok" in checked._repr_html_()
    wrong = fp.check(fp.Scenario().set("motion.radius", 0.09))
    assert not wrong.ok and wrong.findings[0]["key"] == "motion.radius"


def test_effects_and_laws_are_the_catalogues(freeplay: Any) -> None:
    assert fp.effects() == json.loads(freeplay("effects --json"))
    assert fp.laws() == json.loads(freeplay("laws --json"))
    assert fp.effects("payload")["name"] == "payload" and fp.laws("hertz")["name"] == "hertz"
    with pytest.raises(fp.InputError, match="`paylod` is no effect; there are"):
        fp.effects("paylod")


def test_compare_says_what_the_program_says(freeplay: Any, tmp_path: Path) -> None:
    machine = fp.Scenario().set("simulation.duration", 0.03)
    compared = fp.compare(machine, steps=[1e-5], starts=2, out=tmp_path / "ours")
    theirs = json.loads(freeplay("compare --duration 0.03 --steps 1e-5 --starts 2 --json --quiet --out theirs"))
    assert without_times(compared.report) == without_times(theirs)
    assert compared.answer[:-1] == theirs["answer"][:-1] and compared.folder == tmp_path / "ours" and "<svg" in compared.page()
    with pytest.raises(fp.InputError, match="out of range"):
        fp.compare(machine, steps=[1.0])
    with pytest.raises(fp.InputError, match="starts: is 1"):
        fp.compare(machine, starts=1)
    with pytest.raises(fp.InputError, match="did you mean `hertz`"):
        fp.compare(machine, laws=["herz"])


def test_predict_says_what_the_program_says(freeplay: Any, repository: Path, tmp_path: Path) -> None:
    rig = repository / "assets/rigs/rig-2"
    predicted = fp.predict(rig / "rig.toml", rig / "run-b.csv", out=tmp_path / "ours")
    freeplay(f"predict {rig}/rig.toml --data {rig}/run-b.csv --quiet --out theirs")
    theirs = json.loads((tmp_path / "theirs/errors.json").read_text())
    assert without_times(predicted.report) == without_times(theirs)
    assert (tmp_path / "ours/predicted.csv").read_bytes() == (tmp_path / "theirs/predicted.csv").read_bytes()
    assert "F1" in predicted.predicted.columns and "run-b.csv" in repr(predicted)
    with pytest.raises(fp.InputError, match="window: this machine"):
        fp.predict(rig / "rig.toml", rig / "run-b.csv", window=1.0)
    with pytest.raises(fp.InputError, match="no-such.csv"):
        fp.predict(rig / "rig.toml", "no-such.csv")


def test_calibrate_refuses_what_the_program_refuses(repository: Path) -> None:
    rig = repository / "assets/rigs/rig-2"
    with pytest.raises(fp.InputError, match="`payloat` is not an effect; did you mean `payload`"):
        fp.calibrate(rig / "rig.toml", rig / "run-a.csv", without=["payloat"])
    with pytest.raises(fp.InputError, match="several runs are fitted together"):
        fp.calibrate(rig / "rig.toml", [rig / "run-a.csv", rig / "run-b.csv"])
    with pytest.raises(fp.InputError, match="data: expected names of files"):
        fp.calibrate(rig / "rig.toml", [3])  # type: ignore[list-item]


@pytest.mark.slow
def test_calibrate_says_what_the_program_says(freeplay: Any, repository: Path, tmp_path: Path) -> None:
    rig = repository / "assets/rigs/rig-2"
    found = fp.calibrate(rig / "rig.toml", rig / "run-a.csv", validate=rig / "run-b.csv", out=tmp_path / "ours")
    freeplay(f"calibrate --rig {rig}/rig.toml --data {rig}/run-a.csv --validate {rig}/run-b.csv --quiet --out theirs")
    theirs = json.loads((tmp_path / "theirs/report.json").read_text())
    assert without_times(found.report) == without_times(theirs)
    assert found.verdict == "explained" and "actuator-friction" in repr(found) + found._repr_html_()
    assert fp.check(found.model).ok


def test_trials_are_spread_and_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The way of trials through executors and tables; what a trial does is the slow test's."""
    made: list[int] = []

    def quick(version: str, wanted: list[tuple[int, str]]) -> list[str]:
        made.extend(seed for seed, _ in wanted)
        return [json.dumps({**json.loads(trial), "version": version, "unasked": "quick"}) for _, trial in wanted]

    monkeypatch.setattr(_worker, "trials", quick)
    table = tmp_path / "trials.jsonl"
    first = fp.self_test(3, trials=table)
    assert len(first) == 3 and table.read_text().count("\n") == 3
    with ThreadPoolExecutor(2) as executor:
        again = fp.self_test(8, trials=table, executor=executor)
    assert len(again) == 8 == len(set(made)) and sorted(made) == sorted(t["seed"] for t in again.trials)
    assert again.trials[:3] == first.trials and isinstance(again.rates, str)
    table.write_text(table.read_text().replace('"version": "0', '"version": "9', 1))
    with pytest.raises(fp.InputError, match="trials.jsonl:1: a trial of 9"):
        fp.self_test(8, trials=table)
    with pytest.raises(fp.InputError, match="no trial is one of these"):
        fp.self_test(3, hidden=["no-such-effect"])


@pytest.mark.slow
def test_a_trial_in_a_pool_is_that_of_this_process() -> None:
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    with ProcessPoolExecutor(2, get_context("spawn")) as executor:
        there = fp.self_test(2, executor=executor)
    assert without_times(there.trials) == without_times(fp.self_test(2).trials)


def test_rows_that_are_none_are_refused() -> None:
    with pytest.raises(fp.InputError, match="rows: "):
        _native.self_test_rates(["{}"])
    with pytest.raises(fp.InputError, match="trial: "):
        _native.self_test_trial("[]", "0")
