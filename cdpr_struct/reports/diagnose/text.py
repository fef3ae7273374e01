"""A diagnosis as text for a terminal."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.diagnose import tables
from cdpr_struct.reports.diagnose.recordings import length_tables, stretch_table
from cdpr_struct.reports.diagnose.state_errors import state_table, tension_table
from cdpr_struct.reports.diagnose.virtual_table import virtual_tables
from cdpr_struct.reports.html import HtmlTable
from cdpr_struct.reports.text import paragraphs, plain_table


def result_text(result: Mapping[str, Any]) -> str:
    """The sentence first, then errors, candidates and the gain."""
    said = result["verdict"]
    blocks = [said["sentence"], "\n".join(tables.standing(result)), _shown(tables.errors(result))]
    rest = (
        state_table(result, 3),
        tension_table(result, 5),
        tables.candidates(result["candidates"], 8, 2),
        tables.left_out(result["gain"]),
        *length_tables(result),
        stretch_table(result),
        *virtual_tables(result),
        tables.noise(result["noise"], all_of_them=False),
        tables.set_aside(result["set_aside"]),
    )
    blocks += [_shown(table) for table in rest if table]
    after = tables.next_steps(result["next_measurements"])
    blocks += [f"{after.title}\n" + "\n".join(row[0] for row in after.rows)] if after else []
    assumed = tables.assumed(result)
    if assumed:
        blocks += [assumed, _shown(tables.detectable(result))]
    return paragraphs(*blocks)


def diagnosis_sentences(result: Mapping[str, Any]) -> list[str]:
    """The verdict, how far it can be relied on, and where the error sits."""
    said = result["verdict"]
    more = [line[:1].upper() + line[1:] for line in tables.standing(result)]
    return [said["sentence"], *more, *([f"Where: {said['location']}."] if said["location"] else [])]


def _shown(table: HtmlTable) -> str:
    """A table for a terminal, its note below."""
    text = plain_table(table.title, table.columns, table.rows)
    return f"{text}\n{table.note}" if table.note else text
