"""What is wrong with the answers about one robot: sentences, none if all is well."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

import cdpr_struct as cs
from benchmarks.random_robots.case import Case
from benchmarks.random_robots.own_mechanics import OwnRest
from benchmarks.random_robots.refusals import holdable

BALANCED = 1e-9  # of load and tensions
_FITS = 1e-9  # of the chord: by how much the cables' own shape may miss their ends
_SAME_FORCE = 1e-7  # of load and tensions
_SAME_POSE = 1e-5  # of the size of the platform
_SAME_FREQUENCY = 1e-5  # spans of cables that lean by nanometres are rounded
_SHARP = 1e-8  # of the largest stiffness: what counts as zero


def not_numbers(answer: Mapping[str, Any], name: str = "") -> Iterator[str]:
    """Names of values in an answer that are not finite."""
    for key, value in answer.items():
        if isinstance(value, Mapping):
            yield from not_numbers(value, f"{name}{key}.")
        elif isinstance(value, np.ndarray | float) and not np.isfinite(np.asarray(value, dtype=float)).all():
            yield f"{name}{key}"


def rest_faults(own: OwnRest, forces: np.ndarray, answer: Mapping[str, Any]) -> Iterator[str]:
    """What is wrong with a rest that is answered: forces (m, 3) that the program prints [N]."""
    yield from rest_balance_faults(own, forces)
    verdict, neutral = own.verdict(_SHARP), len(answer["neutral_freedoms"])
    if (answer["stable"] and verdict == "unstable") or (not answer["stable"] and verdict == "stable"):
        yield f"stability: {verdict} (least eigenvalue {own.eigenvalues[0]:.1e}), told stable = {answer['stable']}"
    if answer["stable"] and neutral and verdict == "stable":
        yield f"neutral: {neutral} told, the least eigenvalue is {own.eigenvalues[0]:.1e}"


def rest_balance_faults(own: OwnRest, forces: np.ndarray) -> Iterator[str]:
    """What is wrong with the balance of a rest: forces (m, 3) that the program prints [N]."""
    if own.misfit > _FITS:
        yield f"lengths: the cables' ends are missed by {own.misfit:.1e} of the chord"
    elif np.abs(forces - own.forces).max() > _SAME_FORCE * own.scale:
        yield f"forces: off by {np.abs(forces - own.forces).max() / own.scale:.1e}"
    if own.unbalanced > BALANCED:
        yield f"balance: {own.unbalanced:.1e} is left"


def way_back_faults(case: Case, held: "cs.Result", back: "cs.Result") -> Iterator[str]:
    """What is wrong if lengths do not lead back to the pose that they hold."""
    told = back.answer["locked"]["other_equilibria"]
    neutral = held.answer["neutral_freedoms"] or back.answer["neutral_freedoms"]
    pose = np.asarray(held.answer["pose"])
    found = [np.asarray(back.answer["pose"]), *(np.asarray(one["pose"]) for one in told)]
    apart = [_apart(case, pose, one) for one in found]
    if held.answer["stable"] and not neutral and min(apart) > _SAME_POSE and not told:
        yield f"pose: {min(apart):.1e} of the platform's size off, and no other equilibrium is told"


def _apart(case: Case, one: np.ndarray, other: np.ndarray) -> float:
    """Largest distance of an anchor at two poses [m, deg], over the size of the platform."""
    first, second = (cs.Pose.from_degrees(pose) for pose in (one, other))
    anchors = case.robot.platform_anchors
    size = max(float(np.abs(anchors).max()), 1e-2 * float(np.abs(case.robot.frame_anchors).max()))
    moved = first.position - second.position + anchors @ (first.rotation - second.rotation).T
    return float(np.linalg.norm(moved, axis=1).max()) / size


def mode_faults(hertz: np.ndarray, answer: Mapping[str, Any], own: OwnRest) -> Iterator[str]:
    """What is wrong with natural frequencies (k,) of cables with mass [Hz]."""
    if not (np.isfinite(hertz).all() and (hertz >= 0.0).all()):
        yield f"frequencies: {hertz.tolist()}"
    if (np.diff(hertz) < 0.0).any():
        fallen = float((-np.diff(hertz) / np.maximum(hertz[:-1], 1e-300)).max())
        yield f"order: a frequency is {fallen:.1e} below the one before"
    if not answer["count_certified"]:
        yield "count: not certified"
    zeros, neutral = int((hertz == 0.0).sum()), len(answer["neutral_freedoms"])
    if zeros != min(neutral, len(hertz)):
        yield f"neutral: {zeros} frequencies are zero, {neutral} freedoms are told"
    if own.verdict(_SHARP) == "unstable":
        yield f"stability: frequencies of an unstable rest ({own.eigenvalues[0]:.1e})"


def static_faults(hertz: np.ndarray, own: OwnRest) -> Iterator[str]:
    """What is wrong with frequencies (f,) of the platform on massless cables [Hz]."""
    expected = own.hertz()
    large = expected > 1e-3 * expected[-1]
    off = np.abs(np.sort(hertz) / np.where(large, expected, 1.0) - 1.0)[large]
    if off.size and off.max() > _SAME_FREQUENCY:
        yield f"static frequencies: off by {off.max():.1e}"


def refusal_faults(case: Case, step: str, error: Exception, own: OwnRest | None) -> Iterator[str]:
    """What is wrong with a refusal; `own` rest, where the pose is held."""
    said = f"{error!s:.160}"
    if not isinstance(error, cs.CdprError):
        yield f"exception: {type(error).__name__}: {said}"
    elif isinstance(error, cs.InputError | cs.ConvergenceError) or "cannot be computed" in said:
        yield f"{type(error).__name__}: {said}"
    elif own is None:
        if not isinstance(error, cs.UnholdablePoseError):
            yield f"{step} refused: {said}"
        elif case.free is None and holdable(case.robot, case.pose) == "yes":
            yield f"refused though taut cables hold it: {said}"
    elif step == "pose_error" and isinstance(error, cs.UnholdablePoseError):
        return  # ideal cables, or springs, hold less
    elif not _true_of_rest(error, said, own):
        yield f"{step} refused (least eigenvalue {own.eigenvalues[0]:.1e}): {said}"


def _true_of_rest(error: Exception, said: str, own: OwnRest) -> bool:
    if isinstance(error, cs.UnstableEquilibriumError):
        return own.verdict(_SHARP) != "stable"
    return "slack cable has no shape" in said and bool(np.linalg.norm(own.forces, axis=1).min() == 0.0)
