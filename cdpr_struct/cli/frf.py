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
    Percent,
    PoseText,
    RobotName,
    Samples,
    Start,
    Temperature,
    UpperBound,
    Wrench,
    number,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.vibration_options import DampingText, Force, FrameName, ModelName, PointText
from cdpr_struct.errors import InputError

NAME = "frf"
EXAMPLES = (
    "cdpr-struct frf thesis-3-1 --pose 0.5,-1,0.8 --excite fz --respond x,z --band 0.5:12:0.01 --out results/frf",
    "cdpr-struct frf thesis-3-1 --excite fz --respond z,cable5@0.3:z --band 2:6:0.02 --damping viscous:0.005",
)


def run(
    robot: RobotName,
    excite: Annotated[str, typer.Option("--excite", metavar="DOF", help="Where the force acts, like fz.")],
    respond: Annotated[str, typer.Option("--respond", metavar="DOF,..", help="Answers, like x,z,cable5@0.3:z.")],
    band: Annotated[
        list[str],
        typer.Option(
            "--band", metavar="F0:F1:DF", help="Frequencies [Hz]; a second one that is a number, like 90, is --percent."
        ),
    ],
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
    percent: Percent = None,
    samples: Samples = None,
    *,
    output: Output,
) -> int:
    """Frequency response functions, with the certified eigenfrequencies beside their peaks."""
    frequencies, level = _told_apart(band, percent)
    with output.steps(1 if level is None else 2) as progress:
        found = cs.frf(
            robot, excite=excite, respond=respond, band=frequencies, pose=pose, lengths=lengths, start=start, free=free,
            lower_bound=lower_bound, upper_bound=upper_bound, payload=payload, mass=mass,
            wrench=wrench, temperature=temperature,
            quantity=quantity,
            model=model, damping=damping, frame=frame, at=at, assembly=assembly, force=force,
            percent=level, samples=samples, progress=progress,
        )  # fmt: skip
    output.give(found)
    return 0


def _told_apart(band: list[str], percent: float | None) -> tuple[str, float | None]:
    """Frequencies, and the level of the band about the responses: what has no colons is a level.

    Raises
    ------
    InputError : frequencies are missing or given twice, or the level is.
    """
    frequencies = [one for one in band if ":" in one or len(band) == 1]
    levels = [*([] if percent is None else [percent]), *(number(one) for one in band if one not in frequencies)]
    if len(frequencies) != 1 or len(levels) > 1:
        raise InputError("band", "", " and ".join(band), "give F0:F1:DF once, and a level like 90 at most once")
    return frequencies[0], levels[0] if levels else None
