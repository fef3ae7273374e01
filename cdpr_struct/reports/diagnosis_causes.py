"""Pages of the cause library, written from its data."""

from cdpr_struct.diagnosis.causes.cause import Cause
from cdpr_struct.diagnosis.causes.registry import LIBRARY

BLOCKS = {
    "EQ": "wrench balance", "CO": "cable lengths", "NS": "internal force", "LP": "poses at locked lengths",
    "CF": "cable frequencies", "RF": "robot frequencies", "FA": "modal constants of FRFs",
}  # fmt: skip


def cause_page(cause: Cause) -> str:
    """One cause as Markdown."""
    kind = "of one state" if cause.count is not None else "of the robot as a whole"
    if cause.per_cable:
        kind = f"per {cause.carrier} (all alike, one alone, or each its own)"
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
