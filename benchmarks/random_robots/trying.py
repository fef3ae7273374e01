"""One seed: a pose held, the way back from its lengths, and its natural frequencies, each judged."""

import signal
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

import cdpr_struct as cs
from benchmarks.random_robots.case import Case
from benchmarks.random_robots.drawing import drawn
from benchmarks.random_robots.fem_modes import fem_verdict
from benchmarks.random_robots.further import distributed, distribution_faults, error_at, pose_error_faults, taut
from benchmarks.random_robots.judging import (
    mode_faults,
    not_numbers,
    refusal_faults,
    rest_faults,
    static_faults,
    way_back_faults,
)
from benchmarks.random_robots.own_mechanics import OwnRest, own_rest
from benchmarks.random_robots.refusals import holdable
from benchmarks.random_robots.sampled_cables import out_of_reach
from cdpr_struct.fem_reference import FemError

_LONGEST = 120.0  # [s] of a seed, of processor time
_COUNT = 12  # frequencies
OWN_WORD = {"no": "no, sampled", "not found": "not found", "found": "yes, sampled", "unknown": "unknown"}
_BY_FEM = 25  # one seed in so many is also asked of the finite elements


def tried(seed: int) -> dict[str, Any]:
    """What was answered about the case of a seed and what is wrong with it, for one line of JSON."""
    return tried_case(drawn(seed))


def tried_case(case: Case) -> dict[str, Any]:
    """What was answered about a case and what is wrong with it, for one line of JSON."""
    begun = time.process_time()
    told: dict[str, Any] = {
        "seed": case.seed, "kind": case.kind, "cables": len(case.robot.cables), "gravity": case.robot.gravity,
        "free": case.free, "violations": [],
    }  # fmt: skip
    faults = told["violations"]
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        try:
            with _limited():
                _judge(case, told, faults)
        except _TooLongError:
            faults.append(f"time: more than {_LONGEST:g} s")
    faults += sorted({f"warning: {each.category.__name__}: {each.message}" for each in heard})
    told["seconds"] = round(time.process_time() - begun, 3)
    return told


def _judge(case: Case, told: dict[str, Any], faults: list[str]) -> None:
    held = _asked("inverse", case, told, faults, None, case.robot, case.pose, free=case.free)
    if held is None:
        return
    forces = held.solution.cables.force_on_platform
    own = own_rest(case.robot, held.pose, held.answer["lengths_m"], forces)
    told |= {"stable": held.answer["stable"], "balance": own.unbalanced}
    faults += [f"inverse: {fault}" for fault in rest_faults(own, forces, held.answer)]
    _judge_way_back(case, held, own, told, faults)
    _judge_further(case, held, own, told, faults)
    found = _asked("modes", case, told, faults, own, case.robot, held.pose, free=case.free, count=_COUNT)
    if found is not None:
        there = _rest_of(case, found)
        faults += [f"modes: {fault}" for fault in mode_faults(found.modes.hertz, found.answer, there)]
        if case.seed % _BY_FEM == 0:
            _judge_by_fem(found, told, faults)
        count = 6 - len(case.robot.guided)
        rigid = _asked(
            "static", case, told, faults, own, case.robot, held.pose, free=case.free, model="static", count=count
        )
        if rigid is not None:
            faults += [f"static: {fault}" for fault in static_faults(rigid.modes.hertz, _rest_of(case, rigid))]


def _judge_further(case: Case, held: Any, own: OwnRest, told: dict[str, Any], faults: list[str]) -> None:
    error = _asked("pose_error", case, told, faults, own, case, held.pose)
    if error is not None:
        faults += [f"pose error: {fault}" for fault in pose_error_faults(case, held.pose, error)]
    spread = None if case.free else _asked("distribute", case, told, faults, own if taut(case, held) else None, case)
    if spread is not None:
        faults += [f"distribute: {fault}" for fault in distribution_faults(case, held, spread)]


def _judge_by_fem(found: Any, told: dict[str, Any], faults: list[str]) -> None:
    try:
        said = fem_verdict(found.point, found.modes.hertz)
        told["fem"] = "confirmed" if not said.faults else "differs"
        told |= {"fem_off": said.off, "fem_share": said.share, "fem_compared": said.compared}
        faults += [f"finite elements: {fault}" for fault in said.faults]
    except FemError as error:
        told["fem"] = f"{type(error).__name__}: {error}"


def _rest_of(case: Case, found: Any) -> OwnRest:
    """The rest about which frequencies were asked: a search from the orientation found may end at another one."""
    point = found.point
    return own_rest(
        case.robot, (point.position, point.rotation), found.answer["lengths_m"], point.cables.force_on_platform
    )


def _judge_way_back(case: Case, held: Any, own: OwnRest, told: dict[str, Any], faults: list[str]) -> None:
    back = _asked("forward", case, told, faults, own, case.robot, held.answer["lengths_m"], start=case.start)
    if back is None:
        return
    rest, forces = back.rest.solution, back.rest.solution.cables.force_on_platform
    there = own_rest(case.robot, (rest.position, rest.rotation), back.answer["lengths_m"], forces)
    told |= {"balance_forward": there.unbalanced, "rivals": len(back.answer["locked"]["other_equilibria"])}
    faults += [f"forward: {fault}" for fault in rest_faults(there, forces, back.answer)]
    faults += [f"forward: {fault}" for fault in way_back_faults(case, held, back)]


def _asked(
    step: str, case: Case, told: dict[str, Any], faults: list[str], own: OwnRest | None, *args: Any, **named: Any
) -> Any:
    """The answer to a question of the program, None if it refuses."""
    question = {"inverse": cs.inverse, "forward": cs.forward, "pose_error": error_at, "distribute": distributed}.get(
        step, cs.modes
    )
    try:
        answer = question(*args, **named)
    except _TooLongError:
        raise
    except Exception as error:
        told[step] = f"{type(error).__name__}: {error}"
        faults += [f"{step}: {fault}" for fault in refusal_faults(case, step, error, own)]
        if step == "inverse" and isinstance(error, cs.UnholdablePoseError):
            told["holdable"] = _reached(case)
        return None
    told[step] = "answered"
    faults += [f"{step}: not a number: {name}" for name in not_numbers(answer.answer)]
    return answer


def _reached(case: Case) -> str:
    """Whether cables can hold a pose that is refused: a proof, or what the study's own cables say."""
    said = holdable(case.robot, case.pose, case.free is not None)
    return OWN_WORD[out_of_reach(case)] if said == "unknown" and case.free is None else said


class _TooLongError(Exception):
    """A seed takes longer than any should."""


@contextmanager
def _limited() -> Iterator[None]:
    """Work that ends after `_LONGEST` seconds of the processor."""

    def stop(*_: object) -> None:
        raise _TooLongError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, _LONGEST)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def worst_balance(told: dict[str, Any]) -> float:
    """Over load and tensions, of the rests that were answered."""
    return float(np.max([told.get("balance", 0.0), told.get("balance_forward", 0.0)]))
