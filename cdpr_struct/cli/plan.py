"""`cdpr-struct plan`: before measuring, what a campaign could find and what it would confuse."""

from typing import Annotated

import typer

from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.options import Json, Out, require_file
from cdpr_struct.cli.output import emit, result_json, write_files

NAME = "plan"


def run(
    campaign: Annotated[str, typer.Argument(metavar="CAMPAIGN.toml", help="Path to a campaign file.")],
    out: Out = None,
    json: Json = False,
) -> int:
    """Smallest detectable size of each cause, which causes look alike, and which measurement would separate them."""
    require_file(campaign)
    from cdpr_struct.diagnosis.planned_campaign import planned
    from cdpr_struct.measurement.campaign_file import load_campaign
    from cdpr_struct.reports.diagnosis_plan import plan_json, plan_text

    entered = load_campaign(campaign)
    result = with_extensions(plan_json(planned(entered)), entered.robot, NAME)
    if out is not None:
        write_files(out, {"result.json": result_json(result)})
    emit(result, json, lambda: print(plan_text(result)))
    return 0
