"""`cdpr-struct forward`: the pose that the platform takes at locked cable lengths."""

from typing import Annotated

import typer

from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.inverse import read_model
from cdpr_struct.cli.operating_point import read_lengths
from cdpr_struct.cli.options import Lengths, Mass, Payload, RobotName, Start, read_pose, read_robot
from cdpr_struct.cli.output import Output

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
    start: Start = None,
    equilibria: Annotated[
        bool, typer.Option("--equilibria", help="List and draw all stable poses that are found at these lengths.")
    ] = False,
    *,
    output: Output,
) -> int:
    """Pose and tensions at fixed unstrained cable lengths."""
    machine, chosen = read_robot(robot, payload, mass), read_model(model)
    length = read_lengths(lengths, machine)
    begin = None if start is None else read_pose(start, machine, "--start")
    from cdpr_struct.reports import statics_rest as report
    from cdpr_struct.reports.locked_rest import equilibria_text, locked_json, locked_warnings
    from cdpr_struct.reports.text import paragraphs
    from cdpr_struct.statics.bound_advice import outside_limits
    from cdpr_struct.statics.locked_rest import locked_rest

    found = locked_rest(machine, length, begin, chosen)
    told = report.forward_json(machine, chosen, length, found.solution) | {"locked": locked_json(found)}
    told |= {"warnings": [*locked_warnings(found), *outside_limits(machine, found.solution.tensions)]}
    result = with_extensions(told, machine, NAME, chosen)

    def text() -> str:
        return paragraphs(report.forward_text(result), *([equilibria_text(result)] if equilibria else []))

    output.deliver(result, text, lambda: report.forward_files(machine, found, result, equilibria))
    return 0 if result["stable"] else 1
