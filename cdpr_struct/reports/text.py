"""Results as text for a terminal."""

import io
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text


def plain_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A titled table with right-aligned columns after the first, without colour codes."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for i, column in enumerate(columns):
        table.add_column(Text(column), justify="left" if i == 0 else "right", no_wrap=True)
    for row in rows:
        table.add_row(*map(Text, row))
    console = Console(file=io.StringIO(), width=400, color_system=None, highlight=False)
    console.print(table)
    body = console.file.getvalue()  # type: ignore[attr-defined]
    return "\n".join([title, *(line.rstrip() for line in body.splitlines())])


def rounded(values: Iterable[float], digits: int) -> list[float]:
    """Values to so many decimals, without negative zeros."""
    return [round(float(value), digits) + 0.0 for value in values]


def place(position: Iterable[float]) -> str:
    """A position as (x, y, z) m, to a tenth of a millimetre."""
    return "(" + ", ".join(f"{v:g}" for v in rounded(position, 4)) + ") m"


def with_sigma(value: float, sigma: float) -> str:
    """A size with the digits that its sigma allows."""
    if not (sigma > 0.0 and math.isfinite(sigma)):
        return f"{value:.4g}"
    decimals = 1 - math.floor(math.log10(sigma))
    if not -3 <= decimals <= 6:
        return f"{value:.4g} ± {sigma:.2g}"
    return f"{round(value, decimals) + 0.0:.{max(decimals, 0)}f} ± {round(sigma, decimals):.{max(decimals, 0)}f}"


def paragraphs(*blocks: str) -> str:
    """Blocks of text with an empty line between them."""
    return "\n\n".join(blocks)


def cable_frequencies(result: Mapping[str, Any]) -> list[list[str]]:
    """Plane, model, and the first six frequencies [Hz] of each; the FEM's are those of both planes in turn."""
    rows = [
        [plane.replace("_", " "), model, *(f"{f:.4f}" for f in result[key][plane])]
        for plane in ("out_of_plane", "in_plane")
        for model, key in (("closed form", "frequencies_hz"), ("exact catenary", "exact_frequencies_hz"))
    ]
    both = [f"{f:.4f}" for f in result.get("fem_frequencies_hz", [])]
    return [*rows, *(["both planes", "FEM", *part] for part in (both[:6], both[6:]) if part)]


def cable_text(result: Mapping[str, Any]) -> str:
    """One cable's parameters, matrices, frequencies and verdict."""
    validity = result["validity"]
    parameters = [
        ["end point x", f"{result['x_m']:.3f}", "m"],
        ["end point z", f"{result['z_m']:.3f}", "m"],
        ["chord", f"{result['chord_m']:.3f}", "m"],
        ["inclination alpha", f"{result['inclination_deg']:.2f}", "deg"],
        ["sag d", f"{result['sag_m']:.4f}", "m"],
        ["elongation", f"{result['elongation_m']:.5f}", "m"],
        ["chord-parallel tension tau", f"{result['tau_N']:.2f}", "N"],
        ["lambda^2", f"{result['lambda2']:.3f}", f"limit {validity['lambda2_limit']:g}"],
        ["epsilon", f"{result['epsilon']:.4f}", f"limit {validity['epsilon_limit']:g}"],
    ]
    matrices = [
        [name, *(f"{v:.5g}" for v in (m[0][0], m[0][1], m[1][1])), unit]
        for name, m, unit in (
            ("axial compliance", result["compliance_axial"], "m/N"),
            ("sag compliance", result["compliance_sag"], "m/N"),
            ("stiffness", result["stiffness"], "N/m"),
        )
    ]
    frequencies = cable_frequencies(result)
    verdict = (
        "The closed-form DSM is within its printed limits."
        if validity["valid"]
        else "Outside the printed limits of the closed-form DSM: "
        + "; ".join(f"{v['parameter']} {v['value']:.4g} against {v['limit']:.4g}" for v in validity["violations"])
    )
    return paragraphs(
        plain_table("Cable", ["", "value", "unit"], parameters),
        plain_table("2-D matrices at the free end", ["", "xx", "xz", "zz", "unit"], matrices),
        plain_table("Natural frequencies, both ends held [Hz]", ["", "by", *"123456"], frequencies),
        verdict,
    )
