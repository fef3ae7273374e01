"""The cable model of what vibrates a robot: static, dsm or exact."""

from cdpr_struct.crosscheck.robot_modes import require_validity
from cdpr_struct.dynamics.cable_dynamics import CABLE_MODELS, CableModel
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.interface.arguments import one_of
from cdpr_struct.robot.robot import Robot


def read_model(text: str) -> CableModel:
    """The named cable model.

    Raises
    ------
    InputError : no such model.
    """
    return one_of(text, "model", CABLE_MODELS)


def require_valid(model: str, point: OperatingPoint, force: bool) -> None:
    """Refuse the closed form outside its printed limits unless told to use it there."""
    if model == "dsm" and not force:
        require_validity(point)


def dropped_by(model: str, robot: Robot) -> list[str]:
    """One sentence on what of the robot the cable model leaves out without being told; none if it has everything."""
    if model != "dsm" or not any(robot.pulleys):
        return []
    return [
        "the closed form (model dsm) has no pulleys: its cables are held at the points where they leave their pulleys. "
        "The models exact and fem have pulleys; verify shows the difference."
    ]
