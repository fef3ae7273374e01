"""How functions run: linear algebra on one thread that is given back, errors of one family."""

import inspect

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import cdpr_struct as cs
from cdpr_struct import fem_reference
from cdpr_struct.interface.answering import answered

COMPUTE_NOTHING = {"load_robot", "write_robot", "causes"}


def threads() -> set[int]:
    """Numbers of threads of the libraries of linear algebra."""
    return {library["num_threads"] for library in threadpool_info()}


@pytest.fixture
def two_threads():
    with threadpool_limits(2):
        yield


def test_one_thread_while_a_function_runs_and_two_again_after(two_threads, monkeypatch):
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    assert threads() == {2}
    assert answered(threads)() == {1}
    assert threads() == {2}


def test_threads_are_given_back_after_an_error(two_threads, monkeypatch):
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    with pytest.raises(cs.InputError):
        cs.modes("thesis-3-1", count=0)
    assert threads() == {2}


def test_who_sets_the_number_of_threads_keeps_it(two_threads, monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "2")
    assert answered(threads)() == {2}


def test_every_function_that_computes_is_run_this_way():
    functions = {name for name in cs.__all__ if inspect.isfunction(getattr(cs, name))}
    assert {name for name in functions if not hasattr(getattr(cs, name), "__wrapped__")} == COMPUTE_NOTHING


@pytest.mark.parametrize("foreign", [np.linalg.LinAlgError("singular"), ZeroDivisionError("by zero")])
def test_errors_of_numerics_are_of_the_family(foreign):
    def fails() -> None:
        raise foreign

    with pytest.raises(cs.CdprError, match="cannot be computed") as told:
        answered(fails)()
    assert told.value.__cause__ is foreign


def test_errors_of_the_referee_are_of_the_family():
    fails = next(e for e in vars(fem_reference).values() if inspect.isclass(e) and issubclass(e, Exception))

    def refuses() -> None:
        raise fails.__new__(fails)

    with pytest.raises(cs.CdprError, match="FEM reference"):
        answered(refuses)()


def test_a_defect_stays_what_it_is():
    with pytest.raises(KeyError, match="missing"):
        answered({}.__getitem__)("missing")


def test_one_family():
    for name in cs.__all__:
        thing = getattr(cs, name)
        if inspect.isclass(thing) and issubclass(thing, Exception):
            assert issubclass(thing, cs.CdprError), name
    assert issubclass(cs.InputError, ValueError)
