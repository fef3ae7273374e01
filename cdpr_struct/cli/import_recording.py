"""`cdpr-struct import-recording`: a campaign from a bag, a logger's file or a wide table of a real machine."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

import cdpr_struct as cs
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.written_files import write_new, write_new_files
from cdpr_struct.errors import InputError

NAME = "import-recording"
EXAMPLES = (
    "cdpr-struct import-recording examples/recordings/log.csv --list",
    "cdpr-struct import-recording examples/recordings/log.csv examples/recordings/log.toml --out results/recorded",
)
_SHOWN = 400  # channels on the screen


def run(
    recording: Annotated[
        Path, typer.Argument(metavar="RECORDING", help="ROS bag, MCAP, TDMS, MDF, .mat, .xlsx, universal file or CSV.")
    ],
    mapping: Annotated[
        Path | None, typer.Argument(metavar="[MAPPING.toml]", help="Which channel is what; without it, all are listed.")
    ] = None,
    listed: Annotated[bool, typer.Option("--list", help="List the channels, and a mapping file to fill in.")] = False,
    robot: Annotated[
        str | None,
        typer.Option("--robot", metavar="ROBOT", help="Built-in name or robot file, for that of the mapping."),
    ] = None,
    clock: Annotated[
        str,
        typer.Option("--clock", metavar="CLOCK", help="Of a bag that is listed: stamp (of the messages) or received."),
    ] = "stamp",
    template: Annotated[
        Path | None, typer.Option("--template", metavar="MAPPING.toml", help="Write the mapping file to fill in here.")
    ] = None,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Where the campaign goes.")] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace files that are there.")] = False,
    *,
    output: Output,
) -> int:
    """Write a campaign from the recording of a real machine, or list its channels with a mapping file to fill in."""
    if mapping is None or listed:
        if mapping is None and out is not None:
            raise InputError("MAPPING.toml", "", "nothing", "a mapping file; without --out the channels are listed")
        return _list(recording, clock, template, overwrite, output)
    if out is None:
        raise InputError("--out", "", "nothing", "give the directory for campaign.toml and the data file")
    made = cs.import_recording(recording, mapping, robot=robot, directory=out)
    write_new_files(out, made.files, overwrite)
    result = {**made.answer, "directory": str(out), "files_written": list(made.files), "warnings": list(made.warnings)}
    output.deliver(result, lambda: _text(result), dict)
    return 0


def _list(recording: Path, clock: str, template: Path | None, overwrite: bool, output: Output) -> int:
    found = cs.recording_channels(recording, clock=clock)
    if template is not None:
        write_new(template, found.template, overwrite)
    result = {
        "file": str(recording), "form": found.form, "channels": [channel.answer() for channel in found.channels],
        "template": found.template, "warnings": [],
    }  # fmt: skip
    output.deliver(result, lambda: _listing(result, template), dict)
    return 0


def _listing(result: Mapping[str, Any], template: Path | None) -> str:
    head = ("channel", "unit", "samples", "rate [Hz]", "from [s]", "to [s]", "least", "greatest")
    rows = [
        (c["name"], c["unit"], str(c["samples"]) + _faulty(c), _short(c["rate_hz"], ".4g"), _short(c["start_s"], ".6g"),
         _short(c["end_s"], ".6g"), _short(c["low"], ".6g"), _short(c["high"], ".6g"))
        for c in result["channels"]
    ]  # fmt: skip
    more = [f"and {len(rows) - _SHOWN} channels more: --json lists all"] if len(rows) > _SHOWN else []
    shown = [head, *rows[:_SHOWN]]
    widths = [max(len(row[i]) for row in shown) for i in range(len(head))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in shown]
    wanted = (
        [f"Mapping file to fill in: {template}"] if template else ["Mapping file to fill in:", "", result["template"]]
    )
    return "\n".join([f"{result['file']}: {result['form']}, {len(rows)} channels", "", *lines, *more, "", *wanted])


def _faulty(channel: Mapping[str, Any]) -> str:
    return f" ({channel['faulty']} no numbers)" if channel["faulty"] else ""


def _short(value: float, form: str) -> str:
    return format(value, form) if value == value else ""


def _text(result: Mapping[str, Any]) -> str:
    sigma = ", ".join(f"{key} = {value:g}" for key, value in result["sigma"].items())
    campaign = Path(result["directory"]) / "campaign.toml"
    return (
        f"{result['directory']}: {', '.join(result['files_written'])}; {result['states']} states of kind "
        f"{result['kind']}, from {result['start_s']:.6g} to {result['end_s']:.6g} s.\n"
        f"{result['sampling']}\n" + (f"Sigmas: {sigma}.\n" if sigma else "") + f"Next: cdpr-struct diagnose {campaign}"
    )
