"""`cdpr-struct spectrogram`: measured accelerations over time and frequency, with the predicted modes drawn in."""

from pathlib import Path
from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import (
    Free,
    Lengths,
    LowerBound,
    Mass,
    Payload,
    PoseText,
    Start,
    Temperature,
    UpperBound,
    Wrench,
    number,
    robot_names,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.vibration_options import Force, ModelName

NAME = "spectrogram"
EXAMPLES = (
    "cdpr-struct spectrogram examples/stop/acceleration.csv --robot thesis-3-1 --out results/spectrogram",
    "cdpr-struct spectrogram examples/stop/acceleration.csv --robot thesis-3-1 --highest 10 --window 1",
)


def run(
    file: Annotated[Path, typer.Argument(metavar="FILE.csv", help="Columns time_s, ax, ay, az [s, m/s^2].")],
    robot: Annotated[
        str, typer.Option("--robot", metavar="ROBOT", help="Whose modes to draw in.", autocompletion=robot_names)
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
    highest: Annotated[
        float, typer.Option("--highest", parser=number, metavar="HZ", help="Top of the picture.")
    ] = 25.0,
    window: Annotated[
        float | None, typer.Option("--window", parser=number, metavar="S", help="Analysis window [s].")
    ] = None,
    model: ModelName = "exact",
    force: Force = False,
    *,
    output: Output,
) -> int:
    """Spectrogram of measured accelerations, with the robot's certified eigenfrequencies."""
    found = cs.spectrogram(
        file, robot, pose, lengths=lengths, start=start, free=free, lower_bound=lower_bound, upper_bound=upper_bound,
        payload=payload, mass=mass,
        wrench=wrench, temperature=temperature,
        highest=highest, window=window, model=model, force=force,
    )  # fmt: skip
    output.give(found)
    return 0
