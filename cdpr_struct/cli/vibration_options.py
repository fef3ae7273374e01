"""Options of commands that vibrate a robot: cable model, damping, degrees of freedom."""

from typing import Annotated

import typer

ModelName = Annotated[str, typer.Option("--model", help="static, dsm or exact.")]
Force = Annotated[bool, typer.Option("--force", help="Use the dsm outside its validity limits.")]
DampingText = Annotated[
    str,
    typer.Option(
        "--damping",
        metavar="LAW[:NUMBERS]",
        help=(
            "none, viscous[:XI], hysteretic[:ETA], rayleigh:A,B, frequency-dependent[:ETA,EXPONENT[,F_REF_HZ]], or "
            "modal:Z1,Z2,.. (ratios of the robot's modes, the last for all higher ones)."
        ),
    ),
]
FrameName = Annotated[str, typer.Option("--frame", help="Axes of the degrees of freedom: world or platform.")]
PointText = Annotated[
    str | None,
    typer.Option("--at", metavar="X,Y,Z", help="Point of the platform [m, platform frame]; default: its origin."),
]
