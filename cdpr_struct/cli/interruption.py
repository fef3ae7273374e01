"""How a command that the user interrupted says what is left of its work."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

CODE = 130  # of a program ended by an interrupt


class Interrupted(Exception):
    """The user stopped the command; the message says what was kept."""


@contextmanager
def stopped_in_order() -> Iterator[None]:
    """A request to end (SIGTERM) stops the work like an interrupt: finished parts are kept, workers are ended."""
    if threading.current_thread() is not threading.main_thread():
        yield  # Python lets the main thread alone handle signals
        return

    def stop(number: int, frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
