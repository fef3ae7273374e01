"""The cable model of what vibrates a robot: static, dsm or exact."""

from cdpr_struct.crosscheck.robot_modes import require_validity
from cdpr_struct.dynamics.cable_dynamics import CABLE_MODELS, CableModel
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.interface.arguments import one_of
from cdpr_struct.reports.trust import Check
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


def dropped_by(model: str, robot: Robot) -> list[Check]:
    """What of the robot the cable model leaves out without being told: its pulleys; nothing of models that have all."""
    if model != "dsm":
        return []
    dropped = sum(pulley is not None for pulley in robot.pulleys)
    said = (
        "the closed form (model dsm) has no pulleys: its cables are held at the points where they leave their pulleys. "
        "The models exact and fem have pulleys; verify shows the difference."
    )
    return [Check.of("pulleys that the model leaves out", dropped, 0.0, said if dropped else None)]
