"""What the documentation shows, as it stands there."""

from __future__ import annotations

import doctest
import os
import re
import runpy
import subprocess
from pathlib import Path

import pyfreeplay as fp
import pytest


def blocks(text: str) -> str:
    """All blocks of Python of a page, with their lines where they stand."""
    lines, inside = [], False
    for line in text.splitlines():
        if line.startswith("```"):
            inside = line == "```python"
            line = ""
        lines.append(line if inside else "")
    return "\n".join(lines)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("page", ["python/README.md", "docs/python.md", "docs/clusters.md"])
def test_pages(page: str, repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("pandas", "polars", "pyarrow", "dask.distributed", "ray"):
        if name.split(".")[0] in (repository / page).read_text():
            pytest.importorskip(name)
    (tmp_path / "assets").symlink_to(repository / "assets")
    code = blocks((repository / page).read_text())
    assert code.strip()
    script = tmp_path / "page.py"
    # Processes that are spawned import the script again.
    body = "\n".join("    " + line for line in code.splitlines())
    script.write_text(f"def page():\n{body}\n\nif __name__ == '__main__':\n    page()\n")
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(script), run_name="__main__")


def test_doc_strings() -> None:
    from pyfreeplay import _mechanism

    for module in (fp, _mechanism):
        done = doctest.testmod(module)
        assert done.failed == 0 and done.attempted > 0


def test_the_notebook(repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    shown = runpy.run_path(str(repository / "python/examples/notebook.py"))
    assert "data:image/svg+xml" in shown["run"]._repr_html_() and len(shown["sweep"]) == 6


def test_every_name_is_typed_and_said(repository: Path) -> None:
    stubs = (repository / "python/pyfreeplay/_native.pyi").read_text()
    from pyfreeplay import _native

    for name in dir(_native):
        if not name.startswith("__"):
            assert re.search(rf"(def|class) {name}\b", stubs), name
    for name in fp.__all__:
        assert name.startswith("__") or getattr(fp, name).__doc__ or name in ("Scenario", "Table"), name


def test_the_job_array(binary: str, repository: Path, tmp_path: Path) -> None:
    """The blocks of a shell in docs/clusters.md, in their order; the queue is a loop here, a real one in `cli_slurm`."""
    page = (repository / "docs/clusters.md").read_text().replace("log:1000", "log:9")
    forecast, job, resubmit = re.findall(r"```(?:sh|text)\n(.*?)```", page, re.S)
    (tmp_path / "s.toml").write_text(fp.Scenario().set("simulation.duration", 0.02).to_toml())
    (tmp_path / "job.sh").write_text(job)
    (tmp_path / "sbatch").write_text('#!/bin/sh\necho "$1" > asked\n')
    (tmp_path / "sbatch").chmod(0o755)

    def sh(script: str, **variables: str) -> str:
        path = f"{tmp_path}:{Path(binary).parent}:{os.environ['PATH']}"
        environment = {**os.environ, **variables, "PATH": path}
        done = subprocess.run(["sh", "-c", script], cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert sh(forecast).startswith("9 runs, 0 of them done; a run takes ")
    tasks = [str(task) for task in range(1, 9)]
    for task in tasks[:5] + tasks[6:]:
        sh("sh job.sh", SLURM_ARRAY_TASK_ID=task, SLURM_CPUS_PER_TASK="1")
    missing, merge = resubmit.rsplit("freeplay merge", 1)
    sh(missing)
    assert (tmp_path / "asked").read_text() == "--array=6\n"
    sh("sh job.sh", SLURM_ARRAY_TASK_ID="6")
    (tmp_path / "asked").unlink()
    sh(missing + "freeplay merge" + merge)
    assert not (tmp_path / "asked").exists()
    assert len((tmp_path / "all/sweep.csv").read_text().splitlines()) == 10
