"""`cdpr-struct forward`: the pose that the platform takes at locked cable lengths."""

from typing import Annotated, Any

import typer

from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.inverse import read_model
from cdpr_struct.cli.options import Lengths, Mass, Payload, RobotName, read_numbers, read_robot
from cdpr_struct.cli.output import Output
from cdpr_struct.errors import InputError

NAME = "forward"
EXAMPLES = (
    "cdpr-struct forward thesis-3-1 --lengths 10.78,10.38,10.78,10.38,10.24,10.64,10.24,10.64",
    "cdpr-struct forward thesis-3-1 --lengths 10.8,10.4,10.8,10.4,10.3,10.7,10.3,10.7 --payload 20 --model spring",
)


def run(
    robot: RobotName,
    lengths: Lengths = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    model: Annotated[str, typer.Option("--model", help="sagging, spring or ideal")] = "sagging",
    start: Annotated[
        str | None,
        typer.Option(
            "--start", metavar="X,Y,Z[,RX,RY,RZ]",
            help="Where to look first [m, deg], if there are several equilibria; default: the home pose.",
        ),
    ] = None,
    *,
    output: Output,
) -> int:  # fmt: skip
    """Pose and tensions at fixed unstrained cable lengths."""
    machine = read_robot(robot, payload, mass)
    chosen, length = read_model(model), read_lengths(lengths, len(machine.cables), machine.name)
    from cdpr_struct.cli.options import read_pose, require_metres

    require_metres(length, machine)
    from cdpr_struct.reports import statics_rest as report
    from cdpr_struct.statics.bound_advice import outside_limits
    from cdpr_struct.statics.forward_kinematics import forward

    origin = None if start is None and machine.home is None else read_pose(start, machine, "--start")
    first: tuple[Any, Any] = (None, None) if origin is None else (origin.position, origin.rotation)
    solution = forward(machine, length, *first, chosen).require_converged()
    told = report.forward_json(machine, chosen, length, solution)
    told |= {"warnings": outside_limits(machine, solution.tensions)}
    result = with_extensions(told, machine, NAME, chosen)
    output.deliver(result, lambda: report.forward_text(result), lambda: report.forward_files(machine, solution, result))
    return 0 if result["stable"] else 1


def read_lengths(text: str | None, count: int, robot: str) -> list[float]:
    """Unstrained lengths of --lengths [m].

    Raises
    ------
    InputError : missing, not one positive number per cable.
    """
    if text is None:
        raise InputError("--lengths", "", "nothing", f"give {count} unstrained lengths in m, one per cable of {robot}")
    values = read_numbers(text, "--lengths", (count,), f"unstrained lengths in m, one per cable of {robot}")
    if min(values) <= 0.0:
        raise InputError("--lengths", "", text, "lengths must be above zero")
    return values
