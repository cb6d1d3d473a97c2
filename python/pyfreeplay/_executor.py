"""Work spread over the workers of any executor, some of which may be lost."""

from __future__ import annotations

from collections import deque
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from typing import Any, Callable, Optional, TypeVar

from ._errors import FreeplayError

Item = TypeVar("Item")
Row = TypeVar("Row")

WINDOW = 256
"""Tasks that are handed out at once: enough for any pool that a schedule of seconds keeps busy, and nothing to a queue."""

LARGEST = 64
"""Items of a task at most: what a lost worker has to make again."""

TRIES = 3
"""Times that an item is handed out alone before it is held to be what loses its workers."""


def spread(
    executor: Executor,
    task: Callable[[Any, list[Item]], list[Row]],
    job: Any,
    items: list[Item],
    keep: Callable[[Item, Row], None],
    at_once: Optional[int] = None,
) -> Optional[BaseException]:
    """Has `task(job, some items)` done for all items, and `keep`s each row as soon as it is there.

    What a lost worker had is handed out again, item by item. Returns what went wrong if that does not help: nothing that
    was kept is lost. Errors of the work itself are raised.
    """
    size = at_once or max(1, min(LARGEST, len(items) // WINDOW))
    queue = deque((items[i : i + size], 0) for i in range(0, len(items), size))
    going: dict[Future[list[Row]], tuple[list[Item], int]] = {}
    try:
        while queue or going:
            while queue and len(going) < WINDOW:
                some, tries = queue.popleft()
                try:
                    going[executor.submit(task, job, some)] = (some, tries)
                except Exception as error:  # A broken pool takes no more.
                    queue.appendleft((some, tries))
                    if not going:
                        return error
                    break
            done, _ = wait(going, return_when=FIRST_COMPLETED)
            for future in done:
                some, tries = going.pop(future)
                try:
                    rows = future.result()
                except FreeplayError:
                    raise
                except (Exception, CancelledError) as error:
                    cause = getattr(error, "cause", None)
                    if isinstance(cause, FreeplayError):  # Ray wraps what its tasks raise.
                        raise cause from error
                    if tries + 1 >= TRIES:
                        return error
                    queue.extend(([item], tries + 1) for item in some)
                    continue
                for item, row in zip(some, rows):
                    keep(item, row)
    finally:
        for future in going:
            future.cancel()
    return None
