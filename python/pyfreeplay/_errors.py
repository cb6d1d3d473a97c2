"""What goes wrong, as exceptions: what, where, and what would be right."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from ._results import Run


class Problem(NamedTuple):
    """One complaint about a scenario."""

    text: str
    """All of it in one line, as the command prints it."""
    key: str
    """Dotted path of the key; empty where the file as a whole is meant."""
    message: str
    """What is wrong."""
    help: str
    """What would be right."""
    file: str | None
    """The file as it was called; None of a value that was set."""
    line: int | None
    """Line, counted from 1, where the key stands in a file."""
    column: int | None
    """Column, known for syntax errors."""


class FreeplayError(Exception):
    """Everything that freeplay complains about."""


class InputError(FreeplayError, ValueError):
    """Wrong input (exit code 2 of the program)."""

    def __init__(self, message: str) -> None:
        super().__init__(message)


class ScenarioError(InputError):
    """A scenario is wrong; `problems` has everything that was found, the attributes are those of the first."""

    def __init__(self, problems: list[dict[str, Any]]) -> None:
        self.problems = [Problem(**problem) for problem in problems]
        super().__init__("\n".join(problem.text for problem in self.problems))
        first = self.problems[0]
        self.file, self.line, self.key = first.file, first.line, first.key

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), ([problem._asdict() for problem in self.problems],)


class RunError(FreeplayError, RuntimeError):
    """A run broke down, does not balance, or could not be written (exit code 1 of the program)."""

    run: Run | None = None
    """What was simulated until then, where there is something."""

    def __init__(self, message: str, run: Run | None = None) -> None:
        super().__init__(message)
        self.run = run


class Unfinished(FreeplayError):
    """Many runs ended before the last one (exit code 75): rows are kept, and the same call goes on from there."""

    def __init__(self, message: str, finished: int, runs: int) -> None:
        super().__init__(message)
        self.finished, self.runs = finished, runs

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.finished, self.runs)
