"""In which directions the platform is free to move, and which a guide holds: as numbers and in words."""

from typing import Any

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.text import place
from cdpr_struct.robot.robot import FREEDOMS
from cdpr_struct.statics.equilibrium import PlatformArms, tangent_stiffness
from cdpr_struct.statics.guides import guide_reaction
from cdpr_struct.statics.neutral_freedoms import NEUTRAL, stability

_SMALL = 1e-9
_BY_SYMMETRY = "no cable end moves, and the weight does no work"
_BY_SIZE = f"its stiffness is below {NEUTRAL:g} of the largest; only terms of higher order could hold it"


def freedoms_json(point: OperatingPoint, wrench: np.ndarray | list[float] | None = None) -> dict[str, Any]:
    """The result's `neutral_freedoms` and, for a guided platform, `guide`.

    wrench : (6,) on the platform beside its weight, world axes [N, N m]
    """
    arrays, place_, turn = point.arrays, point.position, point.rotation
    tangent = tangent_stiffness(arrays, point.cables, PlatformArms.at(arrays, place_, turn))
    held = stability(arrays, turn, tangent)
    told: dict[str, Any] = {"neutral_freedoms": [], "gravity_m_s2": arrays.gravity * arrays.down}
    if not held.unstable:
        motions = _plain_basis(held.twists)
        proved = bool(held.proved.all())
        told["neutral_freedoms"] = [_entry(motion, place_, told["gravity_m_s2"], proved) for motion in motions]
    if arrays.has_guides:
        extra = np.zeros(6) if wrench is None else np.asarray(wrench, dtype=float)
        reaction = guide_reaction(arrays, place_, turn, point.cables, extra)
        names = [name for name, guided in zip(FREEDOMS, arrays.guided, strict=True) if guided]
        told["guide"] = {"holds": names, "reaction_wrench": reaction}
    return told


def _entry(motion: np.ndarray, position: np.ndarray, down: np.ndarray, proved: bool) -> dict[str, Any]:
    reason = _BY_SYMMETRY if proved else _BY_SIZE
    return {"motion": motion, "words": _words(motion, position, down), "by_symmetry": proved, "reason": reason}


def _words(motion: np.ndarray, position: np.ndarray, down: np.ndarray) -> str:
    shift, turn = motion[:3], motion[3:]
    size = float(turn @ turn)
    if size < _SMALL:
        return f"moving {_direction(shift, down, 'vertically', 'along')}"
    pitch = float(turn @ shift) / size
    through = place(position + np.cross(turn, shift) / size)
    advancing = f", advancing {pitch:.4g} m per radian" if abs(pitch) > 1e-6 else ""
    return f"turning about {_direction(turn, down, 'the vertical axis', 'an axis along')} through {through}{advancing}"


def _direction(vector: np.ndarray, down: np.ndarray, vertical: str, along: str) -> str:
    """`vertical` where the vector lies along gravity (3,) which is not zero, else `along` what it lies."""
    unit = vector / np.linalg.norm(vector)
    if abs(float(unit @ down)) > (1.0 - _SMALL) * np.linalg.norm(down) > 0.0:
        return vertical
    names = [name for name, part in zip("xyz", unit, strict=True) if abs(abs(part) - 1.0) < _SMALL]
    return f"{along} {names[0] if names else place(unit).removesuffix(' m')}"


def _plain_basis(twists: np.ndarray) -> list[np.ndarray]:
    """Motions (6,) that span the columns of (6, k), each with as few components as can be, rotations first."""
    order = [5, 4, 3, 2, 1, 0]
    rows, found = twists.T[:, order].copy(), 0
    for column in range(6):
        rest = np.abs(rows[found:, column])
        if not rest.size or rest.max() < 1e-7 * np.abs(rows).max():
            continue
        pivot = found + int(rest.argmax())
        rows[[found, pivot]] = rows[[pivot, found]]
        rows[found] /= rows[found, column]
        others = np.arange(len(rows)) != found
        rows[others] -= rows[others, column : column + 1] * rows[found]
        found += 1
    motions = rows[:, np.argsort(order)]
    sizes = [np.linalg.norm(m[3:]) or np.linalg.norm(m[:3]) for m in motions]
    return [np.where(np.abs(m) < 1e-12, 0.0, m / size) for m, size in zip(motions, sizes, strict=True)]
