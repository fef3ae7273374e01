"""`cdpr-struct diagnose`: what the simulation gets wrong, why, and what a better model gains."""

from typing import Annotated

import typer

from cdpr_struct.cli.extension_notes import noted, with_extensions
from cdpr_struct.cli.options import Json, Out, require_file
from cdpr_struct.cli.output import emit, result_json, write_files
from cdpr_struct.cli.progress import steps
from cdpr_struct.errors import InputError

NAME = "diagnose"
BUDGET_HELP = "small (10 s, half a minute where much is wrong, minutes with signals) or full."


def run(
    campaign: Annotated[str, typer.Argument(metavar="CAMPAIGN.toml", help="Path to a campaign file.")],
    budget: Annotated[str, typer.Option("--budget", help=BUDGET_HELP)] = "small",
    out: Out = None,
    json: Json = False,
) -> int:
    """Name the cause of differences between a simulation and measured data."""
    if budget not in ("small", "full"):
        raise InputError("--budget", "", budget, "small or full")
    require_file(campaign)
    from cdpr_struct.diagnosis.diagnose import diagnose
    from cdpr_struct.measurement.campaign_file import load_campaign
    from cdpr_struct.reports.diagnosis_result import diagnosis_json
    from cdpr_struct.reports.diagnosis_text import diagnosis_text

    measured = load_campaign(campaign)
    with steps(4) as progress:
        found = diagnose(measured, budget, progress)
    result = with_extensions(diagnosis_json(found), measured.robot, NAME)
    if out is not None:
        from cdpr_struct.reports.diagnosis_page import SOMETIMES, diagnosis_files

        files = noted(result, {"result.json": result_json(result), **diagnosis_files(found, result)})
        write_files(out, files, SOMETIMES)
    emit(result, json, lambda: print(diagnosis_text(result)))
    return 0
