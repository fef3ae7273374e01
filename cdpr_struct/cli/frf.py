"""`cdpr-struct frf`: frequency responses between any points of the robot."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import (
    AssemblyName,
    Free,
    Lengths,
    LowerBound,
    Mass,
    Payload,
    PoseText,
    RobotName,
    Start,
    Temperature,
    UpperBound,
    Wrench,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.vibration_options import DampingText, Force, FrameName, ModelName, PointText

NAME = "frf"
EXAMPLES = (
    "cdpr-struct frf thesis-3-1 --pose 0.5,-1,0.8 --excite fz --respond x,z --band 0.5:12:0.01 --out results/frf",
    "cdpr-struct frf thesis-3-1 --excite fz --respond z,cable5@0.3:z --band 2:6:0.02 --damping viscous:0.005",
)


def run(
    robot: RobotName,
    excite: Annotated[str, typer.Option("--excite", metavar="DOF", help="Where the force acts, like fz.")],
    respond: Annotated[str, typer.Option("--respond", metavar="DOF,..", help="Answers, like x,z,cable5@0.3:z.")],
    band: Annotated[str, typer.Option("--band", metavar="F0:F1:DF", help="Frequencies [Hz].")],
    pose: PoseText = None,
    lengths: Lengths = None,
    start: Start = None,
    free: Free = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    wrench: Wrench = None,
    temperature: Temperature = None,
    quantity: Annotated[
        str, typer.Option("--quantity", help="acceleration, velocity or displacement.")
    ] = "acceleration",
    model: ModelName = "exact",
    damping: DampingText = "viscous",
    frame: FrameName = "world",
    at: PointText = None,
    assembly: AssemblyName = "consistent",
    force: Force = False,
    *,
    output: Output,
) -> int:
    """Frequency response functions, with the certified eigenfrequencies beside their peaks."""
    with output.steps(1) as progress:
        found = cs.frf(
            robot, excite=excite, respond=respond, band=band, pose=pose, lengths=lengths, start=start, free=free,
            lower_bound=lower_bound, upper_bound=upper_bound, payload=payload, mass=mass,
            wrench=wrench, temperature=temperature,
            quantity=quantity,
            model=model, damping=damping, frame=frame, at=at, assembly=assembly, force=force, progress=progress,
        )  # fmt: skip
    output.give(found)
    return 0
