"""Planar mechanisms with clearance joints: simulate, sweep, calibrate.

Names are those of the commands of ``freeplay``; SI units everywhere (m, kg, s, N, rad).

>>> import pyfreeplay as fp
>>> run = fp.run(fp.Scenario().set("simulation.duration", 0.01))
>>> run.summary["impacts"] >= 0
True
"""

from ._commands import (
    calibrate,
    check,
    compare,
    effects,
    evaluate,
    laws,
    merge,
    predict,
    run,
    self_test,
    sweep,
)
from ._errors import FreeplayError, InputError, Problem, RunError, ScenarioError, Unfinished
from ._mechanism import Mechanism
from ._native import Scenario, Table, __rapier_version__, __version__
from ._results import Calibration, Check, Comparison, Prediction, Run, SelfTest, Sweep

__all__ = [
    "Calibration",
    "Check",
    "Comparison",
    "FreeplayError",
    "InputError",
    "Mechanism",
    "Prediction",
    "Problem",
    "Run",
    "RunError",
    "Scenario",
    "ScenarioError",
    "SelfTest",
    "Sweep",
    "Table",
    "Unfinished",
    "__rapier_version__",
    "__version__",
    "calibrate",
    "check",
    "compare",
    "effects",
    "evaluate",
    "laws",
    "merge",
    "predict",
    "run",
    "self_test",
    "sweep",
]
