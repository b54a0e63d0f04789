"""Long calls of the library in a thread of their own, so that Ctrl-C need not wait for their end."""

from __future__ import annotations

import contextlib
import threading
from typing import Any, Callable, Generic, List, Optional, TypeVar

Result = TypeVar("Result")
Enter = Callable[[], "contextlib.AbstractContextManager[Any]"]

LONG = 0.005  # s: from here on a thread's 0.1 ms does not matter


class Aside(Generic[Result]):
    """`call(handle)` within `enter()`, in another thread. `wait` returns its result, or raises its exception.

    Whatever ends `wait` early, as Ctrl-C does, leaves a call under way to its end, with the simulation locked until
    then. A call that has not begun never does. The interpreter ends after the call.
    """

    def __init__(self, enter: Enter, call: Callable[[Any], Result]):
        self._enter, self._call = enter, call
        self._abandoned = False
        self._done = threading.Event()
        self._result: List[Result] = []
        self._error: Optional[BaseException] = None

    def _run(self) -> None:
        try:
            with self._enter() as handle:
                if not self._abandoned:
                    self._result.append(self._call(handle))
        except BaseException as error:
            self._error = error
        finally:
            self._done.set()

    def wait(self) -> Result:
        try:
            threading.Thread(target=self._run, name="singe").start()
            while not self._done.wait(0.1):  # Windows looks for Ctrl-C only between waits
                pass
        except BaseException:
            self._abandoned = True
            raise
        if self._error is not None:
            raise self._error
        return self._result[0]


def is_interruptible() -> bool:
    """Whether this thread is the one that Ctrl-C interrupts."""
    return threading.current_thread() is threading.main_thread()
