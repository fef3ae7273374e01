"""Masts as what they are: uprights on a foot that turns a little, which bend sideways and do not shorten.

A force F at one height bends an upright of bending stiffness EI at another by F l^2 (3 h - l) / 6 EI, l and h the lower
and the higher of the two, and turns its foot, of rotational stiffness k, so that it leans by F l h / k. The size of an
effect is the compliance H^3 / 3 EI + H^2 / k at the top exit, so that an exit lower down gives way less, and one on
the floor not at all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, lil_array

from tests.blind.entered_robot import EnteredRobot

FLOOR = 0.0  # m, where masts are clamped
FOOT = 0.3  # of the compliance at the top comes from the foot: anchor bolts and base plates give way
ONE_LEVEL = 0.1  # m, exits nearer to each other in height move alike
MASTS = 4


@dataclass(frozen=True, eq=False)
class Cantilever:
    """A mast with exits above the floor.

    number      : of the mast;  cables : (k,) those that leave it above the floor
    level       : (k,) which of its r heights each leaves at
    flexibility : (r, r) deflection at each height by a force at each, for a compliance of one at the top
    """

    number: int
    cables: np.ndarray
    level: np.ndarray
    flexibility: np.ndarray


def cantilevers(robot: EnteredRobot) -> tuple[Cantilever, ...]:
    """The masts of a robot."""
    heights = robot.frame_anchors[:, 2] - FLOOR
    return tuple(_cantilever(number, np.flatnonzero(robot.masts == number), heights) for number in range(MASTS))


def _cantilever(number: int, cables: np.ndarray, heights: np.ndarray) -> Cantilever:
    above = cables[heights[cables] > ONE_LEVEL]
    nearest, level = np.unique(np.round(heights[above] / ONE_LEVEL), return_inverse=True)
    levels = np.array([heights[above][level == index].mean() for index in range(len(nearest))])
    low, high = np.minimum.outer(levels, levels), np.maximum.outer(levels, levels)
    top = levels.max(initial=FLOOR)
    bent, leaning = low**2 * (3.0 * high - low) / (2.0 * top**3), low * high / top**2
    return Cantilever(number, above, level, (1.0 - FOOT) * bent + FOOT * leaning)


def mast_deflections(robot: EnteredRobot, compliance: np.ndarray, pulls: np.ndarray) -> np.ndarray:
    """Shift (m, 3) [m] of the exits under pulls (m, 3) [N] of the cables; compliance (4,) [m/N] at the tops."""
    moved = np.zeros_like(pulls)
    for mast in cantilevers(robot):
        share = mast.flexibility[np.ix_(mast.level, mast.level)]
        moved[mast.cables, :2] = compliance[mast.number] * share @ pulls[mast.cables, :2]
    return moved


def mast_springs(robot: EnteredRobot, compliance: np.ndarray) -> np.ndarray:
    """Stiffness (d, d) [N/m] of the soft masts alone: of each the x of all its heights, then the y."""
    blocks = [np.linalg.inv(compliance[m.number] * m.flexibility) for m in _soft(robot, compliance)]
    size = 2 * sum(len(block) for block in blocks)
    springs, first = np.zeros((size, size)), 0
    for block in blocks:
        for _ in "xy":
            own = slice(first, first + len(block))
            springs[own, own] = block
            first += len(block)
    return springs


def mast_motion(robot: EnteredRobot, compliance: np.ndarray) -> np.ndarray:
    """Motion (m, 3, d) of the exits by the unknowns of `mast_springs`."""
    soft = _soft(robot, compliance)
    motion, first = np.zeros((robot.cables, 3, 2 * sum(len(m.flexibility) for m in soft))), 0
    for mast in soft:
        for axis in range(2):
            motion[mast.cables, axis, first + mast.level] = 1.0
            first += len(mast.flexibility)
    return motion


def _soft(robot: EnteredRobot, compliance: np.ndarray) -> list[Cantilever]:
    return [mast for mast in cantilevers(robot) if compliance[mast.number] > 0.0 and len(mast.cables)]


def exit_blocks(first: np.ndarray, motion: np.ndarray, unknowns: int, elements: int) -> tuple[csc_array, np.ndarray]:
    """Coupling (d, unknowns) of moving exits with the first free nodes, and their own block (d, d).

    first : (m, 6, 6) matrices of the first bars;  motion : (m, 3, d) of their starts
    """
    between = lil_array((motion.shape[2], unknowns))
    for cable, (bar, start) in enumerate(zip(first, motion, strict=True)):
        node = 3 * (elements - 1) * cable
        between[:, node : node + 3] = start.T @ bar[:3, 3:]
    own = np.einsum("mad,mab,mbe->de", motion, first[:, :3, :3], motion)
    return csc_array(between), own
