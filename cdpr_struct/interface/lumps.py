"""Masses on cables: which commands know them, and whether they sit on the cable at all."""

from cdpr_struct.errors import CdprError, InputError
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.cable_state import CableStates


def require_no_lumps(robot: Robot, why: str) -> None:
    """Refuse a robot with masses on cables.

    why : what has no room for them

    Raises
    ------
    InputError : there are some; the complaint names the field.
    """
    if robot.lumps:
        first = robot.lumps[0]
        value = f"{first.mass:g} kg on cable {first.cable}"
        raise InputError(robot.name, "lumps", value, f"leave [[lumps]] out: {why}")


def require_sagging(robot: Robot, model: str) -> None:
    """Refuse masses on straight cables.

    Raises
    ------
    InputError : the cable model is not the sagging one.
    """
    if model != "sagging":
        require_no_lumps(robot, f"{model} cables are straight and carry no masses; model = sagging takes them")


def require_lumps_on_cables(robot: Robot, cables: CableStates) -> None:
    """Refuse a rest at which a mass has been wound in beyond the frame end of its cable.

    Raises
    ------
    CdprError : one has; with its number and the length of the free cable.
    """
    for number, lump in enumerate(robot.lumps, start=1):
        free = float(cables.length[..., lump.cable - 1].min())
        if lump.from_platform >= free:
            raise CdprError(
                f"lumps[{number}] is {lump.from_platform:g} m from the platform end of cable {lump.cable}, but only "
                f"{free:.4g} m of it are free here: move the platform away from that frame anchor, or leave it out"
            )
