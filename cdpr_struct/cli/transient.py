"""`cdpr-struct transient`: vibration after an emergency stop, or along a trajectory."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import (
    AssemblyName,
    Band,
    Free,
    Lengths,
    LowerBound,
    Mass,
    Payload,
    PoseText,
    RobotName,
    Samples,
    Start,
    Temperature,
    UniversalFile,
    UpperBound,
    Wrench,
    number,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.vibration_options import DampingText, Force, FrameName, ModelName, PointText

NAME = "transient"
EXAMPLES = (
    "cdpr-struct transient thesis-3-1 --initial-velocity 0.3,0,0 --duration 5 --out results/stop",
    "cdpr-struct transient thesis-3-1 --initial-velocity 0,0,0.2 --duration 3 --highest 10 --damping viscous:0.005",
)


def run(
    robot: RobotName,
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
    initial_velocity: Annotated[
        str | None,
        typer.Option("--initial-velocity", metavar="VX,VY,VZ[,WX,WY,WZ]", help="Before the stop [m/s, rad/s], world."),
    ] = None,
    trajectory: Annotated[
        str | None, typer.Option("--trajectory", metavar="T", help="CSV file, or helix: vibration along this motion.")
    ] = None,
    duration: Annotated[
        float | None, typer.Option("--duration", parser=number, metavar="S", help="Time to predict [s].")
    ] = None,
    highest: Annotated[
        float, typer.Option("--highest", parser=number, metavar="HZ", help="Modes up to this frequency.")
    ] = 25.0,
    watch: Annotated[
        str | None, typer.Option("--watch", metavar="DOF,..", help="Also record these, like cable5@0.3:z.")
    ] = None,
    window: Annotated[
        float | None, typer.Option("--window", parser=number, metavar="S", help="Spectrogram window [s].")
    ] = None,
    model: ModelName = "exact",
    damping: DampingText = "viscous",
    end_friction: Annotated[
        str | None,
        typer.Option(
            "--end-friction",
            metavar="WHERE:R,S",
            help="Dry friction at the ends of the cables (frame, platform or both; two with ';' between): moment over "
            "tension R [m], built up over the angle S [rad].",
        ),
    ] = None,
    frame: FrameName = "world",
    at: PointText = None,
    assembly: AssemblyName = "consistent",
    force: Force = False,
    uff: UniversalFile = False,
    band: Band = None,
    samples: Samples = None,
    *,
    output: Output,
) -> int:
    """Vibration in time by modal superposition, with spectrogram and certified modes."""
    with output.steps(1 if band is None else 2) as progress:
        found = cs.transient(
            robot, pose, lengths=lengths, start=start, free=free, lower_bound=lower_bound, upper_bound=upper_bound,
            payload=payload, mass=mass,
            wrench=wrench, temperature=temperature,
            initial_velocity=initial_velocity, trajectory=trajectory, duration=duration,
            highest=highest, watch=watch, window=window, model=model, damping=damping,
            end_friction=end_friction, frame=frame, at=at,
            assembly=assembly, force=force, band=band, samples=samples, progress=progress,
        )  # fmt: skip
    output.give(found, lambda: {"transient.uff": found.universal_file()} if uff else {})
    return 0
