"""`cdpr-struct spectrogram`: measured accelerations over time and frequency, with the predicted modes drawn in."""

from pathlib import Path
from typing import Annotated

import typer

from cdpr_struct.cli.cable_model import Force, ModelName, read_model, require_valid
from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.operating_point import rest
from cdpr_struct.cli.options import Lengths, LowerBound, Mass, Payload, PoseText, Start, UpperBound, number, read_robot
from cdpr_struct.cli.output import Output
from cdpr_struct.errors import InputError

NAME = "spectrogram"
EXAMPLES = (
    "cdpr-struct spectrogram examples/stop/acceleration.csv --robot thesis-3-1 --out results/spectrogram",
    "cdpr-struct spectrogram examples/stop/acceleration.csv --robot thesis-3-1 --highest 10 --window 1",
)


def run(
    file: Annotated[Path, typer.Argument(metavar="FILE.csv", help="Columns time_s, ax, ay, az [s, m/s^2].")],
    robot: Annotated[str, typer.Option("--robot", metavar="ROBOT", help="Whose modes to draw in.")],
    pose: PoseText = None,
    lengths: Lengths = None,
    start: Start = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    payload: Payload = 0.0,
    mass: Mass = None,
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
    from cdpr_struct.measurement.time_series import read_accelerations

    time, acceleration = read_accelerations(file)
    half_rate = 0.5 * (len(time) - 1) / (time[-1] - time[0])
    if not 0.0 < highest <= half_rate:
        raise InputError("--highest", "", highest, f"a frequency up to half of the sampling rate, {half_rate:.6g} Hz")
    if window is not None and not 8.0 <= window * 2.0 * half_rate <= len(time):
        raise InputError("--window", "", window, f"between {4.0 / half_rate:.4g} and {time[-1] - time[0]:.4g} s")
    cable_model, machine = read_model(model), read_robot(robot, payload, mass, lower_bound, upper_bound)
    state = rest(machine, pose, lengths, start)
    point = state.point
    require_valid(cable_model, point, force)
    from cdpr_struct.reports.transient_measured import measured_files, measured_json, measured_text

    with state.advised():
        result = measured_json(time, acceleration, point, cable_model, highest)
    result |= state.told()
    result = with_extensions(result, machine, NAME, cable_model)
    output.deliver(result, lambda: measured_text(result), lambda: measured_files(time, acceleration, result, window))
    return 0
