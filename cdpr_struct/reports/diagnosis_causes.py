"""Pages of the cause library, written from its data."""

from cdpr_struct.diagnosis.causes import internal_mode
from cdpr_struct.diagnosis.causes.cause import Cause
from cdpr_struct.diagnosis.causes.registry import LIBRARY
from cdpr_struct.diagnosis.causes.sensors import internal_forces

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


_DAMPING = "log-uniform over four decades, up to a damping ratio of 0.3"
_DECAYS = "two amplitudes or more and four modes or more; free decays rather than FRFs"
_FILED = (
    "none; a corrected copy of the data, tried before all other causes, that must bring 8 nats beyond the logarithm of "
    "the number of such corrections"
)
BESIDE = {
    "unit_error": ("A column is in another unit", _FILED, "every column with a unit", "asking who filed it"),
    "sign_error": ("A coordinate of the pose has the wrong sign", _FILED, "poses", "asking who filed it"),
    "swapped_channels": (
        "Load cells or encoders of two cables are exchanged", _FILED, "tensions and lengths",
        "pulling one cable by hand",
    ),
    "cable_sag": (
        "The simulation under test leaves out the weight of the cables", "none; model `spring` against `dsm`",
        "every kind of data", "another model",
    ),
    "cable_dynamics": (
        "The simulation under test leaves out the cables' own vibration", "none; model `static` against `dsm`",
        "robot frequencies", "another model",
    ),
    "attachment_geometric_stiffness": (
        "The simulation under test leaves out the work of the cable forces on the rotating attachments",
        "none; assembly `thesis` against `consistent`", "robot frequencies", "another assembly",
    ),
    "viscous_damping": (
        "Damping proportional to velocity, of the medium at rest (not the entered ratio) or in the cables' material",
        f"damping_ratio_factor (ratio), or stiffness_time (s); {_DAMPING}",
        "damping ratios of FRFs and decays", _DECAYS,
    ),
    "hysteretic_damping": (
        "Structural damping of the cables, the same at every frequency", f"loss_factor (1); {_DAMPING}",
        "damping ratios of FRFs and decays", _DECAYS,
    ),
    "coulomb_damping": (
        "Dry friction where cables turn at frame and platform", f"friction_moment (N m); {_DAMPING}",
        "damping ratios over amplitude, of decays", _DECAYS,
    ),
}  # fmt: skip
"""Causes that change no world: title, parameters, seen in, separated by."""


def beside_page(name: str) -> str:
    """The page of a cause that is no change of a world."""
    title, parameters, seen, separated = BESIDE[name]
    lines = [
        f"# {name}", "", f"{title}.", "", f"Parameters: {parameters}.", "", f"Seen in: {seen}.", "",
        f"Separated from its rivals by: {separated}.", "",
        "Generated from the library: `python -m cdpr_struct.reports.diagnosis_causes`.", "",
    ]  # fmt: skip
    return "\n".join(lines)


def pages() -> dict[str, str]:
    """File name to text, one page a cause."""
    one = internal_forces(1, 1)
    found = {f"{name}.md": cause_page(cause) for name, cause in {**LIBRARY, one.name: one}.items()}
    found |= {f"{name}.md": beside_page(name) for name in BESIDE}
    return {**found, f"{internal_mode.NAME}.md": internal_mode_page()}


if __name__ == "__main__":
    from pathlib import Path

    for name, text in pages().items():
        (Path("docs/causes") / name).write_text(text, encoding="utf-8")
