"""Sweeps: the bytes of the program, whoever makes the runs and whatever is lost on the way."""

from __future__ import annotations

import os
import signal
import threading
import time
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any, Callable

import numpy as np
import pyfreeplay as fp
import pytest

LINE = "sweep --duration 0.02 --set simulation.tolerance=1e-4 --quiet"
VARY = {"joints.clearance": "1e-4..1e-3:log:4", "motion.phase": [0.0, 1.0, 2.0]}
AS_LINE = "--vary joints.clearance=1e-4..1e-3:log:4 --vary motion.phase=0,1,2"


@pytest.fixture
def table(freeplay: Any, tmp_path: Path) -> bytes:
    """The table of the program."""
    freeplay(f"{LINE} {AS_LINE} --out theirs")
    return (tmp_path / "theirs/sweep.csv").read_bytes()


def ours(folder: Path) -> bytes:
    return (folder / "sweep.csv").read_bytes()


def test_the_bytes_are_those_of_the_program(short: fp.Scenario, table: bytes, tmp_path: Path) -> None:
    sweep = fp.sweep(short, VARY, out=tmp_path / "a", threads=2)
    assert ours(tmp_path / "a") == table and ours(tmp_path / "theirs") == table
    for name in ("rows.jsonl", "scenario.toml"):
        mine, theirs = ((tmp_path / folder / name).read_text().splitlines() for folder in ("a", "theirs"))
        assert sorted(mine) == sorted(theirs)
    assert len(sweep) == 12 and sweep.columns[0] == "joints.clearance" and sweep["status"] == ["ok"] * 12
    assert sweep["impacts"].dtype == np.float64 and "12 of 12 runs: 12 ok" in repr(sweep)
    assert "data:image/svg+xml" in sweep._repr_html_()
    # It is there: nothing is run again, by either.
    assert fp.sweep(short, VARY, out=tmp_path / "a").record == sweep.record
    pyarrow = pytest.importorskip("pyarrow")
    assert pyarrow.table(sweep)["status"].to_pylist() == ["ok"] * 12


def test_values_may_be_lists_arrays_texts_and_ranges(short: fp.Scenario) -> None:
    vary = {"contact.law": ["hertz-step", "ideal"], "environment.gravity": [[0, 0], np.array([0.0, -9.81])]}
    sweep = fp.sweep(short, vary)
    assert sweep["contact.law"] == ["hertz-step"] * 2 + ["ideal"] * 2
    assert len(fp.sweep(short, {"seed": np.arange(1, 4)})) == 3
    # A text that would be read as something else is one all the same.
    for name in ("plain", "1e-4", "a,b", "1..2", "true", "with 'quotes\""):
        assert fp.sweep(short, {"name": [name, "other"]})["status"] == ["ok", "ok"], name
    assert len(fp.sweep(short, ["seed=1..3:3"])) == 3


@pytest.mark.parametrize(
    "vary, message",
    [
        ({}, "nothing is varied"),
        ({"joints.clearence": [1e-4]}, "did you mean `clearance`"),
        ({"joints.clearance": [float("nan")]}, "nan"),
        ({"joints.clearance": 1e-4}, "varies over 0.0001, one value; expected a list"),
        ({"joints.clearance": "1..2"}, "is no number of values"),
        ({"joints.clearance": [None]}, "joints.clearance.0: is of type `NoneType`"),
        ({"joints.clearance": np.array([1j])}, "complex"),
    ],
)
def test_what_cannot_be_varied(short: fp.Scenario, vary: Any, message: str) -> None:
    with pytest.raises(fp.InputError, match=message):
        fp.sweep(short, vary)


def test_threads_are_at_least_one(short: fp.Scenario) -> None:
    for threads in (0, -1):
        with pytest.raises(fp.InputError, match="threads: is"):
            fp.sweep(short, VARY, threads=threads)


def test_parts_are_merged_and_missing_ones_named(short: fp.Scenario, table: bytes, tmp_path: Path) -> None:
    parts = [tmp_path / f"p{i}" for i in (1, 2, 3)]
    for i, part in enumerate(parts, 1):
        fp.sweep(short, VARY, out=part, shard=f"{i}/3")
    with pytest.raises(fp.InputError, match="4 of 12 rows are missing.*shard 2/3 is not among the parts"):
        fp.merge([parts[0], parts[2]], tmp_path / "all")
    fp.merge(parts, tmp_path / "all")
    assert ours(tmp_path / "all") == table
    fp.sweep(short.set("seed", 5), {"motion.phase": [0.0]}, out=tmp_path / "foreign")
    with pytest.raises(fp.InputError, match="`.*foreign` is no part of the sweep"):
        fp.merge([*parts, tmp_path / "foreign"], tmp_path / "none")


@pytest.mark.parametrize("pool", [lambda: ThreadPoolExecutor(3), lambda: ProcessPoolExecutor(2, get_context("spawn"))])
def test_standard_pools(pool: Callable[[], Executor], short: fp.Scenario, table: bytes, tmp_path: Path) -> None:
    with pool() as executor:
        fp.sweep(short, VARY, out=tmp_path / "a", executor=executor)
    assert ours(tmp_path / "a") == table


def test_an_executor_says_how_many(short: fp.Scenario) -> None:
    with ThreadPoolExecutor(1) as executor, pytest.raises(fp.InputError, match="threads"):
        fp.sweep(short, VARY, executor=executor, threads=2)


LONGER = {"simulation.duration": 0.3}
MANY = {"joints.clearance": "1e-4..1e-3:log:8", "motion.phase": [0.0, 1.0]}


def rows(folder: Path) -> int:
    journal = folder / "rows.jsonl"
    return journal.read_text().count("\n") if journal.exists() else 0


def once(condition: Callable[[], bool], action: Callable[[], None]) -> threading.Thread:
    """Does something as soon as a condition holds."""

    def watch() -> None:
        while not condition():
            time.sleep(0.01)
        action()

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    return thread


def test_a_pool_that_loses_a_worker_breaks_and_a_new_one_goes_on(tmp_path: Path) -> None:
    machine, out = fp.Scenario().set(LONGER), tmp_path / "a"
    with ProcessPoolExecutor(2, get_context("spawn")) as executor:
        kill = lambda: os.kill(next(iter(executor._processes)), signal.SIGKILL)  # noqa: E731
        killed = once(lambda: rows(out) >= 2, kill)
        with pytest.raises(fp.Unfinished, match="rows are kept in .*; the same command goes on") as caught:
            fp.sweep(machine, MANY, out=out, executor=executor)
        killed.join()
    made = (out / "rows.jsonl").read_text()
    assert 2 <= caught.value.finished == rows(out) < caught.value.runs == 16
    with ProcessPoolExecutor(2, get_context("spawn")) as executor:
        fp.sweep(machine, MANY, out=out, executor=executor)
    assert (out / "rows.jsonl").read_text().startswith(made) and rows(out) == 16
    fp.sweep(machine, MANY, out=tmp_path / "b")
    assert ours(out) == ours(tmp_path / "b")


class Careless(Executor):
    """An executor that loses every third task, gives some rows twice and some late."""

    def __init__(self) -> None:
        self.tasks = 0

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **keywords: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.tasks += 1
        if self.tasks % 3 == 0:
            future.set_exception(ConnectionError("the worker is gone"))
        else:
            future.set_result(function(*arguments, **keywords))
        return future


def test_what_is_lost_is_handed_out_again(short: fp.Scenario, table: bytes, tmp_path: Path) -> None:
    executor = Careless()
    fp.sweep(short, VARY, out=tmp_path / "a", executor=executor)
    assert ours(tmp_path / "a") == table and rows(tmp_path / "a") == 12 and executor.tasks > 12


class Deadly(Careless):
    def submit(self, function: Callable[..., Any], /, *arguments: Any, **keywords: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_exception(ConnectionError("the worker is gone"))
        return future


def test_what_loses_every_worker_ends_the_sweep(short: fp.Scenario, tmp_path: Path) -> None:
    with pytest.raises(fp.Unfinished, match="the worker is gone; 0 of 12 rows are kept"):
        fp.sweep(short, VARY, out=tmp_path / "a", executor=Deadly())


def test_rows_are_refused_that_a_worker_with_other_files_makes(tmp_path: Path) -> None:
    table = tmp_path / "m.csv"
    text = "t,x,y,phi\n" + "".join(f"{t / 10},0.{t:02},0.0,0.5\n" for t in range(8))
    table.write_text(text)
    motion = {"kind": "table", "file": str(table)}
    machine = fp.Scenario().set({"motion": motion, "simulation.duration": 0.02})

    class Elsewhere(Careless):
        def submit(self, function: Callable[..., Any], /, *arguments: Any, **keywords: Any) -> Future[Any]:
            table.write_text(text.replace("0.03", "0.031"))
            future: Future[Any] = Future()
            try:
                future.set_result(function(*arguments, **keywords))
            except Exception as error:
                future.set_exception(error)
            return future

    with pytest.raises(fp.InputError, match="not the same here and where the sweep was planned"):
        fp.sweep(machine, {"seed": [1, 2]}, executor=Elsewhere())


def dask() -> Any:
    distributed = pytest.importorskip("dask.distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True
    )
    return cluster, distributed.Client(cluster)


def under_dask(machine: fp.Scenario, vary: Any, out: Path, kill_at: int) -> None:
    """A sweep by two workers of Dask, of which one is killed when so many rows are there."""
    cluster, client = dask()
    with cluster, client:

        def kill() -> None:
            os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)

        killed = once(lambda: rows(out) >= kill_at, kill)
        fp.sweep(machine, vary, out=out, executor=client.get_executor())
        killed.join()


def test_dask_with_a_worker_killed_in_the_middle(tmp_path: Path) -> None:
    machine = fp.Scenario().set(LONGER)
    under_dask(machine, MANY, tmp_path / "a", 3)
    fp.sweep(machine, MANY, out=tmp_path / "b")
    assert ours(tmp_path / "a") == ours(tmp_path / "b") and rows(tmp_path / "a") == 16


@pytest.mark.slow
def test_ten_thousand_runs_under_dask_one_of_two_workers_killed(tmp_path: Path) -> None:
    machine = fp.Scenario().set({"simulation.duration": 0.01, "simulation.tolerance": 1e-3})
    vary = {"joints.clearance": "1e-5..1e-3:log:100", "motion.phase": "0..6:100"}
    under_dask(machine, vary, tmp_path / "a", 5000)
    fp.sweep(machine, vary, out=tmp_path / "b")
    assert ours(tmp_path / "a") == ours(tmp_path / "b")
    assert rows(tmp_path / "a") == 10_000


def test_ray_with_a_worker_killed_in_the_middle(tmp_path: Path) -> None:
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:

        class Ray(Executor):
            def submit(self, function: Callable[..., Any], /, *arguments: Any, **keywords: Any) -> Future[Any]:
                task = ray.remote(num_cpus=1, max_retries=3)(function)
                future: Future[Any] = task.remote(*arguments, **keywords).future()
                return future

        first = ray.remote(lambda: os.getpid())
        machine, out = fp.Scenario().set(LONGER), tmp_path / "a"
        pid = ray.get(first.remote())
        killed = once(lambda: rows(out) >= 3, lambda: os.kill(pid, signal.SIGKILL))
        fp.sweep(machine, MANY, out=out, executor=Ray())
        killed.join()
        fp.sweep(machine, MANY, out=tmp_path / "b")
        assert ours(out) == ours(tmp_path / "b") and rows(out) == 16
        with pytest.raises(fp.InputError, match="not the same here"):
            other = tmp_path / "m.csv"
            other.write_text("t,x,y,phi\n" + "".join(f"{t / 10},0.{t:02},0.0,0.5\n" for t in range(8)))
            motion = {"kind": "table", "file": str(other)}

            class Late(Ray):
                def submit(self, function: Callable[..., Any], /, *a: Any, **k: Any) -> Future[Any]:
                    other.write_text(other.read_text().replace("0.03", "0.031"))
                    return super().submit(function, *a, **k)

            fp.sweep(fp.Scenario().set({"motion": motion, "simulation.duration": 0.02}), {"seed": [1]}, executor=Late())
    finally:
        ray.shutdown()


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="threads are counted as Linux shows them")
def test_threads_are_those_of_the_queue(monkeypatch: pytest.MonkeyPatch) -> None:
    count = lambda: len(os.listdir("/proc/self/task"))  # noqa: E731
    machine = fp.Scenario().set("simulation.duration", 0.2)
    most: dict[str, int] = {}
    for cores in ("1", "7"):
        monkeypatch.setenv("SLURM_CPUS_PER_TASK", cores)
        done, seen = threading.Event(), [0]

        def watch(done: threading.Event = done, seen: list[int] = seen) -> None:
            while not done.wait(0.005):
                seen.append(count())

        watcher = threading.Thread(target=watch)
        watcher.start()
        fp.sweep(machine, {"seed": [1, 2]})
        done.set()
        watcher.join()
        most[cores] = max(seen)
    assert most["7"] - most["1"] == 6
