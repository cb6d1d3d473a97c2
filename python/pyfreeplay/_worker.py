"""What an executor's workers do: nothing of it is lost with them, nothing of it is kept by them."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from . import _native
from ._errors import InputError


@lru_cache(maxsize=2)
def _plan(job: Any) -> _native.Plan:
    parts, vary, version, rapier = job
    here = (_native.__version__, _native.__rapier_version__)
    if (version, rapier) != here:
        raise InputError(
            f"this worker has pyfreeplay {here[0]} on rapier {here[1]}, and the sweep was planned by {version} on {rapier}: "
            "rows of both would not agree"
        )
    return _native.Plan(_native.Scenario._restore(*parts), list(vary), "1/1", False)


def rows(job: Any, runs: list[tuple[int, int]]) -> list[list[str]]:
    """The rows of some runs."""
    text, name, folder, sets = job[0]
    plan = _plan(((text, name, folder, tuple(sets)), tuple(job[1]), *job[2:]))
    return [plan.row(run, mark) for run, mark in runs]


def trials(version: str, wanted: list[tuple[int, str]]) -> list[str]:
    """The rows of some trials of the self-test."""
    return [_native.self_test_trial(trial, version) for _, trial in wanted]
