"""One sentence on the damping that acts: which law, which numbers, and where they come from."""

import numpy as np

from cdpr_struct.dynamics.damping import Damping, Hysteretic, ModalDamping, PowerLaw, Rayleigh, Viscous
from cdpr_struct.dynamics.rubbing_motion import EndFriction
from cdpr_struct.robot.robot import Robot

UNBOUNDED_PEAKS = "peaks are unbounded"
ENDLESS_VIBRATION = "the vibration does not decay"
_MOST_MODES = 4


def damping_note(damping: Damping, option: str, robot: Robot, massless: bool, undamped: str = UNBOUNDED_PEAKS) -> str:
    """A sentence for screens, pages and result.json.

    Parameters
    ----------
    option : as --damping was written (or its default); without numbers the robot file's damping_ratio holds
    massless : the cable model gives the cables no mass (`static`)
    undamped : what it means for the result if nothing damps
    """
    of_file = ":" not in option and option != "none"
    if of_file and not robot.damping_ratio.any():
        return (
            f"The robot file has no damping_ratio above zero: the cables are undamped and {undamped}; "
            "give --damping viscous:0.01 or a damping_ratio."
        )
    if isinstance(damping, ModalDamping):
        what, loses = _modal(damping), any(damping.ratios)
    elif isinstance(damping, Viscous):
        what, loses = _viscous(damping, of_file, massless)
    elif isinstance(damping, Rayleigh):
        what, loses = _rayleigh(damping, massless)
    elif isinstance(damping, Hysteretic | PowerLaw):
        what, loses = _loss_factor(damping, of_file), damping.loss_factor > 0.0
    else:
        what, loses = "No damping (option)", False
    return f"{what}." if loses else f"{what}: {undamped}."


def friction_note(friction: EndFriction) -> str:
    """A sentence on dry friction at the ends of the cables."""
    said = [
        f"{radius:g} m times the tension at the {name} ends, built up over {angle:g} rad"
        for name, (radius, angle) in (("frame", friction.frame), ("platform", friction.platform))
        if radius > 0.0
    ]
    return f"Dry friction at the ends of the cables: {'; '.join(said) or 'none'}."


def _viscous(law: Viscous, of_file: bool, massless: bool) -> tuple[str, bool]:
    if massless:
        return "Viscous damping brakes the cables' mass, which this cable model leaves out", False
    source = "of the robot file" if of_file else "(option)"
    each = "" if np.ptp(law.ratio) == 0.0 else " (cable by cable)"
    what = f"Viscous damping of each cable, at its first mode with the damping ratio {_range(law.ratio)} {source}{each}"
    return what, bool(law.ratio.any())


def _rayleigh(law: Rayleigh, massless: bool) -> tuple[str, bool]:
    mass = f"{law.mass_rate:g} 1/s times their mass" + (", which this cable model leaves out," if massless else "")
    loses = law.stiffness_time > 0.0 or (law.mass_rate > 0.0 and not massless)
    return f"Rayleigh damping of the cables, {mass} and {law.stiffness_time:g} s times their stiffness (option)", loses


def _loss_factor(law: Hysteretic | PowerLaw, of_file: bool) -> str:
    source = ", twice the mean damping_ratio of the robot file" if of_file else " (option)"
    if isinstance(law, Hysteretic):
        return f"Hysteretic damping, loss factor {law.loss_factor:g}{source}"
    own = law.reference_omega is None
    place = "each cable's first frequency" if own else f"{(law.reference_omega or 0.0) / (2.0 * np.pi):g} Hz"
    what = f"loss factor {law.loss_factor:g} at {place}, exponent {law.exponent:g}"
    return f"Frequency-dependent damping, {what}{source}"


def _modal(damping: ModalDamping) -> str:
    ratios = damping.ratios
    if len(ratios) == 1:
        return f"Modal damping, ratio {ratios[0]:g} of all modes of the robot (option)"
    last = f"{ratios[-1]:g} of mode {len(ratios)} and all higher modes of the robot (option)"
    if len(ratios) > _MOST_MODES:
        return f"Modal damping, ratios {_range(np.array(ratios[:-1]))} of modes 1 to {len(ratios) - 1} and {last}"
    first = ", ".join(f"{ratio:g} of mode {i}" for i, ratio in enumerate(ratios[:-1], start=1))
    return f"Modal damping, ratio {first} and {last}"


def _range(values: np.ndarray) -> str:
    low, high = float(values.min()), float(values.max())
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"
