"""Where do the cables of a robot leave their pulleys, and how much slides in from what is elastic behind?

With the exits held, the robot is a plain one: frame anchors at the exits, lengths less what lies on the
pulleys. Its first bars say where the exits should be. Repeating that settles fast, since an exit moves by about
radius / cable length of what its cable's end moves. No energy is needed to find the exits: moving one along
its tangent costs nothing to first order, as the path length over a pulley is stationary where it is tangent.
A winch that holds a tension pays out what its first bar lacks.
What slides in grows with the tension; between two rounds it is part of the first bar's own flexibility
(`CableBatch.line_give`), so that it settles as fast however soft the line is.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from cdpr_struct.fem_reference.cable import CableData, CableEquilibrium
from cdpr_struct.fem_reference.cable_statics import CableBatch
from cdpr_struct.fem_reference.pulley import PulleyData, Wrap, wrapped
from cdpr_struct.fem_reference.robot import RobotData
from cdpr_struct.fem_reference.sliding_bar import Eyelet
from cdpr_struct.fem_reference.winch import SOFTER, Winch

Wraps = tuple[Wrap | Eyelet | Winch | None, ...]


def guessed_wraps(robot: RobotData, position: np.ndarray, rotation: np.ndarray) -> Wraps:
    """Wraps of weightless cables that run straight to a platform at a pose, under no tension."""
    chords = position + robot.platform_anchors @ rotation.T - robot.frame_anchors
    none = np.zeros(len(chords))
    return wraps_towards(robot, chords, none, np.zeros_like(chords), none)


def wraps_towards(
    robot: RobotData, first_bars: np.ndarray, tensions: np.ndarray, half_weights: np.ndarray, drawn: np.ndarray
) -> Wraps:
    """Wraps for first bars of directions (m, 3), tensions (m,) [N], half weights (m, 3) [N], lengths drawn (m,) [m]."""
    pulleys = robot.pulleys or (None,) * len(robot.cables)
    each = zip(pulleys, robot.cables, robot.frame_anchors, first_bars, tensions, half_weights, drawn, strict=True)
    return tuple(_start(*one) for one in each)


def _start(
    pulley: PulleyData | None,
    cable: CableData,
    anchor: np.ndarray,
    bar: np.ndarray,
    tension: float,
    half_weight: np.ndarray,
    drawn: float,
) -> Wrap | Eyelet | Winch | None:
    """How a cable starts: over its pulley, through an eyelet, from a winch, or held."""
    if cable.winch_tension:
        return Winch.at(anchor, cable.winch_tension, float(drawn), cable.unstrained_length, bar, half_weight)
    stiffness, behind = cable.axial_stiffness, cable.path_behind
    if pulley is not None:
        return wrapped(pulley, anchor, bar, float(tension), half_weight, stiffness, behind)
    return Eyelet.at(anchor, behind, bar, float(tension), half_weight, stiffness) if behind else None


def sliding_in(batch: CableBatch, handed: np.ndarray, tensions: np.ndarray, wraps: Wraps) -> CableBatch:
    """The cables with forces handed on (m, 3) [N], about first bars of tensions (m,) [N] whose lengths they have."""
    give = np.array([cable.line_give for cable in batch.cables]) / (1.0 + tensions / batch.axial_stiffness)
    winch = np.array([isinstance(wrap, Winch) for wrap in wraps])
    wanted = np.array([wrap.bar_tension if isinstance(wrap, Winch) else 0.0 for wrap in wraps])
    give = np.where(winch, SOFTER * batch.unstrained_length / batch.axial_stiffness, give)
    return dataclasses.replace(batch, handed_on=handed, line_give=give, line_tension=np.where(winch, wanted, tensions))


def drawn_from_winches(wraps: Wraps, batch: CableBatch, tensions: np.ndarray) -> np.ndarray:
    """Unstrained lengths (m,) [m] drawn from winches beyond the guessed ones, first bars having tensions (m,) [N]."""
    before = np.array([wrap.drawn if isinstance(wrap, Winch) else 0.0 for wrap in wraps])
    more = batch.line_give * (tensions - batch.line_tension) / (1.0 + tensions / batch.axial_stiffness)
    winch = np.array([isinstance(wrap, Winch) for wrap in wraps])
    return np.where(winch, before + more, 0.0)


def handed_on(wraps: Wraps, bars: np.ndarray) -> np.ndarray:
    """Forces (m, 3) [N] by which the weights that ride on the exits act on the first free nodes; bars (m,) [m]."""
    pairs = zip(wraps, bars, strict=True)
    return np.array([np.zeros(3) if wrap is None else wrap.handed_on(float(bar)) for wrap, bar in pairs])


def unwound(robot: RobotData, wraps: Wraps) -> RobotData:
    """The robot without pulleys and eyelets: frame anchors at the exits, lengths of what lies beyond them."""
    pairs = list(zip(robot.cables, robot.frame_anchors, wraps, strict=True))
    anchors = [anchor if wrap is None else wrap.exit_point for _, anchor, wrap in pairs]
    return dataclasses.replace(
        robot,
        frame_anchors=np.array(anchors),
        cables=tuple(_beyond(cable, wrap) for cable, _, wrap in pairs),
        pulleys=(),
    )


def _beyond(cable: CableData, wrap: Wrap | Eyelet | Winch | None) -> CableData:
    if wrap is None:
        return cable
    beyond = cable.unstrained_length + wrap.behind - wrap.unstrained_length
    return dataclasses.replace(cable, unstrained_length=beyond)


def movement(before: Wraps, after: Wraps) -> tuple[float, float]:
    """Largest change [m] of an exit point or wrapped length between two rounds, and what counts as round-off."""
    moved, floor = 0.0, 0.0
    for old, new in zip(before, after, strict=True):
        if old is not None and new is not None:
            exit_moved = float(np.linalg.norm(new.exit_point - old.exit_point))
            moved = max(moved, exit_moved, abs(new.unstrained_length - old.unstrained_length))
            radius = new.pulley.radius if isinstance(new, Wrap) else 0.0
            place = float(np.abs(new.exit_point).max()) + radius + new.behind
            floor = max(floor, 1e-11 * radius + 64.0 * float(np.finfo(float).eps) * place)
    return moved, floor


def rewrapped(cables: tuple[CableEquilibrium, ...], wraps: Wraps) -> tuple[CableEquilibrium, ...]:
    """The cables at rest, each told of its wrap."""
    return tuple(dataclasses.replace(cable, wrap=wrap) for cable, wrap in zip(cables, wraps, strict=True))
