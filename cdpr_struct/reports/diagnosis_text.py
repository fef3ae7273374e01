"""A diagnosis as text for a terminal."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.diagnosis_tables import Table, error_table, gain_table, standing
from cdpr_struct.reports.text import paragraphs, plain_table


def diagnosis_text(result: Mapping[str, Any]) -> str:
    """The sentence first, then errors, candidates and the gain."""
    said = result["verdict"]
    blocks = [said["sentence"], "\n".join(standing(result)), _shown(error_table(result))]
    if result["candidates"]:
        rows = [
            [c["cause"], f"{c['log_evidence_gain']:.1f}", _sizes(c["parameters"])] for c in result["candidates"][:8]
        ]
        blocks.append(plain_table("Candidates", ["cause", "evidence [nats]", "size"], rows))
    blocks += [_shown(table) for table in (gain_table(result["gain"]),) if table]
    if said["next_measurement"]:
        blocks.append(f"To measure next: {said['next_measurement']}.")
    return paragraphs(*blocks)


def _shown(table: Table) -> str:
    """A table for a terminal, its note below."""
    text = plain_table(table.title, table.columns, table.rows)
    return f"{text}\n{table.note}" if table.note else text


def _sizes(parameters: Mapping[str, Any]) -> str:
    shown = [f"{name} {p['value']:.4g} ± {p['sigma']:.2g} {p['unit']}" for name, p in list(parameters.items())[:2]]
    return "; ".join(shown) + (" ..." if len(parameters) > 2 else "")
