"""Pages of the cause library, written from its data."""

from dataclasses import replace

from cdpr_struct.hypotheses.causes import internal_force
from cdpr_struct.hypotheses.causes.cause import Cause, Parameter
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.hypothesis import PRICE
from cdpr_struct.reports.diagnose.cause_descriptions import DESCRIPTIONS
from cdpr_struct.reports.diagnose.cause_rivals import confused_with
from cdpr_struct.robot.parameters import PARAMETERS

BLOCKS = {
    "EQ": "wrench balance", "CO": "cable lengths", "NS": "internal force", "CF": "cable frequencies",
    "RF": "robot frequencies", "FA": "modal constants of FRFs",
}  # fmt: skip


_CARRIED = {"": "of the robot as a whole", "state": "of one state"} | dict.fromkeys(
    ("cable", "mast", "axis"), "per {} (equal for all, one alone, or each different)"
)
"""Whose the parameters of a cause are, by its carrier."""


NO_PICTURE = ("coulomb_damping",)
"""Causes whose effect depends on the amplitude: no one picture shows it."""


def cause_page(cause: Cause) -> str:
    """One cause as Markdown."""
    kind = _CARRIED[cause.carrier].format(cause.carrier)
    kind += "; " + ", ".join(label for label, _, _ in cause.shapes) if cause.tuned else ""
    if cause.one_of:
        kind = f"per {cause.carrier} (equal for all, or each different), each with one of: {', '.join(cause.one_of)}"
    rows = [f"| {p.name} | {'ratio' if p.ratio else p.unit} | {_prior(p)} |" for p in dict.fromkeys(cause.parameters)]
    table = ["| parameter | unit | prior, one sigma (of the logarithm for ratios) |", "|---|---|---|", *rows]
    sign = cause.sign or DESCRIPTIONS[cause.name].sign
    seen = ", ".join(BLOCKS[b] for b in cause.seen_in)
    title = f"{cause.title[:1].upper()}{cause.title[1:]}. Parameters are {kind}."
    return "\n".join(_page(cause.name, title, table, sign, seen, cause.separated_by, _extended(cause)))


def _page(
    name: str, title: str, table: list[str], sign: str, seen: str, separated_by: str, extended: list[str]
) -> list[str]:
    """All lines of a page."""
    said = DESCRIPTIONS[name]
    picture = (
        [] if name in NO_PICTURE else [f"![{name} in every kind of reading](pictures/{name}.svg)", "", _CAPTION, ""]
    )
    others = ", ".join(f"[{other}]({other}.md)" for other in confused_with(name))
    return [
        f"# {name}", "", title, "", *table, "",
        "## Law", "", f"{said.law[:1].upper()}{said.law[1:]}.", "", *extended,
        *([f"Sign: {sign}.", ""] if sign else []),
        *([f"Reference: {said.reference}.", ""] if said.reference else []),
        "## What it looks like", "", f"{said.looks}.", "", *picture, f"Seen in: {seen}.", "",
        "## Confused with", "",
        f"Campaigns often do not tell it from {others}." if others else _NO_RIVAL,
        "", "## What to measure next", "", f"{separated_by[:1].upper()}{separated_by[1:]}.", "",
        "Generated from the library: `python -m cdpr_struct.reports.diagnose.cause_pages`.", "",
    ]  # fmt: skip


_NO_RIVAL = "No cause of the library is often taken for it."
_CAPTION = (
    "Bars: real less simulated, winches locked at the same encoder lengths. How the pictures are made, and all others: "
    "[gallery](gallery.md)."
)


def _extended(cause: Cause) -> list[str]:
    """What of the extended robot holds it."""
    if cause.outside or cause.extension not in PARAMETERS:
        return []
    rule = PARAMETERS[cause.extension]
    place = rule.place if rule.place != "extensions" else f"extensions.{cause.extension}"
    return [f"In the [extended robot](../files.md#extensions): `{place}` [{rule.unit}].", ""]


def _prior(parameter: Parameter) -> str:
    """One sigma, in the parameter's own unit."""
    if parameter.in_band:
        return f"{parameter.prior:g} times the highest measured robot frequency"
    return f"{parameter.prior:g}"


def internal_force_page() -> str:
    """The cause that acts on commanded lengths: the numbers of one direction, in one state."""
    same, own = internal_force.patterns(1, 1)
    return cause_page(replace(internal_force.CAUSE, parameters=same.parameters + own.parameters))


_DAMPING = "log-uniform over four decades, up to a damping ratio of 0.3"
_DECAYS = "two or more amplitudes and four or more modes; free decays rather than FRFs"
_FILED = (
    f"none; a corrected copy of the data; its prior odds against the data as recorded are exp(-{PRICE:g}) divided by "
    "the number of such corrections"
)
BESIDE = {
    "unit_error": ("A column is in another unit", _FILED, "every column with a unit", "asking who recorded the data"),
    "sign_error": (
        "A coordinate of the pose has the wrong sign, or an encoder on a swivel counts the other way round", _FILED,
        "poses, swivel angles", "asking who recorded the data"),
    "rotation_convention": (
        "The poses are written in another convention: order of rotations, quaternion, transpose, axes of the frame",
        _FILED, "poses of several orientations", "entering one pose with a single large angle",
    ),
    "swapped_channels": (
        "Load cells or encoders of two cables are exchanged", _FILED, "tensions and lengths",
        "pulling one cable by hand",
    ),
    "cable_sag": (
        "The simulation under test leaves out the weight of the cables", "none; model `spring` against `dsm`",
        "every kind of data", "another model",
    ),
    "cable_dynamics": (
        "The simulation under test leaves out the vibration of the cables", "none; model `static` against `dsm`",
        "robot frequencies", "another model",
    ),
    "attachment_geometric_stiffness": (
        "The simulation under test leaves out the geometric stiffness of the rotating attachments",
        "none; assembly `thesis` against `consistent`", "robot frequencies", "another assembly",
    ),
    "viscous_damping": (
        "Damping proportional to velocity, of the surrounding medium (other than entered) or in the cable material",
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
"""Causes that change nothing of the robot: title, parameters, seen in, separated by."""


def beside_page(name: str) -> str:
    """The page of a cause that is no change of the robot."""
    title, parameters, seen, separated = BESIDE[name]
    table = [f"Parameters: {parameters}."]
    return "\n".join(_page(name, f"{title}.", table, DESCRIPTIONS[name].sign, seen, separated, []))


def index_page() -> str:
    """The table of all causes."""
    titles = {cause.name: cause.title for cause in (*LIBRARY.values(), internal_force.CAUSE)}
    titles |= {name: title for name, (title, *_) in BESIDE.items()}
    rows = [f"| [{name}]({name}.md) | {title[:1].lower()}{title[1:]} |" for name, title in sorted(titles.items())]
    lines = [
        "# Library of causes", "",
        "What [`diagnose`](../measuring.md) tests, and [how](../diagnosis.md). A cause that is missing here can be "
        "[added](../own_cause.md). All of them in pictures: [gallery](gallery.md).", "",
        "| cause | meaning |", "|---|---|", *rows, "",
        "Generated from the library: `python -m cdpr_struct.reports.diagnose.cause_pages`.", "",
    ]  # fmt: skip
    return "\n".join(lines)


def pages() -> dict[str, str]:
    """File name to text: one page a cause, and the table of all."""
    found = {f"{name}.md": cause_page(cause) for name, cause in LIBRARY.items()}
    found |= {f"{name}.md": beside_page(name) for name in BESIDE}
    return {**found, f"{internal_force.CAUSE.name}.md": internal_force_page(), "index.md": index_page()}


if __name__ == "__main__":
    from pathlib import Path

    for name, text in pages().items():
        (Path("docs/causes") / name).write_text(text, encoding="utf-8")
