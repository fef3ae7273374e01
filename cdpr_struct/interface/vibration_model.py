"""The cable model of what vibrates a robot: static, dsm or exact."""

from cdpr_struct.crosscheck.robot_modes import require_validity
from cdpr_struct.dynamics.cable_dynamics import CABLE_MODELS, CableModel
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.interface.arguments import one_of


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
