"""`cdpr-struct verify`: the DSM model on trial before the finite-element referee."""

from typing import TYPE_CHECKING, Annotated

import typer

from cdpr_struct.cli.operating_point import rest_at
from cdpr_struct.cli.options import (
    Json,
    Mass,
    Out,
    Payload,
    PoseText,
    RobotName,
    number,
    read_numbers,
    read_pose,
    read_robot,
    whole_number,
)
from cdpr_struct.cli.output import emit, result_json, write_files
from cdpr_struct.cli.progress import steps
from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    pass

NAME = "verify"


def run(
    robot: RobotName,
    pose: PoseText = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    elements: Annotated[str, typer.Option("--elements", help="Element counts per cable.")] = "10,20,40,80",
    modes: Annotated[
        int, typer.Option("--modes", parser=whole_number, help="How many eigenfrequencies to compare.")
    ] = 60,
    assembly: Annotated[
        str, typer.Option("--assembly", help="consistent, or thesis (eq. 3.8 as printed)")
    ] = "consistent",
    tolerance: Annotated[
        float, typer.Option("--tolerance", parser=number, help="Largest relative deviation from the FEM.")
    ] = 0.01,
    out: Out = None,
    json: Json = False,
) -> int:
    """Compare the DSM's eigenfrequencies with the FEM's; exit 1 if they disagree."""
    counts = read_elements(elements)
    if not 1 <= modes <= 200:
        raise InputError("--modes", "", modes, "give a number from 1 to 200")
    if assembly != "consistent" and assembly != "thesis":
        raise InputError("--assembly", "", assembly, "consistent or thesis")
    if not 0.0 < tolerance < 1.0:
        raise InputError("--tolerance", "", tolerance, "give a ratio between 0 and 1, like 0.01")
    machine = read_robot(robot, payload, mass)
    where = read_pose(pose, machine)
    from cdpr_struct.crosscheck.verification import Criteria, verify
    from cdpr_struct.reports.verification_result import verification_json
    from cdpr_struct.reports.verification_text import verification_text

    with steps(len(counts) + 2) as progress:
        trial = verify(rest_at(machine, where), counts, modes, assembly, Criteria(relative_error=tolerance), progress)
    result = verification_json(trial, where)
    emit(result, json, lambda: print(verification_text(trial)))
    if out is not None:
        from cdpr_struct.reports.verification_page import verification_files

        write_files(out, {"result.json": result_json(result), **verification_files(trial)})
    return 1 if trial.objections() else 0


def read_elements(text: str) -> list[int]:
    """Element counts of --elements: at least three, ascending, multiples of the first.

    Raises
    ------
    InputError : anything else.
    """
    values = read_numbers(text, "--elements", None, "element counts")
    counts = [int(v) for v in values]
    ascending = all(a < b for a, b in zip(counts, counts[1:], strict=False))
    whole = [float(c) for c in counts] == values
    if not (whole and len(counts) >= 3 and counts[0] >= 4 and ascending and all(c % counts[0] == 0 for c in counts)):
        raise InputError(
            "--elements", "", text, "give at least three ascending multiples of the first (4 or more), like 10,20,40,80"
        )
    if counts[-1] > 2000:
        raise InputError("--elements", "", text, "at most 2000 elements per cable")
    return counts
