"""The files of one cable's description: profile as CSV, figures as SVG, and the report page."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.reports.cable_bands_told import cable_bands_plate, cable_bands_table
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import single_cable
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.text import cable_frequencies


def cable_files(result: Mapping[str, Any]) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name; `result` as `describe_cable` gives it."""
    plates = cable_plates(result)
    if "bands" in result:
        plates.append(cable_bands_plate(result))
    trace = single_cable.stiffness_trace(result)
    return {
        "profile.csv": csv_text(profile_columns(result)),
        "stiffness_trace.csv": csv_text(
            {
                "frequency_hz": trace.hertz,
                "dynamic_N_per_m": trace.dynamic,
                "static_N_per_m": np.full(len(trace.hertz), trace.static),
            }
        ),
        **page_files(cable_page(result, plates)),
    }


def profile_columns(result: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of profile.csv, one row a point of the cable."""
    profile = single_cable.cable_profile(result)
    return {
        "s_m": profile.s,
        "x_m": profile.x,
        "z_m": profile.z,
        "along_chord_m": profile.along,
        "below_chord_m": profile.below,
    }


def cable_plates(result: Mapping[str, Any]) -> list[Plate]:
    """The figures, in the order of the page."""
    return [
        Plate(
            "profile",
            "The hanging cable",
            Drawing("profile", single_cable.PROFILE_SIZE, lambda f: single_cable.draw_profile(f, result)),
            single_cable.profile_caption(result),
        ),
        Plate(
            "stiffness_trace",
            "Dynamic against static stiffness",
            Drawing("stiffness_trace", single_cable.TRACE_SIZE, lambda f: single_cable.draw_trace(f, result)),
            single_cable.trace_caption(result),
        ),
    ]


def cable_page(result: Mapping[str, Any], plates: list[Plate]) -> Page:
    """The report page around the given figures."""
    given, validity = result["input"], result["validity"]
    return Page(
        title="One cable under an end force",
        subtitle=(
            f"unstrained {given['length_m']:g} m, EA {given['axial_stiffness_N']:g} N, "
            f"{given['linear_density_kg_m']:g} kg/m, gravity {given['gravity_m_s2']:g} m/s²"
        ),
        verdict=[validity_sentence(validity)],
        holds=validity["valid"],
        facts=[
            (f"{result['chord_m']:.3f} m", "chord"),
            (f"{1000.0 * result['sag_m']:.4g} mm", "sag"),
            (f"{result['tau_N']:.4g} N", "tension τ along the chord"),
            (f"{result['lambda2']:.3g}", f"λ² (limit {validity['lambda2_limit']:g})"),
            (f"{result['epsilon']:.3g}", _epsilon_meaning(result)),
        ],
        plates=plates,
        tables=[
            _matrices(result),
            _frequencies(result),
            *([cable_bands_table(result["bands"])] if "bands" in result else []),
        ],
        notes=[("How it was computed", _NOTES)],
    )


_NOTES = (
    "Shape, sag and elongation: the elastic catenary, without approximation (eqs 2.11 to 2.23). Compliance: its exact "
    "derivative, split into the stretch and the change of sag (eqs 2.28, 2.29).",
    "Dynamic stiffness and frequencies: the closed form for shallow, taut cables (eqs 2.31 to 2.41), valid inside "
    "the limits of the verdict only. Linear elastic material, no bending stiffness, one end held.",
)


def validity_sentence(validity: Mapping[str, Any]) -> str:
    """Whether the closed form is within its printed limits, or which it breaks."""
    if validity["valid"]:
        return "The closed-form dynamic stiffness is within its printed limits."
    broken = "; ".join(f"{v['parameter']} {v['value']:.4g} against {v['limit']:.4g}" for v in validity["violations"])
    return f"Outside the printed limits of the closed-form dynamic stiffness: {broken}."


def _epsilon_meaning(result: Mapping[str, Any]) -> str:
    limit, angle = result["validity"]["epsilon_limit"], result["inclination_deg"]
    return f"ε (limit {limit:g} at {angle:.1f}°)" if limit > 0.0 else f"ε (no limit is given at {angle:.1f}°)"


def _matrices(result: Mapping[str, Any]) -> HtmlTable:
    rows = [
        [name, f"{m[0][0]:.5g}", f"{m[0][1]:.5g}", f"{m[1][1]:.5g}", unit]
        for name, m, unit in (
            ("axial compliance", result["compliance_axial"], "m/N"),
            ("sag compliance", result["compliance_sag"], "m/N"),
            ("stiffness", result["stiffness"], "N/m"),
        )
    ]
    note = (
        "x horizontal, z up, in the cable's plane, for a motion of C with B held. Total compliance is the sum of both "
        "parts."
    )
    return HtmlTable("Static stiffness at C", ["", "xx", "xz", "zz", "unit"], rows, note)


def _frequencies(result: Mapping[str, Any]) -> HtmlTable:
    rows = cable_frequencies(result)
    columns = ["plane", "by", *(f"{n + 1} [Hz]" for n in range(len(rows[0]) - 2))]
    note = "Where the exact catenary and the closed form differ, the closed form is outside its limits."
    return HtmlTable("Natural frequencies, both ends held", columns, rows, note)
