"""`cdpr-struct modes`: eigenfrequencies of the whole robot, none missing."""

from typing import Annotated

import typer

from cdpr_struct.cli.extension_notes import noted, with_extensions
from cdpr_struct.cli.operating_point import pose_in_degrees, rest
from cdpr_struct.cli.options import (
    AssemblyName,
    Json,
    Lengths,
    LowerBound,
    Mass,
    Out,
    Payload,
    PoseText,
    RobotName,
    read_assembly,
    read_robot,
    whole_number,
)
from cdpr_struct.cli.output import emit, result_json, write_files
from cdpr_struct.errors import InputError

NAME = "modes"


def run(
    robot: RobotName,
    pose: PoseText = None,
    lengths: Lengths = None,
    lower_bound: LowerBound = 0.0,
    payload: Payload = 0.0,
    mass: Mass = None,
    model: Annotated[str, typer.Option("--model", help="static, dsm, exact or fem.")] = "exact",
    assembly: AssemblyName = "consistent",
    elements: Annotated[int, typer.Option("--elements", parser=whole_number, help="Per cable, for --model fem.")] = 80,
    count: Annotated[int, typer.Option("--count", parser=whole_number, help="How many eigenfrequencies.")] = 40,
    force: Annotated[bool, typer.Option("--force", help="Use the dsm outside its validity limits.")] = False,
    out: Out = None,
    json: Json = False,
) -> int:
    """Eigenfrequencies of the robot at rest, with their kind."""
    if not 1 <= count <= 500:
        raise InputError("--count", "", count, "give a number from 1 to 500")
    if not 2 <= elements <= 2000:
        raise InputError("--elements", "", elements, "give a number from 2 to 2000")
    way = read_assembly(assembly)
    machine = read_robot(robot, payload, mass)
    from cdpr_struct.crosscheck.robot_modes import MODELS, require_validity, robot_modes
    from cdpr_struct.statics.robot_arrays import RobotArrays

    name = next((m for m in MODELS if m == model), None)
    if name is None:
        raise InputError("--model", "", model, f"one of: {', '.join(MODELS)}")
    point = rest(machine, pose, lengths, lower_bound)
    if name == "dsm" and not force:
        require_validity(point)
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
    }
    result = with_extensions(result, machine, NAME, name)

    def text() -> None:
        from cdpr_struct.reports.modes_text import modes_text

        print(modes_text(result))

    emit(result, json, text)
    if out is not None:
        from cdpr_struct.reports.modes_text import modes_csv

        write_files(out, noted(result, {"result.json": result_json(result), "modes.csv": modes_csv(result)}))
    return 0
