"""What calls return: facts, tables, and how a notebook shows them."""

from __future__ import annotations

import json
from base64 import b64encode
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    import numpy as np
    from numpy.typing import NDArray

from . import _native
from ._native import Scenario, Table

def number(value: object) -> str:
    """A number as people read it."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return "–" if value is None else str(value)
    return str(value) if isinstance(value, int) else f"{value:.4g}"


def _rows(rows: Iterable[Sequence[str]], head: Sequence[str] = ()) -> str:
    """An HTML table."""

    def line(cells: Sequence[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    body = "".join(line(row, "td") for row in rows)
    return f"<table>{line(head, 'th') if head else ''}{body}</table>"


def _image(svg: str) -> str:
    """A picture that keeps its styles to itself."""
    data = b64encode(svg.encode()).decode()
    return f'<img src="data:image/svg+xml;base64,{data}" style="display:block; width:100%; max-width:48em"/>'


class Place:
    """A folder of results: the user's, or one that goes when the last result that needs it does."""

    def __init__(self, out: str | Path | None) -> None:
        self.path: Path
        if out is not None:
            self.path = Path(out)
        else:
            self._temporary = TemporaryDirectory(prefix="pyfreeplay-")
            self.path = Path(self._temporary.name) / "result"


class Run:
    """One run: `run["x"]` is a column (numpy, read-only), `run.summary` the figures of `summary.json`."""

    def __init__(self, record: _native.Record, scenario: Scenario) -> None:
        self._record = record
        self.scenario = scenario
        self.summary: dict[str, Any] = json.loads(record.json)

    @property
    def table(self) -> Table:
        """The rows, to be handed to pandas, polars or pyarrow."""
        return self._record.table

    @property
    def columns(self) -> list[str]:
        """Names of the columns, those of `timeseries.csv`."""
        return self.table.columns

    @property
    def folder(self) -> Path | None:
        """Where its files are, if it was written."""
        return None if self._record.folder is None else Path(self._record.folder)

    @property
    def halted(self) -> str | None:
        """Why it broke down, if it did."""
        halted: str | None = self.summary["halted"]
        return halted

    @property
    def faults(self) -> list[str]:
        """What it saw of its own errors."""
        faults: list[str] = self.summary["watched"]["faults"]
        return faults

    def pictures(self) -> dict[str, str]:
        """SVG by file name, as `freeplay run` writes them."""
        return {file: svg for file, _, _, svg in self._record.pictures()}

    def animation(self) -> str:
        """The start of the run as an SVG that moves."""
        return self._record.animation()

    def player(self) -> str:
        """A page that plays the run."""
        return self._record.player()

    def __getitem__(self, column: str) -> NDArray[np.float64]:
        values: NDArray[np.float64] = self.table[column]
        return values

    def __len__(self) -> int:
        return len(self.table)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self.table.__arrow_c_stream__(requested_schema)

    @property
    def verdict(self) -> str:
        """How the run went, in a few words."""
        if self.halted:
            return f"halted: {self.halted}"
        return "; ".join(self.faults) if self.faults else "ran to its end, its energy balanced"

    def __repr__(self) -> str:
        s = self.summary
        return (
            f"<Run {s['scenario_name']!r}: {number(s['simulated_s'])} s, {len(self)} rows, "
            f"{s['impacts']} impacts, peak contact force {number(s['peak_contact_force_N'])} N>"
        )

    def _repr_html_(self) -> str:
        s = self.summary
        figures = [
            ("peak contact force", f"{number(s['peak_contact_force_N'])} N"),
            ("peak acceleration", f"{number(s['peak_platform_acceleration_m_s2'])} m/s²"),
            ("largest path error", f"{number(s['max_path_error_m'])} m"),
            ("time in contact", f"{number(100.0 * (s['contact_fraction'] or 0.0))} %"),
            ("impacts", number(s["impacts"])),
        ]
        orbits = self.pictures()["orbits.svg"]
        return (
            f"<h4>{escape(s['scenario_name'])}: {escape(self.verdict)}</h4>{_rows(figures)}"
            f"{_image(self.animation())}{_image(orbits)}"
        )


class Report:
    """A JSON file of freeplay as a dict in `report`; its keys are items, too."""

    def __init__(self, text: str, place: Place | None = None) -> None:
        self.report: dict[str, Any] = json.loads(text)
        self._place = place

    @property
    def folder(self) -> Path | None:
        """Where its files are; a temporary folder lives as long as this object."""
        return None if self._place is None else self._place.path

    def __getitem__(self, key: str) -> Any:
        return self.report[key]

    def __contains__(self, key: str) -> bool:
        return key in self.report

    def __iter__(self) -> Iterator[str]:
        return iter(self.report)

    def page(self) -> str:
        """The page that people read, as HTML."""
        assert self.folder is not None
        return (self.folder / "index.html").read_text()


class Check(Report):
    """Everything that can be said without simulating."""

    @property
    def ok(self) -> bool:
        """Whether a run would start."""
        return bool(self.report["ok"])

    @property
    def findings(self) -> list[dict[str, Any]]:
        """Errors and warnings."""
        findings: list[dict[str, Any]] = self.report["findings"]
        return findings

    def __repr__(self) -> str:
        return f"<Check: {'ok' if self.ok else 'a run would be refused'}, {len(self.findings)} findings>"

    def _repr_html_(self) -> str:
        found = [(f["severity"], f["key"], f["message"], f["help"]) for f in self.findings]
        return f"<h4>{'ok' if self.ok else 'a run would be refused'}</h4>{_rows(found)}"


class Comparison(Report):
    """One motion under several contact models."""

    @property
    def answer(self) -> list[str]:
        """What the physics engine's own contacts may be used for; none where laws were compared."""
        answer: list[str] = self.report.get("answer", [])
        return answer

    def __repr__(self) -> str:
        return f"<Comparison of {self.report['scenario_name']!r}: {len(self.report['rows'])} rows>"

    def _repr_html_(self) -> str:
        return _rows([(line,) for line in self.answer] or [(repr(self),)])


class Calibration(Report):
    """What a declared model lacks."""

    @property
    def verdict(self) -> str:
        """`explained`, `nothing-missing` or `unexplained`."""
        return str(self.report["verdict"])

    @property
    def effects(self) -> list[dict[str, Any]]:
        """What was found."""
        effects: list[dict[str, Any]] = self.report["effects"]
        return effects

    @property
    def model(self) -> Scenario:
        """The rig with what was found."""
        assert self.folder is not None
        return Scenario(self.folder / "calibrated.toml")

    def __repr__(self) -> str:
        found = ", ".join(effect["kind"] for effect in self.effects) or "no effects"
        return f"<Calibration: {self.verdict}, {found}>"

    def _repr_html_(self) -> str:
        values = [
            (e["kind"], str(e.get("joint") or ""), name, number(p["value"]), f"± {number(p['std'])}")
            for e in self.effects
            for name, p in e["params"].items()
        ]
        errors = [
            (e["run"], e["channel"], *(f"{number(e[k])} {e['unit']}" for k in ("before", "after", "floor")))
            for e in self.report["errors"]
        ]
        summary = escape(str(self.report.get("summary", "")))
        head = ("run", "channel", "before", "after", "floor")
        return f"<h4>{self.verdict}</h4><p>{summary}</p>{_rows(values)}{_rows(errors, head)}"


class Prediction(Report):
    """How far a model is off along a recording."""

    @property
    def predicted(self) -> Table:
        """The log's rows and columns as the model has them."""
        assert self.folder is not None
        return _native.read_csv(self.folder / "predicted.csv")

    def __repr__(self) -> str:
        return f"<Prediction of {self.report['scenario_name']!r} along {self.report['run']}>"


class Sweep(Report):
    """Many runs, one row each: `sweep["impacts"]` is a column."""

    def __init__(self, text: str, place: Place) -> None:
        super().__init__(text, place)
        self.table = _native.read_csv(place.path / "sweep.csv")

    @property
    def record(self) -> dict[str, Any]:
        """What `sweep.json` says."""
        return self.report

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return self.table.columns

    def __getitem__(self, column: str) -> Any:
        return self.table[column]

    def __contains__(self, column: str) -> bool:
        return column in self.table

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.table)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self.table.__arrow_c_stream__(requested_schema)

    def _counts(self) -> str:
        r = self.report
        return f"{r['finished']} of {r['runs_of_shard']} runs: {r['ok']} ok, {r['halted']} halted, {r['refused']} refused"

    def __repr__(self) -> str:
        return f"<Sweep of {', '.join(self.report['vary'])}: {self._counts()}>"

    def _repr_html_(self) -> str:
        assert self.folder is not None
        pictures = "".join(_image(p.read_text()) for p in sorted(self.folder.glob("over-*.svg"))[:1])
        return f"<h4>{escape(self._counts())}</h4>{pictures}"


class SelfTest:
    """What became of the trials."""

    def __init__(self, rows: list[str]) -> None:
        self.trials: list[dict[str, Any]] = [json.loads(row) for row in rows]
        self.rates: str = _native.self_test_rates(rows)

    def __len__(self) -> int:
        return len(self.trials)

    def __repr__(self) -> str:
        right = sum(bool(trial.get("right")) for trial in self.trials)
        return f"<SelfTest: {right} of {len(self)} trials right>"
