"""`cdpr-struct frf`: frequency responses between any points of the robot."""

from typing import TYPE_CHECKING, Annotated

import typer

from cdpr_struct.cli.cable_model import Force, ModelName, read_model, require_valid
from cdpr_struct.cli.damping_option import DampingText, read_damping
from cdpr_struct.cli.degrees_of_freedom import FrameName, PointText, read_ports
from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.operating_point import rest
from cdpr_struct.cli.options import (
    AssemblyName,
    Lengths,
    LowerBound,
    Mass,
    Payload,
    PoseText,
    RobotName,
    Start,
    UpperBound,
    read_assembly,
    read_robot,
)
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    import numpy as np

NAME = "frf"
EXAMPLES = (
    "cdpr-struct frf thesis-3-1 --pose 0.5,-1,0.8 --excite fz --respond x,z --band 0.5:12:0.01 --out results/frf",
    "cdpr-struct frf thesis-3-1 --excite fz --respond z,cable5@0.3:z --band 2:6:0.02 --damping viscous:0.005",
)
_MOST_FREQUENCIES = 1_000_000


def run(
    robot: RobotName,
    excite: Annotated[str, typer.Option("--excite", metavar="DOF", help="Where the force acts, like fz.")],
    respond: Annotated[str, typer.Option("--respond", metavar="DOF,..", help="Answers, like x,z,cable5@0.3:z.")],
    band: Annotated[str, typer.Option("--band", metavar="F0:F1:DF", help="Frequencies [Hz].")],
    pose: PoseText = None,
    lengths: Lengths = None,
    start: Start = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    payload: Payload = 0.0,
    mass: Mass = None,
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
    hertz = read_band(band)
    cable_model, way = read_model(model), read_assembly(assembly)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound)
    law = read_damping(damping, machine, cable_model == "static")
    from cdpr_struct.dynamics.frequency_response import QUANTITIES
    from cdpr_struct.dynamics.frequency_sweep import sweep_response
    from cdpr_struct.reports.damping_note import damping_note
    from cdpr_struct.reports.frf_result import frf_json
    from cdpr_struct.reports.frf_text import frf_text

    what = next((q for q in QUANTITIES if q == quantity), None)
    if what is None:
        raise InputError("--quantity", "", quantity, f"one of: {', '.join(QUANTITIES)}")
    state = rest(machine, pose, lengths, start)
    point = state.point
    require_valid(cable_model, point, force)
    source = read_ports(excite, "--excite", point, frame, at)
    if len(source) != 1:
        raise InputError("--excite", "", excite, "give one degree of freedom")
    if cable_model == "static" and excite.startswith("cable"):
        raise InputError("--excite", "", excite, "massless cables cannot be shaken; use --model dsm or exact")
    targets = read_ports(respond, "--respond", point, frame, at)
    with output.steps(1) as progress, state.advised():
        progress("response, eigenfrequencies and peaks")
        sweep = sweep_response(point, cable_model, law, source[0], targets, hertz, what, way)
    described = {"damping": damping, "frame": frame, "at_m": at or "0,0,0", "assembly": way, "band_hz": band}
    described["damping_note"] = damping_note(law, damping, machine, cable_model == "static")
    result = frf_json(sweep, {**described, "command": output.words})
    result |= state.told()
    result = with_extensions(result, machine, "frf", cable_model)

    def files() -> Files:
        from cdpr_struct.reports.frf_page import frf_files

        return frf_files(sweep, result)

    output.deliver(result, lambda: frf_text(result), files)
    return 0


def read_band(text: str) -> "np.ndarray":
    """Frequencies F0, F0 + DF, .. up to F1 [Hz].

    Raises
    ------
    InputError : not three numbers, not ascending, or too many steps.
    """
    import numpy as np

    expected = "give F0:F1:DF in Hz with 0 <= F0 < F1 and DF > 0, like 0.5:20:0.01"
    try:
        first, last, step = (float(part) for part in text.split(":"))
    except ValueError as error:
        raise InputError("--band", "", text, expected) from error
    if not (0.0 <= first < last < float("inf") and 0.0 < step <= last - first):
        raise InputError("--band", "", text, expected)
    if (last - first) / step > _MOST_FREQUENCIES:
        raise InputError("--band", "", text, f"at most {_MOST_FREQUENCIES} frequencies")
    return first + step * np.arange(int((last - first) / step * (1.0 + 1e-12)) + 1)
