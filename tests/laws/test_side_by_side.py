"""Work shared among processes has the results, and the errors, of work done by one."""

import os
import signal
import time
import warnings
from pathlib import Path

import pytest

from cdpr_struct import side_by_side as module
from cdpr_struct.side_by_side import side_by_side

several = pytest.mark.skipif(module.cores() < 2, reason="needs two cores, and forks")


@pytest.fixture(autouse=True)
def two(monkeypatch):
    if module.cores() > 1:
        monkeypatch.setattr(module, "cores", lambda: 1 if module._alone else 2)


def where(item):
    return item, os.getpid()


@several
def test_results_stand_in_order_and_come_from_two_processes():
    def slow(item):
        sum(range(200_000))
        return where(item)

    found = side_by_side(slow, range(40), ())
    assert [item for item, _ in found] == list(range(40))
    assert len({process for _, process in found}) == 2


def test_what_is_known_stays_the_same_thing_and_need_not_be_copied():
    thing = lambda: None  # noqa: E731  # no process could send it
    assert all(found[1] is thing for found in side_by_side(lambda item: (item, thing), range(8), [thing]))


def test_what_another_process_cannot_send_is_done_here():
    found = side_by_side(lambda item: lambda: item, range(8), ())
    assert [each() for each in found] == list(range(8))


def test_what_another_process_dies_of_is_done_here():
    here = os.getpid()

    def deadly(item):
        if os.getpid() != here:
            os._exit(1)
        return item

    assert side_by_side(deadly, range(8), ()) == list(range(8))


def test_errors_are_those_of_the_work():
    def wrong(item):
        raise ArithmeticError(item)

    with pytest.raises(ArithmeticError):
        side_by_side(wrong, range(4), ())


@several
def test_work_within_work_is_done_by_its_own_process():
    def nested(item):
        return {process for _, process in side_by_side(where, range(4), ())}, os.getpid()

    apart = [(inner, own) for inner, own in side_by_side(nested, range(6), ()) if own != os.getpid()]
    assert all(inner == {own} for inner, own in apart)


def children() -> set[str]:
    """Processes that this one has started, whoever asked for them."""
    tasks = Path("/proc/self/task").glob("*/children")
    return {number for task in tasks for number in task.read_text().split()}


@several
def test_no_process_is_left():
    before = children()
    side_by_side(where, range(4), ())
    assert children() <= before


@several
def test_other_processes_end_with_a_killed_one():
    """A process that is killed while it works leaves none of its forks behind."""
    read, write = os.pipe()

    def told(item):
        os.write(write, os.getpid().to_bytes(4, "little"))
        time.sleep(60.0)
        return item

    first = subprocess_of(lambda: side_by_side(told, range(2), ()))
    workers = {int.from_bytes(os.read(read, 4), "little") for _ in range(2)}
    os.kill(first, signal.SIGKILL)
    os.waitpid(first, 0)
    for _ in range(100):
        if not any(alive(worker) for worker in workers):
            break
        time.sleep(0.05)
    assert len(workers) == 2
    assert not any(alive(worker) for worker in workers)


def subprocess_of(work) -> int:
    """Number of a fork that does some work and ends."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        process = os.fork()
    if not process:
        try:
            work()
        finally:
            os._exit(0)
    return process


def alive(process: int) -> bool:
    """Whether a process still runs; one that ended and waits to be asked for does not."""
    status = Path(f"/proc/{process}/stat")
    try:
        return status.read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False
