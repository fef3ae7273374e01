"""`cdpr-struct modes`: eigenfrequencies of the whole robot, none missing."""

from typing import Annotated

import typer

from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.operating_point import pose_in_degrees, rest
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
    whole_number,
)
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.errors import InputError

NAME = "modes"
EXAMPLES = (
    "cdpr-struct modes thesis-3-1 --count 20 --out results/modes",
    "cdpr-struct modes thesis-5 --pose 1,0.5,2 --lower-bound 150 --count 6 --json",
)


def run(
    robot: RobotName,
    pose: PoseText = None,
    lengths: Lengths = None,
    start: Start = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    model: Annotated[str, typer.Option("--model", help="static, dsm, exact or fem.")] = "exact",
    assembly: AssemblyName = "consistent",
    elements: Annotated[int, typer.Option("--elements", parser=whole_number, help="Per cable, for --model fem.")] = 80,
    count: Annotated[int, typer.Option("--count", parser=whole_number, help="How many eigenfrequencies.")] = 40,
    force: Annotated[bool, typer.Option("--force", help="Use the dsm outside its validity limits.")] = False,
    *,
    output: Output,
) -> int:
    """Eigenfrequencies of the robot at rest, with their kind."""
    if not 1 <= count <= 500:
        raise InputError("--count", "", count, "give a number from 1 to 500")
    if not 2 <= elements <= 2000:
        raise InputError("--elements", "", elements, "give a number from 2 to 2000")
    way = read_assembly(assembly)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound)
    from cdpr_struct.crosscheck.robot_modes import MODELS, require_validity, robot_modes
    from cdpr_struct.robot.robot_arrays import RobotArrays

    name = next((m for m in MODELS if m == model), None)
    if name is None:
        raise InputError("--model", "", model, f"one of: {', '.join(MODELS)}")
    state = rest(machine, pose, lengths, start)
    point = state.point
    if name == "dsm" and not force:
        require_validity(point)
    with state.advised():
        found = robot_modes(point, name, min(count, 6) if name == "static" else count, way, elements)
    result = {
        "robot": machine.name,
        "pose": pose_in_degrees(point),
        "model": name,
        "assembly": way,
        "frequencies_hz": found.hertz,
        "count_certified": found.count_certified,
        "kinds": found.kinds(),
        "platform_energy": found.platform_energy,
        "tensions_N": point.cables.tension_at_platform,
        "lengths_m": RobotArrays.of(machine).reading(point.cables.total_length),
        **state.told(),
    }
    result = with_extensions(result, machine, NAME, name)

    from cdpr_struct.reports.modes_text import modes_text

    def files() -> Files:
        from cdpr_struct.reports.modes_page import modes_files

        return modes_files(point, result)

    output.deliver(result, lambda: modes_text(result), files)
    return 0
