"""`cdpr-struct new-campaign`: campaign file and data files to begin with."""

from pathlib import Path
from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import RobotName, number
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.written_files import write_new
from cdpr_struct.errors import InputError

NAME = "new-campaign"
EXAMPLES = (
    "cdpr-struct new-campaign cogiro --kinds tensions,lengths --poses '0,0,1;1,0,1.2' --out results/new-campaign",
    "cdpr-struct new-campaign thesis-3-1 --kinds loaded,cable_frequency,robot_frequency --out results/mine",
)


def run(
    robot: RobotName,
    kinds: Annotated[
        str,
        typer.Option(
            "--kinds", metavar="KIND,..",
            help="Of tensions, lengths, swivels, cable_frequency, robot_frequency, loaded.",
        ),
    ] = "tensions,lengths",
    poses: Annotated[
        str | None,
        typer.Option(
            "--poses", metavar="P;P;..",
            help="Poses x,y,z[,rx,ry,rz] [m, deg], or a CSV file with columns x_m, y_m, z_m[, rx_deg, ry_deg, rz_deg]; "
            "default: the home pose.",
        ),
    ] = None,
    payload: Annotated[
        float, typer.Option("--payload", parser=number, metavar="KG", help="Of the loaded poses [kg].")
    ] = 10.0,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Where the files go.")] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace files that are there.")] = False,
    *,
    output: Output,
) -> int:  # fmt: skip
    """Write a commented campaign file and its data files, poses and predictions filled in, readings left to fill."""
    if out is None:
        raise InputError("--out", "", "nothing", "give the directory for campaign.toml and the data files")
    made = cs.new_campaign(robot, kinds=kinds, poses=poses, payload=payload, directory=out)
    if not overwrite and (there := [name for name in made.files if (out / name).exists()]):
        expected = "the file is there already; give another directory, or --overwrite"
        raise InputError("--out", "", str(out / there[0]), expected)
    for name, text in made.files.items():
        write_new(out / name, text, overwrite)
    result = {"directory": str(out), "files_written": list(made.files), "cases": list(made.cases)}
    result |= {"warnings": list(made.warnings)}
    text = (
        f"{out}: {', '.join(made.files)}; {len(made.cases)} poses.\n"
        f"Fill the cells with ?, then: cdpr-struct diagnose {out / 'campaign.toml'}"
    )
    output.deliver(result, lambda: text, dict)
    return 0
