"""The first frequencies of a robot by finite elements on meshes that double, and how certain their limit is."""

from dataclasses import dataclass

import numpy as np

import cdpr_struct.fem_reference as fem
from benchmarks.robot_reference import romberg
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.operating_point import OperatingPoint

_MESHES = (20, 40, 80, 160)
_FINER = (40, 80, 160, 320, 640)
_SURE = 10.0  # times what the finest mesh changed
_FLOOR = 1e-6  # of a frequency: rounding of fine meshes


@dataclass(frozen=True, slots=True)
class FemVerdict:
    """faults : what is wrong with frequencies;  off : largest relative difference;  share : largest, of what is sure;
    compared : how many frequencies."""

    faults: tuple[str, ...]
    off: float = 0.0
    share: float = 0.0
    compared: int = 0


def fem_verdict(point: OperatingPoint, hertz: np.ndarray) -> FemVerdict:
    """What the finite elements say of natural frequencies (k,), neutral ones among them [Hz].

    Raises
    ------
    FemError : the finite elements find no rest or no modes.
    """
    said = _compared(point, hertz, _MESHES)
    return _compared(point, hertz, _FINER) if said.faults else said


def _compared(point: OperatingPoint, hertz: np.ndarray, meshes: tuple[int, ...]) -> FemVerdict:
    rests = [solve_in_fem(point, elements) for elements in meshes]
    neutral = fem.neutral_freedoms(rests[-1])
    if neutral != (hertz == 0.0).sum():
        return FemVerdict((f"neutral: {neutral} freedoms in the finite elements",))
    asked = hertz[neutral:]
    values = [fem.robot_modes(rest, len(hertz)).frequencies_hz[neutral:] for rest in rests]
    best, coarser = romberg(values), romberg(values[:-1])
    tolerance = _FLOOR + _SURE * np.abs(coarser / best - 1.0)
    off = np.abs(asked / best - 1.0)
    share = off / tolerance
    worst = int(share.argmax())
    fault = f"frequency {worst + 1}: {off[worst]:.1e} from the finite elements, sure to {tolerance[worst]:.1e}"
    return FemVerdict((fault,) if share[worst] > 1.0 else (), float(off.max()), float(share[worst]), len(asked))
