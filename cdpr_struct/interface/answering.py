"""How the functions of the interface run: linear algebra on one thread, and errors of one family."""

import functools
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

from cdpr_struct.errors import told

_P = ParamSpec("_P")
_R = TypeVar("_R")
_CHOSEN = "OMP_NUM_THREADS"


def answered(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """The function with `one_thread` around it; what numerics and referee raise becomes a `CdprError`."""

    @functools.wraps(function)
    def answer(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        try:
            with one_thread():
                return function(*args, **kwargs)
        except Exception as error:
            known = told(error)
            if known is None or known is error:
                raise
            raise known from error

    return answer


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
