"""Pages of the cause library, written from its data."""

from dataclasses import replace

from cdpr_struct.hypotheses.causes import internal_force
from cdpr_struct.hypotheses.causes.cause import Cause, Parameter
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.hypothesis import PRICE

BLOCKS = {
    "EQ": "wrench balance", "CO": "cable lengths", "NS": "internal force", "CF": "cable frequencies",
    "RF": "robot frequencies", "FA": "modal constants of FRFs",
}  # fmt: skip


_CARRIED = {"": "of the robot as a whole", "state": "of one state"} | dict.fromkeys(
    ("cable", "mast", "axis"), "per {} (equal for all, one alone, or each different)"
)
"""Whose the parameters of a cause are, by its carrier."""


def cause_page(cause: Cause) -> str:
    """One cause as Markdown."""
    kind = _CARRIED[cause.carrier].format(cause.carrier)
    kind += "; " + ", ".join(label for label, _, _ in cause.shapes) if cause.tuned else ""
    rows = [f"| {p.name} | {'ratio' if p.ratio else p.unit} | {_prior(p)} |" for p in cause.parameters]
    lines = [
        f"# {cause.name}", "", f"{cause.title[:1].upper()}{cause.title[1:]}. Parameters are {kind}.", "",
        "| parameter | unit | prior, one sigma (of the logarithm for ratios) |", "|---|---|---|", *rows, "",
        f"Seen in: {', '.join(BLOCKS[b] for b in cause.seen_in)}.", "",
        f"Separated from its rivals by: {cause.separated_by}.", "",
        "Generated from the library: `python -m cdpr_struct.reports.diagnose.cause_pages`.", "",
    ]  # fmt: skip
    return "\n".join(lines)


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
    "sign_error": ("A coordinate of the pose has the wrong sign", _FILED, "poses", "asking who recorded the data"),
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
    lines = [
        f"# {name}", "", f"{title}.", "", f"Parameters: {parameters}.", "", f"Seen in: {seen}.", "",
        f"Separated from its rivals by: {separated}.", "",
        "Generated from the library: `python -m cdpr_struct.reports.diagnose.cause_pages`.", "",
    ]  # fmt: skip
    return "\n".join(lines)


def index_page() -> str:
    """The table of all causes."""
    titles = {cause.name: cause.title for cause in (*LIBRARY.values(), internal_force.CAUSE)}
    titles |= {name: title for name, (title, *_) in BESIDE.items()}
    rows = [f"| [{name}]({name}.md) | {title[:1].lower()}{title[1:]} |" for name, title in sorted(titles.items())]
    lines = [
        "# Library of causes", "",
        "What [`diagnose`](../measuring.md) tests, and [how](../diagnosis.md). A cause that is missing here can be "
        "[added](../own_cause.md).", "", "| cause | meaning |", "|---|---|", *rows, "",
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
