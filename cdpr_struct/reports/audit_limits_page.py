"""The files of a trial of the printed limits: tables as CSV, figures as SVG, and the report page."""

from cdpr_struct.crosscheck.limits_domain import MAX_STRAIN
from cdpr_struct.crosscheck.limits_trial import LimitsTrial
from cdpr_struct.reports import audit_limits_text as text
from cdpr_struct.reports.audit_limits_result import MEANINGS, cable_columns, veering_csv
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import audit_error_map, audit_evidence, audit_veering
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files

_MAPS = (
    ("in_plane_frequency", "Error of the clamped frequencies"),
    ("mode_shape", "Error of the mode shapes"),
    ("end_mass_frequency", "Error of the frequencies of a mass on the cable"),
)


def limits_trial_files(trial: LimitsTrial) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name; equal results give equal bytes."""
    plates = _plates(trial)
    return {
        "cables.csv": csv_text(cable_columns(trial)),
        "veering.csv": veering_csv(trial),
        **page_files(_page(trial, plates)),
    }


def _page(trial: LimitsTrial, plates: list[Plate]) -> Page:
    return Page(
        title="The validity limits of the closed-form dynamic stiffness, on trial",
        subtitle="λ² ≤ 24, distance from the crossovers, pairs of α and ε, d/l ≤ 1/20; tried on a single cable",
        verdict=text.verdict(trial),
        holds=trial.holds,
        facts=_facts(trial),
        plates=plates,
        tables=_tables(trial),
        notes=_NOTES,
    )


def _facts(trial: LimitsTrial) -> list[tuple[str, str]]:
    inside = trial.inside
    return [
        (f"{len(trial.groups)}", "cables tried"),
        (f"{int(inside.sum())}", "inside the printed limits"),
        (f"{100.0 * trial.error('in_plane_frequency')[inside].max():.2g} %", "largest frequency error among these"),
        (f"{100.0 * trial.error('end_mass_frequency')[inside].max():.2g} %", "the same with a mass at the end"),
        (f"{100.0 * trial.curves[-1].gap:.2g} %", "gap at the first crossover, inclined"),
    ]


def _plates(trial: LimitsTrial) -> list[Plate]:
    def drawn(name: str, title: str, size: tuple[float, float], draw: object, caption: str) -> Plate:
        return Plate(name, title, Drawing(name, size, draw), caption)  # type: ignore[arg-type]

    return [
        drawn("veering", "What happens at the crossovers", audit_veering.SIZE,
              lambda f: audit_veering.draw_veering(f, trial), audit_veering.veering_caption(trial)),
        *(
            drawn(f"error_{quantity}", title, audit_error_map.SIZE,
                  lambda f, q=quantity: audit_error_map.draw_error_map(f, trial, q),
                  audit_error_map.error_map_caption(trial, quantity))
            for quantity, title in _MAPS
        ),
        drawn("evidence", "Which limit is missing", audit_evidence.SIZE,
              lambda f: audit_evidence.draw_evidence(f, trial), audit_evidence.evidence_caption(trial)),
    ]  # fmt: skip


def _tables(trial: LimitsTrial) -> list[HtmlTable]:
    bad = [i for i, limit in enumerate(trial.held_out) if limit.after > trial.tolerance]
    return [
        HtmlTable("Inside the printed limits", text.INSIDE_COLUMNS, text.inside_rows(trial)),
        HtmlTable(
            "Limits that are missing",
            text.MISSING_COLUMNS,
            text.missing_rows(trial),
            "Cause: the effect whose removal from the reference halves the error. Limit: of all dimensionless "
            "groups the one "
            "that excludes these errors at least cost in rightly admitted volume (inclination, log ε, log λ²).",
        ),
        HtmlTable(
            "Cables that only one printed limit refuses",
            text.STRICT_COLUMNS,
            text.strict_rows(trial),
            "Nothing: not one refused cable had to be refused. The crossovers all lie above λ² = 24, and d/l > 1/20 is "
            "ε > 0.4, so these two are counted where only their companion is broken as well.",
        ),
        HtmlTable(
            "Random cables inside the printed limits, not used to find the further ones",
            text.HELD_OUT_COLUMNS,
            text.held_out_rows(trial),
            marked=frozenset(bad),
        ),
        HtmlTable("The catenary before the finite-element referee", text.REFEREE_COLUMNS, text.referee_rows(trial)),
        HtmlTable("Groups", ["name", "meaning"], [[name, meaning] for name, meaning in MEANINGS.items()]),
    ]


_NOTES = [
    (
        "How to read this",
        [
            "A cable at rest has three dimensionless numbers: weight across the chord over tension (ε, the sag), "
            "weight along "
            "the chord over tension (ε tan α), and tension over stiffness (τ/EA, the strain). λ² follows from ε and "
            "the "
            "strain. The inclination itself is no such number: in the axes of the chord only the two parts of the "
            "weight "
            "are left of it, so a limit on α stands in for one on ε tan α.",
            "The closed form keeps ε and λ². It leaves out the weight along the chord, the inertia along the chord (it "
            "stretches without delay), the strain at rest, and the curvature beyond a parabola. The reference "
            "contains them "
            "all and can leave out each; that is how an error gets its cause.",
        ],
    ),
    (
        "How it was computed",
        [
            "Reference: the linearised elastic catenary by Galerkin's method, checked against the extrapolated "
            "finite-element "
            "model. Frequencies are compared in order, shapes by the modal assurance criterion with their best "
            "partner.",
            "End stiffness: the smallest number such that changing frequency and stiffness (scaled by the static "
            "one) by it "
            "makes both models agree; median in each of six bands up to the sixth mode, both ends. Mass at the end: "
            "a point "
            "mass of 1, 3, 10, 30 or 100 cable masses; this is what a robot sees of K(ω).",
            f"Cables with strains above {MAX_STRAIN:.0%} are not tried: the print admits them, no rope of a robot "
            f"carries "
            "them. Damping enters both models by the same substitution and adds no group.",
        ],
    ),
]
