"""How the functions of the interface run: linear algebra on one thread, errors of one family, doubts told with both."""

import functools
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

from cdpr_struct.errors import CdprError, InputError, told

_P = ParamSpec("_P")
_R = TypeVar("_R")
_CHOSEN = "OMP_NUM_THREADS"
_DOUBTS: ContextVar[list[str] | None] = ContextVar("doubts", default=None)


def answered(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """The function with `one_thread` around it; what numerics and referee raise becomes a `CdprError`.

    Sentences given to `doubt` meanwhile stand behind its error.
    """

    @functools.wraps(function)
    def answer(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        doubts: list[str] = []
        token = _DOUBTS.set(doubts)
        try:
            with one_thread():
                return function(*args, **kwargs)
        except Exception as error:
            known = told(error)
            if known is None:
                raise
            _explain(known, doubts)
            if known is error:
                raise
            raise known from error
        finally:
            _DOUBTS.reset(token)

    return answer


def doubt(sentences: Iterable[str]) -> None:
    """Say of an input what may be wrong with it, should physics refuse what is asked of it."""
    doubts = _DOUBTS.get()
    if doubts is not None:
        doubts += [sentence for sentence in sentences if sentence not in doubts]


def _explain(error: CdprError, doubts: list[str]) -> None:
    """What physics refuses may be what was doubted."""
    if doubts and not isinstance(error, InputError):
        error.args = (" ".join([f"{str(error).rstrip('.')}.", *doubts]),)


@contextmanager
def one_thread() -> Iterator[None]:
    """Linear algebra on one thread, unless OMP_NUM_THREADS is set: matrices here are small, threads would wait."""
    if _CHOSEN in os.environ:
        yield
        return
    with threadpool_limits(1):
        yield


def silent(name: str) -> None:
    """A step that nobody is told of."""
