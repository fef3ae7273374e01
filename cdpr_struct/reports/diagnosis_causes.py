"""Pages of the cause library, written from its data."""

from cdpr_struct.diagnosis.causes.cause import Cause
from cdpr_struct.diagnosis.causes.registry import LIBRARY

BLOCKS = {
    "EQ": "wrench balance", "CO": "cable lengths", "NS": "internal force", "LP": "poses at locked lengths",
    "CF": "cable frequencies", "RF": "robot frequencies", "FA": "modal constants of FRFs",
}  # fmt: skip


def cause_page(cause: Cause) -> str:
    """One cause as Markdown."""
    kind = "per cable (all alike, one alone, or each its own)" if cause.per_cable else "of the robot as a whole"
    if cause.groups is not None:
        first = f"`{cause.parameters[0].name}_mast_of_1_2`"
        kind = f"per mast (all alike, one alone, or each its own; {first} is that of the mast of cables 1 and 2)"
    if cause.count is not None:
        kind = "of one state"
    rows = [f"| {p.name} | {'ratio' if p.ratio else p.unit} | {p.prior:g} |" for p in cause.parameters]
    lines = [
        f"# {cause.name}", "", f"{cause.title[:1].upper()}{cause.title[1:]}. Parameters are {kind}.", "",
        "| parameter | unit | prior, one sigma (of the logarithm for ratios) |", "|---|---|---|", *rows, "",
        f"Seen in: {', '.join(BLOCKS[b] for b in cause.seen_in)}.", "",
        f"Separated from its rivals by: {cause.separated_by}.", "",
        "Generated from the library: `python -m cdpr_struct.reports.diagnosis_causes`.", "",
    ]  # fmt: skip
    return "\n".join(lines)


def pages() -> dict[str, str]:
    """File name to text, one page a cause."""
    return {f"{name}.md": cause_page(cause) for name, cause in LIBRARY.items()}


if __name__ == "__main__":
    from pathlib import Path

    for name, text in pages().items():
        (Path("docs/causes") / name).write_text(text, encoding="utf-8")
