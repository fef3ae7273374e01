"""`cdpr-struct export`: a robot at rest as a file of another program."""

from pathlib import Path
from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import Free, Lengths, LowerBound, Mass, Payload, PoseText, RobotName, Start, UpperBound
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.written_files import write_new
from cdpr_struct.errors import InputError

NAME = "export"
EXAMPLES = (
    "cdpr-struct export thesis-3-1 --pose 0.5,-1,0.8 --to moorpy --out results/thesis-3-1.txt",
    "cdpr-struct export cogiro --to gltf --out results/cogiro.glb",
)


def run(
    robot: RobotName,
    to: Annotated[str, typer.Option("--to", metavar="FORMAT", help="moorpy, moordyn or gltf (binary, .glb).")],
    pose: PoseText = None,
    lengths: Lengths = None,
    start: Start = None,
    free: Free = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="File to write.")] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace FILE if it is there.")] = False,
    *,
    output: Output,
) -> int:
    """Write a robot at rest as an input file of MoorPy or MoorDyn, or as a glTF scene."""
    if out is None:
        raise InputError("--out", "", "nothing", "give the name of the file to write")
    made = cs.export(
        robot, pose, to=to, lengths=lengths, start=start, free=free, lower_bound=lower_bound, upper_bound=upper_bound,
        payload=payload, mass=mass,
    )  # fmt: skip
    write_new(out, made.content, overwrite)
    result = {"file": str(out), "format": to, "pose": made.pose, "warnings": list(made.warnings)}
    output.deliver(result, lambda: f"{out}: {to}, {len(made.content)} bytes", dict)
    return 0
