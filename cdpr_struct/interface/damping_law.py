"""The damping that an argument names: a law, with its numbers."""

import numpy as np

from cdpr_struct.dynamics import damping
from cdpr_struct.dynamics.rubbing_motion import EndFriction
from cdpr_struct.errors import InputError
from cdpr_struct.interface.arguments import read_numbers
from cdpr_struct.robot.robot import Robot

_COUNTS = {"none": (0,), "viscous": (0, 1), "hysteretic": (0, 1), "rayleigh": (2,), "frequency-dependent": (0, 2, 3)}
_MODAL = "modal"
_HIGHEST = {"viscous": 1.0, "hysteretic": 2.0, "frequency-dependent": 2.0}


def read_damping(text: str, robot: Robot, massless: bool = False) -> damping.Damping:
    """The law of cable damping, or modal damping; a law without numbers is fitted to the robot file's damping ratio at
    the first mode.

    Raises
    ------
    InputError : an unknown law, or numbers that are missing, negative or too large.
    """
    name, _, numbers = text.partition(":") if isinstance(text, str) else ("", "", "")
    if name not in (*_COUNTS, _MODAL):
        raise InputError("damping", "", text, f"one of: {', '.join((*_COUNTS, _MODAL))}")
    if name == _MODAL:
        return _modal(numbers, text)
    values = read_numbers(numbers, "damping", None, "numbers") if numbers else []
    if len(values) not in _COUNTS[name]:
        wanted = " or ".join(map(str, _COUNTS[name]))
        raise InputError("damping", name, text, f"give {wanted} numbers, like rayleigh:0.1,1e-5")
    if values and not 0.0 <= values[0] < _HIGHEST.get(name, float("inf")):
        raise InputError("damping", name, text, f"the first number must be in [0, {_HIGHEST.get(name, 'inf')})")
    return _law(name, values, robot, text, massless)


def read_end_friction(text: str) -> EndFriction:
    """Dry friction at the ends of the cables: `WHERE:R,S`, WHERE frame, platform or both, R in m, S in rad; two of them
    with a semicolon between.

    Raises
    ------
    InputError : something else.
    """
    expected = "give WHERE:R,S with frame, platform or both, R >= 0 in m and S > 0 in rad, like platform:0.0001,0.003"
    found: dict[str, tuple[float, float]] = {}
    for part in text.split(";") if isinstance(text, str) else ():
        where, _, numbers = part.strip().partition(":")
        ends = ("frame", "platform") if where == "both" else (where,)
        if not {*ends} <= {"frame", "platform"} or {*ends} & found.keys() or not numbers:
            raise InputError("end_friction", "", text, expected)
        radius, angle = read_numbers(numbers, "end_friction", (2,), "numbers: R in m and S in rad")
        if radius < 0.0 or angle <= 0.0:
            raise InputError("end_friction", where, text, expected)
        found |= dict.fromkeys(ends, (radius, angle))
    if not found:
        raise InputError("end_friction", "", text, expected)
    return EndFriction(found.get("frame", (0.0, 1.0)), found.get("platform", (0.0, 1.0)))


def _modal(numbers: str, text: str) -> damping.ModalDamping:
    expected = "give the ratios of modes 1, 2, .., each in [0, 1), like modal:0.01,0.012"
    if not numbers:
        raise InputError("damping", _MODAL, text, expected)
    ratios = read_numbers(numbers, "damping", None, "damping ratios")
    if not all(0.0 <= ratio < 1.0 for ratio in ratios):
        raise InputError("damping", _MODAL, text, expected)
    return damping.ModalDamping(tuple(ratios))


def _law(name: str, values: list[float], robot: Robot, text: str, massless: bool) -> damping.DampingLaw:
    of_file = robot.damping_ratio
    loss = values[0] if values else 2.0 * float(of_file.mean())
    if name == "none":
        return damping.Undamped()
    if name == "viscous":
        return damping.Viscous(np.full_like(of_file, values[0]) if values else of_file)
    if name == "hysteretic":
        return damping.Hysteretic(loss)
    if name == "rayleigh":
        if values[1] < 0.0:
            raise InputError("damping", name, text, "B must be zero or more")
        return damping.Rayleigh(values[0], values[1])
    exponent = values[1] if values else 1.0
    if abs(exponent) > 4.0:
        raise InputError("damping", name, text, "give an exponent between -4 and 4")
    if len(values) < 3 and massless:
        raise InputError("damping", name, text, "massless cables have no first mode: give ETA,EXPONENT,F_REF_HZ")
    if len(values) == 3 and not values[2] > 0.0:
        raise InputError("damping", name, text, "F_REF_HZ must be above zero")
    return damping.PowerLaw(loss, exponent, 2.0 * np.pi * values[2] if len(values) == 3 else None)
