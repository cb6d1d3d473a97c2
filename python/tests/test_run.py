"""Runs: the numbers of the program, as arrays and tables."""

from __future__ import annotations

import csv
import json
import math
import re
import signal
import subprocess
import sys
import threading
import time
from base64 import b64decode
from pathlib import Path
from typing import Any

import numpy as np
import pyfreeplay as fp
import pytest

LINE = "--duration 0.05 --set joints.clearance=2e-4 --set drive.mode=servo"


@pytest.fixture
def machine() -> fp.Scenario:
    values = {"simulation.duration": 0.05, "joints.clearance": 2e-4, "drive.mode": "servo"}
    return fp.Scenario().set(values)


def same(a: dict[str, Any], b: dict[str, Any], but: set[str]) -> None:
    for key in a.keys() | b.keys():
        assert key in but or a[key] == b[key], key


def test_the_figures_and_rows_are_those_of_the_program(machine: fp.Scenario, freeplay: Any, tmp_path: Path) -> None:
    freeplay(f"run {LINE} --out r --quiet")
    run = fp.run(machine)
    theirs = json.loads((tmp_path / "r/summary.json").read_text())
    same(run.summary, theirs, {"wall_s", "wall_s_per_simulated_s", "files"})
    with (tmp_path / "r/timeseries.csv").open() as file:
        rows = list(csv.reader(file))
    assert run.columns == rows[0] and len(run) == len(rows) - 1
    for column, name in enumerate(rows[0]):
        # Files have ten digits.
        ours = run[name] if name == "t" else [float(f"{value:.9e}") for value in run[name]]
        assert [float(row[column]) for row in rows[1:]] == list(ours), name


def test_a_folder_has_the_bytes_of_the_program(machine: fp.Scenario, freeplay: Any, tmp_path: Path) -> None:
    freeplay(f"run {LINE} --out r --quiet")
    run = fp.run(machine, out=tmp_path / "ours")
    assert run.folder == tmp_path / "ours"
    files = sorted(p.name for p in (tmp_path / "r").iterdir())
    assert files == sorted(p.name for p in run.folder.iterdir())
    for name in set(files) - {"summary.json", "index.html"}:  # they say how long it took
        assert (tmp_path / "r" / name).read_bytes() == (run.folder / name).read_bytes(), name
    with pytest.raises(fp.InputError, match="already holds a result"):
        fp.run(machine, out=tmp_path / "ours")
    fp.run(machine, out=tmp_path / "ours", force=True)


def test_arrays_are_not_copied_and_not_written_to(short: fp.Scenario) -> None:
    run = fp.run(short)
    assert run["x"] is run["x"] and run["x"].dtype == np.float64 and run["x"].flags.c_contiguous
    with pytest.raises(ValueError, match="read-only"):
        run["x"][0] = 1.0
    with pytest.raises(KeyError, match="`z` is no column"):
        run["z"]


def test_tables_go_to_pandas_polars_and_pyarrow(short: fp.Scenario) -> None:
    pandas, polars, pyarrow = map(pytest.importorskip, ["pandas", "polars", "pyarrow"])
    run = fp.run(short)
    tables = [pyarrow.table(run), polars.DataFrame(run), pyarrow.table(run).to_pandas()]
    if hasattr(pandas.DataFrame, "from_arrow"):
        tables.append(pandas.DataFrame.from_arrow(run))
    for table in tables:
        assert len(table) == len(run)
        for name in run.columns:
            assert np.array_equal(np.asarray(table[name]), run[name])


def test_what_a_notebook_shows(short: fp.Scenario) -> None:
    run = fp.run(short)
    assert repr(run).startswith("<Run 'default': 0.02 s, 41 rows, ")
    page = run._repr_html_()
    assert "ran to its end, its energy balanced" in page
    shown = [b64decode(data).decode() for data in re.findall(r"base64,([^\"]*)", page)]
    assert shown == [run.animation(), run.pictures()["orbits.svg"]]
    assert len(run.player()) > 10_000


def test_evaluate_has_the_figures_of_run_and_of_the_program(short: fp.Scenario, freeplay: Any) -> None:
    names = ["peak_contact_force_N", "impacts", "rms_path_error_m"]
    figures = fp.evaluate(short, names)
    run = fp.run(short)
    assert figures == {name: run.summary[name] for name in names}
    line = freeplay(f"evaluate --duration 0.02 --set simulation.tolerance=1e-4 --figures {','.join(names)}")
    assert [float(number) for number in line.split()] == list(figures.values())
    assert set(names) < set(fp.evaluate(short))
    with pytest.raises(fp.InputError, match="did you mean `impacts`"):
        fp.evaluate(short, ["impact"])


def test_a_run_that_breaks_down_is_an_exception_with_what_there_is() -> None:
    weak = {"contact.stiffness": 10, "contact.c_max": 0, "simulation.duration": 0.2}
    with pytest.raises(fp.RunError, match="broke down at t = 0.0") as caught:
        fp.run(fp.Scenario().set(weak))
    assert caught.value.run is not None and caught.value.run.halted and len(caught.value.run) > 1


def test_what_a_machine_cannot_do_is_refused_before() -> None:
    with pytest.raises(fp.ScenarioError, match="motion.radius") as caught:
        fp.run(fp.Scenario().set("motion.radius", 0.09))
    assert caught.value.key == "motion.radius"


def test_doubts_are_warnings() -> None:
    with pytest.warns(UserWarning, match="10000 kg heavy"):
        fp.evaluate(fp.Scenario().set({"simulation.duration": 0.005, "mechanism.platform_mass": 1e4}), ["steps"])


def test_others_go_on_while_a_run_works() -> None:
    counted, stop = 0, threading.Event()

    def count() -> None:
        nonlocal counted
        while not stop.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    started = time.perf_counter()
    fp.evaluate(fp.Scenario().set("simulation.duration", 0.5), ["impacts"])
    took = time.perf_counter() - started
    stop.set()
    thread.join()
    # With the lock held it would have counted to one or two.
    assert counted > 20 * took, (counted, took)


ENDLESS = """
import pyfreeplay as fp, time
machine = fp.Scenario().set({"simulation.duration": 1000.0, "simulation.output_interval": 10.0})
print("ready", flush=True)
try:
    %s
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


@pytest.mark.parametrize(
    "call", ["fp.run(machine)", "fp.evaluate(machine)", "fp.sweep(machine, {'seed': [1, 2]})", "fp.compare(machine)"]
)
def test_ctrl_c_stops(call: str, tmp_path: Path) -> None:
    child = subprocess.Popen([sys.executable, "-c", ENDLESS % call], stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    assert child.stdout is not None and child.stdout.readline() == "ready\n"
    time.sleep(1.0)
    child.send_signal(signal.SIGINT)
    started = time.perf_counter()
    assert child.communicate(timeout=60)[0] == "interrupted\n"
    assert child.returncode == 0 and time.perf_counter() - started < 20
    assert not math.isnan(started) and not list(tmp_path.iterdir())
