"""What the readings do to the truth."""

from functools import partial

import numpy as np

from cdpr_struct.diagnosis.causes.cause import Cause, Parameter
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.world import World

COMMON = "the same everywhere"  # of internal force, not another one in each state


def _gain(world: World, theta: np.ndarray) -> World:
    return world.times(cell_gain=np.exp(theta))


def _bias(world: World, theta: np.ndarray) -> World:
    return world.plus(cell_bias=theta)


def _friction(world: World, theta: np.ndarray) -> World:
    return world.plus(friction=theta)


def _slip(world: World, theta: np.ndarray) -> World:
    return world.plus(slip=theta)


def _cells(setting: Setting) -> str:
    sheets = setting.campaign.sheets
    unread = bool(sheets) and not any("tension_N" in sheet.columns for sheet in sheets)
    return "needs tensions" if unread or not setting.held.size else ""


def _approach(setting: Setting) -> str:
    return "" if np.any(setting.known.approach) else "needs a column approach (+1 or -1)"


def _times(setting: Setting) -> str:
    return "" if np.ptp(setting.known.hours) > 0.01 else "needs time_s"


def _null_space(setting: Setting) -> str:
    return (
        "" if setting.sent.null_space.any() else "needs tensions of a redundant robot at states without encoder lengths"
    )


CAUSES = (
    Cause(
        "load_cell_gain",
        "gain of the load cells",
        (Parameter("gain", "ratio", 0.03, True),),
        _gain,
        True,
        seen_in=("EQ", "CO", "CF"),
        sentence="the load cells read {percent} of the tension",
        needs=_cells,
        separated_by="a payload series; cable frequencies; a known weight on one cell",
        extension="cell_gain",
    ),
    Cause(
        "load_cell_bias",
        "zero of the load cells",
        (Parameter("bias", "N", 6.0),),
        _bias,
        True,
        seen_in=("EQ", "CO", "CF"),
        sentence="the load cells' zero is off, by {rms} N in the mean",
        sign="reading = tension + this",
        needs=_cells,
        separated_by="tensions over a range of two or more",
        extension="cell_bias",
    ),
    Cause(
        "pulley_friction",
        "friction between cable and load cell",
        (Parameter("friction", "1", 0.03, positive=True),),
        _friction,
        True,
        seen_in=("EQ", "CO", "CF"),
        sentence="pulley friction takes {value} of the tension a right angle",
        needs=_approach,
        separated_by="approaching each pose from both sides",
        extension="friction",
    ),
    Cause(
        "brake_slip",
        "a brake or a winch creeps",
        (Parameter("slip", "m/h", 2e-3),),
        _slip,
        True,
        seen_in=("CO", "LP"),
        needs=_times,
        sentence="a winch slips by {rms} m an hour",
        sign="above zero pays out",
        separated_by="the motor encoder's log",
    ),
)


def _pulled(q: int, world: World, theta: np.ndarray) -> World:
    """Forces of q directions first, then lengths."""
    return world.plus(internal_force=theta[..., :q], internal=theta[..., q:])


def internal_force(setting: Setting) -> Cause:
    """The measured tensions sit elsewhere in the null space of these states."""
    return internal_forces(setting.sent.null_space.shape[-1], len(setting.campaign.states.names))


def internal_forces(q: int, states: int) -> Cause:
    """Internal force of q directions in the null space: one force everywhere, or lengths of each state."""
    named = tuple(Parameter(f"internal_force_{j + 1}", "N", 15.0) for j in range(q))
    named += tuple(Parameter(f"null_space_{j + 1}_{i + 1}", "m", 6e-3) for i in range(states) for j in range(q))
    return Cause(
        "internal_force",
        "internal force other than commanded",
        named,
        partial(_pulled, q),
        seen_in=("NS",),
        needs=_null_space,
        sentence="the cables pull against each other differently from the simulation, by {rms} {unit} in the mean",
        separated_by="reading the encoders; measuring the anchors",
        shapes=((COMMON, slice(0, q), 0.5), ("each state its own", slice(q, None), 0.5)),
    )
