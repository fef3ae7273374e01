"""Force distributions along many trajectories in one table."""

from collections.abc import Mapping, Sequence
from typing import Any

from cdpr_struct.reports.figures import many_inputs as figures
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import Plate
from cdpr_struct.reports.many_inputs import rows_csv, rows_files, rows_text, unanswered

Row = Mapping[str, Any]
_COLUMNS = {
    "trajectory": ("folder", "s"),
    "duration [s]": ("duration_s", ".4g"),
    "largest force [N]": ("max_force_N", ".4g"),
    "cable": ("max_force_cable", "d"),
    "lower bound [N]": ("lower_bound_max_N", ".4g"),
    "energy [J]": ("energy_J", ".4g"),
    "lowest cable frequency [Hz]": ("min_cable_frequency_hz", ".4g"),
    "wanted [Hz]": ("wanted_frequency_hz", ".4g"),
}


def trajectory_row(result: Mapping[str, Any]) -> dict[str, Any]:
    """What the table shows of one result.json."""
    forces = [float(force) for force in result["max_force_N"]]
    return {
        "duration_s": float(result["trajectory"]["duration_s"]),
        "max_force_N": max(forces),
        "max_force_cable": forces.index(max(forces)) + 1,
        "lower_bound_max_N": float(result["lower_bound_N"]["max"]),
        "energy_J": float(result["energy_J"]),
        "min_cable_frequency_hz": float(result["min_cable_frequency_hz"]),
        "wanted_frequency_hz": float(result["wanted_frequency_hz"]),
    }


def trajectories_text(result: Mapping[str, Any]) -> str:
    """For the terminal."""
    return rows_text(_summary(result), _COLUMNS, result["trajectories"])


def trajectories_files(result: Mapping[str, Any]) -> dict[str, str | bytes]:
    """The table as CSV, its figures and the page."""
    rows: Sequence[Row] = result["trajectories"]
    told = [row for row in rows if not row["message"]]
    plates = [_forces(told), _frequencies(told)] if told else []
    largest = max((row["max_force_N"] for row in told), default=float("nan"))
    lowest = min((row["min_cable_frequency_hz"] for row in told), default=float("nan"))
    facts = [(f"{largest:.4g} N", "largest force"), (f"{lowest:.4g} Hz", "lowest cable frequency")]
    title = f"{result['robot']}: cable forces along many trajectories"
    return {
        "trajectories.csv": rows_csv(rows),
        **rows_files(title, [_summary(result)], facts if told else [], plates, _COLUMNS, rows, frozenset({0})),
    }


def _forces(told: Sequence[Row]) -> Plate:
    picture = _drawn("largest_forces", told, "max_force_N", "largest cable force [N]")
    said = "Largest cable force along each trajectory. The longest bar sizes winches, cables and anchors."
    return Plate("largest_forces", "Largest forces", picture, said)


def _frequencies(told: Sequence[Row]) -> Plate:
    picture = _drawn("lowest_frequencies", told, "min_cable_frequency_hz", "lowest cable frequency [Hz]")
    wanted = told[0]["wanted_frequency_hz"]
    said = f"Lowest first frequency of any cable along each trajectory; {wanted:.4g} Hz is wanted."
    return Plate("lowest_frequencies", "Lowest cable frequencies", picture, said)


def _drawn(name: str, told: Sequence[Row], key: str, label: str) -> Drawing:
    names, values = [row["folder"] for row in told], [row[key] for row in told]
    return Drawing(name, figures.size(len(told)), lambda f: figures.draw_values(f, names, values, [], (), label))


def _summary(result: Mapping[str, Any]) -> str:
    rows = result["trajectories"]
    failed = len(unanswered(rows))
    text = f"{result['robot']}: {len(rows)} trajectories, {result['bound']} bound"
    return text + (f"; {failed} without an answer." if failed else ".")
