"""The files of a force distribution: CSV over time, figures, and the report page."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from cdpr_struct.bands.force_bands import ForceBands
from cdpr_struct.dynamics.trajectory_distribution import TrajectoryDistribution
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.distribution_notes import distribution_notes
from cdpr_struct.reports.distribution_result import force_columns, missed_json
from cdpr_struct.reports.distribution_text import BOUND_NAMES, frequency_sentence, saving_sentence
from cdpr_struct.reports.figures import distribution as figures
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.figures.interactive_forces import forces_plot
from cdpr_struct.reports.force_bands_told import force_bands_csv, force_bands_plate, force_bands_table
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files

Found = Sequence[TrajectoryDistribution]


def distribution_files(
    found: Found, within: ForceBands | None = None, bands: Mapping[str, Any] | None = None
) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name; the first entry is the bound that was asked for.

    within, bands : of the first, and key `bands` of the result, if there are any
    """
    plates, tables = distribution_plates(found), {}
    if within is not None and bands is not None:
        plates.insert(1, force_bands_plate(found[0], within, bands["level"]))
        tables["force_bands.csv"] = force_bands_csv(found[0], within)
    page = distribution_page(found, plates)
    if bands is not None:
        page = replace(page, tables=[*page.tables, force_bands_table(bands)])
    return {
        **tables,
        **{f"forces_{f.rule.replace('-', '_')}.csv": csv_text(force_columns(f)) for f in found},
        **page_files(page),
    }


def distribution_plates(found: Found) -> list[Plate]:
    """The figures, in the order of the page (thesis figs 5.5, 5.4 and 5.6, and the frequencies that are behind)."""
    size = figures.panels_size(found)
    return [
        Plate(
            "cable_forces",
            "Force of each cable at the platform",
            Drawing("cable_forces", size, lambda f: figures.draw_forces(f, found)),
            "The forces of least cost that balance weight and inertia of the platform above the bounds (thesis "
            "fig. 5.5).",
            forces_plot(found),
        ),
        Plate(
            "cable_frequencies",
            "Does each cable vibrate as fast as wanted?",
            Drawing("cable_frequencies", size, lambda f: figures.draw_frequencies(f, found)),
            "Lowest natural frequency of each cable held at both ends, exact model with sag, over the wanted "
            f"{found[0].b / (2.0 * np.pi):.4g} Hz (black line), on a logarithmic scale. "
            "Below the line the bound does not ensure the wanted frequency.",
        ),
        Plate(
            "lower_bounds",
            "Lower bound of each cable",
            Drawing("lower_bounds", size, lambda f: figures.draw_bounds(f, found)),
            "What each cable must carry at least. Longer cables need more; the fixed bound applies the largest demand "
            "of all cables and instants to every cable (thesis fig. 5.4).",
        ),
        Plate(
            "energy",
            "Energy spent",
            Drawing("energy", figures.ENERGY_SIZE, lambda f: figures.draw_energy(f, found)),
            "Work of the cable forces, paid for in both directions: the integral of |force| |change of unstrained "
            "length|, all cables (thesis fig. 5.6).",
        ),
    ]


def distribution_page(found: Found, plates: list[Plate]) -> Page:
    """The report page around the given figures."""
    first, path = found[0], found[0].trajectory
    d = first.distribution
    saved = [saving_sentence(a, b) for a in found for b in found if b.rule == "fixed" and a.rule != "fixed"]
    return Page(
        robot=first.robot.name,
        title=f"{first.robot.name}: cable forces along a trajectory",
        subtitle=(
            f"{len(first.max_force)} cables, platform {first.robot.platform.mass:g} kg, {len(path)} instants over "
            f"{path.time[-1] - path.time[0]:.4g} s; {BOUND_NAMES[first.rule]}, {first.model} cables, "
            f"cost {first.cost.name}"
        ),
        verdict=[frequency_sentence(first), *saved],
        holds=not first.missed.any(),
        facts=[
            (f"{first.max_force.max():.0f} N", f"largest cable force (cable {int(first.max_force.argmax()) + 1})"),
            (f"{first.work.total / 1000.0:.1f} kJ", "energy spent"),
            (f"{d.lower.min():.0f} to {d.lower.max():.0f} N", "lower bound"),
            (
                f"{first.frequency.min() / (2.0 * np.pi):.3f} Hz",
                f"lowest cable frequency, wanted {first.b / 6.283185:.3f}",
            ),
            (f"{first.work.winch_power.max() / 1000.0:.2f} kW", "largest power of one winch"),
        ],
        plates=plates,
        tables=[_force_table(found), _motor_table(first), _bound_table(found)],
        notes=distribution_notes(first),
    )


def _force_table(found: Found) -> HtmlTable:
    cables = len(found[0].max_force)
    rows = [[BOUND_NAMES[f.rule], *(f"{v:.0f}" for v in f.max_force), f"{f.max_force.mean():.0f}"] for f in found]
    columns = ["[N]", *(f"cable {i + 1}" for i in range(cables)), "mean"]
    return HtmlTable("Largest force of each cable", columns, rows, "At the platform; thesis Table 5.3.")


def _motor_table(found: TrajectoryDistribution) -> HtmlTable:
    work, frame = found.work, found.distribution.cables.tension_at_frame
    peaks = np.stack([frame.max(axis=0), work.winch_power.max(axis=0), -work.winch_power.min(axis=0)], axis=1)
    rows = [[f"cable {i}", *(f"{v:.0f}" for v in peak)] for i, peak in enumerate(peaks, start=1)]
    note = (
        f"With the {BOUND_NAMES[found.rule]}. All winches together give {work.driving[-1] / 1000.0:.1f} kJ while "
        f"driving and take up {work.braking[-1] / 1000.0:.1f} kJ while braking."
    )
    return HtmlTable("What the motors see", ["", "force [N]", "power [W]", "braking power [W]"], rows, note)


def _bound_table(found: Found) -> HtmlTable:
    columns = ["", "least [N]", "most [N]", "set by", "energy [kJ]", "lowest [Hz]", "missed"]
    rows, marked = [], set()
    for number, f in enumerate(found):
        lower, missed = f.distribution.lower, missed_json(f)["instants"]
        setters = ", ".join(f"cable {i} at {t:.2f} s" for i, t in f.bound_is_set_by[:3])
        lowest = f"{f.frequency.min() / (2.0 * np.pi):.4f}"
        size = [f"{lower.min():.1f}", f"{lower.max():.1f}"]
        rows.append([BOUND_NAMES[f.rule], *size, setters, f"{f.work.total / 1000.0:.1f}", lowest, str(missed)])
        marked |= {number} if missed else set()
    note = (
        "Set by: where the demand is largest. Lowest: cable frequency; missed: instants with a cable below the wanted "
    )
    note += f"{found[0].b / (2.0 * np.pi):.4f} Hz, of {len(found[0].trajectory)}."
    return HtmlTable("The lower bounds", columns, rows, note, frozenset(marked))
