"""`cdpr-struct verify`: the DSM model on trial before the finite-element referee."""

from itertools import pairwise
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
    number,
    read_assembly,
    read_numbers,
    read_robot,
    whole_number,
)
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.errors import InputError

NAME = "verify"
EXAMPLES = (
    "cdpr-struct verify thesis-3-1 --modes 12 --elements 8,16,32 --out results/verify",
    "cdpr-struct verify thesis-5 --pose 1,0.5,2 --lower-bound 300 --modes 6 --elements 8,16,32",
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
    elements: Annotated[str, typer.Option("--elements", help="Element counts per cable.")] = "10,20,40,80",
    modes: Annotated[
        int, typer.Option("--modes", parser=whole_number, help="How many eigenfrequencies to compare.")
    ] = 60,
    assembly: AssemblyName = "consistent",
    tolerance: Annotated[
        float, typer.Option("--tolerance", parser=number, help="Largest relative deviation from the FEM.")
    ] = 0.01,
    *,
    output: Output,
) -> int:
    """Compare the DSM's eigenfrequencies with the FEM's; exit 1 if they disagree."""
    counts = read_elements(elements)
    if not 1 <= modes <= 200:
        raise InputError("--modes", "", modes, "give a number from 1 to 200")
    if not 0.0 < tolerance < 1.0:
        raise InputError("--tolerance", "", tolerance, "give a ratio between 0 and 1, like 0.01")
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound)
    way = read_assembly(assembly)
    from cdpr_struct.crosscheck.fem_robot import NOT_IN_FEM
    from cdpr_struct.crosscheck.verification import Criteria, verify
    from cdpr_struct.reports.verification_result import verification_json
    from cdpr_struct.reports.verification_text import verification_text

    with output.steps(len(counts) + 2) as progress:
        state = rest(machine.without_extensions(*NOT_IN_FEM), pose, lengths, start)
        with state.advised():
            trial = verify(state.point, counts, modes, way, Criteria(relative_error=tolerance), progress)
    told = verification_json(trial, pose_in_degrees(state.point)) | state.told()
    result = with_extensions(told, machine, NAME)

    def files() -> Files:
        from cdpr_struct.reports.verification_page import verification_files

        return verification_files(trial)

    output.deliver(result, lambda: verification_text(trial), files)
    return 1 if trial.objections() else 0


def read_elements(text: str) -> list[int]:
    """Element counts of --elements: at least three, ascending, multiples of the first.

    Raises
    ------
    InputError : anything else.
    """
    values = read_numbers(text, "--elements", None, "element counts")
    counts = [int(v) for v in values]
    ascending = all(a < b for a, b in pairwise(counts))
    whole = [float(c) for c in counts] == values
    if not (whole and len(counts) >= 3 and counts[0] >= 4 and ascending and all(c % counts[0] == 0 for c in counts)):
        raise InputError(
            "--elements", "", text, "give at least three ascending multiples of the first (4 or more), like 10,20,40,80"
        )
    if counts[-1] > 2000:
        raise InputError("--elements", "", text, "at most 2000 elements per cable")
    return counts
