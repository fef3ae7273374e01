"""Pages of the cause library, written from its data."""

from cdpr_struct.diagnosis.causes import internal_mode
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


def internal_mode_page() -> str:
    """The page of the one cause that is no change of the model."""
    rivals, prior = " and ".join(internal_mode.RIVALS), "equally likely in ln f over the measured band"
    seen = f"a peak of one frequency at {internal_mode.POSES} poses or more that no mode of the model has"
    lines = [
        f"# {internal_mode.NAME}", "",
        "A mode inside the platform. No parameter of the model, whose platform is rigid: its peaks are set aside, and "
        "the extended robot has no such mode.", "",
        "| parameter | unit | prior |", "|---|---|---|", f"| frequency | Hz | {prior} |", "",
        f"Seen in: robot frequencies, as {seen}.", "",
        f"Never told from {rivals} (a mode of frame or mast) by frequencies alone. Separated from it by: "
        f"{internal_mode.NEXT_MEASUREMENT}.", "",
        "Generated from the library: `python -m cdpr_struct.reports.diagnosis_causes`.", "",
    ]  # fmt: skip
    return "\n".join(lines)


def pages() -> dict[str, str]:
    """File name to text, one page a cause."""
    found = {f"{name}.md": cause_page(cause) for name, cause in LIBRARY.items()}
    return {**found, f"{internal_mode.NAME}.md": internal_mode_page()}


if __name__ == "__main__":
    from pathlib import Path

    for name, text in pages().items():
        (Path("docs/causes") / name).write_text(text, encoding="utf-8")
