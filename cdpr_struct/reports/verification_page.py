"""The files of a verification: tables as CSV, figures as SVG, and the report page."""

import numpy as np

from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import convergence, determinant, interactive, limits, mac, mode_errors, robot_drawing
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import Page, Plate, page_files
from cdpr_struct.reports.verification_notes import verification_notes
from cdpr_struct.reports.verification_result import eigenfrequency_columns, mac_columns
from cdpr_struct.reports.verification_tables import verification_tables
from cdpr_struct.reports.verification_verdict import percent, verdict_lines


def verification_files(trial: Verification) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name; equal results give equal bytes."""
    plates = verification_plates(trial)
    return {
        "eigenfrequencies.csv": csv_text(eigenfrequency_columns(trial)),
        "mac.csv": csv_text(mac_columns(trial)),
        "convergence.csv": _convergence_csv(trial),
        "cables.csv": _cables_csv(trial),
        "determinant_scan.csv": _determinant_csv(trial),
        **page_files(verification_page(trial, plates)),
    }


def verification_page(trial: Verification, plates: list[Plate]) -> Page:
    """The report page around the given figures."""
    robot, (x, y, z) = trial.point.entered, trial.point.position
    return Page(
        robot=robot.name,
        title=f"{robot.name}: the models before the finite elements",
        subtitle=(
            f"{len(robot.cables)} cables, platform {robot.platform.mass:g} kg at ({x:g}, {y:g}, {z:g}) m, "
            f"assembly {trial.assembly}; judged by an independent finite-element model"
        ),
        verdict=verdict_lines(trial),
        holds=not trial.objections(),
        facts=_facts(trial),
        plates=plates,
        tables=verification_tables(trial),
        notes=verification_notes(trial),
    )


def verification_plates(trial: Verification) -> list[Plate]:
    """The figures, in the order of the page."""
    return [_determinant(trial), _convergence(trial), _mode_errors(trial), _mac(trial), _limits(trial), _robot(trial)]


def _determinant(trial: Verification) -> Plate:
    picture = Drawing("determinant", determinant.SIZE, lambda f: determinant.draw_determinant(f, trial))
    caption, plot = determinant.determinant_caption(trial), interactive.determinant_plot(trial)
    return Plate("determinant", "What a determinant scan sees", picture, caption, plot)


def _convergence(trial: Verification) -> Plate:
    picture = Drawing("convergence", convergence.SIZE, lambda f: convergence.draw_convergence(f, trial))
    caption = convergence.convergence_caption(trial)
    return Plate("convergence", "Is the mesh fine enough to judge?", picture, caption)


def _mode_errors(trial: Verification) -> Plate:
    picture = Drawing("mode_errors", mode_errors.SIZE, lambda f: mode_errors.draw_mode_errors(f, trial))
    caption = mode_errors.mode_errors_caption(trial)
    return Plate("mode_errors", "Models against FEM, mode by mode", picture, caption)


def _mac(trial: Verification) -> Plate:
    picture = Drawing("mac", mac.SIZE, lambda f: mac.draw_mac(f, trial))
    return Plate("mac", "Which shapes are alike?", picture, mac.mac_caption(trial))


def _limits(trial: Verification) -> Plate:
    picture = Drawing("limits", limits.SIZE, lambda f: limits.draw_limits(f, trial.limits))
    caption = limits.limits_caption(trial.limits)
    return Plate("limits", "Cables against the printed validity limits", picture, caption)


def _robot(trial: Verification) -> Plate:
    point = trial.point
    picture = Drawing("robot", robot_drawing.SIZE, lambda f: robot_drawing.draw_robot(f, point))
    caption, plot = robot_drawing.robot_caption(point), interactive.robot_plot(point)
    return Plate("robot", "The robot at rest", picture, caption, plot)


def _facts(trial: Verification) -> list[tuple[str, str]]:
    cables = len({v.cable for v in trial.limits.violations})
    return [
        (f"{len(trial.kinds)}", "eigenfrequencies compared"),
        (percent(float(np.abs(trial.exact_error).max())), "largest deviation of the exact model from the FEM limit"),
        (percent(float(np.abs(trial.relative_error).max())), "largest deviation of the DSM from the FEM limit"),
        (percent(trial.fem_uncertainty), "largest uncertainty of the FEM limit"),
        (f"{trial.missed_by_scan} of {len(trial.kinds)}", "modes that the determinant scan misses"),
        (f"{cables} of {len(trial.limits.epsilon)}", "cables outside a printed limit"),
    ]


def _convergence_csv(trial: Verification) -> str:
    modes = len(trial.kinds)
    return csv_text(
        {
            "elements": np.repeat(trial.elements, modes),
            "mode": np.tile(np.arange(1, modes + 1), len(trial.elements)),
            "fem_hz": trial.fem_hertz.ravel(),
            "relative_error": trial.mesh_error.ravel(),
            "relative_error_consistent_mass": trial.consistent_mesh_error.ravel(),
        }
    )


def _cables_csv(trial: Verification) -> str:
    cables, limits_ = trial.point.cables, trial.limits
    number = range(1, len(limits_.epsilon) + 1)
    broken = [";".join(v.parameter for v in limits_.violations if v.cable == i) for i in number]
    return csv_text(
        {
            "cable": number,
            "tension_at_platform_N": cables.tension_at_platform,
            "tau_N": cables.tension,
            "length_m": cables.length,
            "chord_m": cables.chord,
            "sag_m": cables.sag,
            "inclination_deg": limits_.inclination_deg,
            "lambda2": limits_.lambda_squared,
            "epsilon": limits_.epsilon,
            "sag_ratio": limits_.sag_ratio,
            "crossover_distance": limits_.crossover_distance,
            "violates": broken,
        }
    )


def _determinant_csv(trial: Verification) -> str:
    scan = trial.scan
    return csv_text(
        {
            "frequency_hz": scan.hertz,
            "log10_det_dynamic_per_s12": scan.log_dynamic,
            "log10_det_static_per_s12": scan.log_static,
            "is_minimum": np.isin(scan.hertz, scan.minima_hertz).astype(int),
        }
    )
