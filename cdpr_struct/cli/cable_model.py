"""The option --model of commands that vibrate a robot: static, dsm or exact cables."""

from typing import TYPE_CHECKING, Annotated

import typer

from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    from cdpr_struct.dynamics.cable_dynamics import CableModel
    from cdpr_struct.dynamics.operating_point import OperatingPoint

ModelName = Annotated[str, typer.Option("--model", help="static, dsm or exact.")]
Force = Annotated[bool, typer.Option("--force", help="Use the dsm outside its validity limits.")]


def read_model(text: str) -> "CableModel":
    """The named cable model.

    Raises
    ------
    InputError : no such model.
    """
    from cdpr_struct.dynamics.cable_dynamics import CABLE_MODELS

    found = next((model for model in CABLE_MODELS if model == text), None)
    if found is None:
        raise InputError("--model", "", text, f"one of: {', '.join(CABLE_MODELS)}")
    return found


def require_valid(model: str, point: "OperatingPoint", force: bool) -> None:
    """Refuse the closed form outside its printed limits unless told to use it there."""
    if model == "dsm" and not force:
        from cdpr_struct.crosscheck.robot_modes import require_validity

        require_validity(point)
