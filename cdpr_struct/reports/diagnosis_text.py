"""A diagnosis as text for a terminal."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.diagnosis_tables import (
    candidate_table,
    default_sigmas,
    error_table,
    gain_table,
    next_table,
    standing,
)
from cdpr_struct.reports.html import HtmlTable
from cdpr_struct.reports.text import paragraphs, plain_table


def diagnosis_text(result: Mapping[str, Any]) -> str:
    """The sentence first, then errors, candidates and the gain."""
    said = result["verdict"]
    blocks = [said["sentence"], "\n".join(standing(result)), _shown(error_table(result))]
    tables = (candidate_table(result["candidates"], 8, 2), gain_table(result["gain"]))
    blocks += [_shown(table) for table in tables if table]
    after = next_table(said["next_measurement"])
    blocks += [f"{after.title}\n" + "\n".join(row[0] for row in after.rows)] if after else []
    blocks += filter(None, [default_sigmas(result["sigmas"])])
    return paragraphs(*blocks)


def _shown(table: HtmlTable) -> str:
    """A table for a terminal, its note below."""
    text = plain_table(table.title, table.columns, table.rows)
    return f"{text}\n{table.note}" if table.note else text
